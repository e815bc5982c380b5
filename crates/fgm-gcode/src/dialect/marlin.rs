use fgm_core::{MAX_MATERIALS, Mixture};

use super::{Change, Dialect};
use crate::{GcodeError, State, Text};

/// The motors of a mixing head: some of constant weight, then one for each filament.
#[derive(Clone, Debug, PartialEq)]
pub struct Motors {
    leading: Vec<f64>,
    filaments: usize,
    weights: Vec<f64>,
}

impl Motors {
    /// Motors with these constant weights (an auger's is 1), then `filaments` that mix.
    pub fn new(leading: Vec<f64>, filaments: usize) -> Self {
        Self { leading, filaments: filaments.clamp(1, MAX_MATERIALS), weights: Vec::new() }
    }

    /// One weight a motor; filaments that the mixture does not have get 0.
    pub fn weights(&mut self, mixture: &Mixture) -> &[f64] {
        self.weights.clear();
        self.weights.extend_from_slice(&self.leading);
        self.weights.extend_from_slice(mixture.fractions());
        self.weights.resize(self.leading.len() + self.filaments, 0.0);
        &self.weights
    }
}

/// Marlin's portable form: `M163 S<motor> P<weight>` for each motor, `M164 S<virtual tool>`.
#[derive(Clone, Debug, PartialEq)]
pub struct MarlinMixing {
    motors: Motors,
    virtual_tool: u32,
}

impl MarlinMixing {
    /// Rewrites `virtual_tool` at each change.
    pub fn new(motors: Motors, virtual_tool: u32) -> Self {
        Self { motors, virtual_tool }
    }
}

impl Dialect for MarlinMixing {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        for (motor, &weight) in (0..).zip(self.motors.weights(&change.state.mixture)) {
            out.raw("M163").int('S', motor).real('P', weight)?.end();
        }
        out.raw("M164").int('S', self.virtual_tool).end();
        Ok(())
    }
}

/// Marlin with a table of virtual tools: `M163` and `M164 S<tool>` once for each colour, at the
/// first of them, then `T<tool>` (the material profiles of the active-mixing paper).
///
/// What has no place in the table, of a larger palette or a mixture between colours, is written
/// into the last tool when it is needed.
#[derive(Clone, Debug, PartialEq)]
pub struct MarlinTools {
    motors: Motors,
    tools: usize,
    /// What each tool keeps.
    table: Vec<Mixture>,
    written: bool,
}

impl MarlinTools {
    /// A table of so many tools; Marlin has 16 unless it is built with another number.
    pub fn new(motors: Motors, tools: u32) -> Self {
        Self { motors, tools: tools.max(1) as usize, table: Vec::new(), written: false }
    }

    fn store(&mut self, tool: usize, out: &mut Text) -> Result<(), GcodeError> {
        for (motor, &weight) in (0..).zip(self.motors.weights(&self.table[tool])) {
            out.raw("M163").int('S', motor).real('P', weight)?.end();
        }
        out.raw("M164").int('S', tool as u32).end();
        Ok(())
    }
}

impl Dialect for MarlinTools {
    fn palette(&mut self, states: &[State]) {
        for state in states {
            if self.table.len() < self.tools && !self.table.contains(&state.mixture) {
                self.table.push(state.mixture);
            }
        }
    }

    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        if !std::mem::replace(&mut self.written, true) {
            (0..self.table.len()).try_for_each(|tool| self.store(tool, out))?;
        }
        let mixture = change.state.mixture;
        let tool = match self.table.iter().position(|kept| *kept == mixture) {
            Some(tool) => tool,
            None => {
                if self.table.len() < self.tools {
                    self.table.push(mixture);
                } else if let Some(last) = self.table.last_mut() {
                    *last = mixture;
                }
                self.store(self.table.len() - 1, out)?;
                self.table.len() - 1
            }
        };
        out.raw("T").number(tool as f64)?;
        out.end();
        Ok(())
    }
}

/// Marlin's short form: `M165 A<weight> B<weight>`, for firmwares with `DIRECT_MIXING_IN_G1`.
#[derive(Clone, Debug, PartialEq)]
pub struct MarlinDirect {
    motors: Motors,
}

impl MarlinDirect {
    /// The letters, one a motor.
    const LETTERS: [char; 6] = ['A', 'B', 'C', 'D', 'H', 'I'];

    /// Sets the active virtual tool at each change. Motors after the sixth have no letter.
    pub fn new(motors: Motors) -> Self {
        Self { motors }
    }
}

impl Dialect for MarlinDirect {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        out.raw("M165");
        for (letter, &weight) in
            Self::LETTERS.iter().zip(self.motors.weights(&change.state.mixture))
        {
            out.real(*letter, weight)?;
        }
        out.end();
        Ok(())
    }
}
