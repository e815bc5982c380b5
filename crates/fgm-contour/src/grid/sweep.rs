use super::classes::{CHUNK, MIXED, Row, crossed_cells, crossed_edges};
use super::edges::Edges;
use super::nodes::{Crossed, NONE, Nodes};
use super::{Grid, Sample};
use crate::cases::{is_saddle, links, saddle_is_above};
use crate::march::NAN_CLASS;
use crate::{ContourError, MAX_CROSSINGS};
use fgm_core::Point2;

/// Marching squares over a grid at all levels in one visit to each cell, row by row.
///
/// Chunks of cells that no level passes through are left out after one look at each sample.
#[derive(Debug, Default)]
pub(crate) struct Sweep {
    pub(crate) nodes: Nodes,
    /// The border of the data.
    pub(crate) edges: Edges,
    /// By row of samples: where its horizontal edges' crossings begin and end among the nodes.
    pub(crate) rows: Vec<(u32, u32)>,
    xs: Vec<f64>,
    lower: Side,
    upper: Side,
    /// By column: the first crossing on the upright edge between the two rows.
    upright: Vec<u32>,
}

/// One of the two rows of samples around a row of cells.
#[derive(Debug, Default)]
pub(crate) struct Side {
    /// Values that had to be converted.
    buffer: Vec<f64>,
    pub(crate) row: Row,
    /// By column: the first crossing on the edge to the next sample.
    pub(crate) level_edges: Vec<u32>,
}

/// A row of cells, as it is looked at.
struct Cells<'a> {
    j: u32,
    y: f64,
    height: f64,
    lower: &'a [f64],
    upper: &'a [f64],
    levels: &'a [f64],
}

/// A chunk of it: the samples below and above, one more than cells, and the first crossings on
/// the edges between those in a row.
struct Chunk<'a> {
    first: usize,
    low: &'a [u16; CHUNK + 1],
    high: &'a [u16; CHUNK + 1],
    below: &'a [u32; CHUNK + 1],
    above: &'a [u32; CHUNK + 1],
}

impl Sweep {
    /// Finds every crossing and every segment.
    pub(crate) fn run<T: Sample>(
        &mut self,
        grid: &Grid<'_, T>,
        levels: &[f64],
    ) -> Result<(), ContourError> {
        self.reset(grid);
        for j in 0..grid.rows {
            let row = grid.values.get(j * grid.columns..).unwrap_or_default();
            let row = &row[..grid.columns];
            std::mem::swap(&mut self.lower, &mut self.upper);
            T::load(row, &mut self.upper.buffer);
            let mut buffers = [std::mem::take(&mut self.lower.buffer), Vec::new()];
            buffers[1] = std::mem::take(&mut self.upper.buffer);
            let upper = T::view(row, &buffers[1]);
            self.upper.row.classify(upper, levels);
            let y = grid.origin.y + j as f64 * grid.step.y;
            self.cross_row(upper, y, levels)?;
            if j > 0 {
                let below = &grid.values[(j - 1) * grid.columns..j * grid.columns];
                let lower = T::view(below, &buffers[0]);
                let y = grid.origin.y + (j - 1) as f64 * grid.step.y;
                let height = grid.origin.y + j as f64 * grid.step.y - y;
                let cells = Cells { j: j as u32 - 1, y, height, lower, upper, levels };
                self.march(&cells)?;
            }
            [self.lower.buffer, self.upper.buffer] = buffers;
        }
        let last = grid.rows as u32 - 1;
        self.edges.end(last, &self.upper);
        Ok(())
    }

    fn reset<T>(&mut self, grid: &Grid<'_, T>) {
        self.nodes.clear();
        self.rows.clear();
        self.xs.clear();
        let x = |i: usize| grid.origin.x + i as f64 * grid.step.x;
        self.xs.extend((0..grid.columns).map(x));
        for side in [&mut self.lower, &mut self.upper] {
            side.row.reset(grid.columns);
            side.level_edges.clear();
            side.level_edges.resize(side.row.classes.len(), NONE);
        }
        self.upright.clear();
        self.upright.resize(self.lower.row.classes.len(), NONE);
        self.edges.reset(grid.columns);
    }

    /// Adds the crossings of the upper row's own edges.
    fn cross_row(&mut self, values: &[f64], y: f64, levels: &[f64]) -> Result<(), ContourError> {
        let begin = self.nodes.list.len() as u32;
        let Side { row, level_edges, .. } = &mut self.upper;
        for (q, _) in row.chunks.iter().enumerate().filter(|c| *c.1 == MIXED) {
            for i in crossed_edges(row, q).map(|k| q * CHUNK + k) {
                let classes = [row.classes[i], row.classes[i + 1]];
                if !classes.contains(&NAN_CLASS) {
                    let from = Point2::new(self.xs[i], y);
                    let step = Point2::new(self.xs[i + 1] - self.xs[i], 0.0);
                    let values = [values[i], values[i + 1]];
                    level_edges[i] = self.nodes.add((from, step), values, classes, levels);
                }
            }
            check(&self.nodes)?;
        }
        self.rows.push((begin, self.nodes.list.len() as u32));
        Ok(())
    }

