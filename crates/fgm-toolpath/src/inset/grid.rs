//! The edges of a border in square cells, for asking what lies near.

use fgm_core::{Bounds2, Point2};

/// The most cells an edge: a long thin border must not make mostly empty cells, which cost more
/// to clear than they save.
const CELLS_AN_EDGE: f64 = 4.0;
/// The same where empty cells spare a look at what lies in them.
const CELLS_AN_EDGE_ALONG: f64 = 32.0;
/// A segment is cut into no more stretches than this.
const MOST_STRETCHES: f64 = 1e4;

/// Whether a cell is far from every edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quiet {
    /// There is one in it or in a cell around it.
    No,
    Outside,
    Inside,
}

/// Edges by cell, in one array a piece (no allocation a cell).
pub(crate) struct EdgeGrid {
    origin: Point2,
    cell: f64,
    /// `1 / cell`.
    per_mm: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    items: Vec<u32>,
    edges: Vec<(Point2, Point2)>,
    /// Which cells have no edge in or around them; empty where that is not asked for.
    quiet: Vec<Quiet>,
}

impl EdgeGrid {
    /// Sorts edges into cells of about `cell` mm.
    pub(crate) fn new(edges: Vec<(Point2, Point2)>, cell: f64) -> Self {
        Self::with_cells(edges, cell, CELLS_AN_EDGE)
    }

    fn with_cells(edges: Vec<(Point2, Point2)>, cell: f64, cells_an_edge: f64) -> Self {
        let bounds = Bounds2::of(edges.iter().flat_map(|&(a, b)| [a, b]));
        let size = if bounds.is_finite() { bounds.size() } else { Point2::ZERO };
        let most = cells_an_edge * edges.len().max(1) as f64;
        // Along a border as straight as a line, too, where the area says nothing.
        let least = (size.x * size.y / most).sqrt().max(size.max_element() / most);
        let cell = cell.max(least).max(1e-6);
        let count = |length: f64| (length.max(0.0) / cell) as usize + 1;
        let (columns, rows) = if bounds.is_finite() {
            (count(bounds.size().x), count(bounds.size().y))
        } else {
            (1, 1)
        };
        let starts = vec![0; columns * rows + 1];
        let mut grid = Self {
            origin: bounds.min,
            cell,
            per_mm: 1.0 / cell,
            columns,
            rows,
            starts,
            items: Vec::new(),
            edges,
            quiet: Vec::new(),
        };
        grid.fill();
        grid
    }

