use crate::graph::Graph;
use crate::lattice::Lattice;
use crate::noder::Noder;
use crate::topology::Topology;
use crate::{ArrangeError, ArrangeOptions, Chain, Cutter, Edge, Face, Location};
use fgm_core::{Point2, Sectioner, Span};

/// Name of a bounded face of one arrangement: `0..face_count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(pub u32);

/// Name of an edge of one arrangement: `0..edge_count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId(pub u32);

/// Name of a vertex of one arrangement: `0..vertex_count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexId(pub u32);

impl FaceId {
    /// The index into a list with an entry a face.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The face of a topology's index.
    pub(crate) fn bounded(face: u32) -> Option<Self> {
        (face != crate::topology::NONE).then_some(Self(face))
    }
}

/// A label of an edge, and the direction in which its chain runs there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeLabel<L> {
    /// The chain's label.
    pub label: L,
    /// Whether the chain runs with the edge (or with the border it is asked of) or against it.
    pub forward: bool,
}

/// The planar subdivision that a set of chains makes: vertices, edges, faces.
///
/// Names follow from places, not from the order of the input: the same lines in another order,
/// direction or number of copies give the same faces with the same names and points. (Edges end
/// where labels or their directions change, so copies in the other direction may change edges.)
#[derive(Clone, Debug)]
pub struct Arrangement<L> {
    pub(crate) topology: Topology,
    pub(crate) lattice: Lattice,
    /// The labels of all edges, edge by edge.
    pub(crate) labels: Vec<EdgeLabel<L>>,
}

/// Makes arrangements, and keeps the memory from one to the next: one for each thread that slices
/// layers.
///
/// With the feature `parallel` (on by default) inputs with many thousands of crossings are shared out
/// among the threads of the rayon pool that this is called in; layers of a part are not. The result
/// is the same with any number of threads.
#[derive(Debug, Default)]
pub struct Arranger {
    noder: Noder,
    graph: Graph,
    ranks: Vec<u32>,
}

impl Arranger {
    /// An arranger that has no memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Arranges chains; see [`Arrangement::new`].
    ///
    /// # Errors
    /// As [`Arrangement::new`]. The arranger stays usable.
    pub fn arrange<L: Copy + Ord>(
        &mut self,
        chains: &[Chain<'_, L>],
        options: &ArrangeOptions,
    ) -> Result<Arrangement<L>, ArrangeError> {
        let lattice = Lattice::new(options.lattice)?;
        self.noder.node(chains, &lattice)?;
        let mut ranked: Vec<L> = chains.iter().map(|chain| chain.label).collect();
        ranked.sort_unstable();
        ranked.dedup();
        let rank = |label: &L| ranked.binary_search(label).unwrap_or_default() as u32;
        self.ranks.clear();
        self.ranks.extend(chains.iter().map(|chain| rank(&chain.label)));
        self.graph.build(&mut self.noder, &self.ranks, options.keep_dangling);
        let topology = Topology::build(&mut self.noder, &mut self.graph);
        let label =
            |&key: &u32| EdgeLabel { label: ranked[key as usize >> 1], forward: key & 1 == 1 };
        let labels = topology.labels.iter().map(label).collect();
        Ok(Arrangement { topology, lattice, labels })
    }
}

impl<L: Copy + Ord> Arrangement<L> {
    /// Nodes the chains and finds the faces.
    ///
    /// Every point of the result is a lattice point. Each chain's line and its image are within
    /// one lattice step of each other, in x and in y: half a step from rounding its points, half
    /// from snapping. Edges meet at common ends only.
    ///
    /// # Errors
    /// When the lattice step is of no use, a point is not finite or too far away for the lattice,
    /// or there are more points or crossings than 2^30.
    pub fn new(chains: &[Chain<'_, L>], options: &ArrangeOptions) -> Result<Self, ArrangeError> {
        Arranger::new().arrange(chains, options)
    }
}

impl<L> Arrangement<L> {
    /// The bounded faces, in the order of their names.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = Face<'_, L>> {
        (0..self.face_count() as u32).map(|id| self.face(FaceId(id)))
    }

    /// Number of bounded faces.
    pub fn face_count(&self) -> usize {
        self.topology.faces.len()
    }

    /// A face by its name, which must be of this arrangement.
    pub fn face(&self, id: FaceId) -> Face<'_, L> {
        Face { arrangement: self, id }
    }

    /// The edges, in the order of their names.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = Edge<'_, L>> {
        (0..self.edge_count() as u32).map(|id| self.edge(EdgeId(id)))
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.topology.ends.len()
    }

    /// An edge by its name, which must be of this arrangement.
    pub fn edge(&self, id: EdgeId) -> Edge<'_, L> {
        Edge { arrangement: self, id }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.topology.vertices.len()
    }

    /// Number of connected components.
    pub fn component_count(&self) -> usize {
        self.topology.components
    }

    /// Where a vertex lies, mm; it must be of this arrangement.
    pub fn vertex(&self, id: VertexId) -> Point2 {
        self.lattice.unscaled(self.topology.vertices[id.0 as usize])
    }

    /// The borders of the components that lie in no bounded face, each as half-edges seen from
    /// outside, so that the arrangement is to the right.
    pub fn outlines(&self) -> impl Iterator<Item = crate::Borders<'_, L>> {
        self.topology.outlines.iter().map(|&half| crate::Borders::new(self, half))
    }

    /// Which face, edge or vertex holds a point. Exact for points given in lattice steps; a point
    /// within 1/1000 of a step of a lattice point counts as that. A point that is not finite is
    /// outside.
    ///
    /// Takes time in the logarithm of the number of edges. Of an arrangement with nothing inside a
    /// face and mostly straight edges, the first point or path asked for makes the index.
    pub fn locate(&self, p: Point2) -> Location {
        self.topology.locate(self.lattice.scaled(p))
    }

    /// Replaces `spans` by the stretches of an open path and the bounded faces they lie in; `None`
    /// outside. See [`Cutter::cut`], which keeps its memory for many paths.
    pub fn cut(&self, path: &[Point2], spans: &mut Vec<Span<Option<FaceId>>>) {
        self.cutter().cut(path, spans);
    }

    /// A cutter of paths by these faces.
    pub fn cutter(&self) -> Cutter<'_, L> {
        Cutter::new(self)
    }
}

impl<L: Sync> Sectioner<Option<FaceId>> for Arrangement<L> {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Option<FaceId>>>) {
        self.cut(path, spans);
    }
}
