use crate::graph::{Graph, origin};
use crate::noder::Noder;
use crate::piece::{self, Piece};
use crate::tree::BoxTree;
use fgm_core::Point2;

/// No such thing; as a face, the unbounded one.
pub(crate) const NONE: u32 = u32::MAX;

/// Vertices, edges, half-edges and faces by index; coordinates in lattice steps.
///
/// Half-edge `2 e` runs along edge `e`, `2 e + 1` against it; a half-edge's face lies to its left.
#[derive(Clone, Debug, Default)]
pub(crate) struct Topology {
    pub(crate) vertices: Vec<Point2>,
    /// Where each vertex's half-edges begin in `around`, and the end.
    pub(crate) vertex_starts: Vec<u32>,
    /// The half-edges that leave each vertex, anticlockwise from +x.
    pub(crate) around: Vec<u32>,
    /// Vertices at the ends of each edge.
    pub(crate) ends: Vec<[u32; 2]>,
    /// Where each edge's points begin in `points`, and the end.
    pub(crate) edge_starts: Vec<u32>,
    pub(crate) points: Vec<Point2>,
    /// Whether an edge has the same face on both sides.
    pub(crate) bridge: Vec<bool>,
    /// Where each edge's labels begin in `labels`, and the end.
    pub(crate) label_starts: Vec<u32>,
    /// `rank << 1 | forward`.
    pub(crate) labels: Vec<u32>,
    /// The half-edge that follows along the face.
    pub(crate) next: Vec<u32>,
    /// The face to the left of each half-edge.
    pub(crate) face: Vec<u32>,
    pub(crate) faces: Vec<FaceRecord>,
    /// A half-edge of each hole, by face.
    pub(crate) holes: Vec<u32>,
    /// A half-edge of each outer border, seen from the unbounded face.
    pub(crate) outlines: Vec<u32>,
    /// Number of connected components.
    pub(crate) components: usize,
    /// The edges in pieces, for searching.
    pub(crate) pieces: Vec<Piece>,
    pub(crate) tree: BoxTree,
}

/// A bounded face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceRecord {
    /// A half-edge of the outer border.
    pub(crate) outer: u32,
    /// Where its holes begin in `holes`.
    pub(crate) holes_start: u32,
    /// Where they end.
    pub(crate) holes_end: u32,
    /// Square lattice steps.
    pub(crate) area: f64,
}

impl Topology {
    /// The points of an edge, from its first vertex to its last.
    pub(crate) fn line(&self, edge: usize) -> &[Point2] {
        &self.points[self.edge_starts[edge] as usize..self.edge_starts[edge + 1] as usize]
    }

    /// The vertex that a half-edge leaves.
    pub(crate) fn origin(&self, half: u32) -> u32 {
        self.ends[half as usize / 2][half as usize & 1]
    }

    /// The half-edges around the face to the left of `half`.
    pub(crate) fn cycle(&self, half: u32) -> impl Iterator<Item = u32> + Clone + '_ {
        let mut at = Some(half);
        std::iter::from_fn(move || {
            let here = at?;
            let next = self.next[here as usize];
            at = (next != half).then_some(next);
            Some(here)
        })
    }

    /// The arrangement of a graph. Numbering follows places only, so that it does not depend on
    /// the order, direction or repetition of chains.
    pub(crate) fn build(noder: &mut Noder, graph: &Graph) -> Self {
        let mut topology = Self::default();
        let mut keys = std::mem::take(&mut noder.keys);
        Numbering::new(noder, graph).run(&mut topology);
        topology.link();
        topology.index(&mut keys);
        topology.find_faces();
        noder.keys = keys;
        topology
    }

    /// Finds each half-edge's successor: with its face to the left it goes on along the next
    /// half-edge clockwise from where it came.
    fn link(&mut self) {
        self.next.resize(2 * self.ends.len(), NONE);
        for vertex in self.vertex_starts.windows(2) {
            let around = &self.around[vertex[0] as usize..vertex[1] as usize];
            let mut before = around.last().copied().unwrap_or(NONE);
            for &half in around {
                self.next[half as usize ^ 1] = before;
                before = half;
            }
        }
    }

    fn index(&mut self, keys: &mut Vec<u64>) {
        for edge in 0..self.ends.len() {
            let (first, end) =
                (self.edge_starts[edge] as usize, self.edge_starts[edge + 1] as usize);
            piece::split(&self.points, first, end - 1, edge as u32, &mut self.pieces);
        }
        let bounds: Vec<_> = self.pieces.iter().map(|piece| piece.bounds(&self.points)).collect();
        self.tree.build(&bounds, keys);
    }
}

