//! Travels: shortening them by changing the order, and doing without them where pieces meet.

use fgm_core::Point2;

use crate::{Piece, order::MEETS};

/// Most changes tried for one group of pieces, whatever its size.
const MOST_CHANGES: usize = 1_000_000;
/// Shorter gains, mm, are rounding.
const LEAST_GAIN: f64 = 1e-7;

/// A stop of a tour: pieces printed without a travel between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leg {
    pub(crate) enter: Point2,
    pub(crate) exit: Point2,
    /// The end of a piece at `enter`.
    pub(crate) first: u32,
    /// The end of a piece at `exit`.
    pub(crate) last: u32,
}

impl Leg {
    fn reversed(self) -> Self {
        Self { enter: self.exit, exit: self.enter, first: self.last, last: self.first }
    }
}

/// The length of all travels from `start` through a tour, mm.
#[cfg(test)]
pub(crate) fn travel(legs: &[Leg], start: Point2) -> f64 {
    let from = std::iter::once(start).chain(legs.iter().map(|leg| leg.exit));
    from.zip(legs).map(|(from, leg)| from.distance(leg.enter)).sum()
}

/// Shortens the travels of a tour by 2-opt and or-opt moves: the longest travel is tried against the
/// rest of the tour, and the best change is made; then the next, down to the mean. A travel that no
/// change shortens is not tried again until one moves it.
///
/// Tries about `per_leg` changes a leg in all, so that the cost is linear in the number of legs.
pub(crate) fn improve(legs: &mut [Leg], start: Point2, per_leg: u32) {
    let count = legs.len();
    let mut budget = count.saturating_mul(per_leg as usize).min(MOST_CHANGES);
    if budget < count || count < 2 {
        return;
    }
    let (gaps, tried) = (vec![0.0; count + 1], vec![false; count]);
    let mut tour = Tour { gaps, tried, legs, start };
    tour.measure(0, count);
    while let Some(left) = budget.checked_sub(count)
        && let Some(i) = tour.longest()
    {
        budget = left;
        match tour.best_change(i) {
            Some(change) => tour.make(change),
            None => tour.tried[i] = true,
        }
    }
}

#[derive(Clone, Copy)]
enum Change {
    /// The legs from the first to the second, both included, the other way round.
    Reverse(usize, usize),
    /// The first leg taken out and put in so that it is the second, turned or not.
    Move(usize, usize, bool),
}

struct Tour<'a> {
    legs: &'a mut [Leg],
    start: Point2,
    /// The travels to each leg, and 0 after the last.
    gaps: Vec<f64>,
    /// Whether nothing shortens the travel to each leg.
    tried: Vec<bool>,
}

impl Tour<'_> {
    /// Where the nozzle is before leg `i`.
    fn before(&self, i: usize) -> Point2 {
        if i == 0 { self.start } else { self.legs[i - 1].exit }
    }

    /// Brings the travels from leg `from` to leg `to` up to date.
    fn measure(&mut self, from: usize, to: usize) {
        for i in from..=to.min(self.legs.len() - 1) {
            self.gaps[i] = self.before(i).distance(self.legs[i].enter);
            self.tried[i] = false;
        }
    }

    /// The longest travel not tried yet, if it is longer than the mean.
    fn longest(&self) -> Option<usize> {
        let mean = self.gaps.iter().sum::<f64>() / self.legs.len() as f64;
        let mut longest = (mean.max(LEAST_GAIN), None);
        for (i, (&gap, tried)) in self.gaps.iter().zip(&self.tried).enumerate() {
            if gap > longest.0 && !tried {
                longest = (gap, Some(i));
            }
        }
        longest.1
    }

    /// The travel from a point to leg `i`; none after the last.
    fn to(&self, from: Point2, i: usize) -> f64 {
        self.legs.get(i).map_or(0.0, |leg| from.distance(leg.enter))
    }

    /// The change around the travel to leg `i` that gains most, if one gains.
    ///
    /// A change takes out travels of a known length and puts in two: where the first of these
    /// alone is as long, the second is not looked at.
    fn best_change(&self, i: usize) -> Option<Change> {
        let (from, leg) = (self.before(i), self.legs[i]);
        let gap = self.gaps[i];
        let shorter = |a: Point2, b: Point2, than: f64| {
            than > LEAST_GAIN && a.distance_squared(b) < than * than
        };
        let mut best = (LEAST_GAIN, None);
        let mut offer = |gain: f64, change: Change| {
            if gain > best.0 {
                best = (gain, Some(change));
            }
        };
        // What taking leg `i` out alone would save.
        let saved = gap + self.gaps[i + 1] - self.to(from, i + 1);
        let mut before = self.start;
        for (j, other) in self.legs.iter().enumerate() {
            if j >= i {
                let old = gap + self.gaps[j + 1];
                if shorter(from, other.exit, old) {
                    let new = from.distance(other.exit) + self.to(leg.enter, j + 1);
                    offer(old - new, Change::Reverse(i, j));
                }
            } else {
                let old = self.gaps[j] + gap;
                if shorter(other.enter, leg.enter, old) {
                    let new = before.distance(from) + other.enter.distance(leg.enter);
                    offer(old - new, Change::Reverse(j, i - 1));
                }
            }
            // Between the legs j - 1 and j.
            if j < i || j > i + 1 {
                let (old, to) = (saved + self.gaps[j], if j < i { j } else { j - 1 });
                if shorter(before, leg.enter, old) {
                    let new = before.distance(leg.enter) + leg.exit.distance(other.enter);
                    offer(old - new, Change::Move(i, to, false));
                }
                if shorter(before, leg.exit, old) {
                    let new = before.distance(leg.exit) + leg.enter.distance(other.enter);
                    offer(old - new, Change::Move(i, to, true));
                }
            }
            before = other.exit;
        }
        best.1
    }

    fn make(&mut self, change: Change) {
        match change {
            Change::Reverse(i, j) => {
                self.legs[i..=j].reverse();
                self.legs[i..=j].iter_mut().for_each(|leg| *leg = leg.reversed());
                self.measure(i, j + 1);
            }
            Change::Move(i, to, turned) => {
                if turned {
                    self.legs[i] = self.legs[i].reversed();
                }
                if i < to {
                    self.legs[i..=to].rotate_left(1);
                } else {
                    self.legs[to..=i].rotate_right(1);
                }
                self.measure(i.min(to), i.max(to) + 1);
            }
        }
    }
}

