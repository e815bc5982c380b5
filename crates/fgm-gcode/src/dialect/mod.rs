mod foaming;
mod marlin;
mod mixing;
mod tools;

use fgm_core::ColorId;

use crate::{DialectName, Fixed, GcodeError, Machine, State, Text};

pub use foaming::Foam;
pub use marlin::{MarlinDirect, MarlinMixing, MarlinTools, Motors};
pub use mixing::{Kalico, RepRap, Repetier};
pub use tools::{PrusaXl, ToolChange};

/// What a firmware is told, and how.
///
/// One method is required: how a colour is set. Everything else has a default that Marlin,
/// RepRapFirmware, Klipper and their kin share, so that a new system is one small implementation;
/// `docs/dialects.md` shows one for a valve.
pub trait Dialect {
    /// Sets a colour, in whole lines.
    ///
    /// # Errors
    /// [`GcodeError`] where the state cannot be told, such as a ratio that is no number.
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError>;

    /// Learns the palette's states, before anything is written. Nothing by default.
    fn palette(&mut self, states: &[State]) {
        let _ = states;
    }

    /// Follows where the deposit takes on a colour, a dead volume after [`state`](Self::state):
    /// here the flow is told, unless it is [folded into E](Self::folds_flow). Nothing by default.
    ///
    /// # Errors
    /// [`GcodeError`] as for [`state`](Self::state).
    fn deposit(&mut self, state: &State, out: &mut Text) -> Result<(), GcodeError> {
        let _ = (state, out);
        Ok(())
    }

    /// A straight move: `G1` with the words that are there.
    #[inline]
    fn linear(&mut self, to: &Move, out: &mut Text) {
        out.raw("G1");
        for (letter, axis) in [('X', to.x), ('Y', to.y), ('Z', to.z)] {
            if let Some(value) = axis {
                out.word(letter, value);
            }
        }
        if let Some(e) = to.e {
            out.word('E', e);
        }
        if let Some(feedrate) = to.feedrate {
            out.int('F', feedrate);
        }
        out.end();
    }

    /// Units and modes, after the start template: millimetres, absolute positions, and relative
    /// extrusion, which is stated after every `G90`.
    fn begin(&mut self, out: &mut Text) {
        out.raw("G21\nG90\nM83\n");
    }

    /// Before the end template. Nothing by default.
    fn end(&mut self, out: &mut Text) {
        let _ = out;
    }

    /// A comment of one line.
    fn comment(&mut self, text: &str, out: &mut Text) {
        out.raw(";").line(text);
    }

    /// A nozzle's temperature, whole degrees: `M104`, or `M109` to wait for it.
    fn temperature(&mut self, tool: Option<u32>, celsius: f64, wait: bool, out: &mut Text) {
        out.raw(if wait { "M109" } else { "M104" });
        if let Some(tool) = tool {
            out.int('T', tool);
        }
        out.int('S', celsius.round() as u32).end();
    }

    /// The bed's temperature, whole degrees: `M140`, or `M190` to wait for it.
    fn bed_temperature(&mut self, celsius: f64, wait: bool, out: &mut Text) {
        out.raw(if wait { "M190" } else { "M140" }).int('S', celsius.round() as u32).end();
    }

    /// The part's fan, 0..=1: `M106`, or `M107` for off.
    fn fan(&mut self, share: f64, out: &mut Text) {
        match (share.clamp(0.0, 1.0) * 255.0).round() as u32 {
            0 => out.line("M107"),
            speed => out.raw("M106").int('S', speed).end(),
        }
    }

    /// Whether a change of colour makes the machine stop until all moves before it are over: the
    /// estimate of the time counts it. Not by default.
    fn stops(&self) -> bool {
        false
    }

    /// Whether the flow of a state is part of every E (the default), or told by
    /// [`deposit`](Self::deposit).
    fn folds_flow(&self) -> bool {
        true
    }
}

/// The setting of a colour.
#[derive(Clone, Copy, Debug)]
pub struct Change<'a> {
    /// The colour.
    pub color: ColorId,
    /// What it takes.
    pub state: &'a State,
    /// What was set before; none for the first colour, set inside the start template.
    pub previous: Option<&'a State>,
    /// The temperature that a tool changer's new head prints at, °C.
    pub temperature: f64,
    /// The temperature of the head that is left, °C; none to leave it hot.
    pub standby: Option<f64>,
}

/// The words of a straight move; what is not there does not change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Move {
    /// Absolute, mm.
    pub x: Option<Fixed<3>>,
    /// Absolute, mm.
    pub y: Option<Fixed<3>>,
    /// Absolute, mm.
    pub z: Option<Fixed<3>>,
    /// Relative, mm of filament.
    pub e: Option<Fixed<5>>,
    /// Speed, mm/min.
    pub feedrate: Option<u32>,
}

