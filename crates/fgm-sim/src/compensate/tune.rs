//! How much to trust the measured transition: weights for the ways in which it may be off.

use super::solve::{Case, LEAST_WEIGHT, Problem};
use crate::Transition;

/// What a corner of the uncertainty may come to on a single change, as a share of the squared
/// error of the plain lead there. Below 1, since a print's changes are not all alike.
const LIMIT: f64 = 0.995;
/// What the corners are then kept at over a print, and how fast.
const GOAL: f64 = 0.997;
const GAIN: f64 = 0.5;
/// Rounds in which the weights settle, and steps of the solver in each.
const ROUNDS: usize = 24;
const STEPS: usize = 100;
/// Steps for the response that blocks begin with.
const LAST_STEPS: usize = 1000;
/// Lengths of the transition before and after the change that is tried.
const AROUND: (f64, f64) = (5.0, 4.0);
/// Bounds of what may be told for a change by 1: a palette has room on both sides of a colour.
const ROOM: (f64, f64) = (-8.0, 8.0);
/// Weight that holds what is told to the plain lead where the deposit does not decide.
pub(super) const HOLD: f64 = 1e-5;

/// The transition as measured and with delay and length off by a share, each up and down: first
/// the measured one.
pub(super) fn corners(transition: &Transition, off: f64) -> Vec<Transition> {
    let mut all = vec![*transition];
    if off > 0.0 {
        let (more, less) = (1.0 + off, 1.0 - off);
        let pairs = [(more, more), (less, less), (more, less), (less, more)];
        all.extend(pairs.map(|(delay, length)| transition.scaled(delay, length)));
    }
    all
}

/// How a print's changes are met: the ways the machine may behave, with their weights, and what is
/// best told around a single change by 1.
#[derive(Clone, Debug)]
pub(super) struct Tuned {
    pub(super) cases: Vec<Case>,
    /// What is told beyond the plain lead, cell by cell.
    pub(super) response: Vec<f64>,
    /// Which cell of it the plain lead's command is in.
    pub(super) command: usize,
}

/// Cases for the corners, weighted so that on a single change the measured transition fits best
/// while none of the others comes out worse than with the plain lead: the weights are the
/// multipliers of these limits, found by raising those that are broken and lowering the rest.
pub(super) fn tune(corners: &[Transition], lead: f64, cell: f64) -> Tuned {
    let mut cases: Vec<Case> = corners.iter().map(|t| Case::new(t, cell, 1.0)).collect();
    let mut problem = single_change(&cases, lead / cell, corners[0].length / cell);
    let plain: Vec<f64> = cases.iter().map(|case| problem.error(case)).collect();
    let mut multipliers = vec![0.3; cases.len()];
    multipliers[0] = 1.0;
    for round in 0..if cases.len() > 1 { ROUNDS } else { 0 } {
        weigh(&mut cases, &multipliers, &plain);
        problem.solve(&cases, STEPS);
        // Ever smaller steps, or the corners take turns.
        let power = 8.0 / (1.0 + 0.25 * round as f64);
        for (i, multiplier) in multipliers.iter_mut().enumerate().skip(1) {
            let share = problem.error(&cases[i]) / plain[i].max(f64::MIN_POSITIVE);
            *multiplier = (*multiplier * (share / LIMIT).powf(power).clamp(0.5, 2.0)).min(100.0);
        }
    }
    weigh(&mut cases, &multipliers, &plain);
    problem.solve(&cases, LAST_STEPS);
    let difference = problem.told.iter().zip(&problem.plain).map(|(told, plain)| told - plain);
    let command = problem.plain.iter().take_while(|plain| **plain < 0.5).count();
    Tuned { cases, response: difference.collect(), command }
}

impl Tuned {
    /// Takes another step towards weights that keep the corners just below the plain lead, by
    /// what share of its squared errors theirs are so far.
    pub(super) fn adapt(&mut self, shares: impl Iterator<Item = f64>) {
        for (case, share) in self.cases.iter_mut().zip(shares).skip(1) {
            let by = (share / GOAL).powf(GAIN).clamp(0.5, 2.0);
            case.weight = (case.weight * by).clamp(LEAST_WEIGHT, 100.0);
        }
    }

    /// Gives more weight to the corners that came to more than they may, by what share of it.
    pub(super) fn insist(&mut self, shares: impl Iterator<Item = f64>) {
        for (case, share) in self.cases.iter_mut().zip(shares).skip(1) {
            let by = if share > 1.0 { share.powi(2).clamp(1.2, 3.0) } else { 1.0 };
            case.weight = (case.weight * by).min(100.0);
        }
    }
}

/// Errors count by what they are with the plain lead, that of the measured transition as 1.
fn weigh(cases: &mut [Case], multipliers: &[f64], plain: &[f64]) {
    for (case, (multiplier, error)) in cases.iter_mut().zip(multipliers.iter().zip(plain)) {
        let weight = multiplier * plain[0] / error.max(f64::MIN_POSITIVE);
        case.weight = weight.max(LEAST_WEIGHT);
    }
}

/// One change from 0 to 1 with the plain lead; lengths in cells.
fn single_change(cases: &[Case], lead: f64, length: f64) -> Problem {
    let pad = cases.iter().map(Case::reach).max().unwrap_or(0) + 1;
    let command = pad + (AROUND.0 * length).ceil() as usize;
    let change = command as f64 + lead;
    let count = (change + AROUND.1 * length).ceil() as usize;
    let mut problem = Problem::new(ROOM, HOLD);
    problem.resize(count, 1);
    (problem.free, problem.rows) = (pad..count, pad..count);
    for j in 0..count {
        problem.weight[j] = 1.0;
        problem.target[j] = (j as f64 + 1.0 - change).clamp(0.0, 1.0);
        problem.told[j] = if j < command { 0.0 } else { 1.0 };
    }
    problem.plain.clone_from(&problem.told);
    problem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_corner_is_worse_than_the_plain_lead() {
        for (delay, length, off) in
            [(13.0, 26.0, 0.2), (5.0, 26.0, 0.2), (26.0, 26.0, 0.2), (13.0, 26.0, 0.05)]
        {
            let transition = Transition { delay, length };
            let cell = length / 48.0;
            let corners = corners(&transition, off);
            let Tuned { cases, .. } = tune(&corners, transition.lead(), cell);
            let mut problem = single_change(&cases, transition.lead() / cell, 48.0);
            let plain: Vec<f64> = cases.iter().map(|case| problem.error(case)).collect();
            problem.solve(&cases, 300);
            let shares: Vec<f64> =
                cases.iter().zip(&plain).map(|(c, p)| (problem.error(c) / p).sqrt()).collect();
            assert!(shares[0] < 0.75, "{shares:?}");
            assert!(shares[1..].iter().all(|share| *share <= 1.0), "{shares:?}");
        }
    }
}
