use crate::lattice::Lattice;
use crate::piece::{self, Piece};
use crate::predicate::by_place;
use crate::{ArrangeError, Chain, memory};
use fgm_core::Point2;
use std::cmp::Ordering;

/// The input on the lattice: all chains' points in one row, repeated points dropped. A slot is an
/// index into it; segment `i` runs from slot `i` to slot `i + 1` where both are of one run.
///
/// A closed chain is turned so that it begins at its least point, and ends with that again.
#[derive(Debug, Default)]
pub(crate) struct Slots {
    pub(crate) points: Vec<Point2>,
    pub(crate) runs: Vec<Run>,
    pub(crate) pieces: Vec<Piece>,
}

/// A chain in the row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// Slot of the first point.
    pub(crate) first: u32,
    /// Slot of the last point, above `first`; the same point for a closed chain.
    pub(crate) last: u32,
    /// Index of the chain in the input.
    pub(crate) chain: u32,
}

impl Slots {
    /// Replaces the content by these chains.
    pub(crate) fn load<L>(
        &mut self,
        chains: &[Chain<'_, L>],
        lattice: &Lattice,
    ) -> Result<(), ArrangeError> {
        self.points.clear();
        self.runs.clear();
        self.pieces.clear();
        // One more a chain, to close it.
        let count = chains.iter().map(|c| c.points.len() + 1).sum::<usize>();
        too_many("points", count)?;
        self.points.reserve(count);
        let limit = lattice.limit();
        for (index, chain) in chains.iter().enumerate() {
            let first = self.points.len();
            self.copy(index, chain, lattice, limit)?;
            if chain.closed {
                self.close(first);
            }
            if self.points.len() - first < 2 {
                self.points.truncate(first);
                continue;
            }
            let last = self.points.len() - 1;
            piece::split(&self.points, first, last, self.runs.len() as u32, &mut self.pieces);
            self.runs.push(Run { first: first as u32, last: last as u32, chain: index as u32 });
        }
        Ok(())
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.points);
        memory::rest(&mut self.pieces);
    }

    fn copy<L>(
        &mut self,
        index: usize,
        chain: &Chain<'_, L>,
        lattice: &Lattice,
        limit: f64,
    ) -> Result<(), ArrangeError> {
        let mut before = Point2::splat(f64::INFINITY);
        for (at, &p) in chain.points.iter().enumerate() {
            // False for NaN, too.
            if !(p.x.abs() <= limit && p.y.abs() <= limit) {
                let Point2 { x, y } = p;
                return Err(if p.is_finite() {
                    let step = lattice.step;
                    ArrangeError::OutOfRange { chain: index, point: at, x, y, limit, step }
                } else {
                    ArrangeError::NotFinite { chain: index, point: at, x, y }
                });
            }
            let q = lattice.snap(p);
            if q != before {
                self.points.push(q);
                before = q;
            }
        }
        Ok(())
    }

    fn close(&mut self, first: usize) {
        while self.points.len() > first + 1 && self.points.last() == self.points.get(first) {
            self.points.pop();
        }
        let ring = &mut self.points[first..];
        let least = (0..ring.len())
            .reduce(|a, b| if by_place(ring[b], ring[a]) == Ordering::Less { b } else { a });
        ring.rotate_left(least.unwrap_or(0));
        if ring.len() > 1 {
            let start = ring[0];
            self.points.push(start);
        }
    }
}

/// Refuses what 32-bit handles cannot name; half of them, as half-edges take two.
pub(crate) fn too_many(what: &'static str, count: usize) -> Result<(), ArrangeError> {
    let limit = (u32::MAX / 4) as usize;
    if count > limit { Err(ArrangeError::TooMany { what, count, limit }) } else { Ok(()) }
}
