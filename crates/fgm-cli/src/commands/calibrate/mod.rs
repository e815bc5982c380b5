//! Prints that measure a machine, and what was measured turned into its profile.

mod fit;
mod pattern;
mod prints;
mod profile;
mod solve;

use crate::{
    args::{CalibrateArguments, Calibration},
    failure::Failure,
};

/// Writes a calibration print, or solves one.
pub(crate) fn run(arguments: &CalibrateArguments) -> Result<(), Failure> {
    match &arguments.what {
        Calibration::Lead(plate) => prints::lead(plate),
        Calibration::Transition(lines) => prints::transition(lines),
        Calibration::Foaming(ladder) => prints::foaming(ladder),
        Calibration::Solve(solve) => solve::run(solve),
    }
}
