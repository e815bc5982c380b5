use crate::contact::Contacts;
use crate::lattice::Lattice;
use crate::slots::{Slots, too_many};
use crate::snap::{NONE, Snap};
use crate::tree::BoxTree;
use crate::{ArrangeError, Chain};
use fgm_core::Point2;

/// From chains to arcs that meet at their ends only (but for repetitions of two-point arcs, which
/// the graph merges). Holds the memory for the next layer.
#[derive(Debug, Default)]
pub(crate) struct Noder {
    slots: Slots,
    tree: BoxTree,
    contacts: Contacts,
    snap: Snap,
    pub(crate) keys: Vec<u64>,
    /// The arcs' points, their ends included, one arc after the other.
    pub(crate) points: Vec<Point2>,
    pub(crate) arcs: Vec<Arc>,
}

/// A line between two nodes with no node in between.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    /// Index of its first point.
    pub(crate) first: u32,
    /// Index of its last point.
    pub(crate) last: u32,
    /// Nodes at its ends.
    pub(crate) ends: [u32; 2],
    /// Index of the input chain.
    pub(crate) chain: u32,
}

impl Arc {
    /// Whether it is one segment.
    pub(crate) fn is_straight(&self) -> bool {
        self.first + 1 == self.last
    }
}

impl Noder {
    /// The nodes' places, in order of place.
    pub(crate) fn nodes(&self) -> &[Point2] {
        &self.snap.hot
    }

    pub(crate) fn node<L>(
        &mut self,
        chains: &[Chain<'_, L>],
        lattice: &Lattice,
    ) -> Result<(), ArrangeError> {
        self.slots.load(chains, lattice)?;
        self.tree.build(&self.slots.bounds, &mut self.keys);
        self.contacts.find(&self.slots, &self.tree);
        self.snap.solve(&self.slots, &self.contacts, &self.tree, &mut self.keys)?;
        self.emit();
        too_many("points of edges", self.points.len())
    }

    fn emit(&mut self) {
        self.points.clear();
        self.arcs.clear();
        self.points.reserve(self.slots.points.len() + 2 * self.snap.cuts.len());
        let (slots, snap) = (&self.slots, &self.snap);
        let mut cuts = snap.cuts.iter().peekable();
        for run in &slots.runs {
            let mut line = Line {
                points: &mut self.points,
                arcs: &mut self.arcs,
                first: 0,
                from: snap.of_slot[run.first as usize],
                chain: run.chain,
            };
            line.begin(slots.points[run.first as usize]);
            for segment in run.first..run.last {
                while let Some(cut) = cuts.next_if(|cut| cut.segment == segment) {
                    line.end(snap.hot[cut.pixel as usize], cut.pixel);
                }
                let (p, node) =
                    (slots.points[segment as usize + 1], snap.of_slot[segment as usize + 1]);
                if node == NONE {
                    line.points.push(p);
                } else {
                    line.end(p, node);
                }
            }
            // The start of an arc that never came.
            line.points.pop();
        }
    }
}

/// The arc being written.
struct Line<'a> {
    points: &'a mut Vec<Point2>,
    arcs: &'a mut Vec<Arc>,
    first: u32,
    from: u32,
    chain: u32,
}

impl Line<'_> {
    fn begin(&mut self, p: Point2) {
        self.first = self.points.len() as u32;
        self.points.push(p);
    }

    #[inline]
    fn end(&mut self, p: Point2, node: u32) {
        let last = self.points.len() as u32;
        if node == self.from && last == self.first + 1 {
            return;
        }
        self.points.push(p);
        self.arcs.push(Arc { first: self.first, last, ends: [self.from, node], chain: self.chain });
        self.from = node;
        self.begin(p);
    }
}
