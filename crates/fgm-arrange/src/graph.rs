use crate::memory;
use crate::noder::{Arc, Noder};
use crate::predicate::by_angle;
use fgm_core::Point2;
use std::cmp::Ordering;

/// None.
const NONE: u32 = u32::MAX;

/// The arcs of a noder as a graph: half-arcs around their nodes in order of angle, repeated arcs
/// merged, bridges found. Half-arc `2 a` leaves the first end of arc `a`, `2 a + 1` its last.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    /// Where each node's half-arcs begin in `around`; their number is in `degree`.
    starts: Vec<u32>,
    degree: Vec<u32>,
    around: Vec<u32>,
    /// For each arc the one that stands for it.
    representative: Vec<u32>,
    /// `representative << 32 | rank << 1 | forward`, in order.
    label_keys: Vec<u64>,
    label_starts: Vec<u32>,
    pub(crate) bridge: Vec<bool>,
    /// For each half-arc the one that follows along the face to its left.
    next: Vec<u32>,
    /// For each half-arc its face's cycle.
    cycle: Vec<u32>,
    /// The half-arcs of a node and the directions in which they leave it.
    rays: Vec<(Point2, u32)>,
}

/// The direction in which a half-arc leaves its node.
fn direction(points: &[Point2], arcs: &[Arc], half: u32) -> Point2 {
    let arc = &arcs[half as usize / 2];
    let (at, next) =
        if half & 1 == 0 { (arc.first, arc.first + 1) } else { (arc.last, arc.last - 1) };
    points[next as usize] - points[at as usize]
}

/// The node that a half-arc leaves.
pub(crate) fn origin(arcs: &[Arc], half: u32) -> u32 {
    arcs[half as usize / 2].ends[half as usize & 1]
}

