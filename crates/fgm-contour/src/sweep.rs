use crate::ContourError;
use crate::graph::Graph;
use crate::lattice::Lattice;
use crate::march::{CellRow, Marcher, NAN_CLASS, class_near, range_of};
use crate::prune::{BLOCK, Blocks};
use fgm_core::{PlanarField, Point2};
use std::ops::Range;

/// Samples of a band: one row of blocks and the row of samples above it.
const BAND_ROWS: usize = BLOCK as usize + 1;
/// Points gathered before the field is asked.
const BATCH: usize = 1024;

/// Samples a field in the active blocks, each lattice point once, and marches through them.
///
/// Memory is one band of rows, whatever the window's height.
#[derive(Debug, Default)]
pub(crate) struct Sweep {
    marcher: Marcher,
    values: Vec<f64>,
    classes: Vec<u16>,
    runs: Vec<(u32, u32)>,
    top_runs: Vec<(u32, u32)>,
    points: Vec<Point2>,
    results: Vec<f64>,
    spans: Vec<Range<usize>>,
}

/// What a sweep goes over.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) field: &'a dyn PlanarField,
    /// In order.
    pub(crate) levels: &'a [f64],
    pub(crate) skip_nan: bool,
}

impl Sweep {
    /// Fills the graph with every crossing and segment in the active blocks.
    pub(crate) fn run(
        &mut self,
        task: &Task<'_>,
        blocks: &Blocks,
        graph: &mut Graph,
    ) -> Result<(), ContourError> {
        let stride = task.lattice.x.cells() as usize + 1;
        self.marcher.reset(task.lattice.x.cells());
        self.values.resize(stride * BAND_ROWS, 0.0);
        self.classes.resize(stride * BAND_ROWS, 0);
        for band in 0..blocks.rows() {
            let j0 = band * BLOCK;
            let rows = (task.lattice.y.cells() - j0).min(BLOCK);
            blocks.runs(band, false, &mut self.runs);
            blocks.runs(band, true, &mut self.top_runs);
            self.sample(task, j0, rows, band == 0)?;
            for r in 0..rows {
                self.march(task, j0, r, graph);
                graph.check()?;
            }
            let top = rows as usize * stride;
            self.values.copy_within(top..top + stride, 0);
            self.classes.copy_within(top..top + stride, 0);
        }
        Ok(())
    }

    /// Samples the rows of a band; the lowest is the top one of the band below.
    fn sample(
        &mut self,
        task: &Task<'_>,
        j0: u32,
        rows: u32,
        lowest: bool,
    ) -> Result<(), ContourError> {
        let stride = task.lattice.x.cells() as usize + 1;
        for r in u32::from(!lowest)..=rows {
            let runs = if r == rows { self.top_runs.len() } else { self.runs.len() };
            for k in 0..runs {
                let (from, to) = if r == rows { self.top_runs[k] } else { self.runs[k] };
                let at = r as usize * stride + from as usize;
                self.gather(task, j0 + r, from, to, at)?;
            }
        }
        self.flush(task)
    }

    /// Queues the samples of a run, or fills those beyond a closed window.
    fn gather(
        &mut self,
        task: &Task<'_>,
        j: u32,
        from: u32,
        to: u32,
        at: usize,
    ) -> Result<(), ContourError> {
        let (x, y) = (&task.lattice.x, &task.lattice.y);
        let (mut first, mut end) = (from, to + 1);
        if y.is_pad(j) {
            first = end;
        } else {
            first += u32::from(x.is_pad(first));
            end -= u32::from(x.is_pad(end - 1));
        }
        let outside = task.levels.len() as u16;
        let index = |i: u32| at + (i - from) as usize;
        for span in [index(from)..index(first), index(end)..index(to + 1)] {
            self.values[span.clone()].fill(f64::INFINITY);
            self.classes[span].fill(outside);
        }
        if first < end {
            let height = y.at(j);
            self.points.extend((first..end).map(|i| Point2::new(x.at(i), height)));
            self.spans.push(index(first)..index(end));
            if self.points.len() >= BATCH {
                return self.flush(task);
            }
        }
        Ok(())
    }

    /// Evaluates what is queued.
    fn flush(&mut self, task: &Task<'_>) -> Result<(), ContourError> {
        self.results.resize(self.points.len(), 0.0);
        task.field.eval_into(&self.points, &mut self.results);
        let mut at = 0;
        for span in self.spans.drain(..) {
            let results = &self.results[at..at + span.len()];
            self.values[span.clone()].copy_from_slice(results);
            let mut nan = false;
            let mut before = 0;
            let mut range = range_of(before, task.levels);
            for (class, &value) in self.classes[span.clone()].iter_mut().zip(results) {
                if value >= range.0 && value < range.1 {
                    *class = before;
                    continue;
                }
                *class = class_near(before, value, task.levels);
                if *class == NAN_CLASS {
                    nan = true;
                } else {
                    before = *class;
                    range = range_of(before, task.levels);
                }
            }
            if nan && !task.skip_nan {
                let k = results.iter().position(|v| v.is_nan()).unwrap_or(0);
                return Err(ContourError::NotANumber { at: self.points[at + k] });
            }
            at += span.len();
        }
        self.points.clear();
        Ok(())
    }

    fn march(&mut self, task: &Task<'_>, j0: u32, r: u32, graph: &mut Graph) {
        let stride = task.lattice.x.cells() as usize + 1;
        for &(from, to) in &self.runs {
            let lower = r as usize * stride + from as usize;
            let (lower, upper) = (
                lower..lower + (to - from) as usize + 1,
                lower + stride..lower + stride + (to - from) as usize + 1,
            );
            let row = CellRow {
                j: j0 + r,
                i: from,
                lower: &self.values[lower.clone()],
                upper: &self.values[upper.clone()],
                lower_class: &self.classes[lower],
                upper_class: &self.classes[upper],
            };
            self.marcher.run(&row, task.levels, graph);
        }
    }
}
