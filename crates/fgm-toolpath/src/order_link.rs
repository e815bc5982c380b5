//! Points that meet: a hash table of small cells, so that every point sees only its neighbours.

use fgm_core::Point2;

use crate::order::MEETS;

/// Side of a cell, mm: few points then lie so near to a side that they have to look beyond it.
const CELL: f64 = 64.0 * MEETS;
const NONE: u32 = u32::MAX;

/// Points by number, from 0, found by place.
pub(crate) struct Meeting<'a> {
    points: &'a [Point2],
    /// The last point of every bucket; the number of buckets is a power of two.
    heads: Vec<u32>,
    /// The point before in the same bucket.
    next: Vec<u32>,
}

impl<'a> Meeting<'a> {
    pub(crate) fn new(points: &'a [Point2]) -> Self {
        let mut heads = vec![NONE; (points.len() * 2).next_power_of_two()];
        let mut next = vec![NONE; points.len()];
        for (p, id) in points.iter().zip(0_u32..) {
            let bucket = bucket(cell(p.x), cell(p.y), heads.len());
            next[id as usize] = heads[bucket];
            heads[bucket] = id;
        }
        Self { points, heads, next }
    }

    /// The nearest point that meets point `id` and that `accept` takes; of equally near ones the
    /// least.
    pub(crate) fn of(&self, id: u32, accept: impl Fn(u32) -> bool) -> Option<u32> {
        let p = self.points[id as usize];
        let mut best = (MEETS * MEETS, NONE);
        let [x0, x1] = [cell(p.x - MEETS), cell(p.x + MEETS)];
        let [y0, y1] = [cell(p.y - MEETS), cell(p.y + MEETS)];
        for (x, y) in (x0..=x1).flat_map(|x| (y0..=y1).map(move |y| (x, y))) {
            let mut other = self.heads[bucket(x, y, self.heads.len())];
            while other != NONE {
                let d = p.distance_squared(self.points[other as usize]);
                if (d, other) < best && other != id && accept(other) {
                    best = (d, other);
                }
                other = self.next[other as usize];
            }
        }
        (best.1 != NONE).then_some(best.1)
    }
}

fn cell(x: f64) -> i64 {
    (x / CELL).floor() as i64
}

/// The bucket of a cell. Mixed twice: points of infill lie on lattices, which one multiplication
/// would put into few buckets.
fn bucket(x: i64, y: i64, buckets: usize) -> usize {
    let mut mixed = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ mixed >> 32).wrapping_add(y as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
    (mixed ^ mixed >> 32) as usize & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn as_a_plain_search_finds(
            // Around the sides of cells, some closer than MEETS and some not.
            points in prop::collection::vec((-2..3i32, -2..3i32, -2..3i32, -2..3i32), 1..40),
        ) {
            let along = |cell: i32, off: i32| f64::from(cell) * CELL + f64::from(off) * 0.4 * MEETS;
            let points: Vec<_> = points
                .iter()
                .map(|&(x, y, dx, dy)| Point2::new(along(x, dx), along(y, dy)))
                .collect();
            let meeting = Meeting::new(&points);
            for (p, id) in points.iter().zip(0_u32..) {
                let accept = |other: u32| other % 3 != 0;
                let plain = points
                    .iter()
                    .zip(0_u32..)
                    .filter(|&(_, other)| other != id && accept(other))
                    .map(|(q, other)| (p.distance_squared(*q), other))
                    .filter(|(d, _)| *d <= MEETS * MEETS)
                    .min_by(|a, b| a.partial_cmp(b).unwrap());
                prop_assert_eq!(meeting.of(id, accept), plain.map(|(_, other)| other));
            }
        }
    }
}
