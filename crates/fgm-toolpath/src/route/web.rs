//! Lines that can be cut and joined anywhere.

use fgm_core::{Point2, Role};

use super::{MEETS, strand::Strand};
use crate::{Path, inset::near::NearBorder};

/// No side.
pub(super) const NONE: u32 = u32::MAX;
/// The bead of a travel.
pub(super) const TRAVEL: u32 = u32::MAX;

/// The lines as a graph without directions: every vertex has two sides, and each side leads to a
/// side of another vertex, or nowhere. Cutting and joining take constant time.
///
/// Side `2 v` and `2 v + 1` are those of vertex `v`.
pub(super) struct Web {
    pub(super) spacing: f64,
    pub(super) at: Vec<Point2>,
    /// The side that a side leads to.
    pub(super) twin: Vec<u32>,
    /// The path whose bead lies between a side and its twin, or [`TRAVEL`].
    pub(super) bead: Vec<u32>,
    /// The strand that each vertex comes from.
    pub(super) strand: Vec<u32>,
    pub(super) strands: Vec<Part>,
    /// The edges as they were at first, each by the side it begins at.
    border: NearBorder,
    sides: Vec<u32>,
}

/// What a strand has become.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Its vertices.
    pub(super) first: u32,
    pub(super) end: u32,
    pub(super) closed: bool,
    /// Its length at first, mm.
    pub(super) length: f64,
    /// Another strand of the same line; itself where it stands for the whole line.
    same: u32,
}

/// A place on an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The side from which the edge leads.
    pub(super) side: u32,
    pub(super) at: Point2,
}

impl Web {
    pub(super) fn new(strands: &[Strand], spacing: f64) -> Self {
        let count = strands.iter().map(|s| s.points.len()).sum();
        let mut at = Vec::with_capacity(count);
        let mut twin = vec![NONE; 2 * count];
        let mut bead = vec![TRAVEL; 2 * count];
        let mut strand = Vec::with_capacity(count);
        let mut parts = Vec::with_capacity(strands.len());
        let (mut edges, mut sides) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for (line, number) in strands.iter().zip(0..) {
            let (first, n) = (at.len() as u32, line.points.len() as u32);
            at.extend_from_slice(&line.points);
            strand.resize(at.len(), number);
            for (i, &path) in (0..).zip(&line.beads) {
                let (from, to) = (2 * (first + i) + 1, 2 * (first + (i + 1) % n));
                (twin[from as usize], twin[to as usize]) = (to, from);
                (bead[from as usize], bead[to as usize]) = (path, path);
                edges.push((at[from as usize / 2], at[to as usize / 2]));
                sides.push(from);
            }
            let (closed, length) = (line.closed, line.length());
            parts.push(Part { first, end: first + n, closed, length, same: number });
        }
        let border = NearBorder::of_edges(&edges, spacing);
        Self { spacing, at, twin, bead, strand, strands: parts, border, sides }
    }

    /// The strand that stands for the line of strand `s`.
    pub(super) fn line(&self, mut s: u32) -> u32 {
        loop {
            let same = self.strands[s as usize].same;
            if same == s {
                return s;
            }
            s = same;
        }
    }

    /// Makes the line of strand `t` part of the line of strand `s`, in the books.
    pub(super) fn unite(&mut self, s: u32, t: u32) {
        let (line, other) = (self.line(s), self.line(t));
        if line != other {
            self.strands[line as usize].length += self.strands[other as usize].length;
            self.strands[other as usize].same = line;
        }
        for strand in [s, t] {
            self.strands[strand as usize].same = line;
        }
    }

    pub(super) fn next(&self, side: u32) -> u32 {
        self.twin[side as usize]
    }

    pub(super) fn point(&self, side: u32) -> Point2 {
        self.at[side as usize / 2]
    }

    /// Joins two free sides.
    pub(super) fn join(&mut self, a: u32, b: u32, bead: u32) {
        (self.twin[a as usize], self.twin[b as usize]) = (b, a);
        (self.bead[a as usize], self.bead[b as usize]) = (bead, bead);
    }

    /// A vertex with two free sides; the first of them.
    pub(super) fn add(&mut self, at: Point2, strand: u32) -> u32 {
        self.at.push(at);
        self.strand.push(strand);
        self.twin.extend([NONE; 2]);
        self.bead.extend([TRAVEL; 2]);
        2 * (self.at.len() as u32 - 1)
    }

    /// A vertex on the edge at a place; its first side is towards the vertex the edge leads from.
    pub(super) fn split(&mut self, place: Place) -> u32 {
        let (from, to) = (place.side, self.next(place.side));
        let bead = self.bead[from as usize];
        let new = self.add(place.at, self.strand[from as usize / 2]);
        self.join(from, new, bead);
        self.join(new + 1, to, bead);
        new
    }

