//! Beads along borders that run beside the scan lines, where the lines leave a gap.
//!
//! Lines a pitch apart meet a border at any angle and fill it on average. Along a border parallel
//! to them, and over the round top of a region, there is a gap of up to a pitch that no line and
//! no joining piece fills.

use super::scan::Lattice;
use fgm_core::Point2;

/// Share of a bead below which a gap is left open. A slanting border leaves half a bead between
/// two lines on one side and has half a bead too much on the other: it takes no rim.
const LEAST: f64 = 0.55;
/// The widest rim, in beads.
const MOST: f64 = 1.5;

/// The thickness of the gap between a stretch of border and the lines beside it, mm; `None` where
/// it takes no bead.
///
/// `stretch` holds the bead's centres along the border, with the region on its left. Its ends lie
/// on the scan lines `first` and `last`, and no other line meets it.
pub(super) fn thickness(
    stretch: &[Point2],
    first: i64,
    last: i64,
    lattice: &Lattice,
    spacing: f64,
) -> Option<f64> {
    let axis = lattice.axis();
    let turned = |p: &Point2| Point2::new(p.dot(axis), axis.perp_dot(*p));
    let (mut length, mut run, mut moment) = (0.0, 0.0, 0.0);
    for pair in stretch.windows(2) {
        let (a, b) = (turned(&pair[0]), turned(&pair[1]));
        length += a.distance(b);
        run += b.x - a.x;
        moment += (b.x - a.x) * 0.5 * (a.y + b.y);
    }
    let pitch = lattice.pitch;
    if length < 2.0 * pitch || run.abs() < 0.5 * length || (first - last).abs() > 1 {
        return None;
    }
    let mean = moment / run;
    let low = if first == last {
        if mean >= lattice.v(first) { first } else { first - 1 }
    } else {
        first.min(last)
    };
    // The region lies below a border that runs back along the lines, else above.
    let gap = if run < 0.0 {
        mean - (lattice.v(low) + 0.5 * pitch)
    } else {
        lattice.v(low + 1) - 0.5 * pitch - mean
    };
    let thickness = (gap + 0.5 * spacing) * run.abs() / length;
    (thickness >= LEAST * spacing && thickness <= MOST * spacing).then_some(thickness)
}
