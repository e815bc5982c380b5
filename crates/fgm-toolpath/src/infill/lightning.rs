//! Branches that hold up what is above them and nothing else.
//!
//! Lines lie on a lattice that is the same in all layers: branches, and in the other direction trunks
//! four times as far apart, on which they end; each of these ends on lines that are four times as far
//! apart again, and so on; whatever meets a wall ends there. Right below a roof all of them are printed.
//! Going down, each is cut off from its tip (the middle between the two lines or walls that it ends on)
//! by as much as the layer is deeper below the roof: going up, every branch grows out of what carries
//! it at 45 degrees. A trunk stays as far as its branches need it.
//!
//! A layer asks only how deep below a roof each place is, so layers can be made in any sequence.

use fgm_core::{PlanarField, Point2, Polygon};

use super::{
    InfillOptions,
    join::turn,
    scan::{Crossing, Lattice},
};
use crate::{Inset, Path};

/// How much farther apart the lines of each level are than those that end on them.
const RATIO: i64 = 4;
/// Levels, which alternate between two directions.
const LEVELS: usize = 4;
/// Lines shorter than this, in widths of a bead, are left out.
const SHORTEST: f64 = 2.0;
/// Distance of the places at which the depth is looked at, in widths of a bead.
const STEP: f64 = 2.0;

/// Fills a region with branches that hold up the roofs above it.
///
/// `depth` says how far above this layer's top the next roof begins, mm; not below 0, and values
/// above `reach` count as `reach`: deeper down, branches stay as they are there. All of them, right
/// below a roof, have `options.density`; `options.layer` is not looked at, since branches stand
/// on those of the layer below.
pub fn infill_lightning(
    region: &[Polygon],
    depth: &dyn PlanarField,
    reach: f64,
    options: &InfillOptions,
    inset: &dyn Inset,
) -> Vec<Path> {
    if !options.is_valid() {
        return Vec::new();
    }
    let centres = inset.inset(region, 0.5 * options.spacing());
    let mut trees = Trees::new(&centres, depth, reach, options);
    for level in 0..LEVELS {
        for chord in 0..trees.chords[level % 2].len() {
            if trees.level(level % 2, chord) == level {
                trees.grow(level, chord);
            }
        }
    }
    trees.out
}

/// A roof right above.
pub(super) struct Roof;

impl PlanarField for Roof {
    fn eval(&self, _: Point2) -> f64 {
        0.0
    }
}

/// A line of the lattice inside the region.
struct Chord {
    line: i64,
    from: f64,
    to: f64,
    /// Where branches end on it, and by how much what they hold up lies farther from there than
    /// above it, mm.
    loads: Vec<(f64, f64)>,
}

/// What a stretch of a line ends on.
#[derive(Clone, Copy)]
struct Root {
    at: f64,
    /// The line that carries it, where it is no wall.
    chord: Option<usize>,
}

struct Trees<'a> {
    /// Of the lines of even and of odd levels.
    lattices: [Lattice; 2],
    chords: [Vec<Chord>; 2],
    depth: &'a dyn PlanarField,
    reach: f64,
    options: &'a InfillOptions,
    points: Vec<Point2>,
    values: Vec<f64>,
    out: Vec<Path>,
}

impl<'a> Trees<'a> {
    fn new(
        centres: &[Polygon],
        depth: &'a dyn PlanarField,
        reach: f64,
        options: &'a InfillOptions,
    ) -> Self {
        // All of them together have the density.
        let pitch = options.pitch() * (1.0 + 1.0 / RATIO as f64);
        let quarter = std::f64::consts::FRAC_PI_2;
        let lattices = [
            Lattice { angle: options.angle, pitch, phase: 0.0 },
            Lattice { angle: options.angle + quarter, pitch: RATIO as f64 * pitch, phase: 0.0 },
        ];
        let chords = lattices.map(|lattice| {
            let crossings = lattice.crossings(centres.iter().flat_map(Polygon::rings));
            let chord = |pair: &[Crossing]| Chord {
                line: pair[0].line,
                from: pair[0].u,
                to: pair[1].u,
                loads: Vec::new(),
            };
            crossings.chunks_exact(2).map(chord).collect()
        });
        let (points, values, out) = (Vec::new(), Vec::new(), Vec::new());
        Self { lattices, chords, depth, reach, options, points, values, out }
    }

    /// The level of a line: every 16th of a direction is two levels up.
    fn level(&self, side: usize, chord: usize) -> usize {
        let up = self.chords[side][chord].line.rem_euclid(RATIO * RATIO) == 0;
        side + if up { 2 } else { 0 }
    }

