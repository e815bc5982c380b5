//! Bounded least squares for what to tell the machine, over cells of equal volume.

use std::ops::Range;

use fgm_core::MAX_MATERIALS;

use crate::Transition;

/// How the solver ends: it has moved by less than this in one step, or taken so many.
const STILL: f64 = 2e-5;

/// A case that counts less is not worth its time.
pub(super) const LEAST_WEIGHT: f64 = 1e-3;

/// One way the machine may behave: its moving average in cells, and how much it counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    /// Where the average of a cell's middle ends and begins, as whole cells and a rest, from the
    /// cell's start.
    end: (isize, f64),
    start: (isize, f64),
    length: f64,
    pub(super) weight: f64,
}

impl Case {
    /// A transition in cells of a volume.
    pub(super) fn new(transition: &Transition, cell: f64, weight: f64) -> Self {
        let split = |x: f64| (x.floor() as isize, x - x.floor());
        let length = transition.length / cell;
        let end = 0.5 - transition.delay / cell;
        Self { end: split(end), start: split(end - length), length, weight }
    }

    /// The cells that the averages of rows end and begin in.
    fn windows(&self, rows: &Range<usize>) -> (Range<usize>, Range<usize>) {
        let moved = |by: isize| {
            let at = |row: usize| (row as isize + by) as usize;
            at(rows.start)..at(rows.end)
        };
        (moved(self.end.0), moved(self.start.0))
    }

    /// How many cells before its own the average of a cell reaches.
    pub(super) fn reach(&self) -> usize {
        (1 - self.start.0).max(1) as usize
    }
}

/// What to fit: cells `0..count`, of which `free` may be chosen and those after `rows.start` are
/// measured. Values are in rows, one a component; the last of two materials is left out.
#[derive(Clone, Debug, Default)]
pub(super) struct Problem {
    pub(super) count: usize,
    pub(super) components: usize,
    pub(super) free: Range<usize>,
    pub(super) rows: Range<usize>,
    /// How much each cell matters, 0 to 1.
    pub(super) weight: Vec<f64>,
    pub(super) target: Vec<f64>,
    /// What the plain lead tells: the damping holds to it.
    pub(super) plain: Vec<f64>,
    /// What is told: where to begin, then the solution.
    pub(super) told: Vec<f64>,
    bounds: (f64, f64),
    /// Weight of the distance from the plain lead.
    hold: f64,
    scratch: Scratch,
}

#[derive(Clone, Debug, Default)]
struct Scratch {
    ahead: Vec<f64>,
    prefix: Vec<f64>,
    whole: Vec<f64>,
    rest: Vec<f64>,
    pull: Vec<f64>,
}

impl Problem {
    /// With bounds for one component, and the weight of the distance from the plain lead.
    pub(super) fn new(bounds: (f64, f64), hold: f64) -> Self {
        Self { bounds, hold, ..Self::default() }
    }

    /// Makes room for `count` cells of `components`, all 0.
    pub(super) fn resize(&mut self, count: usize, components: usize) {
        (self.count, self.components) = (count, components);
        for values in [&mut self.target, &mut self.plain, &mut self.told] {
            values.clear();
            values.resize(count * components, 0.0);
        }
        self.weight.clear();
        self.weight.resize(count, 0.0);
    }

    /// The weighted squared error of a case with what is told now, in cells.
    pub(super) fn error(&mut self, case: &Case) -> f64 {
        let mut sum = 0.0;
        for component in 0..self.components {
            let row = component * self.count..(component + 1) * self.count;
            prefix(&self.told[row.clone()], &mut self.scratch.prefix);
            let deposits =
                deposits(case, &self.told[row.clone()], &self.scratch.prefix, &self.rows);
            for (deposit, j) in deposits.zip(self.rows.clone()) {
                let miss = deposit - self.target[row.start + j];
                sum += self.weight[j] * miss * miss;
            }
        }
        sum
    }

