//! Scan lines joined along the border into serpentines.

use fgm_core::{Point2, Polygon, Ring, Role};

use super::rims;
use super::scan::{Crossing, Lattice};
use crate::Path;

/// The longest joining piece, in line pitches: longer ones would run beside a line.
const LONGEST_JOIN: f64 = 4.0;
/// Turns count from here, so that lines below zero have one too and parity is kept.
const TURN_ZERO: i64 = 1 << 24;

/// What lines are laid as.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beads {
    /// Width of a bead, mm.
    pub(super) width: f64,
    /// What a bead fills, mm, and thus the gap that takes one: a solid filling also has beads
    /// along borders beside its lines. `None` for a sparse filling.
    pub(super) spacing: Option<f64>,
    /// What the beads are for.
    pub(super) role: Role,
}

/// Stretches of the rings of a region that paths run along already, by ring: from and to along
/// the ring, mm, in order.
#[derive(Debug, Default)]
pub(super) struct Laid(Vec<Vec<(f64, f64)>>);

impl Laid {
    /// Whether any of a stretch is laid; one that runs past the ring's beginning has `to` below
    /// `from`.
    fn meets(&self, ring: u32, from: f64, to: f64) -> bool {
        let Some(laid) = self.0.get(ring as usize) else { return false };
        if to < from {
            return laid.last().is_some_and(|last| last.1 > from)
                || laid.first().is_some_and(|first| first.0 < to);
        }
        let next = laid.partition_point(|stretch| stretch.1 <= from);
        laid.get(next).is_some_and(|stretch| stretch.0 < to)
    }

    /// Adds the stretches of one set of lines, none of which meets another.
    fn add(&mut self, stretches: impl Iterator<Item = (u32, f64, f64)>) {
        for (ring, from, to) in stretches {
            let ring = ring as usize;
            if self.0.len() <= ring {
                self.0.resize_with(ring + 1, Vec::new);
            }
            if to < from {
                self.0[ring].extend([(from, f64::INFINITY), (0.0, to)]);
            } else {
                self.0[ring].push((from, to));
            }
        }
        for ring in &mut self.0 {
            ring.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        }
    }
}

/// The lines of a lattice inside a region of bead centres, joined where the border leads from
/// one line to the next and is not `laid` yet; what joins them is then.
pub(super) fn serpentines(
    centres: &[Polygon],
    lattice: &Lattice,
    beads: &Beads,
    laid: &mut Laid,
) -> Vec<Path> {
    let rings: Vec<&Ring> = centres.iter().flat_map(Polygon::rings).collect();
    let mut crossings = lattice.crossings(rings.iter().copied());
    if beads.spacing.is_some() {
        crossings = without_tips(&crossings, lattice.pitch);
    }
    joined(&rings, &crossings, lattice, beads, 1, laid)
}

/// Lines, given by the pairs of their ends, joined where a border leads from one to the next, at
/// most `reach` lines of the lattice on.
pub(super) fn joined(
    rings: &[&Ring],
    crossings: &[Crossing],
    lattice: &Lattice,
    beads: &Beads,
    reach: i64,
    laid: &mut Laid,
) -> Vec<Path> {
    let mut joiner = Joiner::new(rings, crossings, lattice, reach, laid);
    let mut out = Vec::new();
    for line in 0..crossings.len() / 2 {
        if !joiner.used[line] {
            let (points, turns) = joiner.serpentine(line);
            if let Some(&turn) = turns.first() {
                let Beads { width, role, .. } = *beads;
                out.push(Path { points, closed: false, role, width, turn, turns });
            }
        }
    }
    if let Some(spacing) = beads.spacing {
        joiner.rims(spacing, beads, &mut out);
    }
    let stretches = joiner.stretches();
    laid.add(stretches.into_iter());
    out
}

/// Leaves out short lines that only cut off the tip of a ring: a rim fills the tip better.
fn without_tips(crossings: &[Crossing], pitch: f64) -> Vec<Crossing> {
    let after = neighbours(crossings).0;
    let tip = |k: usize| {
        let (l, r) = (2 * k, 2 * k + 1);
        let short = crossings[r].u - crossings[l].u < 1.5 * pitch;
        let next = |a: usize, b: usize| after[a] as usize == b;
        // One line alone in its ring is no tip but all there is.
        short && next(l, r) != next(r, l)
    };
    let kept = (0..crossings.len() / 2).filter(|&k| !tip(k));
    kept.flat_map(|k| [crossings[2 * k], crossings[2 * k + 1]]).collect()
}