    /// Every edge of strands taken by `accept` that comes within `reach` of a point, at its nearest
    /// place there, with the distance; some twice.
    pub(super) fn near(
        &self,
        p: Point2,
        reach: f64,
        accept: impl Fn(u32) -> bool,
        mut visit: impl FnMut(Place, f64),
    ) {
        let mut look = |side: u32| {
            let next = self.next(side);
            if next == NONE || self.bead[side as usize] == TRAVEL {
                return;
            }
            let (a, b) = (self.point(side), self.point(next));
            let (v, to) = (b - a, p - a);
            let share = (to.dot(v) / v.length_squared().max(1e-300)).clamp(0.0, 1.0);
            let squared = (to - v * share).length_squared();
            if squared <= reach * reach {
                visit(Place { side, at: a + v * share }, squared.sqrt());
            }
        };
        self.border.around(p, reach, |edge| {
            // What is left of the edge hangs on the two vertices it had.
            let from = self.sides[edge as usize];
            let vertex = from / 2;
            let strand = self.strand[vertex as usize];
            if accept(strand) {
                let part = self.strands[strand as usize];
                let to = 2 * if vertex + 1 < part.end { vertex + 1 } else { part.first };
                look(from);
                if self.next(from) != to {
                    look(to);
                }
            }
        });
    }

    /// The lines in a row, from the longest on, cut where a travel is or the bead changes.
    pub(super) fn round(&self, paths: &[Path]) -> Vec<Path> {
        let mut starts: Vec<u32> = (0..self.strands.len() as u32)
            .filter(|&s| self.strands[s as usize].same == s)
            .collect();
        starts.sort_by(|&a, &b| {
            let length = |s: u32| self.strands[s as usize].length;
            length(b).total_cmp(&length(a)).then(a.cmp(&b))
        });
        let mut done = vec![false; self.at.len()];
        let mut out = Vec::with_capacity(paths.len());
        for start in starts {
            // Strands' vertices may be cut away; some are left of each line.
            let part = self.strands[start as usize];
            let alive = |v: &u32| [2 * v, 2 * v + 1].iter().any(|&s| self.next(s) != NONE);
            if let Some(vertex) = (part.first..part.end).find(alive) {
                self.walk(self.begin(vertex), paths, &mut done, &mut out);
            }
        }
        out
    }

    /// The side at which to set out on the line of a vertex: after a travel or a change of bead.
    fn begin(&self, vertex: u32) -> u32 {
        let mut best = None;
        let mut side = 2 * vertex + 1;
        loop {
            let next = self.next(side);
            if next == NONE {
                // An open line, from its end.
                return side;
            }
            let (before, onward) = (self.bead[next as usize], next ^ 1);
            let after = self.bead[onward as usize];
            let change = before == TRAVEL || best.is_none() && before != after;
            if change && after != TRAVEL {
                best = Some(onward);
            }
            side = onward;
            if side == 2 * vertex + 1 {
                return best.unwrap_or(side);
            }
        }
    }

    /// Appends the line that leaves from a side.
    fn walk(&self, start: u32, paths: &[Path], done: &mut [bool], out: &mut Vec<Path>) {
        // An open line's end is a free side: its other side leads along it.
        let start = if self.next(start) == NONE { start ^ 1 } else { start };
        let kind = |bead: u32| paths.get(bead as usize).map(|p| (p.role, p.width));
        let mut side = start;
        let mut current: Option<((Role, f64), Path)> = None;
        loop {
            let next = self.next(side);
            if next == NONE || done[side as usize / 2] {
                break;
            }
            done[side as usize / 2] = true;
            let bead = self.bead[side as usize];
            let (from, to) = (self.point(side), self.point(next));
            side = next ^ 1;
            if from.distance(to) <= MEETS && current.is_some() {
                continue;
            }
            match (&mut current, kind(bead)) {
                (Some((now, path)), Some(kind)) if *now == kind => path.points.push(to),
                (_, kind) => {
                    out.extend(current.take().map(|(_, path)| path));
                    current = kind.map(|kind| {
                        let Path { role, width, turn, .. } = paths[bead as usize];
                        let points = vec![from, to];
                        let turns = Vec::new();
                        (kind, Path { points, closed: false, role, width, turn, turns })
                    });
                }
            }
        }
        out.extend(current.map(|(_, path)| path).map(closed));
    }
}

/// A path that ends where it begins, closed.
fn closed(mut path: Path) -> Path {
    if let [first, _, .., last] = path.points[..]
        && path.points.len() > 3
        && first.distance(last) <= MEETS
    {
        path.points.pop();
        path.closed = true;
    }
    path
}
