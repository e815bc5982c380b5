use crate::lattice::Lattice;
use crate::{ContourError, MAX_CROSSINGS};
use fgm_core::Point2;

/// No crossing.
pub(crate) const NONE: u32 = u32::MAX;

const ENTERED: u8 = 1;
const SHARED: u8 = 2;
const VISITED: u8 = 4;

/// Where a contour crosses the lattice edge from sample (i, j) to its right or upper neighbour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) i: u32,
    pub(crate) j: u32,
    pub(crate) level: u16,
    pub(crate) vertical: bool,
    /// The field at sample (i, j) and at the neighbour.
    pub(crate) values: [f64; 2],
}

impl Node {
    /// The ends of the lattice edge.
    pub(crate) fn ends(&self, lattice: &Lattice) -> (Point2, Point2) {
        let (di, dj) = if self.vertical { (0, 1) } else { (1, 0) };
        (lattice.at(self.i, self.j), lattice.at(self.i + di, self.j + dj))
    }

    /// Whether the edge has no length: it leads out of a closed window.
    pub(crate) fn is_pad(&self, lattice: &Lattice) -> bool {
        let (di, dj) = if self.vertical { (0, 1) } else { (1, 0) };
        lattice.x.is_pad(self.i)
            || lattice.y.is_pad(self.j)
            || lattice.x.is_pad(self.i + di)
            || lattice.y.is_pad(self.j + dj)
    }

    fn same_edge(&self, other: &Self) -> bool {
        self.i == other.i && self.j == other.j && self.vertical == other.vertical
    }
}

/// The crossings and the segments between them.
///
/// A crossing lies on one lattice edge and so ends at most one segment and starts at most one:
/// the identity of the edge stitches the lines, and walking them is following `next`.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<Node>,
    next: Vec<u32>,
    flags: Vec<u8>,
}

impl Graph {
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.next.clear();
        self.flags.clear();
    }

    /// Adds the crossings of levels `from..to` with one lattice edge; answers the first's id.
    pub(crate) fn add_edge(&mut self, node: Node, from: u16, to: u16) -> u32 {
        let first = self.nodes.len() as u32;
        for level in from..to {
            self.nodes.push(Node { level, ..node });
            self.next.push(NONE);
            self.flags.push(0);
        }
        first
    }

    /// Fails when ids are about to run out; asked once a row of cells.
    pub(crate) fn check(&self) -> Result<(), ContourError> {
        if self.nodes.len() > MAX_CROSSINGS {
            return Err(ContourError::TooManyCrossings { limit: MAX_CROSSINGS });
        }
        Ok(())
    }

    /// Adds the segment from one crossing to another; `shared` where its cell holds more of them.
    pub(crate) fn link(&mut self, from: u32, to: u32, shared: bool) {
        self.next[from as usize] = to;
        if shared {
            self.flags[from as usize] |= SHARED;
        }
        self.flags[to as usize] |= ENTERED;
    }

    /// Whether the segment that starts at `node` shares its cell with another.
    pub(crate) fn is_shared(&self, node: u32) -> bool {
        self.flags[node as usize] & SHARED != 0
    }

    /// The runs of nodes, first and end, that lie on one edge at several levels.
    pub(crate) fn crowded_edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut at = 0;
        std::iter::from_fn(move || {
            while at < self.nodes.len() {
                let first = at;
                let edge = self.nodes[first];
                at += self.nodes[first..].iter().take_while(|n| n.same_edge(&edge)).count();
                if at - first > 1 {
                    return Some((first, at));
                }
            }
            None
        })
    }

    /// Walks every line: the open ones first, each group in the order of the sweep.
    pub(crate) fn chains(&mut self, positions: &[Point2], apart: f64, out: &mut Chains) {
        out.clear();
        for closed in [false, true] {
            for start in 0..self.nodes.len() as u32 {
                let flags = self.flags[start as usize];
                if flags & VISITED == 0 && (closed || flags & ENTERED == 0) {
                    self.walk(start, closed, out);
                    out.finish(self.nodes[start as usize].level, closed, positions, apart);
                }
            }
        }
    }

    fn walk(&mut self, start: u32, closed: bool, out: &mut Chains) {
        let mut at = start;
        loop {
            out.nodes.push(at);
            self.flags[at as usize] |= VISITED;
            at = self.next[at as usize];
            if at == NONE || (closed && at == start) {
                return;
            }
        }
    }
}

/// One line through crossings: a range of [`Chains::nodes`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    pub(crate) level: u16,
    pub(crate) closed: bool,
    pub(crate) from: usize,
    pub(crate) to: usize,
}

/// Lines through crossings, no two neighbours in the same place.
#[derive(Debug, Default)]
pub(crate) struct Chains {
    pub(crate) nodes: Vec<u32>,
    pub(crate) list: Vec<Chain>,
}

impl Chains {
    fn clear(&mut self) {
        self.nodes.clear();
        self.list.clear();
    }

    /// Ends a line whose nodes were pushed: merges neighbours less than `apart` from each other,
    /// keeps the ends of an open line, and drops what has no extent.
    fn finish(&mut self, level: u16, closed: bool, positions: &[Point2], apart: f64) {
        let from = self.list.last().map_or(0, |c| c.to);
        let at = |n: u32| positions[n as usize];
        let near = |a: u32, b: u32| at(a).distance_squared(at(b)) < apart * apart;
        let last = self.nodes[self.nodes.len() - 1];
        let mut to = from + 1;
        for k in from + 1..self.nodes.len() {
            let node = self.nodes[k];
            if !near(self.nodes[to - 1], node) {
                self.nodes[to] = node;
                to += 1;
            }
        }
        if closed {
            while to > from + 1 && near(self.nodes[from], self.nodes[to - 1]) {
                to -= 1;
            }
        } else if to > from + 1 {
            // The end stays where the window's edge is; its neighbour goes instead.
            self.nodes[to - 1] = last;
        }
        let keep = to - from >= if closed { 3 } else { 2 };
        self.nodes.truncate(if keep { to } else { from });
        if keep {
            self.list.push(Chain { level, closed, from, to });
        }
    }
}
