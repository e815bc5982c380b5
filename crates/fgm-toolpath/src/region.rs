//! Booleans of regions.
//!
//! A region is a slice of disjoint polygons. Borders are snapped to 1e-5 mm; what is left of
//! less than 1e-6 mm² is dropped.

use crate::inset::clipper::{self, Operation};
use fgm_core::Polygon;

/// The points in either.
pub fn union(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    clipper::boolean(a, b, Operation::Union)
}

/// The points in both.
pub fn intersection(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    clipper::boolean(a, b, Operation::Intersection)
}

/// The points of `a` that are not in `b`.
pub fn difference(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    if a.is_empty() {
        return Vec::new();
    }
    clipper::boolean(a, b, Operation::Difference)
}

/// Area, mm², holes out.
pub fn area(region: &[Polygon]) -> f64 {
    region.iter().map(Polygon::area).sum()
}
