//! Where a shape begins and ends, found on its field.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use fgm_core::{Bounds3, Field, Point3};
use glam::DMat3;

/// How far a function without a box is searched for its inside, mm.
pub(crate) const REACH: f64 = 2048.0;
/// What is not searched further, as a share of the greatest side: a tip thinner than this may be
/// missed.
const FINE: f64 = 1.0 / 512.0;
/// Cells looked at for each of the six sides.
const BUDGET: usize = 20_000;

/// The box of a function's inside that is far from tight, if the inside ends within [`REACH`] of
/// the origin: the least cube of half sides 0.5, 1, 2, 4 ... mm around which nothing is inside, on
/// to the reach. Empty where nothing is inside at all.
pub(crate) fn enclose(field: &dyn Field) -> Option<Bounds3> {
    let cube = |half: f64| Bounds3::new(Point3::splat(-half), Point3::splat(half));
    let mut found = None;
    let mut half = REACH;
    while half >= 1.0 {
        // The six plates between this cube and the one of half its size.
        let inner = half * 0.5;
        let mut budget = 4000;
        let plates = (0..6).map(|side| {
            let mut plate = cube(half);
            let axis = side / 2;
            if side % 2 == 0 {
                plate.max[axis] = -inner;
            } else {
                plate.min[axis] = inner;
            }
            plate
        });
        for plate in plates {
            if !is_outside(field, &plate, half / 64.0, &mut budget) {
                return found;
            }
        }
        found = Some(cube(inner));
        half = inner;
    }
    let (last, mut budget) = (cube(half), 4000);
    if is_outside(field, &last, half / 64.0, &mut budget) { Some(Bounds3::EMPTY) } else { found }
}

/// Whether the field is proven positive in a box, by cells no smaller than `least`.
fn is_outside(field: &dyn Field, cell: &Bounds3, least: f64, budget: &mut usize) -> bool {
    if field.bounds(cell).lo > 0.0 {
        return true;
    }
    if *budget == 0 || field.eval(cell.center()) <= 0.0 || cell.size().max_element() <= least {
        return false;
    }
    *budget -= 1;
    halves(cell, None).iter().all(|half| is_outside(field, half, least, budget))
}

/// The least box around the inside (field at or below 0) within `outer`; none where nothing is
/// inside.
///
/// Each side is found to 1e-9 of the box's size where its outermost point is the highest of a
/// smooth or flat part; tips thinner than 1/512 of the box may be cut off.
pub(crate) fn tighten(field: &dyn Field, outer: &Bounds3) -> Option<Bounds3> {
    let mut bounds = *outer;
    for axis in [2, 0, 1] {
        for up in [false, true] {
            let side = Side { field, outer: bounds, axis, up };
            let end = side.end()?;
            if up { bounds.max[axis] = end } else { bounds.min[axis] = end }
        }
    }
    (!bounds.is_empty()).then_some(bounds)
}

/// The search for the outermost inside point along one axis.
struct Side<'a> {
    field: &'a dyn Field,
    outer: Bounds3,
    axis: usize,
    up: bool,
}

/// A box, first in line when it reaches out furthest.
struct Cell {
    reach: f64,
    bounds: Bounds3,
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        // Among equals the smaller first, so that one of them is searched to its end.
        let size = |c: &Self| c.bounds.size().max_element();
        self.reach.total_cmp(&other.reach).then(size(other).total_cmp(&size(self)))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl Side<'_> {
    /// How far out a coordinate is.
    fn out(&self, coordinate: f64) -> f64 {
        if self.up { coordinate } else { -coordinate }
    }

    fn cell(&self, bounds: Bounds3) -> Cell {
        let reach = if self.up { bounds.max[self.axis] } else { -bounds.min[self.axis] };
        Cell { reach, bounds }
    }