    /// Adds the crossings of the upright edges and the segments of all cells.
    fn march(&mut self, cells: &Cells<'_>) -> Result<(), ContourError> {
        let Self { nodes, edges, xs, lower, upper, upright, .. } = self;
        let (low, high) = (&lower.row.classes, &upper.row.classes);
        if low[0] != high[0] {
            upright[0] = cells.cross(nodes, xs, 0, [low[0], high[0]]);
        }
        if edges.is_ragged(lower, upper) {
            let classes = low[..xs.len()].windows(2).map(|w| [w[0], w[1]]);
            for (classes, &first) in classes.zip(&lower.level_edges) {
                if classes[0] != classes[1] && !classes.contains(&NAN_CLASS) {
                    nodes.enter(Crossed { first, classes });
                }
            }
        }
        let chunks = lower.row.chunks.iter().zip(&upper.row.chunks).enumerate();
        for (q, _) in chunks.filter(|(_, (below, above))| below != above || **below == MIXED) {
            let first = q * CHUNK;
            let range = first..=first + CHUNK;
            let (Ok(low), Ok(high), Ok(below), Ok(above), Ok(upright)) = (
                low[range.clone()].try_into(),
                high[range.clone()].try_into(),
                lower.level_edges[range.clone()].try_into(),
                upper.level_edges[range.clone()].try_into(),
                <&mut [u32; CHUNK + 1]>::try_from(&mut upright[range]),
            ) else {
                continue;
            };
            let chunk = Chunk { first, low, high, below, above };
            // Beyond the last sample its class is repeated.
            let count = xs.len() - 1 - first;
            for k in crossed_cells(&lower.row, &upper.row, q).take_while(|&k| k < count) {
                cells.cell(&chunk, k % CHUNK, upright, nodes, xs);
            }
            check(nodes)?;
        }
        edges.row(cells.j, lower, upper, upright);
        Ok(())
    }
}

impl Cells<'_> {
    /// Adds the crossings of the upright edge at sample `i`; answers the first.
    fn cross(&self, nodes: &mut Nodes, xs: &[f64], i: usize, classes: [u16; 2]) -> u32 {
        if classes.contains(&NAN_CLASS) {
            return NONE;
        }
        let (from, step) = (Point2::new(xs[i], self.y), Point2::new(0.0, self.height));
        nodes.add((from, step), [self.lower[i], self.upper[i]], classes, self.levels)
    }

    /// Adds the crossings on the right of a cell, and its segments.
    #[inline]
    fn cell(
        &self,
        chunk: &Chunk<'_>,
        k: usize,
        upright: &mut [u32; CHUNK + 1],
        nodes: &mut Nodes,
        xs: &[f64],
    ) {
        let classes = [chunk.low[k], chunk.low[k + 1], chunk.high[k + 1], chunk.high[k]];
        let [c0, c1, c2, c3] = classes;
        if c1 != c2 {
            upright[k + 1] = self.cross(nodes, xs, chunk.first + k + 1, [c1, c2]);
        }
        let (least, greatest) = (c0.min(c1).min(c2.min(c3)), c0.max(c1).max(c2.max(c3)));
        let firsts = [chunk.below[k], upright[k + 1], chunk.above[k], upright[k]];
        if greatest - least == 1 {
            let above = [c0, c1, c2, c3].map(|c| usize::from(c - least));
            let case = above[0] | above[1] << 1 | above[2] << 2 | above[3] << 3;
            let [from, to] = SINGLE[case];
            if from != to {
                let [from, to] = [from, to].map(|e| firsts[usize::from(e % 4)]);
                return nodes.link(from, to, least);
            }
        }
        if greatest != NAN_CLASS {
            self.cell_of_many(chunk.first + k, classes, firsts, nodes);
        }
    }

    /// Adds the segments of a cell with a saddle or several levels.
    fn cell_of_many(&self, i: usize, classes: [u16; 4], firsts: [u32; 4], nodes: &mut Nodes) {
        let [c0, c1, c2, c3] = classes;
        let (least, greatest) = (c0.min(c1).min(c2.min(c3)), c0.max(c1).max(c2.max(c3)));
        let ends = [[c0, c1], [c1, c2], [c3, c2], [c0, c3]];
        for level in least..greatest {
            let bit = |corner: usize| u8::from(classes[corner] > level) << corner;
            let case = bit(0) | bit(1) | bit(2) | bit(3);
            let above = is_saddle(case) && {
                let corners = [self.lower[i], self.lower[i + 1], self.upper[i + 1], self.upper[i]];
                saddle_is_above(corners, self.levels[usize::from(level)])
            };
            for &(from, to) in links(case, above) {
                let id = |e: u8| {
                    let e = usize::from(e);
                    Crossed { first: firsts[e], classes: ends[e] }.id(level)
                };
                nodes.link(id(from), id(to), level);
            }
        }
    }
}

/// The segment of each case that has one, and two equal edges for the others.
const SINGLE: [[u8; 2]; 16] = {
    let mut single = [[0; 2]; 16];
    let mut case = 0;
    while case < 16 {
        if let &[(from, to)] = links(case as u8, false) {
            single[case] = [from, to];
        }
        case += 1;
    }
    single
};

/// Fails when ids are about to run out; asked once a chunk.
fn check(nodes: &Nodes) -> Result<(), ContourError> {
    if nodes.list.len() > MAX_CROSSINGS {
        return Err(ContourError::TooManyCrossings { limit: MAX_CROSSINGS });
    }
    Ok(())
}