/// The crossing after and before each on its ring.
fn neighbours(crossings: &[Crossing]) -> (Vec<u32>, Vec<u32>) {
    let mut order: Vec<u32> = (0..crossings.len() as u32).collect();
    let key = |i: &u32| &crossings[*i as usize];
    order.sort_unstable_by(|a, b| {
        let (c, d) = (key(a), key(b));
        c.ring.cmp(&d.ring).then(c.at.total_cmp(&d.at)).then(a.cmp(b))
    });
    let mut after = vec![0; order.len()];
    let mut before = vec![0; order.len()];
    for same in order.chunk_by(|a, b| key(a).ring == key(b).ring) {
        for (i, &this) in same.iter().enumerate() {
            let next = same[(i + 1) % same.len()];
            after[this as usize] = next;
            before[next as usize] = this;
        }
    }
    (after, before)
}

/// Lines are pairs of crossings: line `k` runs from crossing `2k` to `2k + 1`.
struct Joiner<'a> {
    rings: &'a [&'a Ring],
    /// Length of each ring up to each vertex, and the whole at the end.
    lengths: Vec<Vec<f64>>,
    crossings: &'a [Crossing],
    lattice: &'a Lattice,
    /// The most lines from one to the next that it is joined with.
    reach: i64,
    /// The crossing after and before each on its ring.
    after: Vec<u32>,
    before: Vec<u32>,
    used: Vec<bool>,
    /// Whether the stretch of ring after each crossing is part of a path.
    linked: Vec<bool>,
    /// Stretches that other paths run along.
    laid: &'a Laid,
}

