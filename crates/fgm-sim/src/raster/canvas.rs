use std::ops::Range;

use fgm_core::{Bounds2, Point2, Polygon};

use super::{region, stroke::Stroke};
use crate::SimError;

/// The most cells of a raster: 400 MB of them.
const MOST_CELLS: u64 = 80_000_000;

/// Where the cells of a raster lie.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Grid {
    /// The outer corner of the first cell.
    pub(crate) origin: Point2,
    pub(crate) cell: f64,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl Grid {
    /// Cells that cover `bounds`, with one more on every side.
    pub(crate) fn over(bounds: &Bounds2, cell: f64, layer: u32) -> Result<Self, SimError> {
        let size = bounds.size().max(Point2::ZERO) / cell;
        let (width, height) = (size.x.ceil() as u64 + 2, size.y.ceil() as u64 + 2);
        if width.saturating_mul(height) > MOST_CELLS {
            let layer = layer.saturating_add(1);
            return Err(SimError::Raster { layer, width, height, cell, limit: MOST_CELLS });
        }
        let origin = bounds.min - cell;
        Ok(Self { origin, cell, width: width as usize, height: height as usize })
    }

    /// The rows whose middles lie between two heights.
    pub(crate) fn rows(&self, from: f64, to: f64) -> Range<usize> {
        span((from - self.origin.y) / self.cell, (to - self.origin.y) / self.cell, self.height)
    }

    /// The cells of a row whose middles lie between two places.
    #[inline]
    pub(crate) fn columns(&self, from: f64, to: f64) -> Range<usize> {
        span((from - self.origin.x) / self.cell, (to - self.origin.x) / self.cell, self.width)
    }

    /// The y of the middles of a row's cells, mm.
    pub(crate) fn y(&self, row: usize) -> f64 {
        self.origin.y + (row as f64 + 0.5) * self.cell
    }

    /// The x of the middles of a column's cells, mm.
    pub(crate) fn x(&self, column: usize) -> f64 {
        self.origin.x + (column as f64 + 0.5) * self.cell
    }

    pub(crate) fn cells(&self) -> usize {
        self.width * self.height
    }
}

/// Whole numbers `i` below `count` with `from <= i + 1/2 < to`.
#[inline]
fn span(from: f64, to: f64, count: usize) -> Range<usize> {
    // Floats turn into whole numbers within their range, so that negative ones become 0.
    let first = (from - 0.5).ceil() as usize;
    let end = ((to - 0.5).ceil() as usize).min(count);
    first..end.max(first)
}

/// The cells of a layer.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    grid: Grid,
    /// How many passes cover a cell.
    passes: Vec<u8>,
    /// How far along all paths the last pass was, mm.
    reached: Vec<f32>,
}

/// Numbers of cells.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) covered: u64,
    pub(super) twice: u64,
    pub(super) region: u64,
    /// Of the region and covered.
    pub(super) inside: u64,
}

/// What counts as far along: between two paths, mm.
const APART: f64 = 10.0;

impl Canvas {
    pub(super) fn clear(&mut self, grid: Grid) {
        self.grid = grid;
        self.passes.clear();
        self.passes.resize(grid.cells(), 0);
        self.reached.clear();
        self.reached.resize(grid.cells(), f32::NEG_INFINITY);
    }

    pub(super) fn draw(&mut self, strokes: &[Stroke]) {
        let mut way = 0.0;
        for stroke in strokes {
            let (direction, length) = stroke.direction();
            if !stroke.joined {
                way += APART + 8.0 * stroke.half;
            }
            let bounds = stroke.bounds();
            for row in self.grid.rows(bounds.min.y, bounds.max.y) {
                let y = self.grid.y(row);
                // A joint lies at the bead's very beginning.
                if let Some(run) = stroke.joint(y) {
                    self.cover(row, run, way, 0.0, stroke.half);
                }
                if let Some(run) = stroke.body(direction, length, y) {
                    let offset = self.grid.x(0) - stroke.from.x;
                    let first = way + direction.x * offset + direction.y * (y - stroke.from.y);
                    self.cover(row, run, first, direction.x * self.grid.cell, stroke.half);
                }
            }
            way += length;
        }
    }

    /// Covers a run of a row; the way at its column `i` is `way + i step`.
    #[inline]
    fn cover(&mut self, row: usize, (from, to): (f64, f64), way: f64, step: f64, half: f64) {
        let columns = self.grid.columns(from, to);
        let start = row * self.grid.width;
        let near = (4.0 * half) as f32;
        let cells = start + columns.start..start + columns.end;
        let passes = &mut self.passes[cells.clone()];
        let reached = &mut self.reached[cells];
        for (i, (passes, reached)) in passes.iter_mut().zip(reached).enumerate() {
            let now = (way + (columns.start + i) as f64 * step) as f32;
            if now - *reached > near {
                *passes = passes.saturating_add(1);
            }
            *reached = reached.max(now);
        }
    }

    pub(super) fn count(&self, region: Option<&[Polygon]>) -> Counts {
        let mut counts = Counts::default();
        for passes in &self.passes {
            counts.covered += u64::from(*passes > 0);
            counts.twice += u64::from(*passes > 1);
        }
        if let Some(region) = region {
            region::fill(&self.grid, region, |row, columns| {
                let start = row * self.grid.width;
                let cells = &self.passes[start + columns.start..start + columns.end];
                counts.region += cells.len() as u64;
                counts.inside += cells.iter().map(|p| u64::from(*p > 0)).sum::<u64>();
            });
        }
        counts
    }
}
