//! How far the lines over a region reach from hold to hold, by direction.

use std::f64::consts::PI;

use fgm_core::{Bounds2, Point2, Polygon};

use super::BridgeOptions;
use crate::support::Support;

/// Directions tried besides those of the longest edges.
const DIRECTIONS: u32 = 36;
/// Longest edges whose directions, and normals, are tried.
const EDGES: usize = 6;
/// Lines across a region, at most, that are looked at for a direction.
const LINES: f64 = 64.0;
/// Parts of the border that are told apart, at most but for one an edge.
const PARTS: f64 = 400.0;
/// What a direction may hold less than the best one and still be taken for its shorter spans.
const NEARLY: f64 = 0.05;
/// How much more lines may sag in the direction of an edge, or across it, than in another one.
const ALIKE: f64 = 1.1;

/// A region's border in short parts, each with whether a line that ends there is held.
pub(super) struct Spans {
    parts: Vec<(Point2, Point2, bool)>,
    directions: Vec<f64>,
    width: f64,
}

/// A direction, and how far its lines reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Across {
    /// Radians from +x.
    pub(super) angle: f64,
    /// How long lines sag as much as those that are held at both ends, mm: the cubic mean.
    pub(super) span: f64,
    /// The share of the lines that is held at both ends.
    pub(super) held: f64,
}

/// What a direction comes to.
#[derive(Clone, Copy)]
struct Tally {
    /// Length of the lines, and of those held at both ends.
    all: f64,
    held: f64,
    /// The sum of these lengths' fourth powers: a line sags by the fourth power of its span.
    sag: f64,
}

impl Spans {
    pub(super) fn new(region: &Polygon, support: &Support, options: &BridgeOptions) -> Self {
        let around: f64 = region.rings().map(fgm_core::Ring::length).sum();
        let longest = (around / PARTS).max(options.width);
        let steps = (options.reach / options.width).ceil().clamp(1.0, 64.0) as u32;
        let mut parts = Vec::new();
        let mut edges: Vec<(f64, f64)> = Vec::new();
        for (a, b) in region.rings().flat_map(fgm_core::Ring::edges) {
            let length = a.distance(b);
            if length <= 0.0 {
                continue;
            }
            edges.push((length, (b - a).to_angle().rem_euclid(PI)));
            let outward = -(b - a).perp() / length;
            let count = (length / longest).ceil().max(1.0);
            for i in 0..count as u32 {
                let at = |t: f64| a.lerp(b, t / count);
                let (from, to) = (at(f64::from(i)), at(f64::from(i + 1)));
                let middle = 0.5 * (from + to);
                let held = (0..=steps).any(|k| {
                    let far = 0.5 * options.width + options.reach * f64::from(k) / f64::from(steps);
                    support.contains(middle + outward * far)
                });
                parts.push((from, to, held));
            }
        }
        edges.sort_by(|a, b| b.0.total_cmp(&a.0));
        let along = edges.iter().take(EDGES).flat_map(|e| [e.1, (e.1 + 0.5 * PI).rem_euclid(PI)]);
        let even = (0..DIRECTIONS).map(|i| PI * f64::from(i) / f64::from(DIRECTIONS));
        Self { parts, directions: along.chain(even).collect(), width: options.width }
    }

    /// The best direction; none where no direction has `least` of its lines held.
    pub(super) fn best(&self, least: f64) -> Option<Across> {
        if !self.parts.iter().any(|part| part.2) {
            return None;
        }
        let tallies: Vec<Tally> = self.directions.iter().map(|&d| self.tally(d)).collect();
        let share = |t: &Tally| t.held / t.all.max(f64::MIN_POSITIVE);
        let most = tallies.iter().map(share).fold(0.0, f64::max);
        if most < least {
            return None;
        }
        let sag = |t: &Tally| t.sag / t.held.max(f64::MIN_POSITIVE);
        let good = || tallies.iter().zip(&self.directions).filter(|t| share(t.0) >= most - NEARLY);
        let least = good().map(|(t, _)| sag(t)).fold(f64::INFINITY, f64::min);
        // The edges' own directions come first.
        let best = good().find(|(t, _)| sag(t) <= ALIKE * least);
        best.map(|(t, &angle)| Across { angle, span: sag(t).cbrt(), held: share(t) })
    }

    fn tally(&self, direction: f64) -> Tally {
        let turn = Point2::from_angle(-direction);
        let turned =
            || self.parts.iter().map(|&(a, b, held)| (turn.rotate(a), turn.rotate(b), held));
        let bounds = Bounds2::of(turned().flat_map(|(a, b, _)| [a, b]));
        let (low, height) = (bounds.min.y, bounds.size().y);
        let count = (height / self.width).ceil().clamp(1.0, LINES);
        let pitch = height / count;
        let mut ends: Vec<(u32, f64, bool)> = Vec::new();
        for (a, b, held) in turned() {
            let (from, to) = (a.y.min(b.y), a.y.max(b.y));
            // Lines lie in the middle of their stripes.
            let first = ((from - low) / pitch - 0.5).ceil().max(0.0) as u32;
            for line in first..count as u32 {
                let y = low + (f64::from(line) + 0.5) * pitch;
                if y >= to {
                    break;
                }
                ends.push((line, a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), held));
            }
        }
        ends.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut tally = Tally { all: 0.0, held: 0.0, sag: 0.0 };
        for line in ends.chunk_by(|a, b| a.0 == b.0) {
            for pair in line.chunks_exact(2) {
                let length = pair[1].1 - pair[0].1;
                tally.all += length;
                if pair[0].2 && pair[1].2 {
                    tally.held += length;
                    tally.sag += length.powi(4);
                }
            }
        }
        tally
    }
}