    /// Prints what is needed of a line, and tells the lines that it ends on.
    fn grow(&mut self, level: usize, chord: usize) {
        let side = level % 2;
        let loads = std::mem::take(&mut self.chords[side][chord].loads);
        let roots = self.roots(level, chord);
        let line = self.chords[side][chord].line;
        let mut kept: Option<(f64, f64)> = None;
        for pair in roots.windows(2) {
            let middle = 0.5 * (pair[0].at + pair[1].at);
            for (root, way) in [(pair[0], 1.0), (pair[1], -1.0)] {
                let half = (middle - root.at).abs();
                let Needed { tip, load } = self.needed(side, line, root.at, way, half, &loads);
                if let Some(carrier) = root.chord {
                    let at = self.lattices[side].v(line) * if side == 0 { 1.0 } else { -1.0 };
                    self.chords[1 - side][carrier].loads.push((at, load));
                }
                if tip >= 0.0 {
                    let end = root.at + way * tip;
                    let (from, to) = (root.at.min(end), root.at.max(end));
                    match &mut kept {
                        Some(last) if from - last.1 < self.options.width => last.1 = to,
                        _ => {
                            let last = kept.replace((from, to));
                            self.print(side, line, last);
                        }
                    }
                }
            }
        }
        self.print(side, line, kept);
    }

    fn print(&mut self, side: usize, line: i64, stretch: Option<(f64, f64)>) {
        let Some((from, to)) = stretch else { return };
        if to - from < SHORTEST * self.options.width {
            return;
        }
        let point =
            |u| self.lattices[side].point(&Crossing { line, u, ring: Crossing::INSIDE, at: 0.0 });
        self.out.push(Path {
            points: vec![point(from), point(to)],
            closed: false,
            role: self.options.role,
            width: self.options.width,
            turn: turn(line),
            turns: Vec::new(),
        });
    }

    /// What a line ends on, from one wall to the other.
    fn roots(&self, level: usize, chord: usize) -> Vec<Root> {
        let (side, other) = (level % 2, 1 - level % 2);
        let Chord { line, from, to, .. } = self.chords[side][chord];
        let across = self.lattices[side].v(line);
        // Along a line of the other direction; and the sign by which its number runs along this one.
        let (along, sign) = if side == 0 { (across, -1.0) } else { (-across, 1.0) };
        let mut roots = vec![Root { at: from, chord: None }];
        let pitch = self.lattices[other].pitch;
        let (a, b) = (sign * from / pitch, sign * to / pitch);
        let lines = a.min(b).ceil() as i64..=a.max(b).floor() as i64;
        let mut carriers: Vec<Root> = lines
            .filter_map(|number| {
                let chord = self.chord_at(other, number, along)?;
                let carries = self.level(other, chord) > level;
                let at = sign * number as f64 * pitch;
                (carries && at > from && at < to).then_some(Root { at, chord: Some(chord) })
            })
            .collect();
        if sign < 0.0 {
            carriers.reverse();
        }
        roots.extend(carriers);
        roots.push(Root { at: to, chord: None });
        roots
    }

    /// The part of a line that a place lies in.
    fn chord_at(&self, side: usize, line: i64, at: f64) -> Option<usize> {
        let chords = &self.chords[side];
        let after = chords.partition_point(|c| (c.line, c.from) <= (line, at));
        let chord = &chords[after.checked_sub(1)?];
        (chord.line == line && at <= chord.to).then_some(after - 1)
    }

    /// How much is needed of the half of a stretch that ends on a root.
    fn needed(
        &mut self,
        side: usize,
        line: i64,
        root: f64,
        way: f64,
        half: f64,
        loads: &[(f64, f64)],
    ) -> Needed {
        let step = STEP * self.options.width;
        let parts = (half / step).ceil().clamp(1.0, 1e6);
        let place = |i: usize| half * i as f64 / parts;
        let lattice = &self.lattices[side];
        self.points.clear();
        self.points.extend((0..=parts as usize).map(|i| {
            let u = root + way * place(i);
            lattice.point(&Crossing { line, u, ring: Crossing::INSIDE, at: 0.0 })
        }));
        self.values.clear();
        self.values.resize(self.points.len(), 0.0);
        self.depth.eval_into(&self.points, &mut self.values);
        let mut needed = Needed { tip: f64::NEG_INFINITY, load: f64::NEG_INFINITY };
        for (i, depth) in self.values.iter().enumerate() {
            let left = place(i) - depth.clamp(0.0, self.reach);
            needed.tip = needed.tip.max(left);
            needed.load = needed.load.max(left);
        }
        for &(at, load) in loads {
            let distance = way * (at - root);
            if (0.0..=half).contains(&distance) {
                needed.tip = needed.tip.max(distance + load.min(0.0));
                needed.load = needed.load.max(distance + load);
            }
        }
        needed
    }
}

/// What a half of a stretch has to hold up.
struct Needed {
    /// How far it reaches from its root, mm; not at all below 0.
    tip: f64,
    /// By how much what it holds up is farther from the root than above it, mm.
    load: f64,
}

#[cfg(test)]
#[path = "lightning_tests.rs"]
mod tests;
