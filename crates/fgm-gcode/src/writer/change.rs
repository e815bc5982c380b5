use std::io;

use fgm_core::ColorId;

use super::Writer;
use crate::{GcodeError, State, dialect::Change};

/// The colour, and the heads of a tool changer.
#[derive(Clone, Debug)]
pub(super) struct Heads {
    /// Commanded last: the colour, and what the machine was told for it.
    pub(super) color: ColorId,
    pub(super) state: State,
    /// Whether the stream has commands of its own.
    led: bool,
    active: usize,
    heads: Vec<Head>,
}

#[derive(Clone, Debug, Default)]
struct Head {
    /// Filament pulled back, mm.
    retracted: f64,
    /// Whether it has printed.
    used: bool,
    /// Notices not yet followed by their change.
    wanted: u32,
}

impl Heads {
    /// Heads for the states of a palette, of which `first` is one.
    pub(super) fn new(states: &[State], first: State) -> Self {
        let count = states.iter().map(Self::tool).max().unwrap_or(0) as usize + 1;
        let heads = vec![Head::default(); count];
        Self { color: ColorId(0), state: first, led: false, active: 0, heads }
    }

    /// The head of a state; 0 where there is one only.
    pub(super) fn tool(state: &State) -> u32 {
        // A tool number from elsewhere cannot ask for a list of billions.
        state.tool.unwrap_or(0).min(255)
    }

    pub(super) fn begin(&mut self, color: ColorId, state: State) {
        (self.color, self.state) = (color, state);
        self.take(Self::tool(&state) as usize);
    }

    /// Makes a head the active one; whether it is its first use.
    fn take(&mut self, tool: usize) -> bool {
        self.active = tool;
        let head = &mut self.heads[tool];
        head.wanted = head.wanted.saturating_sub(1);
        !std::mem::replace(&mut head.used, true)
    }

    /// Filament pulled back in the active head, mm.
    pub(super) fn retracted(&mut self) -> &mut f64 {
        &mut self.heads[self.active].retracted
    }
}

impl<W: io::Write> Writer<W> {
    /// The machine is told another colour.
    pub(super) fn command(&mut self, color: ColorId) -> Result<(), GcodeError> {
        self.heads.led = true;
        let state = self.state(color)?;
        self.change(color, state)
    }

    /// The machine is told a state that need not be the palette's.
    pub(super) fn tell(&mut self, color: ColorId, state: State) -> Result<(), GcodeError> {
        self.heads.led = true;
        let least = self.options.temperatures.min_extrusion;
        if let Some(celsius) = state.temperature.filter(|t| t.is_nan() || *t < least) {
            let what = format!("a state between colours, as colour {}", color.0);
            return Err(GcodeError::Cold { what, celsius, least });
        }
        let heads = Heads::tool(&state) as usize + 1;
        if heads > self.heads.heads.len() {
            self.heads.heads.resize(heads, Head::default());
        }
        self.change(color, state)
    }

    /// The deposit takes on another colour.
    pub(super) fn deposit(&mut self, color: ColorId) -> Result<(), GcodeError> {
        let state = self.state(color)?;
        if !self.heads.led {
            self.change(color, state)?;
        }
        if state.flow == self.bead.state_flow { Ok(()) } else { self.set_flow(&state) }
    }

    /// Another factor on the fed filament.
    pub(super) fn flow(&mut self, flow: f64) -> Result<(), GcodeError> {
        let state = State { flow, ..self.heads.state };
        if flow == self.bead.state_flow { Ok(()) } else { self.set_flow(&state) }
    }

    /// Extrudes by the flow of a state from here on.
    pub(super) fn set_flow(&mut self, state: &State) -> Result<(), GcodeError> {
        if !(state.flow > 0.0 && state.flow.is_finite()) {
            return Err(GcodeError::Setting {
                name: "flow of a state".into(),
                value: state.flow,
                expected: "a number above 0",
            });
        }
        self.bead.state(state.flow, self.dialect.folds_flow());
        self.dialect.deposit(state, &mut self.text)
    }

    /// A head will be needed: it is heated.
    pub(super) fn notice(&mut self, color: ColorId) -> Result<(), GcodeError> {
        let state = self.state(color)?;
        let tool = Heads::tool(&state) as usize;
        self.heads.heads[tool].wanted += 1;
        if tool != self.heads.active {
            let celsius = self.temperature_of(&state);
            self.dialect.temperature(state.tool, celsius, false, &mut self.text);
        }
        Ok(())
    }

    /// Counts the filament fed in the state that ends.
    pub(super) fn count_fed(&mut self) {
        let fed = std::mem::take(&mut self.fed);
        self.summary.feed(self.machine.kind, &self.heads.state, fed);
    }

    fn change(&mut self, color: ColorId, state: State) -> Result<(), GcodeError> {
        let previous = self.heads.state;
        if color == self.heads.color && state == previous {
            return Ok(());
        }
        self.count_fed();
        let (tool, old) = (Heads::tool(&state) as usize, self.heads.active);
        let swap = self.is_tool_changer() && tool != old;
        if swap {
            self.leave_head()?;
        }
        let idle = self.heads.heads[old].wanted == 0;
        let change = Change {
            color,
            state: &state,
            previous: Some(&previous),
            temperature: self.temperature_of(&state),
            standby: self.options.temperatures.standby.filter(|_| idle),
        };
        let mut text = std::mem::take(&mut self.text);
        let set = self.set_state(&change, &mut text);
        self.text = text;
        set?;
        (self.heads.color, self.heads.state) = (color, state);
        if !self.machine.max_input_flow.is_empty() {
            self.bead.forget();
        }
        self.summary.state_changes += 1;
        if self.dialect.stops() {
            self.time.dwell(0.0);
        }
        let first_use = self.heads.take(tool);
        if swap {
            self.position.lose();
            self.time.dwell(self.machine.tool_change.seconds);
            if first_use {
                *self.heads.retracted() += self.machine.tool_change.prime;
            }
        }
        Ok(())
    }

    /// Pulls the filament back and lifts before the head is parked.
    fn leave_head(&mut self) -> Result<(), GcodeError> {
        let (length, hop) = (self.machine.tool_change.retraction, self.machine.tool_change.z_hop);
        self.retract(length)?;
        if hop > 0.0 {
            self.lift(hop)?;
        }
        Ok(())
    }
}
