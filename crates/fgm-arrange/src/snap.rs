use crate::ArrangeError;
use crate::contact::Contacts;
use crate::piece::{overlap, segment_reaches};
use crate::predicate::{by_place, orient, passes};
use crate::slots::{Slots, too_many};
use crate::tree::BoxTree;
use fgm_core::{Bounds2, Point2};
use std::cmp::Ordering;

/// No hot pixel.
pub(crate) const NONE: u32 = u32::MAX;

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
    /// Centres of the hot pixels that matter, by place, without repetition.
    pub(crate) hot: Vec<Point2>,
    /// For each slot its hot pixel, or [`NONE`] for a point that nothing else touches.
    pub(crate) of_slot: Vec<u32>,
    /// Where segments are to be cut, in order of segment and of place along it.
    pub(crate) cuts: Vec<Cut>,
    places: Vec<Place>,
    of_crossing: Vec<u32>,
    crossing_pixels: Vec<u32>,
    bent: Vec<bool>,
    active: Vec<bool>,
    boxes: Vec<Bounds2>,
    tree: BoxTree,
}

/// A segment led through a hot pixel's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    pub(crate) segment: u32,
    pub(crate) pixel: u32,
    /// From the segment's start, |dx| + |dy|: strictly grows along it from pixel to pixel.
    along: f64,
    /// Whether the centre lies on the segment.
    exact: bool,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    at: Point2,
    /// A slot, or a crossing when not below the number of slots.
    source: u32,
}

impl Snap {
    /// Replaces the content by what these contacts demand. `tree` holds the slots' pieces.
    pub(crate) fn solve(
        &mut self,
        slots: &Slots,
        contacts: &Contacts,
        tree: &BoxTree,
        keys: &mut Vec<u64>,
    ) -> Result<(), ArrangeError> {
        too_many("points and crossings", slots.points.len() + contacts.crossings.len())?;
        self.find_pixels(slots, contacts);
        self.cuts.clear();
        for pass in &contacts.passes {
            let pixel = self.of_slot[pass.slot as usize];
            self.cut(&slots.points, pass.segment, pixel);
        }
        if self.bend(slots, contacts) {
            self.cut_at_crossings(slots, tree, keys);
            self.spread();
            let bent = &self.bent;
            self.cuts.retain(|cut| cut.exact || bent[cut.segment as usize]);
        } else {
            for (crossing, &pixel) in contacts.crossings.iter().zip(&self.of_crossing) {
                for segment in [crossing.a, crossing.b] {
                    let along = along(&slots.points, segment, crossing.at);
                    self.cuts.push(Cut { segment, pixel, along, exact: true });
                }
            }
            self.cuts.retain(|cut| cut.exact);
        }
        self.cuts.sort_unstable_by(|a, b| {
            a.segment.cmp(&b.segment).then_with(|| a.along.total_cmp(&b.along))
        });
        self.cuts.dedup_by_key(|cut| (cut.segment, cut.pixel));
        self.unfold(&slots.points);
        Ok(())
    }

    /// Makes vertices of untouched slots whose two segments were led through one pixel: there the
    /// line goes out and back, and the doubled edge must be seen as one.
    fn unfold(&mut self, points: &[Point2]) {
        let pairs = self.cuts.windows(2);
        let folds = pairs.filter(|w| w[0].segment + 1 == w[1].segment && w[0].pixel == w[1].pixel);
        let mut tips: Vec<_> =
            folds.map(|w| w[1].segment).filter(|&s| self.of_slot[s as usize] == NONE).collect();
        if tips.is_empty() {
            return;
        }
        tips.sort_unstable_by(|&a, &b| by_place(points[a as usize], points[b as usize]));
        // Nothing else is at these points, so they are new, each once.
        let before = |at: Point2| {
            let less = |&tip: &u32| by_place(points[tip as usize], at) == Ordering::Less;
            tips.partition_point(less) as u32
        };
        let shift: Vec<_> = self.hot.iter().map(|&at| before(at)).collect();
        let pixels = self.of_slot.iter_mut().chain(self.cuts.iter_mut().map(|cut| &mut cut.pixel));
        for pixel in pixels.filter(|pixel| **pixel != NONE) {
            *pixel += shift[*pixel as usize];
        }
        self.hot.extend(tips.iter().map(|&tip| points[tip as usize]));
        self.hot.sort_unstable_by(|&a, &b| by_place(a, b));
        for (k, &tip) in tips.iter().enumerate() {
            let old = shift.partition_point(|&s| s <= k as u32);
            self.of_slot[tip as usize] = (old + k) as u32;
        }
    }