    /// The outermost coordinate; none where nothing was found inside.
    fn end(&self) -> Option<f64> {
        let size = self.outer.size().max_element();
        let fine = size * FINE;
        let mut cells = BinaryHeap::from([self.cell(self.outer)]);
        let mut best: Option<f64> = None;
        // The outermost cell that could not be ruled out and has no inside point at its middle.
        let mut unsure: Option<f64> = None;
        let mut descents = 200;
        for _ in 0..BUDGET {
            let Some(cell) = cells.pop() else { break };
            if best.is_some_and(|best| cell.reach <= best + fine) {
                break;
            }
            let small = cell.bounds.size().max_element() <= fine;
            let center = cell.bounds.center();
            let beyond = best.is_none_or(|best| self.out(center[self.axis]) > best);
            let mut inside = None;
            if beyond && self.field.eval(center) <= 0.0 {
                inside = Some(center);
            } else if (best.is_none() || small) && descents > 0 {
                // The middle misses what is thinner than the cell.
                descents -= 1;
                inside = self.inside_of(&cell.bounds);
            }
            if let Some(p) = inside {
                best = Some(self.climb(p).max(best.unwrap_or(f64::NEG_INFINITY)));
            }
            if small {
                unsure.get_or_insert(cell.reach);
                continue;
            }
            for half in halves(&cell.bounds, Some(self.axis)) {
                if self.field.bounds(&half).lo <= 0.0 {
                    cells.push(self.cell(half));
                }
            }
        }
        // A sheet thinner than the cells has no middle inside: then the cell's end is the answer.
        let left = cells.peek().map(|cell| cell.reach);
        // Adding 0 makes a 0 of a -0.
        best.or(unsure).or(left).map(|end| if self.up { end } else { 0.0 - end })
    }

    /// How far out inside points lead on from the inside point `p`: outwards from plane to plane
    /// across the axis, by bisection.
    fn climb(&self, mut p: Point3) -> f64 {
        let size = self.outer.size().max_element();
        let mut beyond =
            if self.up { self.outer.max[self.axis] } else { self.outer.min[self.axis] };
        if let Some(q) = self.inside_at(p, beyond) {
            return self.out(q[self.axis]);
        }
        while (beyond - p[self.axis]).abs() > 1e-11 * size {
            let middle = 0.5 * (p[self.axis] + beyond);
            // Far from the origin the numbers are further apart than that.
            if middle == beyond || middle == p[self.axis] {
                break;
            }
            match self.inside_at(p, middle) {
                Some(q) => p = q,
                None => beyond = middle,
            }
        }
        // A flat end sits on the number itself: 0 rather than -2e-12.
        let near = (beyond * 1e6).round() * 1e-6;
        self.out(if (near - beyond).abs() < 1e-9 * size { near } else { beyond })
    }

    /// A point inside on the plane across the axis at `coordinate`, looked for downhill from `p`.
    ///
    /// Where the way down ends on a ridge, as it does near edges and corners, a search that is exact
    /// for convex shapes goes on around that place.
    fn inside_at(&self, mut p: Point3, coordinate: f64) -> Option<Point3> {
        p[self.axis] = coordinate;
        let stuck = match downhill(self.field, p, &self.outer, Some(self.axis), 1e-4) {
            Ok(inside) => return Some(inside),
            Err(stuck) => stuck,
        };
        let (u, v) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let reach = self.outer.size() / 8.0;
        let mut inside = None;
        least(stuck[u] - reach[u], stuck[u] + reach[u], |at_u| {
            least(stuck[v] - reach[v], stuck[v] + reach[v], |at_v| {
                let mut q = stuck;
                (q[u], q[v]) = (at_u, at_v);
                let value = self.field.eval(q);
                if value <= 0.0 && self.outer.contains(q) {
                    inside = Some(q);
                }
                // Once a point is found the searches are cut short.
                if inside.is_some() { f64::NEG_INFINITY } else { value }
            })
        });
        inside
    }

