//! Hexagonal cells, the same on every layer.
//!
//! A line is a wave of level and slanting sides, all as long; the next line is its mirror image, so
//! that two waves enclose a row of regular hexagons. Where level sides of two waves meet they lie
//! beside each other, a spacing apart: no bead crosses or covers another.

use fgm_core::{Point2, Polygon};

use super::{InfillOptions, clip::Clip};
use crate::{Inset, Path};

/// The share of a side that a slanting side rises.
const RISE: f64 = 0.866_025_403_784_438_6;

pub(super) fn lines(region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    let spacing = options.spacing();
    let side = side(spacing, options.density);
    let Some(clip) = Clip::new(region, options, side, inset) else {
        return Vec::new();
    };
    let (period, rise) = (3.0 * side, RISE * side);
    let pitch = rise + spacing;
    let (x, y) = (clip.bounds.x(), clip.bounds.y());
    let rows = (y.lo / pitch).floor() as i64 - 1..=(y.hi / pitch).ceil() as i64 + 1;
    let columns = (x.lo / period).floor() as i64 - 1..=(x.hi / period).ceil() as i64 + 1;
    let mut out = Vec::new();
    for (row, turn) in rows.zip(0..) {
        // Odd rows are upside down.
        let (low, high) = (row as f64 * pitch, row as f64 * pitch + rise);
        let (first, second) = if row % 2 == 0 { (low, high) } else { (high, low) };
        let wave = columns.clone().flat_map(|column| {
            let x = column as f64 * period;
            [
                Point2::new(x, first),
                Point2::new(x + side, first),
                Point2::new(x + 1.5 * side, second),
                Point2::new(x + 2.5 * side, second),
            ]
        });
        clip.line(&wave.collect::<Vec<_>>(), turn, options, &mut out);
    }
    out
}

/// The length of a hexagon's sides at a density: four of them are in each `3 side` by a row.
fn side(spacing: f64, density: f64) -> f64 {
    spacing * (4.0 / (3.0 * density) - 1.0) / RISE
}
