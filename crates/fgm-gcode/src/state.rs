use fgm_core::Mixture;

use crate::{GcodeError, Machine, MachineKind, ratio::safe_ratios};

/// What a machine is told so that one colour of the palette comes out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The mixture that is commanded: the colour's, rounded to what the firmware takes.
    pub mixture: Mixture,
    /// The head, on a tool changer.
    pub tool: Option<u32>,
    /// The nozzle temperature, °C, where the colour decides it.
    pub temperature: Option<f64>,
    /// Factor on the fed filament, 1 where nothing foams.
    pub flow: f64,
}

impl State {
    /// A mixture, with nothing else to tell.
    pub fn plain(mixture: Mixture) -> Self {
        Self { mixture, tool: None, temperature: None, flow: 1.0 }
    }
}

impl Machine {
    /// The states for the colours of a palette, in its order.
    ///
    /// A mixing hotend gets ratios by [`safe_ratios`](crate::safe_ratios), a tool changer its
    /// heads in order, a foaming filament a temperature (`low` for all of the first material,
    /// `high` for all of the second, linear between, in the profile's steps) with the flow of the
    /// profile's polynomial at that temperature.
    ///
    /// # Errors
    /// [`GcodeError::NoColors`]; [`GcodeError::TooManyColors`] for more colours than heads;
    /// [`GcodeError::TooManyMaterials`] for mixtures of more materials than there are inputs;
    /// [`GcodeError::Cold`] for a temperature below the least one for extrusion.
    ///
    /// ```
    /// use fgm_core::Mixture;
    /// use fgm_gcode::{Machine, MachineKind};
    ///
    /// let mixing = Machine { kind: MachineKind::Mixing, inputs: 2, ..Machine::default() };
    /// let states = mixing.states(&[Mixture::from_weights(&[1.0, 3.0])?])?;
    /// assert_eq!(states[0].mixture.fractions(), [0.25, 0.75]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn states(&self, palette_mixtures: &[Mixture]) -> Result<Vec<State>, GcodeError> {
        let colors = palette_mixtures.len();
        if colors == 0 {
            return Err(GcodeError::NoColors);
        }
        if let Some(heads) = self.max_colors().filter(|heads| colors > *heads) {
            return Err(GcodeError::TooManyColors { colors, heads, machine: self.name.clone() });
        }
        palette_mixtures.iter().enumerate().map(|(i, m)| self.state_of(i, m)).collect()
    }

    fn state_of(&self, color: usize, mixture: &Mixture) -> Result<State, GcodeError> {
        let mixes = self.kind != MachineKind::ToolChanger;
        if mixes && mixture.materials() > self.inputs() {
            return Err(GcodeError::TooManyMaterials {
                color,
                materials: mixture.materials(),
                inputs: self.inputs(),
                machine: self.name.clone(),
            });
        }
        let plain = State::plain(*mixture);
        match self.kind {
            MachineKind::Mixing => {
                let decimals = self.dialect.name.ratio_decimals();
                let mixture = safe_ratios(mixture, self.min_fraction, decimals);
                Ok(State { mixture, ..plain })
            }
            MachineKind::ToolChanger => Ok(State { tool: Some(color as u32), ..plain }),
            MachineKind::Foaming => self.foaming_state(color, plain),
        }
    }

    fn foaming_state(&self, color: usize, plain: State) -> Result<State, GcodeError> {
        let foaming = &self.foaming;
        let share = plain.mixture.fractions().get(1).copied().unwrap_or(0.0);
        let celsius = foaming.temperature(share);
        let least = self.temperature.min_extrusion;
        if celsius.is_nan() || celsius < least {
            return Err(GcodeError::Cold { what: format!("colour {color}"), celsius, least });
        }
        // What is printed is the rounded temperature, so that is the mixture, too.
        let span = foaming.high - foaming.low;
        let share =
            if span == 0.0 { share } else { ((celsius - foaming.low) / span).clamp(0.0, 1.0) };
        let mixture = match plain.mixture.materials() {
            1 => plain.mixture,
            _ => Mixture::from_weights(&[1.0 - share, share]).unwrap_or(plain.mixture),
        };
        Ok(State { mixture, temperature: Some(celsius), flow: foaming.flow_at(celsius), ..plain })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DialectName, Foaming};

    fn mixtures(shares: &[f64]) -> Vec<Mixture> {
        shares.iter().map(|s| Mixture::from_weights(&[1.0 - s, *s]).unwrap()).collect()
    }

    fn foaming(flow: Vec<f64>, low: f64, high: f64) -> Machine {
        let mut machine = Machine { kind: MachineKind::Foaming, ..Machine::default() };
        machine.dialect.name = DialectName::Foaming;
        machine.foaming = Foaming { low, high, flow, ..Foaming::default() };
        machine
    }

    #[test]
    fn foaming_follows_the_paper() {
        let pla = foaming(vec![-77.814, 1.13374, -5.37075e-3, 8.35479e-6], 190.0, 225.0);
        let states = pla.states(&mixtures(&[0.0, 0.5, 1.0])).unwrap();
        let seen: Vec<_> =
            states.iter().map(|s| (s.temperature, (s.flow * 100.0).round())).collect();
        // 207.5 °C is no whole degree: it becomes the even one beside it.
        assert_eq!(seen, [(Some(190.0), 102.0), (Some(208.0), 83.0), (Some(225.0), 55.0)]);

        let tpu = foaming(vec![15.9560, -1.38401e-1, 3.09637e-4], 190.0, 220.0);
        let states = tpu.states(&mixtures(&[0.0, 1.0])).unwrap();
        let seen: Vec<_> =
            states.iter().map(|s| (s.temperature, (s.flow * 100.0).round())).collect();
        assert_eq!(seen, [(Some(190.0), 84.0), (Some(220.0), 49.0)]);
    }

    #[test]
    fn heads_in_order_and_no_more_colours_than_heads() {
        let mut machine =
            Machine { kind: MachineKind::ToolChanger, inputs: 5, ..Machine::default() };
        machine.name = "five".into();
        let states = machine.states(&mixtures(&[0.1, 0.3, 0.5, 0.7, 0.9])).unwrap();
        assert_eq!(states.iter().filter_map(|s| s.tool).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
        let error = machine.states(&mixtures(&[0.0; 6])).unwrap_err();
        assert_eq!(error.to_string(), "6 colours on 5 heads of five");
        assert!(matches!(machine.states(&[]), Err(GcodeError::NoColors)));
    }

    #[test]
    fn more_materials_than_inputs_are_refused() {
        let machine = Machine { inputs: 2, ..Machine::default() };
        let three = Mixture::from_weights(&[1.0, 1.0, 1.0]).unwrap();
        assert!(matches!(
            machine.states(&[three]),
            Err(GcodeError::TooManyMaterials { color: 0, materials: 3, inputs: 2, .. })
        ));
    }

    #[test]
    fn too_cold_to_foam_is_refused() {
        let machine = foaming(vec![1.0], 20.0, 225.0);
        assert!(matches!(machine.states(&mixtures(&[0.0])), Err(GcodeError::Cold { .. })));
    }
}
