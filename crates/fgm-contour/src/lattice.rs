use crate::{ContourError, MAX_CELLS_A_SIDE};
use fgm_core::{Bounds2, Point2};

/// A remainder of the window below this share of a cell widens the last cell instead of making a
/// sliver of its own.
const LEAST_CELL: f64 = 0.1;

/// The samples along one axis: `start + i * step`, the last of them exactly at `end`.
///
/// A closed axis has one more sample beyond either end, in the same place as the end. The cells
/// of no width between them let a region's border run along the window's edge exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    start: f64,
    end: f64,
    step: f64,
    /// Cells between `start` and `end`.
    inner: u32,
    pad: u32,
}

impl Axis {
    fn new(start: f64, end: f64, cell: f64, closed: bool) -> Self {
        let inner = ((end - start) / cell - LEAST_CELL).ceil().max(1.0) as u32;
        Self { start, end, step: cell, inner, pad: u32::from(closed) }
    }

    /// Where sample `i` lies. The same for every caller, so that neighbours agree to the bit.
    pub(crate) fn at(&self, i: u32) -> f64 {
        let k = i.saturating_sub(self.pad);
        if k >= self.inner { self.end } else { self.start + f64::from(k) * self.step }
    }

    /// Cells, those of no width included.
    pub(crate) fn cells(&self) -> u32 {
        self.inner + 2 * self.pad
    }

    /// Whether sample `i` lies beyond the window.
    pub(crate) fn is_pad(&self, i: u32) -> bool {
        self.pad == 1 && (i == 0 || i > self.inner + 1)
    }

    /// The cell that holds `x`, which lies in the window.
    pub(crate) fn cell_of(&self, x: f64) -> u32 {
        let k = ((x - self.start) / self.step).max(0.0) as u32;
        k.min(self.inner - 1) + self.pad
    }
}

/// The points at which a field is sampled. All blocks of a window share one lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) closed: bool,
}

impl Lattice {
    /// A lattice over a finite window of positive size.
    pub(crate) fn new(window: &Bounds2, cell: f64, closed: bool) -> Result<Self, ContourError> {
        let count = window.size() / cell;
        let limit = MAX_CELLS_A_SIDE;
        if count.max_element() > f64::from(limit) {
            return Err(ContourError::TooManyCells { columns: count.x, rows: count.y, limit });
        }
        Ok(Self {
            x: Axis::new(window.min.x, window.max.x, cell, closed),
            y: Axis::new(window.min.y, window.max.y, cell, closed),
            closed,
        })
    }

    /// All that is sampled.
    pub(crate) fn window(&self) -> Bounds2 {
        let (x, y) = (&self.x, &self.y);
        Bounds2::new(Point2::new(x.start, y.start), Point2::new(x.end, y.end))
    }

    /// Where sample (i, j) lies.
    pub(crate) fn at(&self, i: u32, j: u32) -> Point2 {
        Point2::new(self.x.at(i), self.y.at(j))
    }

    /// The rectangle between two samples.
    pub(crate) fn rect(&self, i: (u32, u32), j: (u32, u32)) -> Bounds2 {
        Bounds2::new(self.at(i.0, j.0), self.at(i.1, j.1))
    }

    /// The cell that holds a point of the window.
    pub(crate) fn cell_around(&self, p: Point2) -> Bounds2 {
        let (i, j) = (self.x.cell_of(p.x), self.y.cell_of(p.y));
        self.rect((i, i + 1), (j, j + 1))
    }
}
