//! How far a deposit is from what was wanted, exactly.

use fgm_core::{MAX_MATERIALS, Mixture, Role};

use super::track::Told;
use crate::Transition;

/// A stretch of the extrusion in which one mixture is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    /// What is extruded before its end, mm³; it begins where the one before ends.
    pub(super) end: f64,
    /// On average.
    pub(super) mixture: Mixture,
    /// Mean error of what is wanted within the stretch from its average.
    pub(super) scatter: f64,
    pub(super) matter: Matter,
}

/// Whether a mixture matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Matter {
    /// It is to be as wanted.
    Part,
    /// The old colour goes there, hidden in the part.
    Hidden,
    /// It is no part of the print.
    Waste,
}

impl Matter {
    pub(super) fn of(role: Role) -> Self {
        match (role.is_part(), role.is_purge()) {
            (true, false) => Self::Part,
            (true, true) => Self::Hidden,
            (false, _) => Self::Waste,
        }
    }

    /// What it weighs where commands are chosen.
    pub(super) fn weight(self) -> f64 {
        if self == Self::Part { 1.0 } else { 0.0 }
    }
}

/// The integral over the volume `from..to` of the squared error of the deposit in the part, mm³.
///
/// The error of a mixture is half the squared distance of the fractions, so that for two materials
/// it is the square of the fraction's own error and for pure materials swapped it is 1. The
/// deposit is linear between the places where a command enters or leaves the moving average, so
/// each of these stretches is integrated in closed form. `wanted` covers the volume; `told` begins
/// before `from - reach`.
pub(super) fn misfit(
    transition: &Transition,
    told: &[Told],
    wanted: &[Wanted],
    part: (f64, f64),
) -> f64 {
    misfit_of(transition, told, wanted, part, Matter::Part)
}

/// As [`misfit`], over the stretches that matter so.
pub(super) fn misfit_of(
    transition: &Transition,
    told: &[Told],
    wanted: &[Wanted],
    (from, to): (f64, f64),
    matter: Matter,
) -> f64 {
    let mut deposit = Deposit::new(transition, told, from);
    let first = wanted.partition_point(|w| w.end <= from);
    let mut sum = 0.0;
    for wanted in &wanted[first..] {
        if deposit.at >= to {
            break;
        }
        let end = wanted.end.min(to);
        if wanted.matter == matter {
            let scatter = wanted.scatter * (end - deposit.at);
            let error = deposit.error(wanted.mixture.fractions(), end);
            sum += error + scatter;
        } else {
            deposit.error(wanted.mixture.fractions(), end);
        }
    }
    sum
}

/// The moving average of the commands, followed along the volume.
struct Deposit<'a> {
    told: &'a [Told],
    transition: Transition,
    at: f64,
    now: [f64; MAX_MATERIALS],
    /// The commands at the ends of the average: the one that entered last, the one that is to
    /// leave next.
    front: usize,
    back: usize,
}

impl Wanted {
    /// Takes in what follows it: another mixture upto the volume `end`, where this begins at
    /// `start`.
    pub(super) fn extend(&mut self, start: f64, end: f64, mixture: &Mixture) {
        let share = (end - self.end) / (end - start);
        let mut weights = [0.0; MAX_MATERIALS];
        let mut apart = 0.0;
        let both = self.mixture.fractions().iter().zip(mixture.fractions());
        for (weight, (a, b)) in weights.iter_mut().zip(both) {
            *weight = a + (b - a) * share;
            apart += 0.5 * (b - a).powi(2);
        }
        let mean = Mixture::from_weights(&weights[..mixture.materials()]);
        self.mixture = mean.unwrap_or(self.mixture);
        self.scatter = (1.0 - share) * (self.scatter + share * apart);
        self.end = end;
    }
}

impl<'a> Deposit<'a> {
    fn new(transition: &Transition, told: &'a [Told], at: f64) -> Self {
        let index = |v: f64| told.partition_point(|t| t.at <= v).saturating_sub(1);
        let (start, end) = (at - transition.reach(), at - transition.delay);
        let (back, front) = (index(start), index(end));
        let mut deposit =
            Self { told, transition: *transition, at, now: [0.0; MAX_MATERIALS], front, back };
        if front == back {
            deposit.settle();
            return deposit;
        }
        for i in back..=front {
            let until = told.get(i + 1).map_or(end, |next| next.at.min(end));
            let part = (until - told[i].at.max(start)) / transition.length;
            for (now, f) in deposit.now.iter_mut().zip(told[i].mixture.fractions()) {
                *now += part * f;
            }
        }
        deposit
    }

