use fgm_core::{Bounds3, Point2, Point3};

use crate::{error::SliceError, outlines::Outliner};

/// Samples along each side of the part's bounds.
const PER_SIDE: usize = 24;

/// Points spread evenly over the inside of the part.
pub(crate) fn inside(outliner: &Outliner<'_>, bounds: &Bounds3) -> Result<Vec<Point3>, SliceError> {
    let place = |i: usize, range: fgm_core::Interval| {
        range.lo + range.width() * (i as f64 + 0.5) / PER_SIDE as f64
    };
    let mut points = Vec::new();
    for k in 0..PER_SIDE {
        let z = place(k, bounds.z());
        let region = outliner.at(z)?.region;
        for j in 0..PER_SIDE {
            for i in 0..PER_SIDE {
                let p = Point2::new(place(i, bounds.x()), place(j, bounds.y()));
                if region.iter().any(|polygon| polygon.contains(p)) {
                    points.push(p.extend(z));
                }
            }
        }
    }
    Ok(points)
}
