use crate::{Arrangement, EdgeId, EdgeLabel, FaceId, VertexId};
use fgm_core::Point2;

/// A line between two vertices (or from one to itself) that has one face to its left, one to its
/// right, and the same labels all along.
#[derive(Debug)]
pub struct Edge<'a, L> {
    pub(crate) arrangement: &'a Arrangement<L>,
    pub(crate) id: EdgeId,
}

impl<'a, L> Edge<'a, L> {
    /// Its name.
    pub fn id(&self) -> EdgeId {
        self.id
    }

    /// The vertices it runs between.
    pub fn ends(&self) -> [VertexId; 2] {
        self.arrangement.topology.ends[self.id.0 as usize].map(VertexId)
    }

    /// Its points from the first vertex to the last, mm.
    pub fn points(&self) -> impl DoubleEndedIterator<Item = Point2> + ExactSizeIterator + 'a {
        let lattice = self.arrangement.lattice;
        let line = self.arrangement.topology.line(self.id.0 as usize);
        line.iter().map(move |&p| lattice.unscaled(p))
    }

    /// The labels of the chains that run here, in order.
    pub fn labels(&self) -> &'a [EdgeLabel<L>] {
        let starts = &self.arrangement.topology.label_starts;
        let edge = self.id.0 as usize;
        &self.arrangement.labels[starts[edge] as usize..starts[edge + 1] as usize]
    }

    /// The face to its left; `None` for the unbounded one.
    pub fn left(&self) -> Option<FaceId> {
        FaceId::bounded(self.arrangement.topology.face[2 * self.id.0 as usize])
    }

    /// The face to its right; `None` for the unbounded one.
    pub fn right(&self) -> Option<FaceId> {
        FaceId::bounded(self.arrangement.topology.face[2 * self.id.0 as usize + 1])
    }

    /// Whether it is on no cycle, and so divides nothing: a dangling end or a bridge. Only where
    /// such edges were kept.
    pub fn is_dangling(&self) -> bool {
        self.arrangement.topology.bridge[self.id.0 as usize]
    }
}

/// An edge as a face sees it: the face lies to the left.
#[derive(Debug)]
pub struct Border<'a, L> {
    arrangement: &'a Arrangement<L>,
    half: u32,
}

impl<'a, L> Border<'a, L> {
    /// The edge.
    pub fn edge(&self) -> Edge<'a, L> {
        self.arrangement.edge(EdgeId(self.half / 2))
    }

    /// Whether the border runs with the edge.
    pub fn is_forward(&self) -> bool {
        self.half & 1 == 0
    }

    /// The face on this side; `None` for the unbounded one.
    pub fn face(&self) -> Option<FaceId> {
        FaceId::bounded(self.arrangement.topology.face[self.half as usize])
    }

    /// The face beyond; `None` for the unbounded one.
    pub fn neighbour(&self) -> Option<FaceId> {
        FaceId::bounded(self.arrangement.topology.face[self.half as usize ^ 1])
    }

    /// The labels of the chains that run here, and whether each runs along the border (with the
    /// face to its left) or against it.
    pub fn labels(&self) -> impl Iterator<Item = EdgeLabel<L>> + 'a
    where
        L: Copy,
    {
        let with = self.is_forward();
        let label =
            move |l: &EdgeLabel<L>| EdgeLabel { label: l.label, forward: l.forward == with };
        self.edge().labels().iter().map(label)
    }

    /// Its points in the border's direction, mm.
    pub fn points(&self) -> impl Iterator<Item = Point2> + 'a {
        let line = self.arrangement.topology.line(self.half as usize / 2);
        let (lattice, with) = (self.arrangement.lattice, self.is_forward());
        let last = line.len() - 1;
        (0..line.len()).map(move |i| lattice.unscaled(line[if with { i } else { last - i }]))
    }
}

/// The borders along one cycle, in order: the end of each is the start of the next.
#[derive(Debug)]
pub struct Borders<'a, L> {
    arrangement: &'a Arrangement<L>,
    first: u32,
    at: Option<u32>,
}

impl<'a, L> Borders<'a, L> {
    pub(crate) fn new(arrangement: &'a Arrangement<L>, first: u32) -> Self {
        Self { arrangement, first, at: Some(first) }
    }
}

impl<'a, L> Iterator for Borders<'a, L> {
    type Item = Border<'a, L>;

    fn next(&mut self) -> Option<Self::Item> {
        let half = self.at?;
        let next = self.arrangement.topology.next[half as usize];
        self.at = (next != self.first).then_some(next);
        Some(Border { arrangement: self.arrangement, half })
    }
}