impl<'a> Joiner<'a> {
    fn new(
        rings: &'a [&'a Ring],
        crossings: &'a [Crossing],
        lattice: &'a Lattice,
        reach: i64,
        laid: &'a Laid,
    ) -> Self {
        let (after, before) = neighbours(crossings);
        let lengths = rings.iter().map(|r| cumulative(r)).collect();
        let used = vec![false; crossings.len() / 2];
        let linked = vec![false; crossings.len()];
        Self { rings, lengths, crossings, lattice, reach, after, before, used, linked, laid }
    }

    /// The path that begins with a line.
    fn serpentine(&mut self, first: usize) -> (Vec<Point2>, Vec<u32>) {
        self.used[first] = true;
        let (left, right) = (2 * first, 2 * first + 1);
        let backward = self.join(right, 1).is_none() && self.join(left, 1).is_some();
        let mut from = if backward { right } else { left };
        let (mut points, mut turns) = (Vec::new(), Vec::new());
        let mut way = 1;
        loop {
            let to = from ^ 1;
            let (start, end) = (&self.crossings[from], &self.crossings[to]);
            let turn = turn(start.line);
            self.point(self.lattice.point(start), turn, &mut points, &mut turns);
            self.point(self.lattice.point(end), turn, &mut points, &mut turns);
            let Some((next, forward)) = self.join(to, way) else { break };
            self.link(to, next, forward, turn, &mut points, &mut turns);
            way = (self.crossings[next].line - end.line).signum();
            self.linked[if forward { to } else { next }] = true;
            self.used[next / 2] = true;
            from = next;
        }
        (points, turns)
    }

    /// Adds beads along stretches of border that no line fills.
    fn rims(&self, spacing: f64, beads: &Beads, out: &mut Vec<Path>) {
        for from in 0..self.crossings.len() {
            let to = self.after[from] as usize;
            if self.linked[from] || to == from {
                continue;
            }
            let (start, end) = (&self.crossings[from], &self.crossings[to]);
            let (mut points, mut turns) = (Vec::new(), Vec::new());
            self.point(self.lattice.point(start), 0, &mut points, &mut turns);
            self.link(from, to, true, 0, &mut points, &mut turns);
            self.point(self.lattice.point(end), 0, &mut points, &mut turns);
            let fills = rims::thickness(&points, start.line, end.line, self.lattice, spacing);
            if let Some(fills) = fills {
                let turn = turn(start.line);
                let width = beads.width - self.lattice.pitch + fills;
                let turns = Vec::new();
                out.push(Path { points, closed: false, role: beads.role, width, turn, turns });
            }
        }
    }

    /// Adds a point and the segment to it, but none of no length.
    fn point(&self, p: Point2, turn: u32, points: &mut Vec<Point2>, turns: &mut Vec<u32>) {
        if let Some(last) = points.last() {
            if last.distance_squared(p) < 1e-12 {
                return;
            }
            turns.push(turn);
        }
        points.push(p);
    }

    /// The crossing to go on to from the end of a line, and whether forward along the ring; one
    /// further in direction `way` is preferred.
    fn join(&self, from: usize, way: i64) -> Option<(usize, bool)> {
        if !self.crossings[from].is_on_border() {
            return None;
        }
        let line = self.crossings[from].line;
        let limit = LONGEST_JOIN * self.lattice.pitch;
        [(self.after[from] as usize, true), (self.before[from] as usize, false)]
            .into_iter()
            .filter(|&(to, forward)| {
                let step = (self.crossings[to].line - line).abs();
                let free = self.used.get(to / 2) == Some(&false);
                let near = || self.distance(from, to, forward) <= limit * step as f64;
                let next = (1..=self.reach).contains(&step);
                next && free && near() && !self.is_laid(from, to, forward)
            })
            .min_by(|&(a, f), &(b, g)| {
                let turns_back = |to: usize| (self.crossings[to].line - line).signum() != way;
                let length = |to, forward| self.distance(from, to, forward);
                turns_back(a).cmp(&turns_back(b)).then(length(a, f).total_cmp(&length(b, g)))
            })
    }

    /// Whether another path runs along the border between two crossings.
    fn is_laid(&self, from: usize, to: usize, forward: bool) -> bool {
        let (from, to) = if forward { (from, to) } else { (to, from) };
        self.laid.meets(self.crossings[from].ring, self.along(from), self.along(to))
    }

    /// The stretches of border that are part of a path.
    fn stretches(&self) -> Vec<(u32, f64, f64)> {
        let linked = (0..self.crossings.len()).filter(|&i| self.linked[i]);
        let stretch = |from: usize| {
            let to = self.after[from] as usize;
            (self.crossings[from].ring, self.along(from), self.along(to))
        };
        linked.map(stretch).collect()
    }

    fn along(&self, crossing: usize) -> f64 {
        let Crossing { ring, at, .. } = self.crossings[crossing];
        let lengths = &self.lengths[ring as usize];
        let edge = at as usize;
        lengths[edge] + (lengths[edge + 1] - lengths[edge]) * at.fract()
    }

    /// Length of the border from one crossing to another on the same ring.
    fn distance(&self, from: usize, to: usize, forward: bool) -> f64 {
        let whole = self.lengths[self.crossings[from].ring as usize].last().copied();
        let step = self.along(to) - self.along(from);
        let step = if forward { step } else { -step };
        if step < 0.0 { step + whole.unwrap_or(0.0) } else { step }
    }

    /// Adds the border's corners between two crossings.
    fn link(
        &self,
        from: usize,
        to: usize,
        forward: bool,
        turn: u32,
        points: &mut Vec<Point2>,
        turns: &mut Vec<u32>,
    ) {
        let ring = &self.rings[self.crossings[from].ring as usize].points;
        let n = ring.len();
        let (a, b) = (self.crossings[from].at, self.crossings[to].at);
        let (start, end) = (a as usize, b as usize);
        // Going forward the first corner is the end of the edge, going back its beginning.
        let wraps = if forward { b < a } else { b > a };
        let corners = match (forward, wraps) {
            (true, false) => end - start,
            (true, true) => end + n - start,
            (false, false) => start - end,
            (false, true) => start + n - end,
        };
        for i in 0..corners {
            let corner = if forward { start + 1 + i } else { start + n - i };
            self.point(ring[corner % n], turn, points, turns);
        }
    }
}

pub(super) fn turn(line: i64) -> u32 {
    (line + TURN_ZERO).rem_euclid(1 << 31) as u32
}

fn cumulative(ring: &Ring) -> Vec<f64> {
    let mut sum = 0.0;
    let mut out = vec![0.0];
    out.extend(ring.edges().map(|(a, b)| {
        sum += a.distance(b);
        sum
    }));
    out
}
