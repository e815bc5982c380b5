use crate::graph::origin;
use crate::noder::{Arc, Noder};
use crate::parallel;
use crate::predicate::by_angle;
use fgm_core::Point2;
use std::cmp::Ordering;

/// Nodes that are worth two threads.
const SHARE: usize = 1 << 15;

/// Some consecutive nodes, whose half-arcs are to be sorted.
pub(crate) struct Nodes<'a> {
    noder: &'a Noder,
    /// Where each node's half-arcs begin.
    starts: &'a [u32],
}

/// A half-arc as its node sees it.
#[derive(Clone, Copy)]
struct Ray {
    /// Grows with the angle, from 0 to 4; off by [`BLUR`] at most.
    turn: f64,
    direction: Point2,
    half: u32,
}

/// Far more than rounding does to a [`Ray`]'s turn.
const BLUR: f64 = 1e-14;

impl Ray {
    #[inline]
    fn new(direction: Point2, half: u32) -> Self {
        let Point2 { x, y } = direction;
        // Along the square through (1, 0) and (0, 1).
        let share = x / (x.abs() + y.abs());
        // From +x on, like the angles of `by_angle`.
        let turn = if y < 0.0 || (y == 0.0 && x < 0.0) { 3.0 + share } else { 1.0 - share };
        Self { turn, direction, half }
    }

    /// The order of angles, exactly.
    #[inline]
    fn compare(&self, other: &Self) -> Ordering {
        if (self.turn - other.turn).abs() > BLUR {
            self.turn.total_cmp(&other.turn)
        } else {
            by_angle(self.direction, other.direction)
        }
    }
}

impl<'a> Nodes<'a> {
    /// `starts` has where the half-arcs of each node begin.
    pub(crate) fn new(noder: &'a Noder, starts: &'a [u32]) -> Self {
        Self { noder, starts }
    }

    /// Puts the half-arcs of each node in order. Straight ones in one direction to one other node
    /// are one; the first stands for all. Returns those that repeat another, and that other.
    pub(crate) fn sort(&self, around: &mut [u32], degree: &mut [u32]) -> Vec<(u32, u32)> {
        if degree.len() < SHARE {
            return self.sort_each(around, degree);
        }
        let half = degree.len() / 2;
        let (left, right) = self.starts.split_at(half);
        let (left_around, right_around) = around.split_at_mut((right[0] - left[0]) as usize);
        let (left_degree, right_degree) = degree.split_at_mut(half);
        let [left, right] = [left, right].map(|starts| Self { starts, ..*self });
        let (mut repeated, more) = parallel::both(
            || left.sort(left_around, left_degree),
            || right.sort(right_around, right_degree),
        );
        repeated.extend(more);
        repeated
    }

    fn sort_each(&self, around: &mut [u32], degree: &mut [u32]) -> Vec<(u32, u32)> {
        let arcs = &self.noder.arcs[..];
        let (mut repeated, mut rays) = (Vec::new(), Vec::new());
        for (start, degree) in self.starts.iter().zip(degree) {
            let start = (start - self.starts[0]) as usize;
            let around = &mut around[start..start + *degree as usize];
            rays.clear();
            rays.extend(around.iter().map(|&half| Ray::new(direction(self.noder, half), half)));
            rays.sort_unstable_by(|a, b| a.compare(b).then(a.half.cmp(&b.half)));
            let mut kept = 0;
            let mut before: Option<Ray> = None;
            for &ray in &rays {
                let same = |before: &Ray| {
                    before.compare(&ray) == Ordering::Equal
                        && same_ends(arcs, before.half, ray.half)
                };
                if let Some(first) = before.filter(same) {
                    repeated.push((ray.half / 2, first.half / 2));
                } else {
                    before = Some(ray);
                    around[kept] = ray.half;
                    kept += 1;
                }
            }
            *degree = kept as u32;
        }
        repeated
    }
}

/// The direction in which a half-arc leaves its node.
#[inline]
fn direction(noder: &Noder, half: u32) -> Point2 {
    let (arc, back) = (&noder.arcs[half as usize / 2], half as usize & 1);
    let between = arc.between(&noder.slots.points);
    let next = if back == 0 { between.first() } else { between.last() };
    let [at, other] = [arc.ends[back], arc.ends[1 - back]].map(|end| noder.nodes()[end as usize]);
    next.copied().unwrap_or(other) - at
}

/// Whether two half-arcs that leave one node in one direction are the same line: straight, to one
/// other node.
fn same_ends(arcs: &[Arc], a: u32, b: u32) -> bool {
    arcs[a as usize / 2].is_straight()
        && arcs[b as usize / 2].is_straight()
        && origin(arcs, a ^ 1) == origin(arcs, b ^ 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn directions() -> impl Strategy<Value = [Point2; 2]> {
        let reach = prop::sample::select(vec![2i64, 1000, 1 << 41]);
        reach
            .prop_flat_map(|r| prop::array::uniform4(-r..=r))
            .prop_map(|[x, y, u, v]| [(x, y), (u, v)].map(|(x, y)| Point2::new(x as f64, y as f64)))
    }

    proptest! {
        #[test]
        fn rays_are_in_order_of_their_angles([a, b] in directions(), near in any::<bool>()) {
            let b = if near { a + (b - a).clamp(Point2::splat(-1.0), Point2::ONE) } else { b };
            prop_assume!(a != Point2::ZERO && b != Point2::ZERO);
            prop_assert_eq!(Ray::new(a, 0).compare(&Ray::new(b, 1)), by_angle(a, b));
        }
    }
}