impl Graph {
    /// Replaces the content by the noder's arcs. `ranks` has a label's rank for each chain.
    pub(crate) fn build(&mut self, noder: &Noder, ranks: &[u32], keep_bridges: bool) {
        let merged = self.sort_around(noder);
        self.collect_labels(&noder.arcs, ranks, merged);
        self.find_bridges(&noder.arcs);
        if !keep_bridges {
            self.drop_bridges();
        }
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.starts);
        memory::rest(&mut self.degree);
        memory::rest(&mut self.around);
        memory::rest(&mut self.representative);
        memory::rest(&mut self.label_keys);
        memory::rest(&mut self.label_starts);
        memory::rest(&mut self.bridge);
    }

    /// A node's half-arcs, anticlockwise from +x.
    pub(crate) fn around(&self, node: usize) -> &[u32] {
        let start = self.starts[node] as usize;
        &self.around[start..start + self.degree[node] as usize]
    }

    /// The labels of an arc that stands for itself: `rank << 1 | forward`, in order.
    pub(crate) fn labels(&self, arc: u32) -> impl ExactSizeIterator<Item = u32> + Clone {
        let range = self.label_starts[arc as usize]..self.label_starts[arc as usize + 1];
        self.label_keys[range.start as usize..range.end as usize].iter().map(|&key| key as u32)
    }

    /// Sorts the half-arcs around their nodes; whether any were repetitions of others.
    fn sort_around(&mut self, noder: &Noder) -> bool {
        let (nodes, arcs) = (noder.nodes().len(), &noder.arcs[..]);
        self.degree.clear();
        self.degree.resize(nodes, 0);
        for node in arcs.iter().flat_map(|arc| arc.ends) {
            self.degree[node as usize] += 1;
        }
        self.starts.clear();
        let mut sum = 0;
        self.starts.extend(self.degree.iter().map(|&degree| {
            sum += degree;
            sum - degree
        }));
        self.around.clear();
        self.around.resize(2 * arcs.len(), 0);
        self.degree.fill(0);
        for half in 0..2 * arcs.len() as u32 {
            let node = origin(arcs, half) as usize;
            self.around[(self.starts[node] + self.degree[node]) as usize] = half;
            self.degree[node] += 1;
        }
        self.representative.clear();
        self.representative.extend(0..arcs.len() as u32);
        let mut merged = false;
        for node in 0..nodes {
            merged |= self.sort_node(noder, node);
        }
        merged
    }

    /// Puts a node's half-arcs in order. Straight ones in one direction to one other node are one;
    /// the first stands for all. Whether there were any such.
    fn sort_node(&mut self, noder: &Noder, node: usize) -> bool {
        let (start, arcs) = (self.starts[node] as usize, &noder.arcs[..]);
        let around = &mut self.around[start..start + self.degree[node] as usize];
        self.rays.clear();
        self.rays.extend(around.iter().map(|&half| (direction(&noder.points, arcs, half), half)));
        self.rays.sort_unstable_by(|a, b| by_angle(a.0, b.0).then(a.1.cmp(&b.1)));
        let (mut kept, mut merged) = (0, false);
        let mut before: Option<(Point2, u32)> = None;
        for &(direction, half) in &self.rays {
            let same = |before: &(Point2, u32)| {
                by_angle(before.0, direction) == Ordering::Equal && same_ends(arcs, before.1, half)
            };
            if let Some((_, first)) = before.filter(same) {
                self.representative[half as usize / 2] = first / 2;
                merged = true;
            } else {
                before = Some((direction, half));
                around[kept] = half;
                kept += 1;
            }
        }
        self.degree[node] = kept as u32;
        merged
    }

    /// Collects the labels of each arc and of those that it stands for.
    fn collect_labels(&mut self, arcs: &[Arc], ranks: &[u32], merged: bool) {
        self.label_keys.clear();
        self.label_keys.extend(arcs.iter().zip(&self.representative).map(|(arc, &to)| {
            let forward = arc.ends[0] == arcs[to as usize].ends[0];
            u64::from(to) << 32 | u64::from(ranks[arc.chain as usize] << 1 | u32::from(forward))
        }));
        if merged {
            self.label_keys.sort_unstable();
            self.label_keys.dedup();
        }
        self.label_starts.clear();
        let mut at = 0;
        for arc in 0..=arcs.len() as u64 {
            while self.label_keys.get(at).is_some_and(|key| key >> 32 < arc) {
                at += 1;
            }
            self.label_starts.push(at as u32);
        }
    }

    /// Edges on no cycle: dangling ones, and those that join two cycles. In the plane they are the
    /// ones with the same face on both sides.
    fn find_bridges(&mut self, arcs: &[Arc]) {
        self.next.clear();
        self.next.resize(2 * arcs.len(), NONE);
        for (&start, &degree) in self.starts.iter().zip(&self.degree) {
            let around = &self.around[start as usize..(start + degree) as usize];
            let mut before = around.last().copied().unwrap_or(NONE);
            for &half in around {
                self.next[half as usize ^ 1] = before;
                before = half;
            }
        }
        self.cycle.clear();
        self.cycle.resize(2 * arcs.len(), NONE);
        for first in 0..2 * arcs.len() as u32 {
            let mut at = first;
            // What another arc stands for has no next.
            while self.next[at as usize] != NONE && self.cycle[at as usize] == NONE {
                self.cycle[at as usize] = first;
                at = self.next[at as usize];
            }
        }
        self.bridge.clear();
        let sides = self.cycle.chunks_exact(2);
        self.bridge.extend(sides.map(|sides| sides[0] != NONE && sides[0] == sides[1]));
        memory::rest(&mut self.next);
        memory::rest(&mut self.cycle);
    }

    fn drop_bridges(&mut self) {
        for node in 0..self.degree.len() {
            let start = self.starts[node] as usize;
            let end = start + self.degree[node] as usize;
            let mut kept = start;
            for at in start..end {
                let half = self.around[at];
                if !self.bridge[half as usize / 2] {
                    self.around[kept] = half;
                    kept += 1;
                }
            }
            self.degree[node] = (kept - start) as u32;
        }
    }

    /// The half-arc that goes on where `half` ends, when nothing else happens there: two arcs meet
    /// that have the same labels, in the same directions.
    pub(crate) fn straight_on(&self, arcs: &[Arc], half: u32) -> Option<u32> {
        let [a, b] = *self.around(origin(arcs, half ^ 1) as usize) else { return None };
        let onward = if a == half ^ 1 { b } else { a };
        if onward == half {
            return None;
        }
        let (mine, next) = (self.labels(half / 2), self.labels(onward / 2));
        let flip = (half ^ onward) & 1;
        let same = mine.len() == next.len()
            && mine.clone().all(|label| next.clone().any(|other| other == label ^ flip));
        same.then_some(onward)
    }
}

/// Whether two half-arcs that leave one node in one direction are the same line: straight, to one
/// other node.
fn same_ends(arcs: &[Arc], a: u32, b: u32) -> bool {
    arcs[a as usize / 2].is_straight()
        && arcs[b as usize / 2].is_straight()
        && origin(arcs, a ^ 1) == origin(arcs, b ^ 1)
}
