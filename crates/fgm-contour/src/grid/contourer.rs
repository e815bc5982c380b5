use super::sweep::Sweep;
use super::trace::Traced;
use super::{Grid, Sample};
use crate::bands::{self, AGAINST, Assembler, Band, Border, NONE, Rings, WITH};
use crate::contour::Sorted;
use crate::options::check_levels;
use crate::{ContourError, LevelLines};
use fgm_core::Point2;

/// Vertices nearer to each other than this share of a step are one.
const APART: f64 = 1e-8;

/// The methods of [`Grid`] with scratch memory that is kept from one call to the next: one for
/// each thread that contours grid after grid. The answers are the same.
#[derive(Debug, Default)]
pub struct GridContourer {
    sweep: Sweep,
    traced: Traced,
    rings: Rings,
}

/// One line of [`GridContourer::lines`], in memory that the next call reuses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineRef<'a> {
    /// The level.
    pub level: f64,
    /// The vertices, lower values on the left.
    pub points: &'a [Point2],
    /// Whether the last point joins the first; otherwise the line ends at the border of the data.
    pub closed: bool,
}

impl GridContourer {
    /// The lines of [`Grid::isolines`] without a copy, in no order of levels.
    ///
    /// # Errors
    /// As [`Grid::isolines`].
    pub fn lines<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<impl Iterator<Item = LineRef<'_>>, ContourError> {
        let Sorted { levels } = self.trace(grid, levels)?;
        let lines = &self.traced.lines;
        let kept = lines.list.iter().filter(|l| l.from < l.to);
        Ok(kept.map(move |line| LineRef {
            level: levels[usize::from(line.level)],
            points: lines.points(line),
            closed: line.closed,
        }))
    }

    /// See [`Grid::isolines`].
    ///
    /// # Errors
    /// As [`Grid::isolines`].
    pub fn isolines<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<Vec<LevelLines>, ContourError> {
        let sorted = self.trace(grid, levels)?;
        Ok(sorted.collect(levels, &self.traced.lines))
    }

    /// See [`Grid::isobands`].
    ///
    /// # Errors
    /// As [`Grid::isobands`].
    pub fn isobands<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<Vec<Band>, ContourError> {
        let Sorted { levels } = self.trace(grid, levels)?;
        let border = self.border(grid);
        let assembler = Assembler { lines: &self.traced.lines, border: &border };
        assembler.run(|_| true, |_| true, &mut self.rings);
        let rings = std::mem::take(&mut self.rings.list);
        if self.sweep.edges.has_holes {
            return Ok(bands::bands_of(&levels, rings));
        }
        let outer_of = self.outers(&border, rings.len(), grid);
        Ok(bands::bands_by(&levels, rings, &outer_of))
    }

    /// See [`Grid::below`].
    ///
    /// # Errors
    /// As [`Grid::below`].
    pub fn below<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<Vec<Band>, ContourError> {
        let sorted = self.trace(grid, levels)?;
        let border = self.border(grid);
        let regions = bands::below(&sorted.levels, &self.traced.lines, &border);
        Ok(sorted.in_order(levels, regions))
    }

    fn trace<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<Sorted, ContourError> {
        check_levels(levels)?;
        grid.check()?;
        let sorted = Sorted::new(levels);
        self.sweep.run(grid, &sorted.levels)?;
        self.traced.run(&mut self.sweep, APART * grid.step.min_element());
        Ok(sorted)
    }

    fn border<T: Sample>(&mut self, grid: &Grid<'_, T>) -> Border {
        let Sweep { nodes, edges, .. } = &mut self.sweep;
        edges.border(|i, j| grid.at(i, j), nodes, &self.traced.lines)
    }

    /// For each ring of data without holes: the ring that it is a hole in, or itself.
    ///
    /// A closed line's first crossing is its leftmost in the row, so that what lies to the left
    /// of it in the row is around it: the region up to the next crossing, or to the edge of the
    /// grid. The ring on that crossing's right is of the same region, and began before this one.
    fn outers<T>(&self, border: &Border, rings: usize, grid: &Grid<'_, T>) -> Vec<u32> {
        let mut outer_of: Vec<u32> = (0..rings as u32).collect();
        let (nodes, lines) = (&self.sweep.nodes, &self.traced.lines);
        for (k, line) in lines.list.iter().enumerate().filter(|l| l.1.closed) {
            let first = self.traced.firsts[k];
            let hole = if nodes.list[first as usize].rises { WITH } else { AGAINST };
            let hole = self.rings.of_line[k][hole];
            if line.from == line.to || hole == NONE {
                continue;
            }
            let row = self.sweep.rows.partition_point(|r| r.1 <= first);
            let crossings = (self.sweep.rows[row].0..first).rev();
            let line_of = |id: u32| {
                let pair = nodes.strands.pairs.get(nodes.list[id as usize].strand as usize / 2)?;
                let line = lines.list.get(pair.line as usize)?;
                (line.from < line.to).then_some((id, pair.line as usize))
            };
            let around = crossings.filter_map(line_of).next();
            let ring = match around {
                Some((id, line)) => {
                    let side = if nodes.list[id as usize].rises { AGAINST } else { WITH };
                    self.rings.of_line[line][side]
                }
                None => self.ring_left_of(border, row, grid.columns - 1, grid.rows - 1),
            };
            outer_of[hole as usize] = outer_of.get(ring as usize).copied().unwrap_or(NONE);
        }
        outer_of
    }

    /// The ring that passes the first sample of a row.
    fn ring_left_of(&self, border: &Border, row: usize, columns: usize, rows: usize) -> u32 {
        // The loop begins at the first sample of the first row and comes down on the left.
        let edge = (2 * (columns + rows) - row) as u32;
        match border.events.partition_point(|e| e.edge < edge).checked_sub(1) {
            Some(event) => self.rings.of_event[event],
            None => self.rings.of_event.last().copied().unwrap_or(self.rings.of_border),
        }
    }
}
