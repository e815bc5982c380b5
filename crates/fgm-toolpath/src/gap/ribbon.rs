//! Triangulating a ribbon: a polygon whose triangles all reach from one side to the other.

use fgm_core::Point2;

use super::{
    flip::in_circle,
    mesh::{BORDER, Triangle},
};

/// How many corners are tried as a ribbon's end.
const MOST_ENDS: usize = 6;

/// The triangles of an anticlockwise polygon from one end to the other, by going along both its
/// sides at once; `None` where it is no ribbon, or its sides are further apart than `widest`.
pub(super) fn ribbon(points: &[Point2], widest: f64) -> Option<Vec<Triangle>> {
    let n = points.len();
    let &origin = points.first()?;
    // The vertex furthest from another lies at an end, if the ribbon is not bent too much.
    let far = |i: &usize| points[*i].distance_squared(origin);
    let start = (0..n).max_by(|a, b| far(a).total_cmp(&far(b)))?;
    from_end(points, start, widest)
        .or_else(|| ends(points).into_iter().find_map(|end| from_end(points, end, widest)))
}

/// The triangles between an anticlockwise ring and a clockwise one inside it.
pub(super) fn annulus(outer: &[Point2], hole: &[Point2], widest: f64) -> Option<Vec<Triangle>> {
    let (n, m) = (outer.len(), hole.len());
    let &origin = outer.first()?;
    let far = |i: &usize| hole[*i].distance_squared(origin);
    let start = (0..m).min_by(|a, b| far(a).total_cmp(&far(b)))?;
    let right = |i: usize| outer[i % n];
    let left = |i: usize| hole[(start + m - i % m) % m];
    let mut strip = Strip::new(n + m, widest);
    let (mut i, mut j) = (0, 0);
    while i < n || j < m {
        let ahead = ((i < n).then(|| right(i + 1)), (j < m).then(|| left(j + 1)));
        if strip.extend(right(i), left(j), ahead)? { i += 1 } else { j += 1 }
    }
    strip.closed()
}

/// The sharpest convex corners of an anticlockwise ring, sharpest first.
fn ends(points: &[Point2]) -> Vec<usize> {
    let n = points.len();
    let mut corners: Vec<(f64, usize)> = Vec::new();
    for i in 0..n {
        let (before, after) = (points[(i + n - 1) % n], points[(i + 1) % n]);
        let (u, v) = (points[i] - before, after - points[i]);
        let cosine = u.dot(v) / (u.length_squared() * v.length_squared()).sqrt();
        // A turn by more than 45 degrees.
        if u.perp_dot(v) > 0.0 && cosine < 0.7 {
            corners.push((cosine, i));
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners.truncate(MOST_ENDS);
    corners.into_iter().map(|(_, i)| i).collect()
}

/// The triangles from the end at vertex `start` on.
fn from_end(points: &[Point2], start: usize, widest: f64) -> Option<Vec<Triangle>> {
    let n = points.len();
    let at = |i: usize| points[if start + i < n { start + i } else { start + i - n }];
    let (mut right, mut left) = (1, n.checked_sub(1)?);
    let mut strip = Strip::new(n, widest);
    strip.extend(at(0), at(left), (Some(at(1)), None))?;
    while right + 1 < left {
        let ahead = (Some(at(right + 1)), Some(at(left - 1)));
        if strip.extend(at(right), at(left), ahead)? { right += 1 } else { left -= 1 }
    }
    Some(strip.triangles)
}

/// Triangles that each share an edge, from side to side, with the one before.
///
/// Of the two triangles that may come next the one with the empty circle is taken, so that the
/// result is near the constrained Delaunay triangulation. All triangles are anticlockwise, which
/// makes them a triangulation of a simple polygon. Linear.
struct Strip {
    triangles: Vec<Triangle>,
    /// The edge of the last triangle that the next one shares.
    shared: usize,
    /// The square of the greatest width.
    widest: f64,
}

impl Strip {
    fn new(triangles: usize, widest: f64) -> Self {
        let triangles = Vec::with_capacity(triangles);
        Self { triangles, shared: 0, widest: widest * widest }
    }

    /// Adds a triangle on the edge between the sides, with the next vertex of the right side
    /// (true) or the left one; `None` where neither will do.
    fn extend(
        &mut self,
        right: Point2,
        left: Point2,
        ahead: (Option<Point2>, Option<Point2>),
    ) -> Option<bool> {
        if right.distance_squared(left) > self.widest {
            return None;
        }
        let number = self.triangles.len() as u32;
        let before = number.checked_sub(1);
        let on = |next: Option<Point2>| triangle([right, next?, left], before.unwrap_or(BORDER));
        let next = match (on(ahead.0), on(ahead.1), ahead.1) {
            (Some(next), Some(_), Some(other)) if !in_circle(&next.corners, other) => (next, 1),
            (_, Some(next), _) => (next, 0),
            (Some(next), None, _) => (next, 1),
            (None, None, _) => return None,
        };
        if let Some(before) = before {
            self.triangles[before as usize].across[self.shared] = number;
        }
        self.triangles.push(next.0);
        self.shared = next.1;
        Some(self.shared == 1)
    }

    /// The triangles, the last one joined to the first.
    fn closed(mut self) -> Option<Vec<Triangle>> {
        let last = self.triangles.len().checked_sub(1)?;
        self.triangles[last].across[self.shared] = 0;
        self.triangles[0].across[2] = last as u32;
        Some(self.triangles)
    }
}

/// A triangle that shares its last edge with `before`; `None` for one that is not anticlockwise.
fn triangle(corners: [Point2; 3], before: u32) -> Option<Triangle> {
    let out = Triangle { corners, across: [BORDER, BORDER, before] };
    (out.area() > 0.0).then_some(out)
}
