//! Rows of samples: arrays and masks.

mod classes;
mod contourer;
mod edges;
mod nodes;
mod strands;
mod sweep;
mod trace;

pub use contourer::{GridContourer, LineRef};

use crate::bands::Band;
use crate::{ContourError, LevelLines, MAX_CELLS_A_SIDE};
use fgm_core::{Point2, Polygon};

/// Samples on a regular grid, row by row from below, borrowed.
///
/// Between samples, values are interpolated linearly along the grid's edges. What is NaN is a
/// hole: the data end at the cells around it as at the grid's own edge. A value that is exactly
/// the level counts as higher. Nothing is added and nothing simplified: there is a vertex wherever
/// a line passes between two neighbouring samples, except that vertices nearer than 1e-8 of a step
/// are one.
///
/// Each method has memory of its own; for grid after grid see [`GridContourer`].
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a, T = f64> {
    /// Where the first sample lies, mm.
    pub origin: Point2,
    /// From one sample to the next along x and y, mm; above 0.
    pub step: Point2,
    /// Samples along x; 2 or more.
    pub columns: usize,
    /// Samples along y; 2 or more.
    pub rows: usize,
    /// `rows * columns` values; x runs fastest.
    pub values: &'a [T],
}

/// What a [`Grid`] can hold: `f64`, `f32`, and `bool` for a mask, in which `false` is 0 and `true`
/// is 1.
pub trait Sample: Copy + sealed::Sample {}

impl Sample for f64 {}
impl Sample for f32 {}
impl Sample for bool {}

mod sealed {
    pub trait Sample: Sized {
        /// Fills the buffer with the row, unless it can be viewed as it is.
        fn load(row: &[Self], buffer: &mut Vec<f64>);
        /// The row, from the buffer if it was loaded.
        fn view<'a>(row: &'a [Self], buffer: &'a [f64]) -> &'a [f64];
    }

    impl Sample for f64 {
        fn load(_: &[Self], _: &mut Vec<f64>) {}
        fn view<'a>(row: &'a [Self], _: &'a [f64]) -> &'a [f64] {
            row
        }
    }

    impl Sample for f32 {
        fn load(row: &[Self], buffer: &mut Vec<f64>) {
            buffer.clear();
            buffer.extend(row.iter().copied().map(f64::from));
        }
        fn view<'a>(_: &'a [Self], buffer: &'a [f64]) -> &'a [f64] {
            buffer
        }
    }

    impl Sample for bool {
        fn load(row: &[Self], buffer: &mut Vec<f64>) {
            buffer.clear();
            buffer.extend(row.iter().copied().map(|b| f64::from(u8::from(b))));
        }
        fn view<'a>(_: &'a [Self], buffer: &'a [f64]) -> &'a [f64] {
            buffer
        }
    }
}

impl<T: Sample> Grid<'_, T> {
    /// The lines along which the values have the given levels, one answer a level, in the order
    /// asked for. Lower values lie on the left. Lines are open where they leave the grid and end
    /// exactly on its edge; [`below`](Self::below) gives them closed.
    ///
    /// # Errors
    /// [`ContourError`] for values that do not fill the grid, and levels, steps or sizes out of
    /// range.
    ///
    /// ```
    /// use fgm_contour::Grid;
    /// use fgm_core::Point2;
    ///
    /// let values = [0.0_f32, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0];
    /// let (origin, step) = (Point2::ZERO, Point2::ONE);
    /// let grid = Grid { origin, step, columns: 3, rows: 3, values: &values };
    /// let lines = grid.isolines(&[1.0, 2.0])?;
    /// assert_eq!(lines[1].rings[0].area(), -0.5); // Low outside: clockwise.
    /// # Ok::<(), fgm_contour::ContourError>(())
    /// ```
    pub fn isolines(&self, levels: &[f64]) -> Result<Vec<LevelLines>, ContourError> {
        GridContourer::default().isolines(self, levels)
    }

    /// The regions below, between and above the levels: one more than there are different levels,
    /// from the lowest up. Together they are the whole cells of the grid; neighbours share their
    /// border to the last bit.
    ///
    /// # Errors
    /// As [`isolines`](Self::isolines).
    ///
    /// ```
    /// use fgm_contour::Grid;
    /// use fgm_core::Point2;
    ///
    /// let values = [0.0, 1.0, 2.0, 0.0, 1.0, 2.0];
    /// let (origin, step) = (Point2::ZERO, Point2::ONE);
    /// let grid = Grid { origin, step, columns: 3, rows: 2, values: &values };
    /// let bands = grid.isobands(&[0.5, 1.5])?;
    /// let areas: Vec<f64> = bands.iter().map(|b| b.polygons[0].area()).collect();
    /// assert_eq!(areas, [0.5, 1.0, 0.5]);
    /// # Ok::<(), fgm_contour::ContourError>(())
    /// ```
    pub fn isobands(&self, levels: &[f64]) -> Result<Vec<Band>, ContourError> {
        GridContourer::default().isobands(self, levels)
    }

    /// For each level, in the order asked for, the region below it: the lines of
    /// [`isolines`](Self::isolines) closed along the edge of the grid.
    ///
    /// # Errors
    /// As [`isolines`](Self::isolines).
    pub fn below(&self, levels: &[f64]) -> Result<Vec<Band>, ContourError> {
        GridContourer::default().below(self, levels)
    }

    pub(crate) fn check(&self) -> Result<(), ContourError> {
        let (columns, rows, values) = (self.columns, self.rows, self.values.len());
        if columns < 2 || rows < 2 || columns.checked_mul(rows) != Some(values) {
            return Err(ContourError::GridSize { values, columns, rows });
        }
        let limit = MAX_CELLS_A_SIDE;
        if columns.max(rows) > limit as usize {
            let (columns, rows) = (columns as f64, rows as f64);
            return Err(ContourError::TooManyCells { columns, rows, limit });
        }
        for (option, value) in [("step.x", self.step.x), ("step.y", self.step.y)] {
            if !(value.is_finite() && value > 0.0) {
                let limit = "a finite number above 0";
                return Err(ContourError::Option { option, value, limit });
            }
        }
        for (option, value) in [("origin.x", self.origin.x), ("origin.y", self.origin.y)] {
            if !value.is_finite() {
                return Err(ContourError::Option { option, value, limit: "a finite number" });
            }
        }
        Ok(())
    }

    /// Where a sample lies.
    pub(crate) fn at(&self, i: u32, j: u32) -> Point2 {
        self.origin + Point2::new(f64::from(i), f64::from(j)) * self.step
    }
}

impl Grid<'_, bool> {
    /// The region of a mask that is `true`, its border half way to the samples that are `false`
    /// and along the edge of the grid. Diagonal neighbours are joined.
    ///
    /// # Errors
    /// As [`isolines`](Self::isolines).
    ///
    /// ```
    /// use fgm_contour::Grid;
    /// use fgm_core::Point2;
    ///
    /// let values = ["....", ".##.", "...."].concat().bytes().map(|b| b == b'#').collect::<Vec<_>>();
    /// let (origin, step) = (Point2::ZERO, Point2::ONE);
    /// let mask = Grid { origin, step, columns: 4, rows: 3, values: &values };
    /// assert_eq!(mask.outline()?[0].area(), 1.5);
    /// # Ok::<(), fgm_contour::ContourError>(())
    /// ```
    pub fn outline(&self) -> Result<Vec<Polygon>, ContourError> {
        let mut bands = self.isobands(&[0.5])?;
        Ok(bands.pop().map(|b| b.polygons).unwrap_or_default())
    }
}
