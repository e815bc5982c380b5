use crate::contact::Contacts;
use crate::pixel::{NONE, Pixels};
use crate::predicate::{orient, passes};
use crate::slots::{Slots, too_many};
use crate::strips::Strips;
use crate::tree::BoxTree;
use crate::{ArrangeError, memory};
use fgm_core::{Bounds2, Point2};

/// Rounds of spreading after which every segment counts as bent. Each round costs the length of the
/// list of near passes, which is almost always empty; real input needs two.
const ROUNDS: usize = 24;

/// Snap rounding (Hobby 1999; Guibas and Marimont 1998), done only where something must move.
///
/// A pixel is hot when a vertex or a crossing lies in it. Segments are led through the centres of
/// hot pixels. In the plain method that goes for every segment and every hot pixel; its output,
/// snapped again, may move again. Here a segment is *bent* only when a crossing of its own is not a
/// lattice point, or when it passes, off the centre, through a hot pixel that a bent segment
/// passes off the centre, too. The others stay as they are, cut where a vertex lies exactly on
/// them. The pixels through which nothing bent passes can be taken as never shrinking in Guibas and
/// Marimont's proof, so the result is a planar subdivision all the same; and what has no crossing
/// off the lattice does not change at all.
#[derive(Debug, Default)]
pub(crate) struct Snap {
    pub(crate) pixels: Pixels,
    /// Where segments are to be cut, in order of segment and of place along it.
    pub(crate) cuts: Vec<Cut>,
    bent: Vec<bool>,
    active: Vec<bool>,
}

/// A segment led through a hot pixel's centre, in one number that sorts by segment and by place
/// along it: from the segment's start, |dx| + |dy| strictly grows from pixel to pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Cut(u128);

impl Cut {
    #[inline]
    fn new(points: &[Point2], segment: u32, at: Point2, pixel: u32, exact: bool) -> Self {
        let d = (at - points[segment as usize]).abs();
        // Below 2^43.
        let along = u128::from((d.x + d.y) as u64);
        let (segment, pixel) = (u128::from(segment), u128::from(pixel));
        Self(segment << 96 | along << 48 | pixel << 1 | u128::from(exact))
    }

    fn at_pixel(points: &[Point2], segment: u32, at: Point2, pixel: u32) -> Self {
        let (a, b) = (points[segment as usize], points[segment as usize + 1]);
        Self::new(points, segment, at, pixel, orient(a, b, at) == 0.0)
    }

    #[inline]
    pub(crate) fn segment(self) -> u32 {
        (self.0 >> 96) as u32
    }

    #[inline]
    pub(crate) fn pixel(self) -> u32 {
        (self.0 >> 1) as u32
    }

    /// Whether the centre lies on the segment.
    #[inline]
    fn exact(self) -> bool {
        self.0 & 1 == 1
    }

    fn set_pixel(&mut self, pixel: u32) {
        let bits = u128::from(u32::MAX) << 1;
        self.0 = self.0 & !bits | u128::from(pixel) << 1;
    }
}

impl Snap {
    /// Replaces the content by what these contacts demand. `tree` holds the slots' pieces.
    pub(crate) fn solve(
        &mut self,
        slots: &Slots,
        contacts: &Contacts,
        tree: &BoxTree,
    ) -> Result<(), ArrangeError> {
        too_many("points and crossings", slots.points.len() + contacts.crossings.len())?;
        self.pixels.find(slots, contacts);
        let mut cuts = std::mem::take(&mut self.cuts);
        cuts.clear();
        cuts.extend(contacts.passes.iter().map(|pass| {
            let pixel = self.pixels.of_slot[pass.slot as usize];
            self.cut(&slots.points, pass.segment, pixel)
        }));
        let mut parts = vec![cuts];
        if self.bend(slots, contacts) {
            self.cut_at_crossings(slots, tree, &mut parts);
        } else {
            for (crossing, &pixel) in contacts.crossings.iter().zip(&self.pixels.of_crossing) {
                let cut = |segment| Cut::new(&slots.points, segment, crossing.at, pixel, true);
                parts[0].extend([crossing.a, crossing.b].map(cut));
            }
        }
        self.cuts = sorted(parts, slots.points.len());
        self.spread();
        let bent = &self.bent;
        self.cuts.retain(|cut| cut.exact() || bent[cut.segment() as usize]);
        self.cuts.dedup();
        self.unfold(&slots.points);
        self.pixels.rest();
        Ok(())
    }