/// Joins pieces that follow each other in `pieces` and meet end to start, where role, width and
/// colour are the same. What is printed stays the same, but for gaps up to 1e-6 mm that close.
pub fn connect(pieces: &mut Vec<Piece>) {
    pieces.dedup_by(|piece, into| {
        let (Some(end), Some(start)) = (into.points.last(), piece.points.first()) else {
            return false;
        };
        let alike =
            piece.role == into.role && piece.width == into.width && piece.color == into.color;
        let meet = alike && end.distance(*start) <= MEETS;
        if meet {
            into.points.extend_from_slice(&piece.points[1..]);
        }
        meet
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::{ColorId, Role};
    use proptest::prelude::*;

    fn leg((a, b, c, d): (f64, f64, f64, f64), i: usize) -> Leg {
        let first = 2 * i as u32;
        Leg { enter: Point2::new(a, b), exit: Point2::new(c, d), first, last: first + 1 }
    }

    proptest! {
        #[test]
        fn improving_keeps_every_leg_and_never_lengthens(
            legs in prop::collection::vec((0.0..9.0f64, 0.0..9.0f64, 0.0..9.0f64, 0.0..9.0f64), 0..30),
            per_leg in 0..200u32,
        ) {
            let legs: Vec<_> = legs.into_iter().enumerate().map(|(i, l)| leg(l, i)).collect();
            let mut better = legs.clone();
            improve(&mut better, Point2::ZERO, per_leg);
            let (was, is) = (travel(&legs, Point2::ZERO), travel(&better, Point2::ZERO));
            prop_assert!(is <= was + 1e-9, "{was} to {is}");
            better.sort_by_key(|leg| leg.first.min(leg.last));
            for (a, b) in legs.iter().zip(&better) {
                prop_assert!(a == b || *a == b.reversed());
            }
            prop_assert_eq!(legs.len(), better.len());
        }

        #[test]
        fn a_change_gains_what_it_promises(
            legs in prop::collection::vec((0.0..9.0f64, 0.0..9.0f64, 0.0..9.0f64, 0.0..9.0f64), 2..9),
            at in any::<prop::sample::Index>(),
        ) {
            let mut legs: Vec<_> = legs.into_iter().enumerate().map(|(i, l)| leg(l, i)).collect();
            let was = travel(&legs, Point2::ZERO);
            let i = at.index(legs.len());
            let (gaps, tried) = (vec![0.0; legs.len() + 1], vec![false; legs.len()]);
            let mut tour = Tour { legs: &mut legs, start: Point2::ZERO, gaps, tried };
            tour.measure(0, usize::MAX);
            if let Some(change) = tour.best_change(i) {
                tour.make(change);
                let gaps: f64 = tour.gaps.iter().sum();
                let is = travel(&legs, Point2::ZERO);
                prop_assert!(is < was && (is - gaps).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_straggler_is_taken_on_the_way() {
        let row = |x: f64| (x, 0.0, x, 0.1);
        let mut legs: Vec<_> = [0.0, 1.0, 3.0, 4.0, 5.0, 2.0]
            .map(row)
            .into_iter()
            .enumerate()
            .map(|(i, l)| leg(l, i))
            .collect();
        improve(&mut legs, Point2::ZERO, 100);
        let order: Vec<_> = legs.iter().map(|leg| leg.enter.x).collect();
        assert_eq!(order, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn pieces_that_meet_become_one() {
        let piece = |points: &[(f64, f64)], color, role| {
            let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
            Piece::new(points, role, 0.4, ColorId(color))
        };
        let mut pieces = vec![
            piece(&[(0.0, 0.0), (1.0, 0.0)], 0, Role::Infill),
            piece(&[(1.0, 5e-7), (2.0, 0.0)], 0, Role::Infill),
            piece(&[(2.0, 0.0), (3.0, 0.0)], 1, Role::Infill),
            piece(&[(3.0, 0.0), (4.0, 0.0)], 1, Role::GapFill),
            piece(&[(4.1, 0.0), (5.0, 0.0)], 1, Role::GapFill),
            piece(&[], 1, Role::GapFill),
        ];
        connect(&mut pieces);
        let counts: Vec<_> = pieces.iter().map(|p| p.points.len()).collect();
        assert_eq!(counts, [3, 2, 2, 2, 0]);
        assert_eq!(pieces[0].points[2], Point2::new(2.0, 0.0));
    }
}