    /// Names the hot pixels: ends of chains, touched slots, crossings.
    fn find_pixels(&mut self, slots: &Slots, contacts: &Contacts) {
        let count = slots.points.len() as u32;
        let slot = |slot: u32| Place { at: slots.points[slot as usize], source: slot };
        self.places.clear();
        self.places.extend(slots.runs.iter().flat_map(|run| [slot(run.first), slot(run.last)]));
        self.places.extend(contacts.shared.iter().map(|&s| slot(s)));
        self.places.extend(contacts.passes.iter().map(|pass| slot(pass.slot)));
        self.places.extend(
            contacts.crossings.iter().zip(count..).map(|(c, source)| Place { at: c.at, source }),
        );
        self.places.sort_unstable_by(|a, b| by_place(a.at, b.at));
        self.hot.clear();
        self.of_slot.clear();
        self.of_slot.resize(slots.points.len(), NONE);
        self.of_crossing.clear();
        self.of_crossing.resize(contacts.crossings.len(), NONE);
        self.crossing_pixels.clear();
        for place in &self.places {
            if self.hot.last() != Some(&place.at) {
                self.hot.push(place.at);
            }
            let pixel = self.hot.len() as u32 - 1;
            if place.source < count {
                self.of_slot[place.source as usize] = pixel;
            } else {
                self.of_crossing[(place.source - count) as usize] = pixel;
                if self.crossing_pixels.last() != Some(&pixel) {
                    self.crossing_pixels.push(pixel);
                }
            }
        }
    }

    fn cut(&mut self, points: &[Point2], segment: u32, pixel: u32) {
        let at = self.hot[pixel as usize];
        let (a, b) = (points[segment as usize], points[segment as usize + 1]);
        let exact = orient(a, b, at) == 0.0;
        self.cuts.push(Cut { segment, pixel, along: along(points, segment, at), exact });
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
    fn cut_at_crossings(&mut self, slots: &Slots, tree: &BoxTree, keys: &mut Vec<u64>) {
        let points = &slots.points[..];
        if self.crossing_pixels.len() <= 4 * tree.len() {
            for k in 0..self.crossing_pixels.len() {
                let pixel = self.crossing_pixels[k];
                let at = self.hot[pixel as usize];
                let window = Bounds2::new(at, at);
                tree.query(
                    |b| overlap(b, &window),
                    |piece| {
                        for s in slots.pieces[piece as usize].clip(points, &window) {
                            if passes(points[s], points[s + 1], at) {
                                self.cut(points, s as u32, pixel);
                            }
                        }
                    },
                );
            }
            return;
        }
        self.boxes.clear();
        self.boxes.extend(self.crossing_pixels.iter().map(|&pixel| {
            let at = self.hot[pixel as usize];
            Bounds2::new(at, at)
        }));
        let mut index = std::mem::take(&mut self.tree);
        index.build(&self.boxes, keys);
        for piece in &slots.pieces {
            for s in piece.segments() {
                let (a, b) = (points[s], points[s + 1]);
                index.query(
                    |bounds| segment_reaches(a, b, bounds, 1.0),
                    |k| {
                        let pixel = self.crossing_pixels[k as usize];
                        if passes(a, b, self.hot[pixel as usize]) {
                            self.cut(points, s as u32, pixel);
                        }
                    },
                );
            }
        }
        self.tree = index;
    }

    /// Bends what passes near a bent segment's pixels, until nothing changes.
    fn spread(&mut self) {
        self.active.clear();
        self.active.resize(self.hot.len(), false);
        for _ in 0..ROUNDS {
            let mut changed = false;
            for cut in self.cuts.iter().filter(|cut| !cut.exact) {
                let active = &mut self.active[cut.pixel as usize];
                if self.bent[cut.segment as usize] && !*active {
                    *active = true;
                    changed = true;
                }
            }
            for cut in self.cuts.iter().filter(|cut| !cut.exact) {
                let bent = &mut self.bent[cut.segment as usize];
                if self.active[cut.pixel as usize] && !*bent {
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

fn along(points: &[Point2], segment: u32, at: Point2) -> f64 {
    let d = (at - points[segment as usize]).abs();
    d.x + d.y
}
