//! The problem of a block: what its cells are to be, and what they begin with.

use std::ops::Range;

use fgm_core::MAX_MATERIALS;

use super::{
    super::{
        solve::{Case, Problem},
        tune::{self, Tuned},
    },
    Planner,
};
use crate::Transition;

/// Lengths of the transition that are settled at a time, and that are looked at beyond.
const BLOCK: f64 = 12.0;
const OVERLAP: f64 = 5.0;

/// The grid and the working space of the solver.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    pub(super) tuned: Tuned,
    pub(super) cell: f64,
    /// Volumes, mm³.
    pub(super) block: f64,
    pub(super) overlap: f64,
    /// In cells.
    pub(super) pad: usize,
    pub(super) problem: Problem,
    /// The plan that the solver began with.
    begun: Vec<f64>,
}

impl Choice {
    pub(super) fn new(corners: &[Transition], lead: f64, cell: f64) -> Self {
        let tuned = tune::tune(corners, lead, cell);
        let length = corners[0].length / cell;
        let pad = tuned.cases.iter().map(Case::reach).max().unwrap_or(0) + 1;
        Self {
            tuned,
            cell,
            block: (BLOCK * length).ceil() * cell,
            overlap: (OVERLAP * length).ceil() * cell,
            pad,
            problem: Problem::new((0.0, 1.0), tune::HOLD),
            begun: Vec::new(),
        }
    }

    /// How far beyond the end of a block has to be known, mm³.
    pub(super) fn known(&self, corners: &[Transition]) -> f64 {
        let longest = corners.iter().map(Transition::reach).fold(0.0, f64::max);
        self.overlap + longest
    }

    /// Sets up the problem for the block after what is settled.
    pub(super) fn fill(&mut self, planner: &Planner, planned: f64) {
        let components = if planner.materials == 2 { 1 } else { planner.materials };
        let cell = self.cell;
        let start = planner.settled - self.pad as f64 * cell;
        let cells = ((planned - planner.settled) / cell).round() as usize;
        let free = self.pad..self.pad + cells;
        let problem = &mut self.problem;
        problem.resize(free.end + self.pad, components);
        let count = problem.count;
        problem.rows = self.pad..count;
        let grid = (start, cell);
        planner.plain.average(grid, count, count, components, &mut problem.plain);
        problem.told.clone_from(&problem.plain);
        planner.told.average(grid, free.end, count, components, &mut problem.told);
        self.begun.clone_from(&problem.told);
        respond(problem, &self.tuned, free.clone());
        problem.free = free;
        Self::aim(problem, planner, grid);
    }

    /// What is wanted in each cell, and how much it matters.
    fn aim(problem: &mut Problem, planner: &Planner, (start, cell): (f64, f64)) {
        let count = problem.count;
        let mut at = start.max(0.0);
        let first = planner.wanted.partition_point(|w| w.end <= at);
        for wanted in &planner.wanted[first..] {
            while at < wanted.end {
                let i = ((at - start) / cell + 1e-9) as usize;
                if i >= count {
                    break;
                }
                let until = wanted.end.min(start + (i + 1) as f64 * cell).max(at.next_up());
                let share = wanted.matter.weight() * (until - at) / cell;
                problem.weight[i] += share;
                for (c, f) in wanted.mixture.fractions().iter().enumerate().take(problem.components)
                {
                    problem.target[c * count + i] += share * f;
                }
                at = until;
            }
        }
        for i in 0..count {
            let weight = problem.weight[i];
            for c in 0..problem.components {
                if weight > 0.0 {
                    problem.target[c * count + i] /= weight;
                }
            }
            problem.weight[i] = weight.min(1.0);
        }
    }

    /// The fractions told in a cell of the block, blended with the plan before.
    pub(super) fn cell_values(
        &self,
        i: usize,
        share: f64,
        materials: usize,
    ) -> [f64; MAX_MATERIALS] {
        let problem = &self.problem;
        let mut values = [0.0; MAX_MATERIALS];
        for (c, value) in values.iter_mut().enumerate().take(problem.components) {
            let at = c * problem.count + self.pad + i;
            *value = self.begun[at] + share * (problem.told[at] - self.begun[at]);
        }
        if materials == 2 {
            values[1] = 1.0 - values[0];
        }
        values
    }
}

/// Begins the free cells with what is best told around each change of the plain lead alone.
fn respond(problem: &mut Problem, tuned: &Tuned, free: Range<usize>) {
    let count = problem.count;
    for c in 0..problem.components {
        let row = c * count..(c + 1) * count;
        let (plain, told) = (&problem.plain[row.clone()], &mut problem.told[row]);
        told[free.clone()].copy_from_slice(&plain[free.clone()]);
        for i in 1..count {
            let change = plain[i] - plain[i - 1];
            if change == 0.0 {
                continue;
            }
            for (j, by) in (i as isize - tuned.command as isize..).zip(&tuned.response) {
                if usize::try_from(j).is_ok_and(|j| free.contains(&j)) {
                    told[j as usize] += change * by;
                }
            }
        }
        told[free.clone()].iter_mut().for_each(|told| *told = told.clamp(0.0, 1.0));
    }
}