    /// A point inside in a cell, looked for downhill from its middle.
    fn inside_of(&self, cell: &Bounds3) -> Option<Point3> {
        downhill(self.field, cell.center(), cell, None, 1e-6).ok()
    }
}

/// Along the axes and the diagonals.
const DIRECTIONS: [[f64; 3]; 26] = directions();
/// How often the directions are turned before the step is halved. A ridge, where the greatest of
/// several values changes from one to another, leads down in a narrow range of directions.
const TURNS: usize = 4;

/// The most moves downhill: on a curved ridge they become ever shorter.
const MAX_MOVES: usize = 500;

const fn directions() -> [[f64; 3]; 26] {
    let step = [-1.0, 0.0, 1.0];
    let mut all = [[0.0; 3]; 26];
    let mut i = 0;
    while i < 27 {
        // The 13th of the 27 is no step at all.
        if i != 13 {
            all[i - (i > 13) as usize] = [step[i % 3], step[i / 3 % 3], step[i / 9]];
        }
        i += 1;
    }
    all
}

/// The least value of a function of one number that falls and then rises, by golden sections. Ends
/// at once at a value of negative infinity.
fn least(mut a: f64, mut b: f64, mut value: impl FnMut(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut x, mut y) = (b - golden * (b - a), a + golden * (b - a));
    let (mut at_x, mut at_y) = (value(x), value(y));
    for _ in 0..34 {
        if at_x.min(at_y) == f64::NEG_INFINITY {
            break;
        }
        if at_x < at_y {
            (b, y, at_y) = (y, x, at_x);
            x = b - golden * (b - a);
            at_x = value(x);
        } else {
            (a, x, at_x) = (x, y, at_y);
            y = a + golden * (b - a);
            at_y = value(y);
        }
    }
    at_x.min(at_y)
}

/// A point where the field is not above 0, looked for from `p` within these bounds, and on the plane
/// across `fixed` if there is one: by steps downhill that are halved where none leads down, to a
/// share `finest` of the bounds. Where there is none, the lowest point found.
fn downhill(
    field: &dyn Field,
    mut p: Point3,
    within: &Bounds3,
    fixed: Option<usize>,
    finest: f64,
) -> Result<Point3, Point3> {
    let mut value = field.eval(p);
    let size = within.size();
    let axis = fixed.map_or(Point3::splat(1.0 / 3.0_f64.sqrt()), |k| Point3::AXES[k]);
    let mut step = 1.0 / 16.0;
    let mut moves = 0;
    while value > 0.0 || value.is_nan() {
        let mut moved = false;
        for turn in 0..TURNS {
            let angle = turn as f64 * std::f64::consts::FRAC_PI_4 / TURNS as f64;
            let turn = DMat3::from_axis_angle(axis, angle);
            for to in DIRECTIONS.iter().filter(|to| fixed.is_none_or(|k| to[k] == 0.0)) {
                let q = p + turn * Point3::from_array(*to) * size * step;
                let q = q.clamp(within.min, within.max);
                let there = field.eval(q);
                if there < value {
                    (p, value, moved) = (q, there, true);
                }
            }
            if moved {
                break;
            }
        }
        moves += usize::from(moved);
        if !moved {
            step *= 0.5;
        }
        if step < finest || moves > MAX_MOVES {
            return Err(p);
        }
    }
    Ok(p)
}

/// A box cut across its longest side. One side may be favoured, to be cut sooner: thin plates across
/// an axis are soon told to be outside.
fn halves(cell: &Bounds3, favoured: Option<usize>) -> [Bounds3; 2] {
    let mut size = cell.size();
    if let Some(axis) = favoured {
        size[axis] *= 16.0;
    }
    let axis = size.max_position();
    let (mut low, mut high) = (*cell, *cell);
    let middle = cell.center()[axis];
    low.max[axis] = middle;
    high.min[axis] = middle;
    [low, high]
}
