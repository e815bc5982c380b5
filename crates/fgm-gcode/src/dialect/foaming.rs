use super::{Change, Dialect};
use crate::{GcodeError, State, Text};

/// A foaming filament: `M104 S<t>`, not waited for; the flow is folded into E, or told by
/// `M221 S<percent>` where the deposit changes.
///
/// Folding is exact and seen by every viewer; `M221` takes whole percents, and some ignore it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Foam {
    flow_command: bool,
}

impl Foam {
    /// With `M221` where `flow_command`, else with the flow folded into E.
    pub fn new(flow_command: bool) -> Self {
        Self { flow_command }
    }
}

impl Dialect for Foam {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        if let Some(celsius) = change.state.temperature {
            self.temperature(None, celsius, false, out);
        }
        Ok(())
    }

    fn deposit(&mut self, state: &State, out: &mut Text) -> Result<(), GcodeError> {
        if self.flow_command {
            out.raw("M221").int('S', (state.flow * 100.0).round() as u32).end();
        }
        Ok(())
    }

    fn folds_flow(&self) -> bool {
        !self.flow_command
    }

    fn end(&mut self, out: &mut Text) {
        if self.flow_command {
            out.line("M221 S100");
        }
    }
}
