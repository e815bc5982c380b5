use crate::contact::Contacts;
use crate::hilbert::HilbertOrder;
use crate::lattice::Lattice;
use crate::pixel::NONE;
use crate::slots::{Slots, too_many};
use crate::snap::Snap;
use crate::tree::BoxTree;
use crate::{ArrangeError, Chain, memory};
use fgm_core::Point2;

/// From chains to arcs that meet at their ends only (but for repetitions of two-point arcs, which
/// the graph merges). Holds the memory for the next layer.
#[derive(Debug, Default)]
pub(crate) struct Noder {
    slots: Slots,
    tree: BoxTree,
    contacts: Contacts,
    snap: Snap,
    pub(crate) order: HilbertOrder,
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
    /// Index of the input chain; the graph replaces it by the label.
    pub(crate) label: u32,
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
        &self.snap.pixels.hot
    }

    pub(crate) fn node<L>(
        &mut self,
        chains: &[Chain<'_, L>],
        lattice: &Lattice,
    ) -> Result<(), ArrangeError> {
        self.slots.load(chains, lattice)?;
        let slots = &self.slots;
        self.tree.build(
            slots.pieces.len(),
            |piece| slots.pieces[piece].bounds(&slots.points),
            &mut self.order,
        );
        self.contacts.find(slots, &self.tree);
        self.snap.solve(slots, &self.contacts, &self.tree)?;
        self.tree.rest();
        self.contacts.rest();
        self.order.rest();
        self.emit();
        self.slots.rest();
        self.snap.rest();
        too_many("points of edges", self.points.len())
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.points);
        memory::rest(&mut self.arcs);
        memory::rest(&mut self.snap.pixels.hot);
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
                from: snap.pixels.of_slot[run.first as usize],
                chain: run.chain,
            };
            line.begin(slots.points[run.first as usize]);
            for segment in run.first..run.last {
                while let Some(cut) = cuts.next_if(|cut| cut.segment() == segment) {
                    line.end(snap.pixels.hot[cut.pixel() as usize], cut.pixel());
                }
                let to = segment as usize + 1;
                let (p, node) = (slots.points[to], snap.pixels.of_slot[to]);
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
        self.arcs.push(Arc { first: self.first, last, ends: [self.from, node], label: self.chain });
        self.from = node;
        self.begin(p);
    }
}