    /// Chooses the free cells: accelerated projected gradients (Beck and Teboulle's FISTA,
    /// restarted where it overshoots), from what is told now.
    pub(super) fn solve(&mut self, cases: &[Case], steps: usize) {
        // An average never stretches, so the weights bound the curvature.
        let curvature = cases.iter().map(|c| c.weight).sum::<f64>() + self.hold;
        let step = 1.0 / curvature;
        self.scratch.ahead.clone_from(&self.told);
        let mut momentum = 1.0_f64;
        for _ in 0..steps {
            self.gradient(cases);
            let (moved, against) = self.descend(step);
            if moved < STILL {
                break;
            }
            let next = if against > 0.0 {
                1.0
            } else {
                0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt())
            };
            let carry = if against > 0.0 { 0.0 } else { (momentum - 1.0) / next };
            momentum = next;
            self.carry(carry);
        }
    }

    /// The gradient at `scratch.ahead`, for the free cells, into `scratch.rest`.
    fn gradient(&mut self, cases: &[Case]) {
        let Scratch { ahead, prefix: sums, whole, rest, pull } = &mut self.scratch;
        rest.clear();
        rest.resize(self.count * self.components, 0.0);
        for component in 0..self.components {
            let row = component * self.count..(component + 1) * self.count;
            let (ahead, target) = (&ahead[row.clone()], &self.target[row.clone()]);
            let rest = &mut rest[row.clone()];
            prefix(ahead, sums);
            whole.clear();
            whole.resize(self.count + 1, 0.0);
            for case in cases.iter().filter(|case| case.weight > LEAST_WEIGHT) {
                let (end, start) = case.windows(&self.rows);
                let scale = case.weight / case.length;
                let wanted = target[self.rows.clone()].iter().zip(&self.weight[self.rows.clone()]);
                pull.clear();
                pull.extend(
                    deposits(case, ahead, sums, &self.rows)
                        .zip(wanted)
                        .map(|(deposit, (target, weight))| scale * weight * (deposit - target)),
                );
                add(&mut whole[end.clone()], pull, 1.0);
                add(&mut rest[end], pull, case.end.1);
                add(&mut whole[start.clone()], pull, -1.0);
                add(&mut rest[start], pull, -case.start.1);
            }
            // A prefix sum takes in every cell before its end.
            let mut sum = 0.0;
            let plain = &self.plain[row];
            for i in (0..self.count).rev() {
                sum += whole[i + 1];
                rest[i] += sum + self.hold * (ahead[i] - plain[i]);
            }
        }
    }

    /// Goes down the gradient from `scratch.ahead` and back into the bounds; gives how far a cell
    /// moved at most, and whether that was against the step before.
    fn descend(&mut self, step: f64) -> (f64, f64) {
        let Scratch { ahead, rest, .. } = &mut self.scratch;
        let (mut moved, mut against) = (0.0_f64, 0.0);
        for i in self.free.clone() {
            let mut values = [0.0; MAX_MATERIALS];
            let indices = (0..self.components).map(|c| c * self.count + i);
            for (value, at) in values.iter_mut().zip(indices.clone()) {
                *value = ahead[at] - step * rest[at];
            }
            if self.components == 1 {
                values[0] = values[0].clamp(self.bounds.0, self.bounds.1);
            } else {
                to_simplex(&mut values[..self.components]);
            }
            for (value, at) in values.iter().zip(indices) {
                let by = value - self.told[at];
                moved = moved.max(by.abs());
                against += (ahead[at] - value) * by;
                // What is told before this step, for the momentum.
                rest[at] = self.told[at];
                self.told[at] = *value;
            }
        }
        (moved, against)
    }

    fn carry(&mut self, share: f64) {
        let Scratch { ahead, rest, .. } = &mut self.scratch;
        for component in 0..self.components {
            for i in self.free.clone() {
                let at = component * self.count + i;
                ahead[at] = self.told[at] + share * (self.told[at] - rest[at]);
            }
        }
    }
}

/// Sums of all values before each.
fn prefix(values: &[f64], sums: &mut Vec<f64>) {
    sums.clear();
    sums.push(0.0);
    let mut sum = 0.0;
    sums.extend(values.iter().map(|value| {
        sum += value;
        sum
    }));
}

/// The mean over the average of each row.
fn deposits<'a>(
    case: &Case,
    told: &'a [f64],
    sums: &'a [f64],
    rows: &Range<usize>,
) -> impl Iterator<Item = f64> + 'a {
    let (end, start) = case.windows(rows);
    let (end_rest, start_rest, length) = (case.end.1, case.start.1, case.length);
    let upto_end = sums[end.clone()].iter().zip(&told[end]);
    let upto_start = sums[start.clone()].iter().zip(&told[start]);
    upto_end.zip(upto_start).map(move |((sum, last), (before, first))| {
        ((sum + end_rest * last) - (before + start_rest * first)) / length
    })
}

