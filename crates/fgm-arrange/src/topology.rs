use crate::graph::Graph;
use crate::hilbert::HilbertOrder;
use crate::noder::Noder;
use crate::numbering::Numbering;
use crate::piece::{self, Piece};
use crate::tree::BoxTree;
use fgm_core::Point2;
use std::sync::OnceLock;

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
    /// Made when it is first asked for.
    index: OnceLock<Index>,
}

/// The edges in pieces, for searching.
#[derive(Clone, Debug, Default)]
pub(crate) struct Index {
    pub(crate) pieces: Vec<Piece>,
    /// Of the pieces' boxes.
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
    pub(crate) fn build(noder: &mut Noder, graph: &mut Graph) -> Self {
        let mut topology = Self::default();
        Numbering::new(noder, graph).run(&mut topology);
        noder.rest();
        graph.rest();
        topology.link();
        // Where most edges are bent, there are mostly faces in faces: then it is needed at once.
        if topology.points.len() > 3 * topology.ends.len() {
            topology.index = topology.make_index(&mut noder.order).into();
        }
        topology.find_faces();
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

    /// What places are looked up in.
    pub(crate) fn index(&self) -> &Index {
        self.index.get_or_init(|| self.make_index(&mut HilbertOrder::default()))
    }

    /// The index, if it has been made.
    pub(crate) fn made_index(&self) -> Option<&Index> {
        self.index.get()
    }

    /// Adds the pieces of an edge.
    pub(crate) fn split(&self, edge: u32, pieces: &mut Vec<Piece>) {
        let starts = &self.edge_starts[edge as usize..];
        piece::split(&self.points, starts[0] as usize, starts[1] as usize - 1, edge, pieces);
    }

    fn make_index(&self, order: &mut HilbertOrder) -> Index {
        let mut pieces = Vec::with_capacity(self.ends.len());
        (0..self.ends.len() as u32).for_each(|edge| self.split(edge, &mut pieces));
        let mut tree = BoxTree::default();
        tree.build(pieces.len(), |piece| pieces[piece].bounds(&self.points), order);
        order.rest();
        Index { pieces, tree }
    }
}
