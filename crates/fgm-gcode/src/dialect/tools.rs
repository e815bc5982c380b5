use super::{Change, Dialect};
use crate::{GcodeError, Text};

/// Tool changers with `T<n>`: Marlin's, and Klipper's macros.
///
/// The new head is waited for before it is taken, where it cannot drip on the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ToolChange;

/// Heads of a change: the new one, and the old one where it is another.
fn heads(change: &Change<'_>) -> (u32, Option<u32>) {
    let tool = change.state.tool.unwrap_or(0);
    let old = change.previous.map(|p| p.tool.unwrap_or(0)).filter(|old| *old != tool);
    (tool, old)
}

/// Cools the head that is left, where the profile says so.
fn cool(dialect: &mut impl Dialect, change: &Change<'_>, old: Option<u32>, out: &mut Text) {
    if let (Some(old), Some(celsius)) = (old, change.standby) {
        dialect.temperature(Some(old), celsius, false, out);
    }
}

impl Dialect for ToolChange {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        let (tool, old) = heads(change);
        if old.is_some() {
            self.temperature(Some(tool), change.temperature, true, out);
        }
        out.raw("T").number(f64::from(tool))?.end();
        cool(self, change, old, out);
        Ok(())
    }
}

/// Prusa XL: parks the old head without returning (`P0 S1 L2 D0`), waits for the new one in its
/// dock, picks it (`T<n> S1 L0 D0`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrusaXl;

impl Dialect for PrusaXl {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        let (tool, old) = heads(change);
        if old.is_some() {
            out.line("P0 S1 L2 D0");
            self.temperature(Some(tool), change.temperature, true, out);
        }
        out.raw("T").number(f64::from(tool))?.raw(" S1 L0 D0").end();
        cool(self, change, old, out);
        Ok(())
    }
}
