//! Triangulating a ribbon: a polygon whose triangles all reach from one side to the other.

use fgm_core::Point2;

use super::{
    flip::in_circle,
    mesh::{BORDER, Triangle},
};

/// The triangles of an anticlockwise polygon from one end to the other, by going along both its
/// sides at once; `None` where it is no ribbon, or its sides are further apart than `widest`.
///
/// Of the two triangles that may come next the one with the empty circle is taken, so that the
/// result is near the constrained Delaunay triangulation. All triangles are anticlockwise, which
/// makes them a triangulation of a simple polygon. Linear.
pub(super) fn ribbon(points: &[Point2], widest: f64) -> Option<Vec<Triangle>> {
    let n = points.len();
    let &origin = points.first()?;
    // The vertex furthest from another lies at an end.
    let far = |i: &usize| points[*i].distance_squared(origin);
    let start = (0..n).max_by(|a, b| far(a).total_cmp(&far(b)))?;
    let at = |i: usize| points[(start + i) % n];
    let (mut right, mut left) = (1, n.checked_sub(1)?);
    let mut out = Vec::with_capacity(n);
    out.push(triangle([at(0), at(1), at(left)], BORDER)?);
    // The edge of the last triangle that the next one shares.
    let mut shared = 1;
    while right + 1 < left {
        let (r, l) = (at(right), at(left));
        if r.distance_squared(l) > widest * widest {
            return None;
        }
        let number = out.len() as u32;
        out[number as usize - 1].across[shared] = number;
        let on_right = triangle([r, at(right + 1), l], number - 1);
        let on_left = triangle([r, at(left - 1), l], number - 1);
        let next = match (on_right, on_left) {
            (Some(next), Some(_)) if !in_circle(&next.corners, at(left - 1)) => (next, 1),
            (_, Some(next)) => (next, 0),
            (Some(next), None) => (next, 1),
            (None, None) => return None,
        };
        out.push(next.0);
        shared = next.1;
        if shared == 1 { right += 1 } else { left -= 1 }
    }
    Some(out)
}

/// A triangle that shares its last edge with `before`; `None` for one that is not anticlockwise.
fn triangle(corners: [Point2; 3], before: u32) -> Option<Triangle> {
    let out = Triangle { corners, across: [BORDER, BORDER, before] };
    (out.area() > 0.0).then_some(out)
}
