use super::{Change, Dialect, marlin::Motors};
use crate::{GcodeError, Text, ratio};

/// RepRapFirmware: `M567 P<tool> E<a:b:c>`, one value a drive.
///
/// The firmware does not normalise the values; the states' ratios sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct RepRap {
    motors: Motors,
    tool: u32,
}

impl RepRap {
    /// Rewrites the ratios of `tool`, which the machine's configuration made from all drives.
    pub fn new(motors: Motors, tool: u32) -> Self {
        Self { motors, tool }
    }
}

impl Dialect for RepRap {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        out.raw("M567").int('P', self.tool).raw(" E");
        out.list(self.motors.weights(&change.state.mixture))?.end();
        Ok(())
    }
}

/// Kalico: `SET_MIXING_EXTRUDER FACTORS=a:b:c`.
///
/// `M400` stands before it, since a new mixture otherwise reaches back to moves that are queued.
#[derive(Clone, Debug, PartialEq)]
pub struct Kalico {
    motors: Motors,
}

impl Kalico {
    /// Sets the factors of the active extruder.
    pub fn new(motors: Motors) -> Self {
        Self { motors }
    }
}

impl Dialect for Kalico {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        out.raw("M400\nSET_MIXING_EXTRUDER FACTORS=");
        out.list(self.motors.weights(&change.state.mixture))?.end();
        Ok(())
    }

    fn stops(&self) -> bool {
        true
    }
}

/// Repetier: whole weights, `M163 S<motor> P<weight>`, kept by `M164 S<virtual tool>`.
///
/// A weight counts at once, so the motors that run come first: the weights are never all zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Repetier {
    motors: Motors,
    virtual_tool: u32,
}

impl Repetier {
    /// What the weights sum to.
    const TOTAL: u32 = 1000;

    /// Rewrites `virtual_tool` at each change.
    pub fn new(motors: Motors, virtual_tool: u32) -> Self {
        Self { motors, virtual_tool }
    }
}

impl Dialect for Repetier {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        let weights = self.motors.weights(&change.state.mixture);
        for running in [true, false] {
            for (motor, &weight) in (0..).zip(weights) {
                let share = ratio::share(weight, Self::TOTAL);
                if (share > 0) == running {
                    out.raw("M163").int('S', motor).int('P', share).end();
                }
            }
        }
        out.raw("M164").int('S', self.virtual_tool).end();
        Ok(())
    }
}