/// Turns arcs into edges: arcs that go on into each other become one edge.
struct Numbering<'a> {
    noder: &'a Noder,
    graph: &'a Graph,
    /// For each half-arc that begins or ends an edge at a vertex, the half-edge.
    half_edge: Vec<u32>,
    /// For each node its vertex.
    vertex: Vec<u32>,
    done: Vec<bool>,
}

impl<'a> Numbering<'a> {
    fn new(noder: &'a Noder, graph: &'a Graph) -> Self {
        let arcs = noder.arcs.len();
        let half_edge = vec![NONE; 2 * arcs];
        Self {
            noder,
            graph,
            half_edge,
            vertex: vec![NONE; noder.nodes().len()],
            done: vec![false; arcs],
        }
    }

    fn run(mut self, out: &mut Topology) {
        let (graph, arcs, nodes) = (self.graph, &self.noder.arcs[..], self.noder.nodes().len());
        out.points.reserve(self.noder.points.len());
        // Nodes where something happens are vertices; so is the least one of each ring without.
        for node in 0..nodes {
            let around = graph.around(node);
            let passes = matches!(around, [_, b] if graph.straight_on(arcs, b ^ 1).is_some());
            if !around.is_empty() && !passes {
                self.vertex[node] = 0;
            }
        }
        for only_rings in [false, true] {
            for node in 0..nodes {
                if self.vertex[node] == NONE && !only_rings {
                    continue;
                }
                for &half in graph.around(node) {
                    if !self.done[half as usize / 2] {
                        self.vertex[node] = 0;
                        self.edge(half, out);
                    }
                }
            }
        }
        out.edge_starts.push(out.points.len() as u32);
        out.label_starts.push(out.labels.len() as u32);
        self.vertices(out);
    }

    /// Writes the edge that begins with a half-arc.
    fn edge(&mut self, first: u32, out: &mut Topology) {
        let (arcs, points) = (&self.noder.arcs[..], &self.noder.points[..]);
        let edge = out.ends.len() as u32;
        out.edge_starts.push(out.points.len() as u32);
        out.label_starts.push(out.labels.len() as u32);
        out.labels.extend(self.graph.labels(first / 2).map(|label| label ^ (first & 1)));
        let labels = out.label_starts[edge as usize] as usize;
        out.labels[labels..].sort_unstable();
        out.bridge.push(self.graph.bridge[first as usize / 2]);
        let start = origin(arcs, first);
        let mut half = first;
        loop {
            let arc = &arcs[half as usize / 2];
            self.done[half as usize / 2] = true;
            // The last point is the next arc's first.
            if half & 1 == 0 {
                out.points.extend_from_slice(&points[arc.first as usize..arc.last as usize]);
            } else {
                out.points.extend(points[arc.first as usize + 1..=arc.last as usize].iter().rev());
            }
            let end = origin(arcs, half ^ 1);
            if end == start || self.vertex[end as usize] != NONE {
                out.points.push(self.noder.nodes()[end as usize]);
                out.ends.push([start, end]);
                break;
            }
            let Some(onward) = self.graph.straight_on(arcs, half) else { break };
            half = onward;
        }
        self.half_edge[first as usize] = 2 * edge;
        self.half_edge[half as usize ^ 1] = 2 * edge + 1;
    }

    /// Numbers the vertices and writes what is around them.
    fn vertices(mut self, out: &mut Topology) {
        for (node, &place) in self.noder.nodes().iter().enumerate() {
            if self.vertex[node] == NONE {
                continue;
            }
            self.vertex[node] = out.vertices.len() as u32;
            out.vertices.push(place);
            out.vertex_starts.push(out.around.len() as u32);
            out.around.extend(self.graph.around(node).iter().map(|&h| self.half_edge[h as usize]));
        }
        out.vertex_starts.push(out.around.len() as u32);
        for node in out.ends.iter_mut().flatten() {
            *node = self.vertex[*node as usize];
        }
    }
}
