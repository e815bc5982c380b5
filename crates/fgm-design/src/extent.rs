//! Where a shape begins and ends, found on its field.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use fgm_core::{Bounds3, Field, Point3};

/// How far a function without a box is searched for its inside, mm.
pub(crate) const REACH: f64 = 2048.0;
/// What is not searched further, as a share of the greatest side: a tip thinner than this may be
/// missed.
const FINE: f64 = 1.0 / 512.0;
/// Cells looked at for each of the six sides.
const BUDGET: usize = 20_000;

/// The box of a function's inside that is far from tight, if the inside ends within [`REACH`] of
/// the origin: the least of 1, 2, 4 ... mm around which nothing is inside, on to the reach.
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
    found
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
    halves(cell).iter().all(|half| is_outside(field, half, least, budget))
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
        for _ in 0..BUDGET {
            let Some(cell) = cells.pop() else { break };
            if best.is_some_and(|best| cell.reach <= best + fine) {
                break;
            }
            let center = cell.bounds.center();
            let beyond = best.is_none_or(|best| self.out(center[self.axis]) > best);
            if beyond && self.field.eval(center) <= 0.0 {
                best = Some(self.climb(center));
            }
            if cell.bounds.size().max_element() <= fine {
                if unsure.is_none()
                    && let Some(p) = self.inside_at(center, center[self.axis])
                {
                    best = Some(self.climb(p).max(best.unwrap_or(f64::NEG_INFINITY)));
                }
                unsure.get_or_insert(cell.reach);
                continue;
            }
            for half in halves(&cell.bounds) {
                if self.field.bounds(&half).lo <= 0.0 {
                    cells.push(self.cell(half));
                }
            }
        }
        // A sheet thinner than the cells has no middle inside: then the cell's end is the answer.
        let left = cells.peek().map(|cell| cell.reach);
        best.or(unsure).or(left).map(|end| if self.up { end } else { -end })
    }

    /// How far out inside points lead on from the inside point `p`: steps outwards, each with a
    /// search in the plane across for an inside point.
    fn climb(&self, mut p: Point3) -> f64 {
        let end = if self.up { self.outer.max[self.axis] } else { self.outer.min[self.axis] };
        if let Some(q) = self.inside_at(p, end) {
            return self.out(q[self.axis]);
        }
        let mut beyond = end;
        for _ in 0..44 {
            let middle = 0.5 * (p[self.axis] + beyond);
            match self.inside_at(p, middle) {
                Some(q) => p = q,
                None => beyond = middle,
            }
        }
        // A flat end sits on the number itself: 0 rather than -2e-12.
        let near = (beyond * 1e6).round() * 1e-6;
        let flat = (near - beyond).abs() < 1e-9 * self.outer.size().max_element();
        self.out(if flat { near } else { beyond })
    }

    /// A point inside on the plane across the axis at `coordinate`, looked for downhill from `p`.
    fn inside_at(&self, p: Point3, coordinate: f64) -> Option<Point3> {
        let mut p = p;
        p[self.axis] = coordinate;
        let mut value = self.field.eval(p);
        let size = self.outer.size();
        let mut step = 1.0 / 16.0;
        while value > 0.0 || value.is_nan() {
            let mut moved = false;
            for k in 1..3 {
                let across = (self.axis + k) % 3;
                for sign in [-1.0, 1.0] {
                    let mut q = p;
                    q[across] += sign * step * size[across];
                    let there = self.field.eval(q);
                    if there < value && self.outer.contains(q) {
                        (p, value, moved) = (q, there, true);
                    }
                }
            }
            if !moved {
                step *= 0.5;
                if step < 1e-8 {
                    return None;
                }
            }
        }
        Some(p)
    }
}

/// A box cut across its longest side.
fn halves(cell: &Bounds3) -> [Bounds3; 2] {
    let size = cell.size();
    let axis = size.max_position();
    let (mut low, mut high) = (*cell, *cell);
    let middle = cell.center()[axis];
    low.max[axis] = middle;
    high.min[axis] = middle;
    [low, high]
}