    /// Between changes the deposit is what was commanded; taking it anew drops what rounding left.
    fn settle(&mut self) {
        let fractions = self.told[self.front].mixture.fractions();
        self.now[..fractions.len()].copy_from_slice(fractions);
    }

    /// Goes on to the volume `end`; gives the squared error on the way.
    fn error(&mut self, wanted: &[f64], end: f64) -> f64 {
        let Transition { delay, length } = self.transition;
        let mut sum = 0.0;
        while self.at < end {
            let due = |i: usize, by: f64| self.told.get(i + 1).map_or(f64::INFINITY, |t| t.at + by);
            let (enters, leaves) = (due(self.front, delay), due(self.back, delay + length));
            let until = end.min(enters).min(leaves).max(self.at);
            let by = until - self.at;
            sum += by * self.step(wanted, by);
            self.at = until;
            if until == enters {
                self.front += 1;
            }
            if until == leaves {
                self.back += 1;
            }
            if self.front == self.back {
                self.settle();
            }
        }
        sum
    }

    /// Goes on by a volume in which the course does not change; gives the mean squared error.
    fn step(&mut self, wanted: &[f64], by: f64) -> f64 {
        let mut sum = 0.0;
        let (front, back) = (&self.told[self.front].mixture, &self.told[self.back].mixture);
        let share = if self.front == self.back { 0.0 } else { by / self.transition.length };
        let course = front.fractions().iter().zip(back.fractions());
        for ((now, wanted), (front, back)) in self.now.iter_mut().zip(wanted).zip(course) {
            let a = *now - wanted;
            *now += (front - back) * share;
            let b = *now - wanted;
            sum += a * a + a * b + b * b;
        }
        sum / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::ColorId;

    fn told(at: f64, share: f64) -> Told {
        let mixture = Mixture::from_weights(&[share, 1.0 - share]).unwrap();
        Told { at, mixture, color: Some(ColorId(0)) }
    }

    fn wanted(end: f64, share: f64, matter: Matter) -> Wanted {
        Wanted { end, mixture: told(0.0, share).mixture, scatter: 0.0, matter }
    }

    #[test]
    fn a_step_with_the_plain_lead_misses_a_twelfth() {
        let first = f64::NEG_INFINITY;
        let wanted = [wanted(100.0, 0.0, Matter::Part), wanted(200.0, 1.0, Matter::Part)];
        for (transition, expected) in [
            (Transition { delay: 9.0, length: 18.0 }, 18.0 / 12.0),
            (Transition { delay: 18.0, length: 0.0 }, 0.0),
            // Late by 3: w / 12 + d² / w.
            (Transition { delay: 12.0, length: 18.0 }, 1.5 + 0.5),
        ] {
            let told = [told(first, 0.0), told(82.0, 1.0)];
            let found = misfit(&transition, &told, &wanted, (0.0, 200.0));
            assert!((found - expected).abs() < 1e-9, "{transition:?}: {found} {expected}");
            // In parts it is the same.
            let parts: f64 = [(0.0, 97.5), (97.5, 104.0), (104.0, 200.0)]
                .iter()
                .map(|part| misfit(&transition, &told, &wanted, *part))
                .sum();
            assert!((parts - expected).abs() < 1e-9, "{transition:?}: {parts} {expected}");
        }
    }

    #[test]
    fn stretches_taken_together_keep_their_error() {
        let told = [told(f64::NEG_INFINITY, 0.3)];
        let apart = [(1.0, 0.1), (3.0, 0.5), (3.5, 0.9)]
            .map(|(end, share)| wanted(end, share, Matter::Part));
        let mut together = apart[0];
        together.extend(0.0, 3.0, &apart[1].mixture);
        together.extend(0.0, 3.5, &apart[2].mixture);
        let error = |wanted: &[Wanted]| misfit(&Transition::IDEAL, &told, wanted, (0.0, 3.5));
        let (found, expected) = (error(&[together]), error(&apart));
        assert!((found - expected).abs() < 1e-12 && expected > 0.1, "{found} {expected}");
    }

    #[test]
    fn what_nobody_sees_does_not_count() {
        let told = [told(f64::NEG_INFINITY, 0.0)];
        let wanted = [
            wanted(10.0, 1.0, Matter::Waste),
            wanted(30.0, 0.5, Matter::Part),
            wanted(35.0, 1.0, Matter::Hidden),
        ];
        let over = |matter| misfit_of(&Transition::IDEAL, &told, &wanted, (0.0, 40.0), matter);
        assert!((over(Matter::Part) - 20.0 * 0.25).abs() < 1e-12);
        assert!((over(Matter::Hidden) - 5.0).abs() < 1e-12);
    }
}
