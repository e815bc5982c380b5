use crate::lattice::Lattice;
use fgm_core::{Interval, PlanarField};

/// Cells along a side of a block: the leaves of the quadtree.
pub(crate) const BLOCK: u32 = 16;

/// Bounds are widened by this share of their size, so that rounding in a field's interval
/// arithmetic cannot lose a contour.
const SLACK: f64 = 1e-12;

/// The blocks of a lattice in which a contour may lie.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    columns: u32,
    rows: u32,
    cells: u32,
    active: Vec<bool>,
    stack: Vec<(u32, u32, u32)>,
}

impl Blocks {
    fn reset(&mut self, lattice: &Lattice) {
        self.cells = lattice.x.cells();
        self.columns = lattice.x.cells().div_ceil(BLOCK);
        self.rows = lattice.y.cells().div_ceil(BLOCK);
        self.active.clear();
        self.active.resize(self.columns as usize * self.rows as usize, false);
    }

    /// Marks the blocks in which the field's bounds allow one of the `levels`, which are in
    /// order. Cost follows the length of the contour where the bounds are tight.
    pub(crate) fn mark(&mut self, lattice: &Lattice, field: &dyn PlanarField, levels: &[f64]) {
        self.reset(lattice);
        let size = self.columns.max(self.rows).next_power_of_two();
        self.stack.push((0, 0, size));
        while let Some((column, row, size)) = self.stack.pop() {
            if column >= self.columns || row >= self.rows {
                continue;
            }
            let end = |k: u32, cells: u32| ((k + size) * BLOCK).min(cells);
            let (x, y) = (end(column, lattice.x.cells()), end(row, lattice.y.cells()));
            let rect = lattice.rect((column * BLOCK, x), (row * BLOCK, y));
            let at_edge =
                column == 0 || row == 0 || column + size >= self.columns || row + size >= self.rows;
            // A region's border runs along the window's edge where the region leaves it.
            if !may_hold(field.bounds(&rect), levels, lattice.closed && at_edge) {
                continue;
            }
            if size == 1 {
                self.active[(row * self.columns + column) as usize] = true;
            } else {
                let half = size / 2;
                for (dx, dy) in [(half, half), (0, half), (half, 0), (0, 0)] {
                    self.stack.push((column + dx, row + dy, half));
                }
            }
        }
    }

    /// How many rows of blocks there are.
    pub(crate) fn rows(&self) -> u32 {
        self.rows
    }

    /// The runs of cells, first and end, that are active in row `row` of the blocks or, with
    /// `or_next`, in the one above it.
    pub(crate) fn runs(&self, row: u32, or_next: bool, out: &mut Vec<(u32, u32)>) {
        out.clear();
        let line = |row: u32| {
            let from = row as usize * self.columns as usize;
            self.active.get(from..from + self.columns as usize).unwrap_or_default()
        };
        let (this, next) = (line(row), if or_next { line(row + 1) } else { &[] });
        for column in 0..self.columns {
            let k = column as usize;
            if !(this.get(k) == Some(&true) || next.get(k) == Some(&true)) {
                continue;
            }
            let (from, to) = (column * BLOCK, ((column + 1) * BLOCK).min(self.cells));
            match out.last_mut() {
                Some(last) if last.1 == from => last.1 = to,
                _ => out.push((from, to)),
            }
        }
    }
}

fn may_hold(bounds: Interval, levels: &[f64], border: bool) -> bool {
    let Interval { lo, hi } = bounds;
    if lo.is_nan() || hi.is_nan() {
        return true;
    }
    let slack = SLACK * lo.abs().max(hi.abs());
    if !slack.is_finite() {
        return levels.iter().any(|&l| lo <= l && (l <= hi || border));
    }
    let first = levels.partition_point(|&l| l < lo - slack);
    levels.get(first).is_some_and(|&l| l <= hi + slack || border)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_that_touch_a_level_hold_it() {
        let check = |lo, hi, border, expected| {
            assert_eq!(
                may_hold(Interval::new(lo, hi), &[-1.0, 2.0], border),
                expected,
                "{lo} {hi}"
            );
        };
        check(2.0, 3.0, false, true);
        check(2.1, 3.0, true, false);
        check(-0.9, 1.9, false, false);
        check(-0.9, 1.9, true, true);
        check(-5.0, -1.0, false, true);
        check(f64::NAN, 0.0, false, true);
        check(f64::NEG_INFINITY, -4.0, false, false);
        check(f64::NEG_INFINITY, f64::INFINITY, false, true);
        check(f64::INFINITY, f64::INFINITY, true, false);
    }
}
