use super::strands::Strands;
use fgm_core::Point2;

/// No strand.
pub(crate) const NONE: u32 = u32::MAX;

/// Crossings nearer to a sample than this share of an edge are put there.
const LEAST: f64 = 1e-9;

/// Where a line crosses an edge of the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) at: Point2,
    pub(crate) strand: u32,
    /// Whether values rise from left to right or upwards.
    pub(crate) rises: bool,
}

/// All crossings. Those of one edge stand together, in the order of the edge from left to right
/// or upwards.
#[derive(Debug, Default)]
pub(crate) struct Nodes {
    pub(crate) list: Vec<Node>,
    pub(crate) strands: Strands,
}

/// The crossings of one edge: the id of the first, and the classes at its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossed {
    pub(crate) first: u32,
    pub(crate) classes: [u16; 2],
}

impl Crossed {
    /// The crossing of a level that lies between the classes.
    pub(crate) fn id(self, level: u16) -> u32 {
        let [from, to] = self.classes;
        self.first + u32::from(if from < to { level - from } else { from - 1 - level })
    }
}

impl Nodes {
    pub(crate) fn clear(&mut self) {
        self.list.clear();
        self.strands.clear();
    }

    /// Adds the crossings of an edge that begins at `from` and goes on by `step`, by linear
    /// interpolation; answers the first's id.
    pub(crate) fn add(
        &mut self,
        (from, step): (Point2, Point2),
        values: [f64; 2],
        classes: [u16; 2],
        levels: &[f64],
    ) -> u32 {
        let first = self.list.len() as u32;
        let rise = values[1] - values[0];
        let rises = classes[0] < classes[1];
        let mut push = |level: u16| {
            let t = (levels[usize::from(level)] - values[0]) / rise;
            let t = if t.is_nan() { 0.5 } else { t.clamp(LEAST, 1.0 - LEAST) };
            self.list.push(Node { at: from + step * t, strand: NONE, rises });
        };
        if classes[0].abs_diff(classes[1]) == 1 {
            push(classes[0].min(classes[1]));
        } else if rises {
            (classes[0]..classes[1]).for_each(&mut push);
        } else {
            (classes[1]..classes[0]).rev().for_each(&mut push);
        }
        first
    }

    /// Begins strands at the crossings of a level edge that have none: there is no cell below.
    pub(crate) fn enter(&mut self, crossed: Crossed) {
        let [a, b] = crossed.classes;
        for level in a.min(b)..a.max(b) {
            let id = crossed.id(level);
            let node = &mut self.list[id as usize];
            if node.strand == NONE {
                node.strand = self.strands.begin_at_border(id, node.rises, level);
            }
        }
    }

    /// Adds the segment from one crossing to another.
    pub(crate) fn link(&mut self, from: u32, to: u32, level: u16) {
        let (before, after) = (self.list[from as usize].strand, self.list[to as usize].strand);
        if (before == NONE) != (after == NONE) {
            // The one that there is, told without a branch.
            let strand = self.strands.grow(before & after);
            self.list[from as usize].strand = strand;
            self.list[to as usize].strand = strand;
        } else if before == NONE {
            let [ahead, back] = self.strands.begin(from, to, level);
            self.list[to as usize].strand = ahead;
            self.list[from as usize].strand = back;
        } else {
            self.strands.meet(before, after);
        }
    }
}
