use crate::contact::Contacts;
use crate::hilbert::HilbertOrder;
use crate::lattice::Lattice;
use crate::slots::{Slots, too_many};
use crate::snap::Snap;
use crate::tree::BoxTree;
use crate::{ArrangeError, Chain, memory};
use fgm_core::Point2;

/// From chains to arcs that meet at their ends only (but for repetitions of straight arcs, which
/// the graph merges). Holds the memory for the next layer.
#[derive(Debug, Default)]
pub(crate) struct Noder {
    pub(crate) slots: Slots,
    tree: BoxTree,
    contacts: Contacts,
    snap: Snap,
    pub(crate) order: HilbertOrder,
    /// In order of the lesser of their ends: what is near by in the plane is near by in memory.
    pub(crate) arcs: Vec<Arc>,
    starts: Vec<u32>,
}

/// A line between two nodes with no node in between.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Arc {
    /// Slot of the first point between its ends.
    first: u32,
    /// The slot after the last point between its ends.
    last: u32,
    /// Nodes at its ends.
    pub(crate) ends: [u32; 2],
    /// Index of the input chain; the graph replaces it by the label.
    pub(crate) label: u32,
}

impl Arc {
    /// Whether it is one segment.
    #[inline]
    pub(crate) fn is_straight(&self) -> bool {
        self.first == self.last
    }

    /// The points between its ends.
    #[inline]
    pub(crate) fn between<'a>(&self, points: &'a [Point2]) -> &'a [Point2] {
        &points[self.first as usize..self.last as usize]
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
        too_many("points of edges", self.slots.points.len() + 2 * self.snap.cuts.len())?;
        self.emit();
        self.snap.rest();
        Ok(())
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        self.slots.rest();
        memory::rest(&mut self.arcs);
        memory::rest(&mut self.starts);
        memory::rest(&mut self.snap.pixels.hot);
    }

    /// Writes the arcs, by the lesser of their ends.
    fn emit(&mut self) {
        let Self { slots, snap, arcs, starts, .. } = self;
        starts.clear();
        starts.resize(snap.pixels.hot.len(), 0);
        let lesser = |arc: &Arc| arc.ends[0].min(arc.ends[1]) as usize;
        let mut count = 0;
        for_arcs(slots, snap, |arc| {
            starts[lesser(&arc)] += 1;
            count += 1;
        });
        let mut sum = 0;
        for start in &mut *starts {
            sum += std::mem::replace(start, sum);
        }
        arcs.clear();
        arcs.resize(count, Arc::default());
        for_arcs(slots, snap, |arc| {
            let at = &mut starts[lesser(&arc)];
            arcs[*at as usize] = arc;
            *at += 1;
        });
    }
}

/// Calls `visit` with every arc, chain by chain.
#[inline]
fn for_arcs(slots: &Slots, snap: &Snap, mut visit: impl FnMut(Arc)) {
    let mut cuts = snap.cuts.iter().peekable();
    let mut touched = snap.pixels.touched.iter().copied().peekable();
    let of_slot = &snap.pixels.of_slot[..];
    for run in &slots.runs {
        touched.next_if_eq(&run.first);
        let from = of_slot[run.first as usize];
        let mut line = Line { first: run.first + 1, from, chain: run.chain, visit: &mut visit };
        while let Some(slot) = touched.next_if(|&slot| slot <= run.last) {
            while let Some(cut) = cuts.next_if(|cut| cut.segment() < slot) {
                line.end(cut.segment() + 1, cut.pixel());
            }
            line.end(slot, of_slot[slot as usize]);
            line.first = slot + 1;
        }
    }
}

/// The arc being written.
struct Line<'a, V> {
    first: u32,
    from: u32,
    chain: u32,
    visit: &'a mut V,
}

impl<V: FnMut(Arc)> Line<'_, V> {
    /// Ends the arc at a node, before the slot `last`, and begins the next there.
    #[inline]
    fn end(&mut self, last: u32, node: u32) {
        let (first, ends) = (self.first, [self.from, node]);
        if ends[0] == ends[1] && first == last {
            return;
        }
        (self.visit)(Arc { first, last, ends, label: self.chain });
        (self.first, self.from) = (last, node);
    }
}
