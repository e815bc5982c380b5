use crate::ContourError;
use fgm_core::Bounds2;

/// The most cells along one side of a window: at 0.5 mm a window of 65 m.
pub const MAX_CELLS_A_SIDE: u32 = 1 << 17;
/// The most levels in one sweep.
pub const MAX_LEVELS: usize = 4096;
/// The most crossings of contours with the lattice in one sweep; about 6 GB of scratch.
pub const MAX_CROSSINGS: usize = 1 << 26;
/// The most triangles of a mesh to be cut.
pub const MAX_TRIANGLES: usize = 1 << 30;

/// How finely a field is contoured. All lengths are mm.
///
/// The lines lie within `simplify` of the true curve wherever the field is smooth at the scale of
/// a cell: `sag` of it is left to the chords between vertices on the curve, the rest to the
/// vertices that simplification removes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourOptions {
    /// Side of the finest cells. What is at least two cells wide is found.
    pub cell: f64,
    /// How near to the curve each vertex is put, measured along its lattice edge.
    pub root_tolerance: f64,
    /// Greatest distance aimed at between a chord and the curve: where it is more, vertices on
    /// the curve are added. 0 adds none.
    pub sag: f64,
    /// Greatest distance between the simplified lines and the curve. 0 keeps every vertex.
    pub simplify: f64,
    /// Whether corners of the curve become vertices. Worth switching off for fields known to be
    /// smooth, where it costs evaluations at tight bends.
    pub sharp: bool,
    /// Whether lines end where the field is not a number, as at the window's edge, instead of
    /// that being an error. Regions are never skipped: [`crate::outline`] takes no notice of it.
    pub skip_nan: bool,
}

impl Default for ContourOptions {
    fn default() -> Self {
        Self {
            cell: 0.5,
            root_tolerance: 1e-6,
            sag: 0.0025,
            simplify: 0.01,
            sharp: true,
            skip_nan: false,
        }
    }
}

impl ContourOptions {
    /// Checks every field.
    pub(crate) fn check(&self) -> Result<(), ContourError> {
        let positive = |option, value: f64| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(ContourError::Option { option, value, limit: "a finite number above 0" }),
        };
        let not_negative = |option, value: f64| match value.is_finite() && value >= 0.0 {
            true => Ok(()),
            false => {
                Err(ContourError::Option { option, value, limit: "a finite number, 0 or more" })
            }
        };
        positive("cell", self.cell)?;
        positive("root_tolerance", self.root_tolerance)?;
        not_negative("sag", self.sag)?;
        not_negative("simplify", self.simplify)
    }

    /// What simplification may add to the sag.
    pub(crate) fn simplify_budget(&self) -> f64 {
        if self.simplify > self.sag { self.simplify - self.sag } else { self.simplify * 0.5 }
    }
}

/// Checks that a window is finite and has a size.
pub(crate) fn check_window(window: &Bounds2) -> Result<(), ContourError> {
    let size = window.size();
    if window.is_finite() && size.is_finite() && size.x > 0.0 && size.y > 0.0 {
        Ok(())
    } else {
        Err(ContourError::Window { window: *window })
    }
}

/// Checks that every level is finite and there are not too many.
pub(crate) fn check_levels(levels: &[f64]) -> Result<(), ContourError> {
    if levels.len() > MAX_LEVELS {
        return Err(ContourError::TooManyLevels { count: levels.len(), limit: MAX_LEVELS });
    }
    match levels.iter().enumerate().find(|(_, l)| !l.is_finite()) {
        Some((index, &value)) => Err(ContourError::Level { index, value }),
        None => Ok(()),
    }
}
