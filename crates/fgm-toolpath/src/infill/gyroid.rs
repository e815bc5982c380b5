//! The gyroid `sin x cos y + sin y cos z + sin z cos x = 0`, one layer at a time.
//!
//! At one height it is solved for `y` where `|cos z|` is the greater, else for `x`: either way
//! two continuous branches a period, drawn as functions of the other coordinate.

use std::f64::consts::TAU;

use fgm_core::{Point2, Polygon};

use super::{InfillOptions, clip::Clip};
use crate::{Inset, Path};

/// Length of line in a unit of area, for a period of 2 pi, averaged over z.
const LENGTH_PER_AREA: f64 = 0.3913;
/// Steps in a period.
const STEPS: usize = 48;

pub(super) fn lines(region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    let scale = LENGTH_PER_AREA * options.pitch();
    let Some(clip) = Clip::new(region, options, scale, inset) else {
        return Vec::new();
    };
    let bounds = &clip.bounds;
    let mut out = Vec::new();
    let waves = Waves::new(options.z / scale);
    let (along, across) =
        if waves.upright { (bounds.y(), bounds.x()) } else { (bounds.x(), bounds.y()) };
    // A branch strays from its middle by less than a period.
    let first = (across.lo / scale / TAU).floor() as i64 - 1;
    let last = (across.hi / scale / TAU).ceil() as i64 + 1;
    let step = TAU / STEPS as f64;
    let table = [0, 1].map(|branch| -> Vec<f64> {
        (0..STEPS).map(|i| waves.at(i as f64 * step, branch)).collect()
    });
    // Beyond the bounds at both ends: lines begin and end outside.
    let (from, to) =
        ((along.lo / scale / step).floor() as i64, (along.hi / scale / step).ceil() as i64);
    for (turn, period) in (first..=last).enumerate() {
        for branch in 0..2u32 {
            let points: Vec<Point2> = (from - 1..=to + 1)
                .map(|i| {
                    let t = i as f64 * step;
                    let v = table[branch as usize][i.rem_euclid(STEPS as i64) as usize]
                        + period as f64 * TAU;
                    if waves.upright { Point2::new(v, t) } else { Point2::new(t, v) }
                })
                .map(|p| p * scale)
                .collect();
            let turn = 2 * turn as u32 + branch;
            clip.line(&points, turn, options, &mut out);
        }
    }
    out
}

/// The two branches at one height.
struct Waves {
    sin_z: f64,
    cos_z: f64,
    /// Whether lines run along y.
    upright: bool,
}

impl Waves {
    fn new(z: f64) -> Self {
        let (sin_z, cos_z) = z.sin_cos();
        Self { sin_z, cos_z, upright: cos_z.abs() < sin_z.abs() }
    }

    /// The value across at `t` along: of `p cos v + q sin v = r`.
    fn at(&self, t: f64, branch: u32) -> f64 {
        let (sin, cos) = t.sin_cos();
        let (p, q, r) = if self.upright {
            // Turned so that the angle below stays clear of its jump at pi.
            let sign = self.sin_z.signum();
            (sign * self.sin_z, sign * cos, -sign * sin * self.cos_z)
        } else {
            (sin, self.cos_z, -self.sin_z * cos)
        };
        let spread = (r / p.hypot(q)).clamp(-1.0, 1.0).acos();
        let middle = q.atan2(p);
        if branch == 0 { middle - spread } else { middle + spread }
    }
}
