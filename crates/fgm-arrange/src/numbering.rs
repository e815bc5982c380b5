use crate::graph::{Graph, origin};
use crate::noder::Noder;
use crate::predicate::{by_angle, by_place};
use crate::topology::{NONE, Topology};
use fgm_core::Point2;
use std::cmp::Ordering;

/// Turns arcs into edges: arcs that go on into each other become one edge. Numbers vertices by
/// place, edges by their first vertex and angle, and rings without a vertex after them, by their
/// least point, which becomes their vertex.
pub(crate) struct Numbering<'a> {
    noder: &'a Noder,
    graph: &'a Graph,
    /// For each half-arc the half-edge that it is part of, as soon as that is written.
    half_edge: Vec<u32>,
    /// For each node its vertex.
    vertex: Vec<u32>,
}

impl<'a> Numbering<'a> {
    pub(crate) fn new(noder: &'a Noder, graph: &'a Graph) -> Self {
        Self {
            noder,
            graph,
            half_edge: vec![NONE; 2 * noder.arcs.len()],
            vertex: vec![NONE; noder.nodes().len()],
        }
    }

    /// Writes vertices, edges, points and labels.
    pub(crate) fn run(mut self, out: &mut Topology) {
        let (graph, nodes, arcs) = (self.graph, self.noder.nodes(), self.noder.arcs.len());
        out.vertices.reserve(nodes.len());
        out.vertex_starts.reserve(nodes.len() + 1);
        out.around.reserve(2 * arcs);
        out.ends.reserve(arcs);
        out.edge_starts.reserve(arcs + 1);
        out.points.reserve(self.noder.slots.points.len() + 2 * arcs);
        out.label_starts.reserve(arcs + 1);
        out.labels.reserve(arcs);
        // Nodes where something happens are vertices.
        for (node, &place) in nodes.iter().enumerate() {
            let around = graph.around(node);
            let passes = matches!(around, [_, b] if self.onward(b ^ 1).is_some());
            if !around.is_empty() && !passes {
                self.vertex[node] = out.vertices.len() as u32;
                out.vertices.push(place);
            }
        }
        for node in 0..nodes.len() {
            if self.vertex[node] != NONE {
                for &half in graph.around(node) {
                    if self.half_edge[half as usize] == NONE {
                        let last = self.edge(half, out);
                        let ends = [node as u32, origin(&self.noder.arcs, last ^ 1)];
                        out.ends.push(ends.map(|end| self.vertex[end as usize]));
                    }
                }
            }
        }
        for node in 0..nodes.len() {
            if self.vertex[node] != NONE {
                out.vertex_starts.push(out.around.len() as u32);
                out.around.extend(graph.around(node).iter().map(|&h| self.half_edge[h as usize]));
            }
        }
        self.rings(out);
        out.vertex_starts.push(out.around.len() as u32);
        out.edge_starts.push(out.points.len() as u32);
        out.label_starts.push(out.labels.len() as u32);
    }

    fn onward(&self, half: u32) -> Option<u32> {
        self.graph.straight_on(&self.noder.arcs, half)
    }

    /// Writes the edge that begins with a half-arc, up to the next vertex or all the way round;
    /// returns its last half-arc.
    fn edge(&mut self, first: u32, out: &mut Topology) -> u32 {
        let (arcs, nodes) = (&self.noder.arcs[..], self.noder.nodes());
        out.edge_starts.push(out.points.len() as u32);
        let labels = out.labels.len();
        out.label_starts.push(labels as u32);
        let own = self.graph.labels(&arcs[first as usize / 2]);
        out.labels.extend(own.iter().map(|&label| label ^ (first & 1)));
        out.labels[labels..].sort_unstable();
        let name = 2 * out.ends.len() as u32;
        let mut half = first;
        loop {
            let arc = &arcs[half as usize / 2];
            self.half_edge[half as usize] = name;
            self.half_edge[half as usize ^ 1] = name + 1;
            out.points.push(nodes[origin(arcs, half) as usize]);
            let between = arc.between(&self.noder.slots.points);
            if half & 1 == 0 {
                out.points.extend_from_slice(between);
            } else {
                out.points.extend(between.iter().rev());
            }
            let end = origin(arcs, half ^ 1);
            let next = if self.vertex[end as usize] == NONE { self.onward(half) } else { None };
            match next.filter(|&next| next != first) {
                Some(next) => half = next,
                None => {
                    out.points.push(nodes[end as usize]);
                    return half;
                }
            }
        }
    }

    /// Writes the rings on which nothing happens.
    fn rings(&mut self, out: &mut Topology) {
        let mut rings = Vec::new();
        for half in (0..2 * self.noder.arcs.len() as u32).step_by(2) {
            if self.half_edge[half as usize] != NONE {
                continue;
            }
            let node = origin(&self.noder.arcs, half) as usize;
            if self.graph.around(node).contains(&half) {
                rings.push((self.least_around(half), half));
            }
        }
        rings.sort_unstable_by(|a, b| by_place(a.0, b.0));
        for (least, half) in rings {
            let (start, labels) = (out.points.len(), out.labels.len());
            self.edge(half, out);
            let ring = &mut out.points[start..];
            let n = ring.len() - 1;
            let at = ring[..n].iter().position(|&p| p == least).unwrap_or(0);
            ring[..n].rotate_left(at);
            ring[n] = least;
            if by_angle(ring[1] - least, ring[n - 1] - least) == Ordering::Greater {
                ring.reverse();
                out.labels[labels..].iter_mut().for_each(|label| *label ^= 1);
                out.labels[labels..].sort_unstable();
            }
            let (vertex, edge) = (out.vertices.len() as u32, out.ends.len() as u32);
            out.vertex_starts.push(out.around.len() as u32);
            out.around.extend([2 * edge, 2 * edge + 1]);
            out.vertices.push(least);
            out.ends.push([vertex, vertex]);
        }
    }

    /// The least point of the ring of a half-arc; marks the ring as seen.
    fn least_around(&mut self, first: u32) -> Point2 {
        let mut least = Point2::splat(f64::INFINITY);
        let mut half = Some(first);
        while let Some(at) = half {
            let arc = &self.noder.arcs[at as usize / 2];
            // Any name will do until the ring has its own.
            self.half_edge[at as usize] = 0;
            self.half_edge[at as usize ^ 1] = 1;
            // The end is the next arc's start.
            let start = self.noder.nodes()[origin(&self.noder.arcs, at) as usize];
            for &p in arc.between(&self.noder.slots.points).iter().chain([&start]) {
                if by_place(p, least) == Ordering::Less {
                    least = p;
                }
            }
            half = self.onward(at).filter(|&next| next != first);
        }
        least
    }
}
