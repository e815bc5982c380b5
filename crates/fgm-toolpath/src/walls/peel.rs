//! Taking a region apart from its border inward: loops where two beads fit side by side, thin
//! rests where not.

use fgm_core::Polygon;

use super::split::split;
use crate::{Inset, gap::shaved, inset::simplify, region};

/// Half the thickness, in line spacings, below which a region takes no loop where one bead is to fit
/// inside the last: the loop leaves at least 0.6 spacings between its inner sides, room for a bead
/// of the least width, and what takes no loop is at most 2.6 spacings thick, filled by one or two
/// beads.
pub(crate) const HALF_LOOP: f64 = 1.3;
/// Shares of that to try in turn: where sides run along at just this distance the cuts may not work
/// out, and a little more or less settles it.
const OTHERWISE: [f64; 4] = [1.0, 0.95, 1.06, 0.9];
/// How far a thin rest stands off the beads beside it, mm, so that rounding makes no slivers.
const STAND_OFF: f64 = 1e-2;

/// The least area of a thin rest, in squares of the spacing.
const LEAST_THIN: f64 = 0.1;

/// How far a border may be moved by dropping vertices before it is looked at, mm.
const SIMPLIFY: f64 = 5e-3;

/// A region taken apart.
#[derive(Debug, Default)]
pub(crate) struct Peel {
    /// Loops, as the regions they run around, from outside to inside: the centre lines of beads.
    pub(crate) loops: Vec<Vec<Polygon>>,
    /// What is too thin for loops: simple polygons, for [`crate::gap::fill_thin`].
    pub(crate) thin: Vec<Polygon>,
    /// What lies inside the last loops.
    pub(crate) rest: Vec<Polygon>,
}

/// How loops are peeled off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peeling {
    /// Distance between loops, mm.
    pub(crate) spacing: f64,
    /// Half the thickness below which a region takes no loop, in spacings.
    pub(crate) half_loop: f64,
    /// The most loops.
    pub(crate) most: usize,
}

/// Peels loops of beads a spacing wide off a region, each half a spacing inside the border of what
/// is left.
pub(crate) fn peel(region: &[Polygon], peeling: Peeling, inset: &dyn Inset) -> Peel {
    let Peeling { spacing, half_loop, most } = peeling;
    let mut out = Peel::default();
    if !(spacing > 0.0 && spacing.is_finite() && half_loop >= 1.0) {
        return out;
    }
    let mut now = region.to_vec();
    for _ in 0..most {
        if now.is_empty() {
            return out;
        }
        let mut loops = Vec::new();
        let mut next = Vec::new();
        for polygon in now {
            step(&polygon, peeling, inset, &mut loops, &mut next, &mut out.thin);
        }
        if !loops.is_empty() {
            out.loops.push(loops);
        }
        now = next;
    }
    out.rest = now;
    out
}

fn step(
    polygon: &Polygon,
    peeling: Peeling,
    inset: &dyn Inset,
    loops: &mut Vec<Polygon>,
    next: &mut Vec<Polygon>,
    thin: &mut Vec<Polygon>,
) {
    let spacing = peeling.spacing;
    let half = peeling.half_loop * spacing;
    let Some(polygon) = simplify::polygon(polygon, SIMPLIFY) else { return };
    let splits = || OTHERWISE.iter().find_map(|share| split(&polygon, share * half));
    if let Some(split) = splits() {
        // What needed no cut keeps its shape.
        let clear = if split.whole { 0.0 } else { spacing };
        for polygon in split.thick {
            shell(polygon, spacing, clear, inset, loops, next);
        }
        let least = LEAST_THIN * spacing * spacing;
        thin.extend(split.thin.into_iter().filter(|p| p.area() > least));
        return;
    }
    slow(polygon, peeling, inset, loops, next, thin);
}

/// One loop of what is thick throughout; `clear` is how far that is still to be checked.
fn shell(
    polygon: Polygon,
    spacing: f64,
    clear: f64,
    inset: &dyn Inset,
    loops: &mut Vec<Polygon>,
    next: &mut Vec<Polygon>,
) {
    if let Some(rings) = inset.nested(&polygon, clear, &[0.5 * spacing, spacing])
        && let Ok([centre, inner]) = <[Polygon; 2]>::try_from(rings)
    {
        loops.push(centre);
        next.push(inner);
        return;
    }
    let centre = inset.inset(&[polygon], 0.5 * spacing);
    next.extend(inset.inset(&centre, 0.5 * spacing));
    loops.extend(centre);
}

/// The same by offsets and booleans alone, for borders that cuts cannot handle.
fn slow(
    polygon: Polygon,
    peeling: Peeling,
    inset: &dyn Inset,
    loops: &mut Vec<Polygon>,
    next: &mut Vec<Polygon>,
    thin: &mut Vec<Polygon>,
) {
    let spacing = peeling.spacing;
    let half = peeling.half_loop * spacing;
    let polygon = [polygon];
    let mut core = inset.inset(&polygon, half);
    if region::area(&polygon) > 40.0 * spacing * spacing {
        // Lumps in something long and thin, hardly thicker than the rest, are not worth a loop.
        core.retain(|lump| lump.outer.length() > 6.0 * spacing);
    }
    if core.is_empty() {
        thin.extend(polygon);
        return;
    }
    // Grown back the core would have mitred corners where the border is round, so it only says
    // where the loops run; they keep their distance from the true border.
    let fits = inset.inset(&core, 0.5 * spacing - half - STAND_OFF);
    let around = region::intersection(&inset.inset(&polygon, 0.5 * spacing), &fits);
    // Loops nearer to each other than a spacing become one.
    let covered = inset.inset(&around, -0.5 * spacing - STAND_OFF);
    let around = inset.inset(&covered, 0.5 * spacing + STAND_OFF);
    let left = region::difference(&polygon, &covered);
    let least = LEAST_THIN * spacing * spacing;
    let left: Vec<Polygon> = left.into_iter().filter(|p| p.area() > least).collect();
    thin.extend(shaved(&left, inset));
    next.extend(inset.inset(&around, 0.5 * spacing));
    loops.extend(around);
}
