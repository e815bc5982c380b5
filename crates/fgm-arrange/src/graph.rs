use crate::noder::{Arc, Noder};
use crate::predicate::by_angle;
use fgm_core::Point2;
use std::cmp::Ordering;

/// Not visited, or none.
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
    visit: Vec<u32>,
    low: Vec<u32>,
    stack: Vec<Frame>,
}

/// A node on the way of the depth-first search.
#[derive(Clone, Copy, Debug)]
struct Frame {
    node: u32,
    /// The arc by which it was reached.
    by: u32,
    /// How many of its half-arcs are done.
    done: u32,
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
        self.sort_around(noder);
        self.merge(noder, ranks);
        self.find_bridges(noder);
        if !keep_bridges {
            self.drop_bridges();
        }
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

    fn sort_around(&mut self, noder: &Noder) {
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
        for node in 0..nodes {
            let start = self.starts[node] as usize;
            self.around[start..start + self.degree[node] as usize].sort_unstable_by(|&a, &b| {
                by_angle(direction(&noder.points, arcs, a), direction(&noder.points, arcs, b))
            });
        }
    }

    /// Straight arcs in one direction from a node to one other are one; the first stands for all.
    fn merge(&mut self, noder: &Noder, ranks: &[u32]) {
        let arcs = &noder.arcs[..];
        self.representative.clear();
        self.representative.extend(0..arcs.len() as u32);
        let mut merged = false;
        for node in 0..self.degree.len() {
            let start = self.starts[node] as usize;
            let end = start + self.degree[node] as usize;
            let (mut kept, mut at) = (start, start);
            while at < end {
                let first = self.around[at];
                let mut stop = at + 1;
                while stop < end && same_edge(noder, first, self.around[stop]) {
                    stop += 1;
                }
                let least = self.around[at..stop].iter().copied().min().unwrap_or(first);
                if stop > at + 1 {
                    merged = true;
                    for &half in &self.around[at..stop] {
                        self.representative[half as usize / 2] = least / 2;
                    }
                }
                self.around[kept] = least;
                kept += 1;
                at = stop;
            }
            self.degree[node] = (kept - start) as u32;
        }
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

    /// Edges on no cycle (Tarjan 1974): dangling ones, and those that join two cycles.
    fn find_bridges(&mut self, noder: &Noder) {
        let arcs = &noder.arcs[..];
        let nodes = self.degree.len();
        self.bridge.clear();
        self.bridge.resize(arcs.len(), false);
        self.visit.clear();
        self.visit.resize(nodes, NONE);
        self.low.clear();
        self.low.resize(nodes, NONE);
        let mut time = 0;
        for root in 0..nodes as u32 {
            if self.visit[root as usize] != NONE {
                continue;
            }
            self.stack.push(Frame { node: root, by: NONE, done: 0 });
            while let Some(frame) = self.stack.last_mut() {
                let node = frame.node as usize;
                if frame.done == 0 {
                    (self.visit[node], self.low[node]) = (time, time);
                    time += 1;
                }
                if frame.done < self.degree[node] {
                    let half = self.around[(self.starts[node] + frame.done) as usize];
                    frame.done += 1;
                    if half / 2 == frame.by {
                        continue;
                    }
                    let to = origin(arcs, half ^ 1);
                    if self.visit[to as usize] == NONE {
                        self.stack.push(Frame { node: to, by: half / 2, done: 0 });
                    } else {
                        self.low[node] = self.low[node].min(self.visit[to as usize]);
                    }
                    continue;
                }
                let Frame { by, .. } = *frame;
                self.stack.pop();
                if let Some(parent) = self.stack.last() {
                    let parent = parent.node as usize;
                    self.low[parent] = self.low[parent].min(self.low[node]);
                    self.bridge[by as usize] = self.low[node] > self.visit[parent];
                }
            }
        }
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

fn same_edge(noder: &Noder, a: u32, b: u32) -> bool {
    let arcs = &noder.arcs[..];
    arcs[a as usize / 2].is_straight()
        && arcs[b as usize / 2].is_straight()
        && origin(arcs, a ^ 1) == origin(arcs, b ^ 1)
        && by_angle(direction(&noder.points, arcs, a), direction(&noder.points, arcs, b))
            == Ordering::Equal
}
