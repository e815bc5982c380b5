use crate::contact::Contacts;
use crate::slots::Slots;
use crate::{memory, parallel};
use fgm_core::Point2;

/// No hot pixel.
pub(crate) const NONE: u32 = u32::MAX;

/// Hot pixels: the lattice points at which chains end, touch or cross.
#[derive(Debug, Default)]
pub(crate) struct Pixels {
    /// Their centres, by place, without repetition.
    pub(crate) hot: Vec<Point2>,
    /// For each slot its hot pixel, or [`NONE`] for a point that nothing else touches.
    pub(crate) of_slot: Vec<u32>,
    /// The slots that have one, in order.
    pub(crate) touched: Vec<u32>,
    /// For each crossing its hot pixel.
    pub(crate) of_crossing: Vec<u32>,
    /// The hot pixels that hold a crossing.
    pub(crate) crossed: Vec<u32>,
    places: Vec<Place>,
}

/// A lattice point and what is there, in one number that sorts by x, then y, then source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place(u128);

impl Place {
    /// Makes coordinates positive; they stay below 2^42.
    const SHIFT: i64 = 1 << 41;

    /// `source` is a slot, or a crossing when not below the number of slots.
    #[inline]
    pub(crate) fn new(at: Point2, source: u32) -> Self {
        let part = |v: f64| (v as i64 + Self::SHIFT) as u128;
        Self(part(at.x) << 80 | part(at.y) << 32 | u128::from(source))
    }

    #[inline]
    pub(crate) fn source(self) -> u32 {
        self.0 as u32
    }

    #[inline]
    pub(crate) fn at(self) -> Point2 {
        let part = |bits: u128| ((bits as u64 & ((1 << 48) - 1)) as i64 - Self::SHIFT) as f64;
        Point2::new(part(self.0 >> 80), part(self.0 >> 32))
    }
}

impl Pixels {
    /// Replaces the content by the ends of chains, touched slots and crossings.
    pub(crate) fn find(&mut self, slots: &Slots, contacts: &Contacts) {
        let count = slots.points.len() as u32;
        let slot = |slot: u32| Place::new(slots.points[slot as usize], slot);
        self.places.clear();
        let (passes, crossings) = (&contacts.passes, &contacts.crossings);
        let places = 2 * slots.runs.len() + contacts.shared.len() + passes.len() + crossings.len();
        self.places.reserve(places);
        self.places.extend(slots.runs.iter().flat_map(|run| [slot(run.first), slot(run.last)]));
        self.places.extend(contacts.shared.iter().map(|&s| slot(s)));
        self.places.extend(passes.iter().map(|pass| slot(pass.slot)));
        self.places
            .extend(crossings.iter().zip(count..).map(|(c, source)| Place::new(c.at, source)));
        parallel::sort(&mut self.places);
        self.hot.clear();
        self.of_slot.clear();
        self.of_slot.resize(slots.points.len(), NONE);
        self.of_crossing.clear();
        self.of_crossing.resize(crossings.len(), NONE);
        self.crossed.clear();
        self.touched.clear();
        for place in &self.places {
            let at = place.at();
            if self.hot.last() != Some(&at) {
                self.hot.push(at);
            }
            let pixel = self.hot.len() as u32 - 1;
            if place.source() < count {
                self.of_slot[place.source() as usize] = pixel;
                self.touched.push(place.source());
            } else {
                self.of_crossing[(place.source() - count) as usize] = pixel;
                if self.crossed.last() != Some(&pixel) {
                    self.crossed.push(pixel);
                }
            }
        }
        self.touched.sort_unstable();
        self.touched.dedup();
        memory::rest(&mut self.places);
    }

    /// Makes hot pixels of slots that are none, at places where nothing else is. Calls `renamed`
    /// with the function from old names to new ones.
    pub(crate) fn add(&mut self, slots: &[u32], points: &[Point2], renamed: impl FnOnce(&[u32])) {
        let mut added: Vec<_> = slots.iter().map(|&s| Place::new(points[s as usize], s)).collect();
        added.sort_unstable();
        let mut new_names = Vec::with_capacity(self.hot.len());
        let mut hot = Vec::with_capacity(self.hot.len() + added.len());
        let mut rest = added.iter().peekable();
        for &at in &self.hot {
            while let Some(place) = rest.next_if(|place| **place < Place::new(at, 0)) {
                hot.push(place.at());
            }
            new_names.push(hot.len() as u32);
            hot.push(at);
        }
        hot.extend(rest.map(|place| place.at()));
        for pixel in self.of_slot.iter_mut().filter(|pixel| **pixel != NONE) {
            *pixel = new_names[*pixel as usize];
        }
        for (before, place) in added.iter().enumerate() {
            let older = self.hot.partition_point(|&at| Place::new(at, 0) < *place);
            self.of_slot[place.source() as usize] = (older + before) as u32;
        }
        self.touched.extend_from_slice(slots);
        self.touched.sort_unstable();
        self.hot = hot;
        renamed(&new_names);
    }

    /// Gives back what only finding cuts needed, if it was large.
    pub(crate) fn rest(&mut self) {
        memory::rest(&mut self.of_crossing);
        memory::rest(&mut self.crossed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicate::by_place;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn places_sort_as_points_do(
            [a, b] in prop::array::uniform2((-(1i64 << 40)..=1 << 40, -(1i64 << 40)..=1 << 40)),
            near in any::<bool>(),
        ) {
            let point = |(x, y): (i64, i64)| Point2::new(x as f64, y as f64);
            let (a, b) = (point(a), point(if near { (a.0, b.1) } else { b }));
            prop_assert_eq!(Place::new(a, 7).at(), a);
            prop_assert_eq!(Place::new(a, u32::MAX).source(), u32::MAX);
            prop_assert_eq!(Place::new(a, 1).cmp(&Place::new(b, 1)), by_place(a, b));
        }
    }
}
