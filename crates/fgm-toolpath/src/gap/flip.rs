//! Making any triangulation of a polygon its constrained Delaunay triangulation.

use fgm_core::Point2;

use super::mesh::{BORDER, Triangle};

/// Flips to the triangle allowed: ribbons need one or two.
const MOST: usize = 16;

/// Flips edges until every circle through a triangle is empty of its neighbours' corners (Lawson,
/// 1977); `None` where that takes too long.
pub(super) fn flip(mut triangles: Vec<Triangle>) -> Option<Vec<Triangle>> {
    let mut left = MOST * triangles.len();
    let mut open: Vec<u32> = (0..triangles.len() as u32).rev().collect();
    while let Some(t) = open.pop() {
        let Some((edge, other)) = bad_edge(&triangles, t) else { continue };
        left = left.checked_sub(1)?;
        swap(&mut triangles, t, edge, other);
        open.extend([other, t]);
        // The neighbours look at their new neighbours when those look at them.
    }
    Some(triangles)
}

/// An edge of triangle `t` whose other side has its corner in the circle of `t`, with the
/// triangle there.
fn bad_edge(triangles: &[Triangle], t: u32) -> Option<(usize, u32)> {
    let triangle = &triangles[t as usize];
    (0..3).map(|e| (e, triangle.across[e])).find(|&(edge, other)| {
        if other == BORDER {
            return false;
        }
        let Some(back) = triangles[other as usize].edge_to(t) else { return false };
        let beyond = triangles[other as usize].corners[(back + 2) % 3];
        let [p, q, r] = [0, 1, 2].map(|k| triangle.corners[(edge + k) % 3]);
        let convex = (p - r).perp_dot(beyond - r) > 0.0 && (beyond - r).perp_dot(q - r) > 0.0;
        convex && in_circle(&triangle.corners, beyond)
    })
}

/// Replaces the edge between two triangles by the other diagonal of their quadrangle.
fn swap(triangles: &mut [Triangle], t: u32, edge: usize, u: u32) {
    let (one, two) = (triangles[t as usize], triangles[u as usize]);
    let Some(back) = two.edge_to(t) else { return };
    let [p, q, r] = [0, 1, 2].map(|k| one.corners[(edge + k) % 3]);
    let s = two.corners[(back + 2) % 3];
    let (after, before) = (one.across[(edge + 1) % 3], one.across[(edge + 2) % 3]);
    let (beside, beyond) = (two.across[(back + 1) % 3], two.across[(back + 2) % 3]);
    triangles[t as usize] = Triangle { corners: [r, p, s], across: [before, beside, u] };
    triangles[u as usize] = Triangle { corners: [s, q, r], across: [beyond, after, t] };
    for (neighbour, from, to) in [(after, t, u), (beside, u, t)] {
        if let Some(triangle) = triangles.get_mut(neighbour as usize)
            && let Some(edge) = triangle.edge_to(from)
        {
            triangle.across[edge] = to;
        }
    }
}

/// Whether a point lies inside the circle through the corners of an anticlockwise triangle, by
/// more than rounding.
pub(super) fn in_circle(corners: &[Point2; 3], p: Point2) -> bool {
    let [a, b, c] = corners.map(|q| q - p);
    let [x, y, z] = [a, b, c].map(Point2::length_squared);
    let sum = x * b.perp_dot(c) + y * c.perp_dot(a) + z * a.perp_dot(b);
    let size = x.max(y).max(z);
    sum > 1e-12 * size * size
}
