//! Dropping vertices that a border does not need.

use fgm_core::{Point2, Polygon, Ring, long_chords};

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
pub(crate) fn line(points: &[Point2], closed: bool, tolerance: f64, out: &mut Vec<Point2>) {
    long_chords(points, closed, tolerance, |k| out.push(points[k]));
}
