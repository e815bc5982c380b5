//! Lines with fewer vertices.

use crate::Point2;

/// The vertices of a line that are enough: every other one lies within `tolerance` mm of the chord
/// between the ones before and after it. Calls `keep` with the index of each, in order; the first
/// point stays, and the last of an open line.
///
/// A wedge of directions, seen from the last kept vertex, is narrowed by every vertex passed; a
/// vertex outside it, or nearer than the one before, ends the chord (the cone method of Sklansky and
/// Gonzalez, 1980). Each chord is as long as it can be from where it begins. Linear.
///
/// ```
/// use fgm_core::{Point2, long_chords};
///
/// let points = [(0.0, 0.0), (1.0, 0.01), (2.0, 0.0), (2.0, 2.0)].map(|(x, y)| Point2::new(x, y));
/// let mut kept = Vec::new();
/// long_chords(&points, false, 0.02, |k| kept.push(k));
/// assert_eq!(kept, [0, 2, 3]);
/// ```
pub fn long_chords(points: &[Point2], closed: bool, tolerance: f64, mut keep: impl FnMut(usize)) {
    let Some((&first, rest)) = points.split_first() else { return };
    let tolerance = tolerance.max(1e-9);
    keep(0);
    let mut wedge = Wedge::new(first, tolerance);
    let mut last = 0;
    for (k, &p) in (1..).zip(rest.iter().chain(closed.then_some(&first))) {
        if !wedge.admit(p) {
            keep(last);
            wedge = Wedge::new(points[last], tolerance);
            wedge.admit(p);
        }
        last = k;
    }
    if !closed && last > 0 {
        keep(last);
    }
}

struct Wedge {
    from: Point2,
    tolerance: f64,
    sides: Option<(Point2, Point2)>,
    reach: f64,
}

impl Wedge {
    fn new(from: Point2, tolerance: f64) -> Self {
        Self { from, tolerance, sides: None, reach: 0.0 }
    }

    /// Whether one chord can reach `p` and still pass all vertices before it.
    fn admit(&mut self, p: Point2) -> bool {
        let v = p - self.from;
        let squared = v.length_squared();
        let least = self.tolerance * self.tolerance;
        let Some((right, left)) = self.sides else {
            if squared > least {
                self.sides = Some(self.tangents(v, squared));
                self.reach = squared;
            }
            return true;
        };
        // A line that turns back would lose its far end.
        if squared < self.reach || right.perp_dot(v) < 0.0 || v.perp_dot(left) < 0.0 {
            return false;
        }
        self.reach = squared;
        let (r, l) = self.tangents(v, squared);
        let right = if right.perp_dot(r) > 0.0 { r } else { right };
        let left = if l.perp_dot(left) > 0.0 { l } else { left };
        self.sides = Some((right, left));
        true
    }

    /// Directions that pass at the tolerance, right and left of the vertex at `v`.
    fn tangents(&self, v: Point2, squared: f64) -> (Point2, Point2) {
        let along = v * (squared - self.tolerance * self.tolerance).max(0.0).sqrt();
        let across = v.perp() * self.tolerance;
        (along - across, along + across)
    }
}
