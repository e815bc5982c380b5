//! Dropping vertices that a border does not need.

use fgm_core::{Point2, Polygon, Ring};

/// Rings with less area than this, mm², are no regions: a square of 0.01 mm.
const LEAST_AREA: f64 = 1e-4;
/// Coordinates beyond this, mm, are no part of a print (and would not fit the offsetter's units).
const FARTHEST: f64 = 1e7;

/// A region with fewer vertices, its borders within `tolerance` mm of the old ones.
pub(crate) fn region(region: &[Polygon], tolerance: f64) -> Vec<Polygon> {
    region.iter().filter_map(|p| polygon(p, tolerance)).collect()
}

/// One polygon with fewer vertices; `None` where nothing of it is left.
pub(crate) fn polygon(polygon: &Polygon, tolerance: f64) -> Option<Polygon> {
    let outer = ring(&polygon.outer, tolerance)?;
    let holes = polygon.holes.iter().filter_map(|h| ring(h, tolerance)).collect();
    Some(Polygon { outer, holes })
}

fn ring(ring: &Ring, tolerance: f64) -> Option<Ring> {
    let inside = |p: &Point2| p.is_finite() && p.abs().max_element() < FARTHEST;
    if ring.points.len() < 3 || !ring.points.iter().all(inside) {
        return None;
    }
    let mut points = Vec::with_capacity(ring.points.len());
    line(&ring.points, true, tolerance, &mut points);
    let out = Ring::new(points);
    (out.points.len() >= 3 && out.area().abs() > LEAST_AREA).then_some(out)
}

/// Appends a line with fewer vertices: every dropped vertex lies within `tolerance` of the chord
/// that replaces it. The first point stays, and the last of an open line.
///
/// A wedge of directions, seen from the last kept vertex, is narrowed by every vertex passed; a
/// vertex outside it ends the chord (the cone method of Sklansky and Gonzalez, 1980). Linear.
pub(crate) fn line(points: &[Point2], closed: bool, tolerance: f64, out: &mut Vec<Point2>) {
    let Some((&first, rest)) = points.split_first() else { return };
    let tolerance = tolerance.max(1e-9);
    let start = out.len();
    out.push(first);
    let mut wedge = Wedge::new(first, tolerance);
    let mut last = first;
    for &p in rest.iter().chain(closed.then_some(&first)) {
        if !wedge.admit(p) {
            out.push(last);
            wedge = Wedge::new(last, tolerance);
            wedge.admit(p);
        }
        last = p;
    }
    if !closed && out.last() != Some(&last) {
        out.push(last);
    }
    if closed && out.len() > start + 1 && out.last() == Some(&first) {
        out.pop();
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
