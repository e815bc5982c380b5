use fgm_gcode::{Foaming, Machine, MachineKind};

use super::Thermal;
use crate::Transition;

/// From what a machine is told to what it lays down.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// From the mixing, or the melting, to the nozzle's tip.
    pub transition: Transition,
    /// How the nozzle's temperature follows its command, where the deposit depends on it; none for
    /// at once.
    pub thermal: Option<Thermal>,
    /// The foaming filament, on a machine that has one.
    pub foaming: Option<Foaming>,
}

impl Model {
    /// What is told is laid down at once.
    pub fn ideal(machine: &Machine) -> Self {
        let foams = machine.kind == MachineKind::Foaming;
        Self {
            transition: Transition::IDEAL,
            thermal: None,
            foaming: foams.then(|| machine.foaming.clone()),
        }
    }

    /// By the machine's profile: its transition, else a delay of its dead volume, neither on a tool
    /// changer; the rates of its heating and cooling, where a foaming filament has them.
    pub fn of(machine: &Machine) -> Self {
        let usual = Transition { delay: machine.dead_volume(), length: 0.0 };
        let transition = match machine.kind {
            MachineKind::ToolChanger => Transition::IDEAL,
            MachineKind::Mixing | MachineKind::Foaming => Transition::of(machine).unwrap_or(usual),
        };
        let thermal = Thermal::of(machine).filter(|_| machine.kind == MachineKind::Foaming);
        Self { thermal, ..Self::ideal(machine).with_transition(transition) }
    }

    /// With another transition.
    #[must_use]
    pub fn with_transition(mut self, transition: Transition) -> Self {
        self.transition = transition;
        self
    }
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Transition { delay, length } = self.transition;
        match (delay > 0.0, length > 0.0) {
            (false, false) => f.write_str("ideal")?,
            (true, false) => write!(f, "{delay:.2} mm3 late")?,
            (_, true) => write!(f, "{delay:.2} mm3 late, changing over {length:.2} mm3")?,
        }
        match &self.thermal {
            None => Ok(()),
            Some(t) => write!(
                f,
                ", heating {} °C/s, cooling {} °C/s, time constant {} s",
                t.heating, t.cooling, t.time_constant
            ),
        }
    }
}