/// Adds multiples of values.
fn add(to: &mut [f64], values: &[f64], factor: f64) {
    to.iter_mut().zip(values).for_each(|(to, value)| *to += factor * value);
}

/// The nearest fractions: none negative, together 1 (the sorted thresholds of Duchi et al.).
fn to_simplex(values: &mut [f64]) {
    let mut sorted = [0.0; MAX_MATERIALS];
    let sorted = &mut sorted[..values.len()];
    sorted.copy_from_slice(values);
    sorted.sort_unstable_by(|a, b| b.total_cmp(a));
    let (mut sum, mut shift) = (0.0, 0.0);
    for (count, value) in (1..).zip(sorted.iter()) {
        sum += value;
        let by = (sum - 1.0) / f64::from(count);
        if *value > by {
            shift = by;
        }
    }
    values.iter_mut().for_each(|value| *value = (*value - shift).max(0.0));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_nearest_fractions() {
        for (values, expected) in [
            (vec![0.5, 0.5], vec![0.5, 0.5]),
            (vec![2.0, 0.0], vec![1.0, 0.0]),
            (vec![0.6, 0.6, 0.0], vec![0.5, 0.5, 0.0]),
            (vec![0.4, 0.4, 0.4], vec![1.0 / 3.0; 3]),
            (vec![-1.0, 0.2, 0.4], vec![0.0, 0.4, 0.6]),
        ] {
            let mut found = values.clone();
            to_simplex(&mut found);
            let close = found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(close, "{values:?} -> {found:?}");
        }
    }

    fn problem(cells: usize, pad: usize, values: &[f64], components: usize) -> Problem {
        let mut problem = Problem::default();
        problem.resize(cells, components);
        (problem.free, problem.rows) = (pad..cells, pad..cells);
        (problem.bounds, problem.hold) = ((0.0, 1.0), 1e-3);
        for i in 0..cells {
            problem.weight[i] = 1.0;
            for c in 0..components {
                let value = values[(i * components + c) % values.len()];
                problem.target[c * cells + i] = value;
                problem.told[c * cells + i] = 1.0 / components.max(2) as f64;
            }
        }
        problem.plain.clone_from(&problem.told);
        problem
    }

    proptest! {
        /// The gradient is that of the error, by differences.
        #[test]
        fn the_gradient_is_the_errors(
            values in prop::collection::vec(0.0..1.0f64, 10..40),
            delay in 0.0..6.0f64,
            length in 1.0..9.0f64,
            at in 20usize..60,
        ) {
            let case = Case::new(&Transition { delay, length }, 1.0, 1.0);
            prop_assume!(case.reach() <= 20);
            let mut problem = problem(60, 20, &values, 1);
            problem.hold = 0.0;
            problem.scratch.ahead.clone_from(&problem.told);
            problem.gradient(&[case]);
            let found = problem.scratch.rest[at];
            let mut error = |by: f64| {
                problem.told[at] += by;
                let error = problem.error(&case);
                problem.told[at] -= by;
                error
            };
            let slope = (error(1e-3) - error(-1e-3)) / 2e-3;
            prop_assert!((0.5 * slope - found).abs() < 1e-6, "{} {}", 0.5 * slope, found);
        }

        /// Whatever is wanted, what is told is possible, and no worse by the objective.
        #[test]
        fn solutions_are_possible_and_better(
            values in prop::collection::vec(-0.5..1.5f64, 10..40),
            components in 1usize..5,
            length in 1.0..9.0f64,
        ) {
            prop_assume!(components != 2);
            let case = Case::new(&Transition { delay: 2.0, length }, 1.0, 1.0);
            let mut problem = problem(60, 20, &values, components);
            let before = problem.error(&case);
            problem.solve(&[case], 100);
            prop_assert!(problem.error(&case) <= before + 1e-9);
            for i in problem.free.clone() {
                let cell: Vec<f64> =
                    (0..components).map(|c| problem.told[c * problem.count + i]).collect();
                prop_assert!(cell.iter().all(|v| (-1e-12..=1.0 + 1e-12).contains(v)));
                prop_assert!(components == 1 || (cell.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            }
        }
    }
}
