//! The cells inside polygons.

use std::ops::Range;

use fgm_core::{Point2, Polygon};

use super::canvas::Grid;

/// Tells the runs of cells, row by row, whose middles lie inside by the even-odd rule.
pub(crate) fn fill(grid: &Grid, region: &[Polygon], mut run: impl FnMut(usize, Range<usize>)) {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); grid.height];
    for ring in region.iter().flat_map(Polygon::rings) {
        for (a, b) in ring.edges() {
            let (low, high): (Point2, Point2) = if a.y < b.y { (a, b) } else { (b, a) };
            for row in grid.rows(low.y, high.y) {
                let share = (grid.y(row) - low.y) / (high.y - low.y);
                crossings[row].push(low.x + (high.x - low.x) * share);
            }
        }
    }
    for (row, crossings) in crossings.iter_mut().enumerate() {
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let columns = grid.columns(pair[0], pair[1]);
            if !columns.is_empty() {
                run(row, columns);
            }
        }
    }
}
