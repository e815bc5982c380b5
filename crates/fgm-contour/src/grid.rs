use crate::contour::{Sorted, Trace};
use crate::lattice::Lattice;
use crate::lines::Lines;
use crate::march::{CellRow, Marcher, class_of};
use crate::options::check_levels;
use crate::place::place_linear;
use crate::{ContourError, LevelLines, MAX_CELLS_A_SIDE};
use fgm_core::Point2;

/// Vertices nearer to each other than this share of a step are one.
const APART: f64 = 1e-8;

/// Samples on a regular grid, row by row from below, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// Where the first sample lies, mm.
    pub origin: Point2,
    /// From one sample to the next along x and y, mm; above 0.
    pub step: Point2,
    /// Samples along x; 2 or more.
    pub columns: usize,
    /// Samples along y; 2 or more.
    pub rows: usize,
    /// `rows * columns` values; x runs fastest. Lines end around what is NaN.
    pub values: &'a [f64],
}

impl Grid<'_> {
    /// The lines along which the values, interpolated linearly along the grid's edges, have the
    /// given levels; otherwise as [`crate::isolines`]. Nothing is added and nothing simplified.
    ///
    /// # Errors
    /// [`ContourError`] for values that do not fill the grid, and levels, steps or sizes out of
    /// range.
    ///
    /// ```
    /// use fgm_contour::Grid;
    /// use fgm_core::Point2;
    ///
    /// let values = [0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0];
    /// let (origin, step) = (Point2::ZERO, Point2::ONE);
    /// let grid = Grid { origin, step, columns: 3, rows: 3, values: &values };
    /// let lines = grid.isolines(&[1.0, 2.0])?;
    /// assert_eq!(lines[1].rings[0].area(), -0.5); // Low outside: clockwise.
    /// # Ok::<(), fgm_contour::ContourError>(())
    /// ```
    pub fn isolines(&self, levels: &[f64]) -> Result<Vec<LevelLines>, ContourError> {
        check_levels(levels)?;
        self.check()?;
        let sorted = Sorted::new(levels);
        let lattice =
            Lattice::of_samples(self.origin, self.step, self.columns as u32, self.rows as u32);
        let mut trace = Trace::default();
        self.march(&sorted.levels, &mut trace)?;
        place_linear(&lattice, &sorted.levels, &trace.graph, &mut trace.positions);
        let apart = APART * self.step.min_element();
        trace.graph.chains(&trace.positions, apart, &mut trace.chains);
        let mut lines = Lines::default();
        for chain in &trace.chains.list {
            let nodes = &trace.chains.nodes[chain.from..chain.to];
            lines.points.extend(nodes.iter().map(|&id| trace.positions[id as usize]));
            lines.finish(chain.closed, chain.level);
        }
        Ok(sorted.collect(levels, &lines))
    }

    fn march(&self, levels: &[f64], trace: &mut Trace) -> Result<(), ContourError> {
        let mut marcher = Marcher::default();
        marcher.reset(self.columns as u32);
        let mut classes = [vec![0; self.columns], vec![0; self.columns]];
        for (j, upper) in self.values.chunks_exact(self.columns).enumerate() {
            let [lower_class, upper_class] = &mut classes;
            std::mem::swap(lower_class, upper_class);
            for (class, &value) in upper_class.iter_mut().zip(upper) {
                *class = class_of(value, levels);
            }
            if j > 0 {
                let lower = &self.values[(j - 1) * self.columns..j * self.columns];
                let j = j as u32 - 1;
                let row = CellRow { j, i: 0, lower, upper, lower_class, upper_class };
                marcher.run(&row, levels, &mut trace.graph);
                trace.graph.check()?;
            }
        }
        Ok(())
    }

    fn check(&self) -> Result<(), ContourError> {
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
}
