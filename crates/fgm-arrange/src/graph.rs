use crate::memory;
use crate::noder::{Arc, Noder};
use crate::rays::Nodes;

/// None.
const NONE: u32 = u32::MAX;

/// In an arc's label: it is a list's name.
const LIST: u32 = 1 << 31;

/// The arcs of a noder as a graph: half-arcs around their nodes in order of angle, repeated arcs
/// merged, bridges dropped where asked. Half-arc `2 a` leaves the first end of arc `a`, `2 a + 1`
/// its last.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    /// Where each node's half-arcs begin in `around`; their number is in `degree`.
    starts: Vec<u32>,
    degree: Vec<u32>,
    around: Vec<u32>,
    /// Arcs that repeat another, and that other.
    repeated: Vec<(u32, u32)>,
    /// The labels of arcs that stand for several, list after list, as `rank << 1 | forward`.
    labels: Vec<u32>,
    /// Where each list begins in `labels`, and the end.
    lists: Vec<u32>,
    bridge: Vec<bool>,
    /// For each half-arc the one that follows along the face to its left.
    next: Vec<u32>,
    /// For each half-arc its face's cycle.
    cycle: Vec<u32>,
}

/// The node that a half-arc leaves.
pub(crate) fn origin(arcs: &[Arc], half: u32) -> u32 {
    arcs[half as usize / 2].ends[half as usize & 1]
}

impl Graph {
    /// Replaces the content by the noder's arcs, and their chains by labels. `ranks` has a label's
    /// rank for each chain.
    pub(crate) fn build(&mut self, noder: &mut Noder, ranks: &[u32], keep_bridges: bool) {
        self.sort_around(noder);
        self.collect_labels(&mut noder.arcs, ranks);
        if !keep_bridges {
            self.find_bridges(&noder.arcs);
            self.drop_bridges();
        }
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.starts);
        memory::rest(&mut self.degree);
        memory::rest(&mut self.around);
        memory::rest(&mut self.repeated);
        memory::rest(&mut self.labels);
        memory::rest(&mut self.lists);
        memory::rest(&mut self.bridge);
    }

    /// A node's half-arcs, anticlockwise from +x.
    pub(crate) fn around(&self, node: usize) -> &[u32] {
        let start = self.starts[node] as usize;
        &self.around[start..start + self.degree[node] as usize]
    }

    /// The labels of an arc that stands for itself: `rank << 1 | forward`, in order.
    #[inline]
    pub(crate) fn labels<'a>(&'a self, arc: &'a Arc) -> &'a [u32] {
        if arc.label & LIST == 0 {
            return std::slice::from_ref(&arc.label);
        }
        let list = (arc.label & !LIST) as usize;
        &self.labels[self.lists[list] as usize..self.lists[list + 1] as usize]
    }

    /// Sorts the half-arcs around their nodes, without repetitions.
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
        self.repeated = Nodes::new(noder, &self.starts).sort(&mut self.around, &mut self.degree);
    }

    /// Replaces the arcs' chains by labels, and makes lists for those that stand for several.
    fn collect_labels(&mut self, arcs: &mut [Arc], ranks: &[u32]) {
        for arc in &mut *arcs {
            arc.label = ranks[arc.label as usize] << 1 | 1;
        }
        self.labels.clear();
        self.lists.clear();
        // Arc and label in one, to be sorted; repetitions come from both ends of an arc.
        let mut keys: Vec<u64> = Vec::with_capacity(2 * self.repeated.len());
        for &(arc, first) in &self.repeated {
            let ([arc, own], to) = ([arc, first].map(|a| arcs[a as usize]), u64::from(first) << 32);
            let against = u32::from(arc.ends[0] != own.ends[0]);
            keys.extend([to | u64::from(own.label), to | u64::from(arc.label ^ against)]);
        }
        keys.sort_unstable();
        keys.dedup();
        for list in keys.chunk_by(|a, b| a >> 32 == b >> 32) {
            arcs[(list[0] >> 32) as usize].label = LIST | self.lists.len() as u32;
            self.lists.push(self.labels.len() as u32);
            self.labels.extend(list.iter().map(|&key| key as u32));
        }
        self.lists.push(self.labels.len() as u32);
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
        let label = |half: u32| self.labels(&arcs[half as usize / 2]);
        let (mine, next) = (label(half), label(onward));
        let flip = (half ^ onward) & 1;
        let same = mine.len() == next.len() && mine.iter().all(|&l| next.contains(&(l ^ flip)));
        same.then_some(onward)
    }
}