    fn fill(&mut self) {
        let mut starts = std::mem::take(&mut self.starts);
        for &(a, b) in &self.edges {
            self.cells_of(a, b, |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut items = vec![0; starts.last().map_or(0, |&n| n as usize)];
        for (edge, &(a, b)) in self.edges.iter().enumerate() {
            self.cells_of(a, b, |cell| {
                items[next[cell] as usize] = edge as u32;
                next[cell] += 1;
            });
        }
        self.starts = starts;
        self.items = items;
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.per_mm) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.per_mm) as usize).min(self.rows - 1)
    }

    /// The cells an edge passes, row by row.
    fn cells_of(&self, a: Point2, b: Point2, mut visit: impl FnMut(usize)) {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        let slope = if high.y > low.y { (high.x - low.x) / (high.y - low.y) } else { 0.0 };
        let (first, last) = (self.row(low.y), self.row(high.y));
        let (left, right) = (self.column(a.x.min(b.x)), self.column(a.x.max(b.x)));
        // Few cells: which of them it passes costs more to know than to look.
        if last - first <= 1 && right - left <= 1 {
            for row in first..=last {
                (left..=right).for_each(|column| visit(row * self.columns + column));
            }
            return;
        }
        for row in first..=last {
            let (mut from, mut to) = (low.x, high.x);
            if first != last {
                let bottom = self.origin.y + row as f64 * self.cell;
                from = low.x + slope * (bottom - low.y).max(0.0);
                to = low.x + slope * (bottom + self.cell - low.y).min(high.y - low.y);
            }
            // A hair wider, so that rounding at a cell's border loses no cell.
            let hair = self.cell * 1e-6;
            let (from, to) = (from.min(to) - hair, from.max(to) + hair);
            for column in self.column(from)..=self.column(to) {
                visit(row * self.columns + column);
            }
        }
    }

    /// Appends where the segment from `a` to `b` crosses edges, as shares of it, in order.
    ///
    /// A corner on the segment counts for one of its two edges, and likewise an end of the
    /// segment on an edge for one of two segments that meet there, so that counting crossings
    /// tells inside from outside.
    pub(crate) fn crossings(&self, a: Point2, b: Point2, out: &mut Vec<f64>) {
        let mut crossed = Vec::new();
        self.crossed(a, b, &mut crossed);
        out.extend(crossed.into_iter().map(|(share, _)| share));
    }

    /// As [`crossings`](Self::crossings), each with the number of the edge.
    pub(crate) fn crossed(&self, a: Point2, b: Point2, out: &mut Vec<(f64, u32)>) {
        let first = out.len();
        self.cells_of(a, b, |cell| {
            let range = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            for &edge in &self.items[range] {
                let (c, d) = self.edges[edge as usize];
                out.extend(crossing(a, b, c, d).map(|share| (share, edge)));
            }
        });
        // An edge stands in every cell that it passes.
        out[first..].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut kept = first;
        for i in first..out.len() {
            if i == first || out[i] != out[kept - 1] {
                out[kept] = out[i];
                kept += 1;
            }
        }
        out.truncate(kept);
    }

    /// Whether a point lies inside the border, by counting how often the way to it crosses. On the
    /// border either answer is possible.
    pub(crate) fn contains(&self, p: Point2) -> bool {
        let Some(row) = self.row_of(p.y) else { return false };
        let mut inside = false;
        // Towards the nearer side; an edge counts in the cell in which it meets the row's line.
        let column = self.column(p.x);
        let to_left = 2 * column < self.columns;
        let cells = if to_left { 0..column + 1 } else { column..self.columns };
        for cell in cells {
            let place = row * self.columns + cell;
            let range = self.starts[place] as usize..self.starts[place + 1] as usize;
            for &edge in &self.items[range] {
                let (a, b) = self.edges[edge as usize];
                if (a.y > p.y) == (b.y > p.y) {
                    continue;
                }
                let x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
                if (x < p.x) == to_left && self.column(x) == cell {
                    inside = !inside;
                }
            }
        }
        inside
    }

    fn row_of(&self, y: f64) -> Option<usize> {
        let height = self.rows as f64 * self.cell;
        (y >= self.origin.y && y <= self.origin.y + height).then(|| self.row(y))
    }

    /// Calls `visit` for every edge that may come within `reach` of a stretch of the segment from `a`
    /// to `b`: with the shares of the segment between which the stretch lies, and the edge's number
    /// and ends; some edges more than once.
    pub(crate) fn along(
        &self,
        a: Point2,
        b: Point2,
        reach: f64,
        mut visit: impl FnMut((f64, f64), u32, (Point2, Point2)),
    ) {
        // What is within `reach` of so short a stretch lies in the cells around its beginning.
        let longest = (self.cell - reach).max(0.5 * self.cell);
        let count = (a.distance(b) / longest).ceil().clamp(1.0, MOST_STRETCHES);
        for i in 0..count as u32 {
            let stretch = (f64::from(i) / count, f64::from(i + 1) / count);
            let (p, q) = (a.lerp(b, stretch.0), a.lerp(b, stretch.1));
            let cell = self.row(p.y) * self.columns + self.column(p.x);
            if reach < longest && self.quiet.get(cell).is_some_and(|cell| *cell != Quiet::No) {
                continue;
            }
            let (low, high) = (p.min(q) - reach, p.max(q) + reach);
            for row in self.row(low.y)..=self.row(high.y) {
                let cells = row * self.columns;
                let first = self.starts[cells + self.column(low.x)] as usize;
                let end = self.starts[cells + self.column(high.x) + 1] as usize;
                for &edge in &self.items[first..end] {
                    let (c, d) = self.edges[edge as usize];
                    let apart = c.max(d).cmplt(low).any() || c.min(d).cmpgt(high).any();
                    if !apart && !beside(p, q, c, d, reach) {
                        visit(stretch, edge, (c, d));
                    }
                }
            }
        }
    }

    /// Whether a line lies inside the border all along and nowhere comes within `reach` of it. It
    /// may, where this says it does not.
    pub(crate) fn is_deep_inside(&self, line: &[Point2], reach: f64) -> bool {
        let deep = |p: Point2| {
            let cell = self.row(p.y) * self.columns + self.column(p.x);
            self.quiet.get(cell) == Some(&Quiet::Inside)
        };
        // A quiet cell is a cell's side away from any edge: no point of so short a step between
        // two of them comes nearer than half of that.
        let between = |w: &[Point2]| {
            let squared = w[0].distance_squared(w[1]);
            if squared <= self.cell * self.cell {
                return true;
            }
            let steps = (squared.sqrt() * self.per_mm).ceil().min(MOST_STRETCHES);
            steps < MOST_STRETCHES
                && (1..steps as u32).all(|i| deep(w[0].lerp(w[1], f64::from(i) / steps)))
        };
        let points_deep = || line.iter().all(|&p| deep(p));
        2.0 * reach < self.cell && points_deep() && line.windows(2).all(between)
    }

    /// Marks the cells that have no edge in them or in any of the eight around.
    fn mark_quiet(&mut self) {
        let busy = |cell: usize| self.starts[cell] < self.starts[cell + 1];
        let mut quiet = vec![Quiet::Outside; self.rows * self.columns];
        for row in 0..self.rows {
            for column in 0..self.columns {
                if !busy(row * self.columns + column) {
                    continue;
                }
                for y in row.saturating_sub(1)..=(row + 1).min(self.rows - 1) {
                    let cells = y * self.columns;
                    let right = (column + 1).min(self.columns - 1);
                    quiet[cells + column.saturating_sub(1)..=cells + right].fill(Quiet::No);
                }
            }
        }
        for (row, cells) in quiet.chunks_mut(self.columns).enumerate() {
            let mut columns = 0..self.columns;
            while let Some(first) = columns.find(|&column| cells[column] != Quiet::No) {
                let run = cells[first..].iter().take_while(|cell| **cell != Quiet::No).count();
                let middle = Point2::new(first as f64 + 0.5, row as f64 + 0.5);
                if self.contains(self.origin + middle * self.cell) {
                    cells[first..first + run].fill(Quiet::Inside);
                }
                columns.start = first + run;
            }
        }
        self.quiet = quiet;
    }

    /// As far as [`along`](Self::along) is to be asked.
    pub(crate) fn for_along(edges: Vec<(Point2, Point2)>, cell: f64) -> Self {
        let mut grid = Self::with_cells(edges, cell, CELLS_AN_EDGE_ALONG);
        grid.mark_quiet();
        grid
    }
}

/// Where the segment from `a` to `b` crosses an edge, as a share of it; ends count as
/// [`EdgeGrid::crossings`] says.
pub(crate) fn crossing(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<f64> {
    let (u, v) = (b - a, d - c);
    let apart = (u.perp_dot(c - a) > 0.0) != (u.perp_dot(d - a) > 0.0);
    let (from, to) = (v.perp_dot(a - c), v.perp_dot(b - c));
    (apart && (from > 0.0) != (to > 0.0)).then(|| (from / (from - to)).clamp(0.0, 1.0))
}

/// Whether the segment from `p` to `q` lies farther than `reach` to one side of an edge's line.
fn beside(p: Point2, q: Point2, c: Point2, d: Point2, reach: f64) -> bool {
    let edge = d - c;
    let (one, other) = (edge.perp_dot(p - c), edge.perp_dot(q - c));
    let least = reach * reach * edge.length_squared();
    one * other > 0.0 && one * one > least && other * other > least
}
