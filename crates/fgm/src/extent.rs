use fgm_core::{Bounds3, Interval};

use crate::{error::SliceError, outlines::Outliner};

/// How closely the true bottom and top of a part are found, mm.
const PRECISION: f64 = 1e-4;
/// Heights at which a part is looked for between its bounds before it counts as empty.
const MOST_PROBES: usize = 4096;

/// The heights that the part really spans.
///
/// A design's bounds may be wider than its solid (a function in a given box). Where the bounds'
/// ends are not part of the solid, they are moved inwards: searched in steps of `step`, then
/// halved until [`PRECISION`]. Nothing thinner than a step, away from the bounds' ends, is found.
pub(crate) fn heights(
    outliner: &Outliner<'_>,
    bounds: &Bounds3,
    step: f64,
) -> Result<Option<Interval>, SliceError> {
    let z = bounds.z();
    let solid = |z: f64| Ok::<_, SliceError>(!outliner.at(z)?.region.is_empty());
    let lo = end(&solid, z.lo, z.hi, step)?;
    let hi = end(&solid, z.hi, z.lo, step)?;
    Ok(lo.zip(hi).map(|(lo, hi)| Interval::new(lo, hi)))
}

/// The first height from `from` towards `to` that is in the part.
fn end(
    solid: &impl Fn(f64) -> Result<bool, SliceError>,
    from: f64,
    to: f64,
    step: f64,
) -> Result<Option<f64>, SliceError> {
    let step = step.max((to - from).abs() / MOST_PROBES as f64);
    let toward = (to - from).signum();
    // Half a step in: where the end itself is the surface, it cannot be asked.
    let mut at = from + toward * (0.5 * step).min(0.5 * (to - from).abs());
    if solid(at)? {
        return Ok(Some(from));
    }
    let mut outside = at;
    let mut inside = loop {
        at += toward * step;
        if (to - at) * toward < 0.0 {
            return Ok(None);
        }
        if solid(at)? {
            break at;
        }
        outside = at;
    };
    while (inside - outside).abs() > PRECISION {
        let middle = 0.5 * (inside + outside);
        if solid(middle)? { inside = middle } else { outside = middle }
    }
    Ok(Some(inside))
}
