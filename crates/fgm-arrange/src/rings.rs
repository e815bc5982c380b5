use crate::predicate::{by_place, orient};
use crate::topology::Topology;
use fgm_core::Point2;
use std::cmp::Ordering;

/// Turns cycles of half-edges into simple rings of points, the one that encloses first.
pub(crate) struct Rings<'a> {
    topology: &'a Topology,
    outer: Vec<Point2>,
    holes: Vec<Vec<Point2>>,
    /// The half-edges of the ring being walked, without bridges.
    way: Vec<u32>,
    /// The vertices on the way, sorted, to see whether any comes twice.
    seen: Vec<u32>,
}

impl<'a> Rings<'a> {
    pub(crate) fn new(topology: &'a Topology) -> Self {
        Self { topology, outer: Vec::new(), holes: Vec::new(), way: Vec::new(), seen: Vec::new() }
    }

    /// The rings: the outer one, then holes.
    pub(crate) fn finish(self) -> Vec<Vec<Point2>> {
        let mut rings = self.holes;
        rings.sort_unstable_by(|a, b| by_place(a[0], b[0]).then_with(|| by_place(a[1], b[1])));
        rings.insert(0, self.outer);
        rings
    }

    /// Adds the rings of the cycle of a half-edge.
    pub(crate) fn walk(&mut self, half: u32) {
        let topology = self.topology;
        let is_bridge = |half: u32| topology.bridge[half as usize / 2];
        self.way.clear();
        if topology.cycle(half).any(is_bridge) {
            for start in topology.cycle(half).filter(|&h| !is_bridge(h)) {
                self.way.push(start);
            }
            self.split_all();
        } else {
            self.way.extend(topology.cycle(half));
            self.split();
        }
    }

    /// A cycle with bridges falls apart into several: each half-edge is followed by the next one
    /// that is no bridge, around the vertex.
    fn split_all(&mut self) {
        let topology = self.topology;
        let follow = |half: u32| {
            let mut next = topology.next[half as usize];
            while topology.bridge[next as usize / 2] {
                next = topology.next[next as usize ^ 1];
            }
            next
        };
        let mut left = std::mem::take(&mut self.way);
        left.sort_unstable();
        let mut done = vec![false; left.len()];
        for i in 0..left.len() {
            if done[i] {
                continue;
            }
            self.way.clear();
            let mut at = left[i];
            loop {
                self.way.push(at);
                if let Ok(k) = left.binary_search(&at) {
                    done[k] = true;
                }
                at = follow(at);
                if at == left[i] {
                    break;
                }
            }
            self.split();
        }
    }

    /// Splits the way where it comes to a vertex for the second time.
    fn split(&mut self) {
        let topology = self.topology;
        self.seen.clear();
        self.seen.extend(self.way.iter().map(|&half| topology.origin(half)));
        self.seen.sort_unstable();
        if self.seen.windows(2).all(|w| w[0] != w[1]) {
            let way = std::mem::take(&mut self.way);
            self.ring(&way);
            self.way = way;
            return;
        }
        self.seen.dedup();
        // For each vertex, how long the way was when it was left; 0 for not on the way.
        let mut left_at = vec![0usize; self.seen.len()];
        let place =
            |seen: &[u32], half: u32| seen.binary_search(&topology.origin(half)).unwrap_or(0);
        let mut open: Vec<u32> = Vec::new();
        for k in 0..=self.way.len() {
            let half = self.way[k % self.way.len()];
            let at = left_at[place(&self.seen, half)];
            if at > 0 {
                for &gone in &open[at - 1..] {
                    left_at[place(&self.seen, gone)] = 0;
                }
                let ring = open.split_off(at - 1);
                self.ring(&ring);
            }
            open.push(half);
            left_at[place(&self.seen, half)] = open.len();
        }
    }

    fn ring(&mut self, halves: &[u32]) {
        let topology = self.topology;
        let mut points = Vec::new();
        for &half in halves {
            let line = topology.line(half as usize / 2);
            if half & 1 == 0 {
                points.extend_from_slice(&line[..line.len() - 1]);
            } else {
                points.extend(line[1..].iter().rev());
            }
        }
        // From the least point on, so that a ring is the same wherever its vertices are.
        let less = |a: usize, b: usize| by_place(points[b], points[a]) == Ordering::Less;
        let least = (0..points.len()).reduce(|a, b| if less(a, b) { b } else { a });
        points.rotate_left(least.unwrap_or(0));
        // A simple ring turns at its least point as it does on the whole.
        if points.len() > 2 && orient(points[points.len() - 1], points[0], points[1]) > 0.0 {
            self.outer = points;
        } else {
            self.holes.push(points);
        }
    }
}