impl Machine {
    /// The dialect that the profile names.
    pub fn dialect(&self) -> Box<dyn Dialect + Send> {
        let options = &self.dialect;
        let tool = options.virtual_tool;
        let mixing = || {
            let leading = options.leading_weights.clone();
            Motors::new(leading, self.inputs)
        };
        match options.name {
            DialectName::MarlinMixing if options.virtual_tools > 0 => {
                Box::new(MarlinTools::new(mixing(), options.virtual_tools))
            }
            DialectName::MarlinMixing => Box::new(MarlinMixing::new(mixing(), tool)),
            DialectName::MarlinDirect => Box::new(MarlinDirect::new(mixing())),
            DialectName::RepRap => Box::new(RepRap::new(mixing(), tool)),
            DialectName::Kalico => Box::new(Kalico::new(mixing())),
            DialectName::Repetier => Box::new(Repetier::new(mixing(), tool)),
            DialectName::ToolChange => Box::new(ToolChange),
            DialectName::PrusaXl => Box::new(PrusaXl),
            DialectName::Foaming => Box::new(Foam::new(self.foaming.flow_command)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DialectOptions;
    use fgm_core::Mixture;

    const LOW: [f64; 2] = [0.25, 0.75];
    const PURE: [f64; 2] = [1.0, 0.0];

    fn state(weights: &[f64]) -> State {
        let mixture = Mixture::from_weights(weights).unwrap();
        State { mixture, tool: Some(1), temperature: Some(207.0), flow: 0.8125 }
    }

    /// The text of a change from a state of tool 0 to `weights`.
    fn change(machine: &Machine, weights: &[f64]) -> String {
        let mut out = Text::new();
        let (next, mut last) = (state(weights), state(&PURE));
        last.tool = Some(0);
        let change = Change {
            color: ColorId(1),
            state: &next,
            previous: Some(&last),
            temperature: 215.0,
            standby: Some(150.0),
        };
        let mut dialect = machine.dialect();
        dialect.state(&change, &mut out).unwrap();
        dialect.deposit(&next, &mut out).unwrap();
        out.to_text()
    }

    fn machine(name: DialectName) -> Machine {
        let dialect = DialectOptions { name, virtual_tool: 2, ..DialectOptions::default() };
        Machine { dialect, ..Machine::default() }
    }

    #[test]
    fn every_dialect() {
        for (name, weights, expected) in [
            (DialectName::MarlinMixing, LOW, "M163 S0 P0.25\nM163 S1 P0.75\nM164 S2\n"),
            (DialectName::MarlinDirect, LOW, "M165 A0.25 B0.75\n"),
            (DialectName::RepRap, LOW, "M567 P2 E0.25:0.75\n"),
            (DialectName::Kalico, LOW, "M400\nSET_MIXING_EXTRUDER FACTORS=0.25:0.75\n"),
            (DialectName::Repetier, LOW, "M163 S0 P250\nM163 S1 P750\nM164 S2\n"),
            (DialectName::Repetier, [0.0, 1.0], "M163 S1 P1000\nM163 S0 P0\nM164 S2\n"),
            (DialectName::ToolChange, LOW, "M109 T1 S215\nT1\nM104 T0 S150\n"),
            (DialectName::PrusaXl, LOW, "P0 S1 L2 D0\nM109 T1 S215\nT1 S1 L0 D0\nM104 T0 S150\n"),
            (DialectName::Foaming, LOW, "M104 S207\n"),
        ] {
            assert_eq!(change(&machine(name), &weights), expected, "{name:?}");
        }
    }

    #[test]
    fn a_table_of_tools_is_written_once_and_its_last_one_is_free() {
        let mut machine = machine(DialectName::MarlinMixing);
        machine.dialect.virtual_tools = 2;
        let mut dialect = machine.dialect();
        let states = [PURE, LOW, [0.5, 0.5]].map(|w| state(&w));
        dialect.palette(&states);
        let mut tell = |weights: [f64; 2]| {
            let (state, mut out) = (state(&weights), Text::new());
            let color = ColorId(0);
            let change =
                Change { color, state: &state, previous: None, temperature: 215.0, standby: None };
            dialect.state(&change, &mut out).unwrap();
            out.to_text()
        };
        let low = "M163 S0 P0.25\nM163 S1 P0.75\nM164 S1\nT1\n";
        let table = "M163 S0 P1\nM163 S1 P0\nM164 S0\nM163 S0 P0.25\nM163 S1 P0.75\nM164 S1\nT1\n";
        assert_eq!(tell(LOW), table);
        assert_eq!(tell(PURE), "T0\n");
        assert_eq!(tell([0.5, 0.5]), "M163 S0 P0.5\nM163 S1 P0.5\nM164 S1\nT1\n");
        assert_eq!(tell(LOW), low);
    }

    #[test]
    fn an_auger_is_motor_0_and_always_turns() {
        let mut auger = machine(DialectName::MarlinMixing);
        auger.dialect.leading_weights = vec![1.0];
        auger.inputs = 4;
        assert_eq!(
            change(&auger, &LOW),
            "M163 S0 P1\nM163 S1 P0.25\nM163 S2 P0.75\nM163 S3 P0\nM163 S4 P0\nM164 S2\n"
        );
    }

    #[test]
    fn flow_as_a_command_is_a_whole_percentage() {
        let mut foaming = machine(DialectName::Foaming);
        foaming.foaming.flow_command = true;
        assert_eq!(change(&foaming, &LOW), "M104 S207\nM221 S81\n");
        assert!(!foaming.dialect().folds_flow());
    }

    #[test]
    fn defaults_read_as_g_code() {
        let mut out = Text::new();
        let mut dialect = MarlinMixing::new(Motors::new(Vec::new(), 2), 0);
        dialect.temperature(None, 209.6, true, &mut out);
        dialect.temperature(Some(3), 0.0, false, &mut out);
        dialect.bed_temperature(60.0, true, &mut out);
        dialect.fan(0.5, &mut out);
        dialect.fan(0.0, &mut out);
        let z = Fixed::round(0.2).ok();
        dialect.linear(&Move { z, feedrate: Some(600), ..Move::default() }, &mut out);
        assert_eq!(
            out.to_text(),
            "M109 S210\nM104 T3 S0\nM190 S60\nM106 S128\nM107\nG1 Z0.200 F600\n"
        );
    }
}