    /// Gives back what a large input needed; the pixels' places stay.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.cuts);
        memory::rest(&mut self.pixels.of_slot);
        memory::rest(&mut self.pixels.touched);
        memory::rest(&mut self.bent);
        memory::rest(&mut self.active);
    }

    /// Makes vertices of untouched slots whose two segments were led through one pixel: there the
    /// line goes out and back, and the doubled edge must be seen as one.
    fn unfold(&mut self, points: &[Point2]) {
        let pairs = self.cuts.windows(2).map(|w| (w[0], w[1]));
        let folds = pairs.filter(|(a, b)| a.segment() + 1 == b.segment() && a.pixel() == b.pixel());
        let of_slot = &self.pixels.of_slot;
        let tips = folds.map(|(_, b)| b.segment()).filter(|&s| of_slot[s as usize] == NONE);
        let tips: Vec<_> = tips.collect();
        if tips.is_empty() {
            return;
        }
        let cuts = &mut self.cuts;
        // Nothing else is at these points, so they are new, each once.
        self.pixels.add(&tips, points, |names| {
            cuts.iter_mut().for_each(|cut| cut.set_pixel(names[cut.pixel() as usize]));
        });
    }

    fn cut(&self, points: &[Point2], segment: u32, pixel: u32) -> Cut {
        Cut::at_pixel(points, segment, self.pixels.hot[pixel as usize], pixel)
    }

    /// Marks the segments with a crossing off the lattice; whether there are any.
    fn bend(&mut self, slots: &Slots, contacts: &Contacts) -> bool {
        self.bent.clear();
        self.bent.resize(slots.points.len(), false);
        let mut any = false;
        for crossing in &contacts.crossings {
            for segment in [crossing.a, crossing.b].map(|s| s as usize) {
                if !self.bent[segment]
                    && orient(slots.points[segment], slots.points[segment + 1], crossing.at) != 0.0
                {
                    self.bent[segment] = true;
                    any = true;
                }
            }
        }
        any
    }

    /// Finds every segment that passes through the pixel of a crossing. The smaller of the two
    /// sets is looked up in the index of the larger.
    fn cut_at_crossings(&self, slots: &Slots, tree: &BoxTree, parts: &mut Vec<Vec<Cut>>) {
        let points = &slots.points[..];
        let Pixels { hot, crossed, .. } = &self.pixels;
        if crossed.len() > 4 * tree.len() {
            let strips = Strips::new((points, &slots.pieces), (hot, crossed));
            parts.extend(strips.search(|segment, pixel| self.cut(points, segment, pixel)));
            return;
        }
        for &pixel in crossed {
            let at = hot[pixel as usize];
            let window = Bounds2::new(at, at);
            tree.query(&tree.window(&window), |piece| {
                for s in slots.pieces[piece as usize].clip(points, &window) {
                    if passes(points[s], points[s + 1], at) {
                        parts[0].push(self.cut(points, s as u32, pixel));
                    }
                }
            });
        }
    }

    /// Bends what passes near a bent segment's pixels, until nothing changes.
    fn spread(&mut self) {
        let is_straight = |cut: &Cut| !cut.exact() && !self.bent[cut.segment() as usize];
        if !self.cuts.iter().any(is_straight) {
            return;
        }
        self.active.clear();
        self.active.resize(self.pixels.hot.len(), false);
        for _ in 0..ROUNDS {
            let mut changed = false;
            for cut in self.cuts.iter().filter(|cut| !cut.exact()) {
                let active = &mut self.active[cut.pixel() as usize];
                if self.bent[cut.segment() as usize] && !*active {
                    *active = true;
                    changed = true;
                }
            }
            for cut in self.cuts.iter().filter(|cut| !cut.exact()) {
                let bent = &mut self.bent[cut.segment() as usize];
                if self.active[cut.pixel() as usize] && !*bent {
                    *bent = true;
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
        self.bent.fill(true);
    }
}

/// All cuts in order. Where they are many for each of `segments`, they are dealt out to the segments
/// first: they come almost in order along them.
fn sorted(parts: Vec<Vec<Cut>>, segments: usize) -> Vec<Cut> {
    let count: usize = parts.iter().map(Vec::len).sum();
    if count < 8 * segments {
        let mut parts = parts.into_iter();
        let mut cuts = parts.next().unwrap_or_default();
        cuts.extend(parts.flatten());
        cuts.sort_unstable();
        return cuts;
    }
    let mut starts = vec![0; segments];
    for cut in parts.iter().flatten() {
        starts[cut.segment() as usize] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += std::mem::replace(start, sum);
    }
    let mut cuts = vec![Cut(0); count];
    for &cut in parts.iter().flatten() {
        let at = &mut starts[cut.segment() as usize];
        cuts[*at] = cut;
        *at += 1;
    }
    let mut start = 0;
    for end in starts {
        cuts[start..end].sort_unstable();
        start = end;
    }
    cuts
}
