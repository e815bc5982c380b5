use crate::cases::{is_saddle, links, saddle_is_above};
use crate::graph::{Graph, Node};

/// The class of a sample that is not a number.
pub(crate) const NAN_CLASS: u16 = u16::MAX;

/// How many of the levels, which are in order, a value is at or above.
pub(crate) fn class_of(value: f64, levels: &[f64]) -> u16 {
    if value.is_nan() {
        return NAN_CLASS;
    }
    match levels {
        [level] => u16::from(value >= *level),
        _ => levels.partition_point(|&l| l <= value) as u16,
    }
}

/// The class of a value that is probably at most two classes off another, which is then found
/// without a branch.
pub(crate) fn class_near(class: u16, value: f64, levels: &[f64]) -> u16 {
    let k = usize::from(class);
    let below = |k: usize| u16::from(value < levels.get(k).copied().unwrap_or(f64::NEG_INFINITY));
    let above = |k: usize| u16::from(value >= levels.get(k).copied().unwrap_or(f64::INFINITY));
    let fall = below(k.wrapping_sub(1)) + below(k.wrapping_sub(2));
    let class = (class + above(k) + above(k + 1) - fall).min(levels.len() as u16);
    let (lower, upper) = range_of(class, levels);
    if value >= lower && value < upper { class } else { class_of(value, levels) }
}

/// The values of a class: from the first, below the second.
pub(crate) fn range_of(class: u16, levels: &[f64]) -> (f64, f64) {
    let class = usize::from(class);
    let lower = if class == 0 { f64::NEG_INFINITY } else { levels[class - 1] };
    (lower, levels.get(class).copied().unwrap_or(f64::INFINITY))
}

/// A run of cells in one row: the samples below and above it, one more than cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellRow<'a> {
    /// The row, and the first cell in it.
    pub(crate) j: u32,
    pub(crate) i: u32,
    pub(crate) lower: &'a [f64],
    pub(crate) upper: &'a [f64],
    pub(crate) lower_class: &'a [u16],
    pub(crate) upper_class: &'a [u16],
}

/// Crossings on one edge of a cell: the id of the first, which is of level `base`.
#[derive(Clone, Copy, Debug, Default)]
struct Crossings {
    first: u32,
    base: u16,
}

impl Crossings {
    fn id(self, level: u16) -> u32 {
        self.first + u32::from(level - self.base)
    }
}

/// Marching squares, row by row, at all levels in one visit to each cell.
///
/// The crossings on the row's lower edges are those that the row below made on its upper ones.
#[derive(Debug, Default)]
pub(crate) struct Marcher {
    /// By column: the first crossing on the lower edge, and the row for which that holds.
    lower: Vec<(u32, u32)>,
}

impl Marcher {
    pub(crate) fn reset(&mut self, columns: u32) {
        self.lower.clear();
        self.lower.resize(columns as usize, (u32::MAX, 0));
    }

    /// Adds the crossings and segments of a run of cells.
    pub(crate) fn run(&mut self, row: &CellRow<'_>, levels: &[f64], graph: &mut Graph) {
        let mut left: Option<u32> = None;
        let pairs = row.lower_class.windows(2).zip(row.upper_class.windows(2)).enumerate();
        for (c, (low, high)) in pairs {
            let classes = [low[0], low[1], high[1], high[0]];
            let [c0, c1, c2, c3] = classes;
            let uniform = (c0 ^ c1) | (c0 ^ c2) | (c0 ^ c3) == 0;
            left = if uniform || classes.contains(&NAN_CLASS) {
                None
            } else {
                self.cell(row, c, classes, left, levels, graph)
            };
        }
    }

    /// Adds one cell; answers the first crossing on its right edge.
    fn cell(
        &mut self,
        row: &CellRow<'_>,
        c: usize,
        classes: [u16; 4],
        left: Option<u32>,
        levels: &[f64],
        graph: &mut Graph,
    ) -> Option<u32> {
        let (i, j) = (row.i + c as u32, row.j);
        let values = [row.lower[c], row.lower[c + 1], row.upper[c + 1], row.upper[c]];
        let [c0, c1, c2, c3] = classes;
        let mut edges = [Crossings::default(); 4];
        let mut add = |i: u32, j: u32, vertical: bool, a: usize, b: usize| {
            let node = Node { i, j, level: 0, vertical, values: [values[a], values[b]] };
            graph.add_edge(node, classes[a].min(classes[b]), classes[a].max(classes[b]))
        };
        if c0 != c1 {
            let (known_row, id) = self.lower[i as usize];
            let first = if known_row == j { id } else { add(i, j, false, 0, 1) };
            edges[0] = Crossings { first, base: c0.min(c1) };
        }
        if c0 != c3 {
            let first = left.unwrap_or_else(|| add(i, j, true, 0, 3));
            edges[3] = Crossings { first, base: c0.min(c3) };
        }
        let mut right = None;
        if c1 != c2 {
            let first = add(i + 1, j, true, 1, 2);
            edges[1] = Crossings { first, base: c1.min(c2) };
            right = Some(first);
        }
        if c3 != c2 {
            let first = add(i, j + 1, false, 3, 2);
            edges[2] = Crossings { first, base: c3.min(c2) };
            self.lower[i as usize] = (j + 1, first);
        }
        let (least, greatest) = (c0.min(c1).min(c2.min(c3)), c0.max(c1).max(c2.max(c3)));
        for level in least..greatest {
            let bit = |corner: usize| u8::from(classes[corner] > level) << corner;
            let case = bit(0) | bit(1) | bit(2) | bit(3);
            let saddle = is_saddle(case);
            let above = saddle && saddle_is_above(values, levels[usize::from(level)]);
            for &(from, to) in links(case, above) {
                let [a, b] = [from, to].map(|e| edges[usize::from(e)].id(level));
                graph.link(a, b, saddle || greatest - least > 1);
            }
        }
        right
    }
}
