//! Runs of colour along one path: closed over its start, and freed of stretches too short to
//! print.

use std::{cmp::Reverse, collections::BinaryHeap};

use crate::zipper::Run;

/// Joins the last run of a closed path to its first where both have one colour.
pub(crate) fn close(runs: &mut Vec<Run>) {
    let [first, .., last] = runs.as_slice() else { return };
    if first.color == last.color {
        let joined = join(last, first);
        runs.remove(0);
        if let Some(last) = runs.last_mut() {
            *last = joined;
        }
    }
}

/// The run over two neighbours, in the colour of neither in particular.
fn join(a: &Run, b: &Run) -> Run {
    Run { from: a.from, to: b.to, color: a.color, length: a.length + b.length }
}

/// Gives every run shorter than `min` to its longer neighbour, the shortest first, until none is
/// left or one run is left. Runs of no length go in any case.
pub(crate) fn absorb(runs: &mut Vec<Run>, closed: bool, min: f64) {
    let short = |run: &Run| run.length < min || run.length == 0.0;
    if runs.len() < 2 || !runs.iter().any(short) {
        return;
    }
    let mut chain = Chain::new(runs, closed);
    // Lengths are not negative, so their bits sort as they do.
    let mut queue: BinaryHeap<_> = (0..runs.len())
        .filter(|&i| short(&runs[i]))
        .map(|i| Reverse((runs[i].length.to_bits(), i)))
        .collect();
    while let Some(Reverse((bits, i))) = queue.pop() {
        if !chain.alive[i] || chain.runs[i].length.to_bits() != bits {
            continue;
        }
        let Some(grown) = chain.give_away(i) else { break };
        if short(&chain.runs[grown]) {
            queue.push(Reverse((chain.runs[grown].length.to_bits(), grown)));
        }
    }
    let mut alive = chain.alive.iter();
    runs.clone_from(&chain.runs);
    runs.retain(|_| alive.next() == Some(&true));
}

const NONE: usize = usize::MAX;

/// The runs as a doubly linked list, a ring where the path is closed.
struct Chain {
    runs: Vec<Run>,
    before: Vec<usize>,
    after: Vec<usize>,
    alive: Vec<bool>,
}

impl Chain {
    fn new(runs: &[Run], closed: bool) -> Self {
        let n = runs.len();
        let at_start = if closed { n - 1 } else { NONE };
        let at_end = if closed { 0 } else { NONE };
        Self {
            runs: runs.to_vec(),
            before: (0..n).map(|i| if i == 0 { at_start } else { i - 1 }).collect(),
            after: (0..n).map(|i| if i == n - 1 { at_end } else { i + 1 }).collect(),
            alive: vec![true; n],
        }
    }

    /// Merges run `i` into its longer neighbour, and that one with the next where they now have
    /// one colour. The run that grew, or none where there is no neighbour.
    fn give_away(&mut self, i: usize) -> Option<usize> {
        let (before, after) = (self.before[i], self.after[i]);
        let into = match (before, after) {
            (NONE, NONE) => return None,
            (NONE, other) | (other, NONE) => other,
            _ if self.runs[after].length > self.runs[before].length => after,
            _ => before,
        };
        if into == i {
            return None;
        }
        let color = self.runs[into].color;
        self.merge(i, into);
        let beyond = if into == before { self.after[into] } else { self.before[into] };
        if beyond != NONE && beyond != into && self.runs[beyond].color == color {
            self.merge(beyond, into);
        }
        self.runs[into].color = color;
        Some(into)
    }

    /// Takes `i` out of the list; its neighbour `into` grows over it.
    fn merge(&mut self, i: usize, into: usize) {
        let joined = if self.after[into] == i && self.before[i] == into {
            join(&self.runs[into], &self.runs[i])
        } else {
            join(&self.runs[i], &self.runs[into])
        };
        self.runs[into] = Run { color: self.runs[into].color, ..joined };
        self.alive[i] = false;
        let (before, after) = (self.before[i], self.after[i]);
        if before != NONE {
            self.after[before] = after;
        }
        if after != NONE {
            self.before[after] = before;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::ColorId;

    /// Runs of the given lengths and colours one after the other; told as `length:color`.
    fn check(runs: &[(f64, u16)], closed: bool, min: f64, want: &str) {
        let mut at = 0.0;
        let mut all: Vec<Run> = runs
            .iter()
            .map(|&(length, color)| {
                at += length;
                Run { from: at - length, to: at, color: ColorId(color), length }
            })
            .collect();
        if closed {
            close(&mut all);
        }
        absorb(&mut all, closed, min);
        let told: Vec<_> = all.iter().map(|r| format!("{}:{}", r.length, r.color.0)).collect();
        assert_eq!(told.join(" "), want, "{runs:?} closed {closed}, at least {min}");
        for (run, next) in all.iter().zip(all.iter().skip(1)) {
            assert_eq!(run.to, next.from, "{all:?}");
        }
        let round = |r: &Run| if r.to <= r.from { at } else { 0.0 };
        assert!(all.iter().all(|r| r.to - r.from + round(r) == r.length), "{all:?}");
    }

    #[test]
    fn short_runs_go_to_the_longer_neighbour() {
        check(&[(4.0, 0), (1.0, 1), (8.0, 2)], false, 0.5, "4:0 1:1 8:2");
        check(&[(4.0, 0), (1.0, 1), (8.0, 2)], false, 2.0, "4:0 9:2");
        check(&[(8.0, 0), (1.0, 1), (8.0, 2)], false, 2.0, "9:0 8:2");
        check(&[(4.0, 0), (1.0, 1), (8.0, 0)], false, 2.0, "13:0");
        check(&[(1.0, 0), (8.0, 1), (1.0, 2)], false, 2.0, "10:1");
        check(&[(1.0, 0), (1.0, 1), (1.0, 0), (1.0, 1)], false, 2.0, "4:1");
        check(&[(1.0, 0), (1.0, 1), (1.0, 2)], false, 9.0, "3:1");
        check(&[(1.0, 0)], false, 9.0, "1:0");
        check(&[(4.0, 0), (0.0, 1), (8.0, 0)], false, 0.0, "12:0");
        check(&[], false, 9.0, "");
    }

    #[test]
    fn closed_paths_join_over_their_start() {
        check(&[(4.0, 0), (1.0, 1), (8.0, 0)], true, 0.5, "1:1 12:0");
        check(&[(4.0, 0), (1.0, 1), (8.0, 0)], true, 2.0, "13:0");
        check(&[(1.0, 0), (3.0, 1), (8.0, 2)], true, 2.0, "3:1 9:2");
        check(&[(8.0, 2), (3.0, 1), (1.0, 0)], true, 2.0, "9:2 3:1");
        check(&[(0.5, 0), (3.0, 1), (4.0, 2), (0.5, 0)], true, 2.0, "3:1 5:2");
        check(&[(4.0, 0), (4.0, 1)], true, 9.0, "8:1");
        check(&[(4.0, 0)], true, 9.0, "4:0");
    }
}
