//! Straight lines as dense as a field asks, place by place.
//!
//! The lines are those of a solid filling, each with a rank: every other line, then every other of
//! those between, and so on. A line is printed where the density is above its rank, so that lines
//! of a thinner filling are among those of a denser one and end where the density falls.

use fgm_core::{Bounds2, PlanarField, Point2, Polygon, Ring};

use super::{
    InfillOptions, join,
    scan::{Crossing, Lattice},
};
use crate::{Inset, Path, ToolpathError};

/// Lines after which the ranks repeat; a power of two. Densities are told apart by its inverse.
const RANKS: u16 = 1024;
/// How closely the end of a line is found, mm.
const PRECISION: f64 = 0.01;
/// Shorter lines, and shorter gaps in a line, are left out, in spacings.
const SHORTEST: f64 = 3.0;
/// The most lines of a solid filling between two that are joined.
const LONGEST_STEP: i64 = 32;

/// Fills a region with lines whose local density is a field's value, the share of the volume:
/// taken as 0 below, as 1 above.
///
/// By `options.pattern` of straight lines (rectilinear, aligned, grid or triangles; rectilinear in
/// place of others), all lying on the lattice of a solid filling; `options.density` is not looked
/// at. The field is looked at every `step` mm along the lines: lines begin and end where it
/// crosses their rank. Over any neighbouring lines of a solid filling the volume is the field's to
/// that of three lines; what joins the lines along the border comes on top. Lines and gaps of less
/// than three spacings are left out.
///
/// # Errors
/// [`ToolpathError::Density`] where the field is not a number.
pub fn infill_graded(
    region: &[Polygon],
    density: &dyn PlanarField,
    step: f64,
    options: &InfillOptions,
    inset: &dyn Inset,
) -> Result<Vec<Path>, ToolpathError> {
    let options = InfillOptions { density: 1.0, ..*options };
    if !(options.is_valid() && step > 0.0 && step.is_finite()) {
        return Ok(Vec::new());
    }
    let centres = inset.inset(region, 0.5 * options.spacing());
    let rings: Vec<&Ring> = centres.iter().flat_map(Polygon::rings).collect();
    let beads = join::Beads { width: options.width, spacing: None, role: options.role };
    let mut laid = join::Laid::default();
    let mut out = Vec::new();
    for lattice in options.pattern.families(&options).lattices(options.spacing()) {
        let mut thinner = Thinner {
            density,
            lattice: &lattice,
            most: density.bounds(&bounds(&centres)).hi,
            step,
            least: SHORTEST * options.spacing(),
            points: Vec::new(),
            values: Vec::new(),
            kept: Vec::new(),
        };
        for line in lattice.crossings(rings.iter().copied()).chunks_exact(2) {
            thinner.line(&line[0], &line[1], options.z)?;
        }
        let kept = thinner.kept;
        out.extend(join::joined(&rings, &kept, &lattice, &beads, LONGEST_STEP, &mut laid));
    }
    Ok(out)
}

fn bounds(region: &[Polygon]) -> Bounds2 {
    region.iter().fold(Bounds2::EMPTY, |all, polygon| all.union(&polygon.bounds()))
}

/// The density above which a line is printed: its number with the bits in reverse.
fn threshold(line: i64) -> f64 {
    let number = line.rem_euclid(i64::from(RANKS)) as u16;
    let rank = number.reverse_bits() >> (RANKS.leading_zeros() + 1);
    (f64::from(rank) + 0.5) / f64::from(RANKS)
}

/// Keeps of lines what the density asks for.
struct Thinner<'a> {
    density: &'a dyn PlanarField,
    lattice: &'a Lattice,
    /// No density is greater.
    most: f64,
    step: f64,
    /// The shortest line and gap, mm.
    least: f64,
    points: Vec<Point2>,
    values: Vec<f64>,
    /// In pairs.
    kept: Vec<Crossing>,
}

impl Thinner<'_> {
    /// A line from one crossing to another; `z` is for the error.
    fn line(&mut self, from: &Crossing, to: &Crossing, z: f64) -> Result<(), ToolpathError> {
        let threshold = threshold(from.line);
        if self.most <= threshold {
            return Ok(());
        }
        self.sample(from, to);
        if let Some(i) = self.values.iter().position(|value| value.is_nan()) {
            let Point2 { x, y } = self.points[i];
            return Err(ToolpathError::Density { x, y, z });
        }
        let first = self.kept.len();
        let parts = self.values.len() - 1;
        let u = |i: usize| from.u + (to.u - from.u) * i as f64 / parts as f64;
        let mut start = (self.values[0] > threshold).then_some(*from);
        for i in 0..parts {
            let (here, next) = (self.values[i] > threshold, self.values[i + 1] > threshold);
            if here != next {
                let end = self.end(from.line, u(i), u(i + 1), here, threshold);
                match start.take() {
                    Some(start) => self.keep(first, start, end),
                    None => start = Some(end),
                }
            }
        }
        if let Some(start) = start {
            self.keep(first, start, *to);
        }
        self.drop_short(first);
        Ok(())
    }

    fn sample(&mut self, from: &Crossing, to: &Crossing) {
        // At most a million samples, whatever the step.
        let parts = ((to.u - from.u) / self.step).ceil().clamp(1.0, 1e6) as usize;
        let (a, b) = (self.lattice.point(from), self.lattice.point(to));
        self.points.clear();
        self.points.extend((0..=parts).map(|i| a.lerp(b, i as f64 / parts as f64)));
        self.values.clear();
        self.values.resize(parts + 1, 0.0);
        self.density.eval_into(&self.points, &mut self.values);
    }

    /// Where the density passes the threshold between two places of a line; `above` at the first.
    fn end(&self, line: i64, mut a: f64, mut b: f64, above: bool, threshold: f64) -> Crossing {
        let at = |u: f64| Crossing { line, u, ring: Crossing::INSIDE, at: 0.0 };
        while b - a > PRECISION {
            let middle = 0.5 * (a + b);
            let value = self.density.eval(self.lattice.point(&at(middle)));
            if (value > threshold) == above { a = middle } else { b = middle }
        }
        at(0.5 * (a + b))
    }

    /// Adds a stretch, joined with the one before on its line (from `first` on) where they are
    /// near.
    fn keep(&mut self, first: usize, start: Crossing, end: Crossing) {
        match self.kept[first..].last_mut() {
            Some(last) if start.u - last.u < self.least => *last = end,
            _ => self.kept.extend([start, end]),
        }
    }

    /// Drops short stretches from `first` on, but for whole lines.
    fn drop_short(&mut self, first: usize) {
        let mut to = first;
        for i in (first..self.kept.len()).step_by(2) {
            let (start, end) = (self.kept[i], self.kept[i + 1]);
            let whole = start.is_on_border() && end.is_on_border();
            if whole || end.u - start.u >= self.least {
                (self.kept[to], self.kept[to + 1]) = (start, end);
                to += 2;
            }
        }
        self.kept.truncate(to);
    }
}

#[cfg(test)]
#[path = "graded_tests.rs"]
mod tests;
