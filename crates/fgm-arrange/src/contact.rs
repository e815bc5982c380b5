use crate::memory;
use crate::piece::for_pairs;
use crate::predicate::{cross_near, crossing, orient, passes};
use crate::slots::Slots;
use crate::tree::BoxTree;
use fgm_core::Point2;

/// Where the segments of a row of slots touch each other.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    /// Proper crossings.
    pub(crate) crossings: Vec<Crossing>,
    /// Segments that pass through the pixel of a slot that is none of their ends.
    pub(crate) passes: Vec<Pass>,
    /// Slots that share their point with another, or at which a line folds back.
    pub(crate) shared: Vec<u32>,
}

/// Two segments that cross in the interior of both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// The lattice point whose pixel holds the crossing.
    pub(crate) at: Point2,
    pub(crate) a: u32,
    pub(crate) b: u32,
}

/// A segment through a slot's pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pass {
    pub(crate) segment: u32,
    pub(crate) slot: u32,
}

/// Which side of a line: 0 for on it, or so near that the pixel may reach it.
#[inline]
fn side(d: Point2, e: Point2, half: f64) -> i32 {
    let (det, error) = cross_near(d, e);
    let margin = half + error;
    i32::from(det > margin) - i32::from(det < -margin)
}

impl Contacts {
    /// Replaces the content by the contacts among `slots`, whose pieces `tree` holds.
    pub(crate) fn find(&mut self, slots: &Slots, tree: &BoxTree) {
        self.crossings.clear();
        self.passes.clear();
        self.shared.clear();
        let points = &slots.points[..];
        tree.self_join(|a, b| {
            let (a, b) = (&slots.pieces[a as usize], &slots.pieces[b as usize]);
            if !a.goes_on_into(b) {
                for_pairs((points, a), (points, b), |i, j| self.pair(points, i, j));
            }
        });
    }

    /// Gives back what a large input needed.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.crossings);
        memory::rest(&mut self.passes);
        memory::rest(&mut self.shared);
    }

    #[inline]
    fn pair(&mut self, points: &[Point2], i: usize, j: usize) {
        let (p, q) = ([points[i], points[i + 1]], [points[j], points[j + 1]]);
        let (d, e) = (p[1] - p[0], q[1] - q[0]);
        let half = 0.5 * (e.x.abs() + e.y.abs());
        let (s, t) = (side(e, p[0] - q[0], half), side(e, p[1] - q[0], half));
        if s * t > 0 {
            return;
        }
        let half = 0.5 * (d.x.abs() + d.y.abs());
        let (u, v) = (side(d, q[0] - p[0], half), side(d, q[1] - p[0], half));
        if u * v > 0 {
            return;
        }
        if s * t * u * v != 0 {
            let at = crossing(p[0], p[1], q[0], q[1]);
            self.crossings.push(Crossing { at, a: i as u32, b: j as u32 });
        } else {
            self.close_pair(points, i, j);
        }
    }

    /// A pair of which an end of one may lie in reach of the other.
    #[inline(never)]
    fn close_pair(&mut self, points: &[Point2], i: usize, j: usize) {
        let (p, q) = ([points[i], points[i + 1]], [points[j], points[j + 1]]);
        let mut folds = false;
        for k in [i, i + 1] {
            for l in [j, j + 1] {
                if k != l && points[k] == points[l] {
                    self.shared.extend([k as u32, l as u32]);
                    folds = true;
                }
            }
        }
        for (segment, ends, other) in [(i, p, j), (j, q, i)] {
            for slot in [other, other + 1] {
                let c = points[slot];
                if c != ends[0] && c != ends[1] && passes(ends[0], ends[1], c) {
                    self.passes.push(Pass { segment: segment as u32, slot: slot as u32 });
                    folds = true;
                }
            }
        }
        // Neighbours that touch elsewhere, too, fold back: their common slot must become a vertex
        // so that the doubled edge is seen as one.
        if folds && (i + 1 == j || j + 1 == i) {
            self.shared.push(i.max(j) as u32);
        }
        let opposite = |a: f64, b: f64| (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0);
        if opposite(orient(p[0], p[1], q[0]), orient(p[0], p[1], q[1]))
            && opposite(orient(q[0], q[1], p[0]), orient(q[0], q[1], p[1]))
        {
            let at = crossing(p[0], p[1], q[0], q[1]);
            self.crossings.push(Crossing { at, a: i as u32, b: j as u32 });
        }
    }
}
