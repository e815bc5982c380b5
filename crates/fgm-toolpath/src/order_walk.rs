//! Going from part to part of a layer as travels and changes of colour together cost least.
//!
//! A part is all of one colour and may be entered at one of several doors: a travelling salesman's
//! tour with a choice of places in each town. It is shortened from a tour that comes back to no
//! colour, by moving a part, moving a row of parts and turning a row round, until nothing gains.

use std::ops::Range;

use fgm_core::{Bounds2, ColorId, Point2};

use crate::order_color::Change;

/// Most parts that are moved together.
const MOST_MOVED: usize = 24;
/// How far, in places of the tour, parts are moved, so that the cost is linear in their number.
const FARTHEST: usize = 160;
/// Sweeps over a layer.
const SWEEPS: i32 = 12;
/// Smaller gains, mm, are not worth another sweep.
const WORTH: f64 = 1e-3;
/// Smaller gains, mm, are rounding.
const LEAST_GAIN: f64 = 1e-7;

/// Where a part may be entered, and where it is left then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Door {
    pub(crate) enter: Point2,
    pub(crate) exit: Point2,
    /// What it costs beside the travels to and from, mm.
    pub(crate) cost: f64,
    /// The door of the same part for the way back.
    pub(crate) back: u32,
}

/// A part of a layer.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) color: ColorId,
    /// At least one.
    pub(crate) doors: Vec<Door>,
}

/// A part by number, and the door it is entered by.
pub(crate) type Stop = (usize, u32);

/// Shortens a tour that begins at `start` and ends near there, where the next layer begins. The
/// colours of its first and its last part are what the layers below and above are printed in.
pub(crate) fn walk(parts: &[Part], tour: &mut [Stop], start: Point2, change: Change<'_>) {
    let (Some(&(first, _)), Some(&(last, _))) = (tour.first(), tour.last()) else { return };
    let mut colors: Vec<ColorId> = parts.iter().map(|part| part.color).collect();
    colors.sort_unstable();
    colors.dedup();
    let place = |part: usize| colors.partition_point(|&color| color < parts[part].color);
    let cost = |&a: &ColorId| colors.iter().map(move |&b| if a == b { 0.0 } else { change(a, b) });
    let (begin, end) =
        (Side { at: start, color: place(first) }, Side { at: start, color: place(last) });
    let mut walk = Walk {
        parts,
        colors: (0..parts.len()).map(place).collect(),
        bounds: parts.iter().map(|part| Bounds2::of(part.doors.iter().map(|d| d.enter))).collect(),
        changes: colors.iter().flat_map(cost).collect(),
        kinds: colors.len(),
        sides: Vec::new(),
        links: vec![0.0; tour.len() + 1],
        sweep: 0,
        changed: vec![-1; parts.len()],
        tour,
        begin,
        end,
    };
    walk.sides = walk.tour.iter().map(|&stop| walk.sides_of(stop)).collect();
    walk.look(0..walk.tour.len());
    for sweep in 0..SWEEPS {
        walk.sweep = sweep;
        let before = walk.cost();
        (0..walk.tour.len()).for_each(|i| walk.move_part(i));
        walk.move_rows();
        walk.turn_rows();
        walk.choose_doors();
        if walk.cost() > before - WORTH {
            break;
        }
    }
}

/// One end of a travel.
#[derive(Clone, Copy)]
struct Side {
    at: Point2,
    color: usize,
}

struct Walk<'a> {
    parts: &'a [Part],
    /// Of each part, its place among the colours used.
    colors: Vec<usize>,
    /// Around the doors of each part.
    bounds: Vec<Bounds2>,
    /// What a change costs, from each of the colours used to each.
    changes: Vec<f64>,
    kinds: usize,
    tour: &'a mut [Stop],
    /// Where each stop of the tour is entered and left.
    sides: Vec<(Side, Side)>,
    /// What it costs to come to each place of the tour, and to the end.
    links: Vec<f64>,
    sweep: i32,
    /// The sweep in which what lies beside a part last changed.
    changed: Vec<i32>,
    begin: Side,
    end: Side,
}

impl Walk<'_> {
    fn door(&self, (part, door): Stop) -> &Door {
        &self.parts[part].doors[door as usize]
    }

    fn sides_of(&self, stop: Stop) -> (Side, Side) {
        let (door, color) = (self.door(stop), self.colors[stop.0]);
        (Side { at: door.enter, color }, Side { at: door.exit, color })
    }

    /// Brings sides and links up to date with part of the tour.
    fn look(&mut self, places: Range<usize>) {
        for i in places.clone() {
            self.sides[i] = self.sides_of(self.tour[i]);
        }
        for i in places.start..=places.end {
            self.links[i] = self.link(self.before(i), self.after(i));
        }
    }

    /// Notes that a place of the tour follows another than before.
    fn note(&mut self, i: usize) {
        for near in [i.wrapping_sub(1), i] {
            if let Some(&(part, _)) = self.tour.get(near) {
                self.changed[part] = self.sweep;
            }
        }
    }

    /// Whether something has changed beside a place of the tour since it was tried in vain.
    fn is_fresh(&self, i: usize) -> bool {
        self.tour.get(i).is_some_and(|&(part, _)| self.changed[part] + 1 >= self.sweep)
    }

    /// The places that what stands from `i` to before `j` may be moved to.
    fn places(&self, i: usize, j: usize) -> impl Iterator<Item = usize> + use<> {
        let last = self.tour.len().min(j + FARTHEST);
        (i.saturating_sub(FARTHEST)..i).chain(j + 1..=last)
    }

    /// What lies before place `i` of the tour.
    fn before(&self, i: usize) -> Side {
        i.checked_sub(1).map_or(self.begin, |i| self.sides[i].1)
    }

    /// What lies at place `i` of the tour.
    fn after(&self, i: usize) -> Side {
        self.sides.get(i).map_or(self.end, |side| side.0)
    }

    fn change(&self, from: usize, to: usize) -> f64 {
        self.changes[from * self.kinds + to]
    }

    fn link(&self, from: Side, to: Side) -> f64 {
        from.at.distance(to.at) + self.change(from.color, to.color)
    }

    /// The link, where it costs less than a limit.
    fn link_below(&self, from: Side, to: Side, limit: f64) -> Option<f64> {
        let change = self.change(from.color, to.color);
        let left = limit - change;
        let square = from.at.distance_squared(to.at);
        (left > 0.0 && square < left * left).then(|| square.sqrt() + change)
    }

    fn cost(&self) -> f64 {
        let own: f64 = self.tour.iter().map(|&stop| self.door(stop).cost).sum();
        own + self.links.iter().sum::<f64>()
    }

    /// Takes a part out and puts it in, by whichever door, where that gains most.
    fn move_part(&mut self, i: usize) {
        if !self.is_fresh(i) {
            return;
        }
        let stop = self.tour[i];
        let (from, to) = (self.before(i), self.after(i + 1));
        let here = self.links[i] + self.door(stop).cost + self.links[i + 1];
        let mut best = (here - self.link(from, to) - LEAST_GAIN, None);
        // A door costs less than nothing where a travel of the part's own is left out.
        let own = self.parts[stop.0].doors.iter().map(|door| door.cost).fold(0.0, f64::min);
        for k in self.places(i, i + 1) {
            let (from, to) = (self.before(k), self.after(k));
            let now = self.links[k];
            if !self.may_lie_between(stop.0, from, to, best.0 + now - own) {
                continue;
            }
            let (cost, door) = self.best_door(stop.0, from, to);
            if cost - now < best.0 {
                best = (cost - now, Some((k, door)));
            }
        }
        let Some((k, door)) = best.1 else { return };
        self.tour[i].1 = door;
        self.carry(i, i + 1, k);
    }

    /// Takes what stands from place `i` to before `j` to before place `k`.
    fn carry(&mut self, i: usize, j: usize, k: usize) {
        let (from, to, seam) = if k > i {
            self.tour[i..k].rotate_left(j - i);
            (i, k, k - (j - i))
        } else {
            self.tour[k..j].rotate_right(j - i);
            (k, j, k + (j - i))
        };
        self.look(from..to);
        [from, seam, to].into_iter().for_each(|place| self.note(place));
    }

    /// Whether a part can lie between two sides at less than a cost, by where its doors are.
    fn may_lie_between(&self, part: usize, from: Side, to: Side, cost: f64) -> bool {
        let (color, bounds) = (self.colors[part], &self.bounds[part]);
        let left = cost - self.change(from.color, color) - self.change(color, to.color);
        if left <= 0.0 {
            return false;
        }
        let near = |p: Point2| p.distance_squared(p.clamp(bounds.min, bounds.max));
        let one = near(from.at);
        one < left * left && one.sqrt() + near(to.at).sqrt() < left
    }

    fn best_door(&self, part: usize, from: Side, to: Side) -> (f64, u32) {
        let color = self.colors[part];
        let changes = self.change(from.color, color) + self.change(color, to.color);
        let mut best = (f64::INFINITY, 0);
        for (door, number) in self.parts[part].doors.iter().zip(0..) {
            let way = from.at.distance(door.enter) + door.cost + door.exit.distance(to.at);
            if way + changes < best.0 {
                best = (way + changes, number);
            }
        }
        best
    }

    /// Takes rows of parts out and puts them in, ahead or turned, where that gains most.
    fn move_rows(&mut self) {
        let count = self.tour.len();
        for length in 2..=MOST_MOVED.min(count.saturating_sub(1)) {
            for i in 0..=count - length {
                let fresh = self.is_fresh(i) || self.is_fresh(i + length - 1);
                if let Some((k, turned)) = fresh.then(|| self.best_move(i, i + length)).flatten() {
                    if turned {
                        self.turn(i, i + length);
                    }
                    self.carry(i, i + length, k);
                }
            }
        }
    }

    /// Where the row from place `i` to before `j` gains most, and whether turned.
    fn best_move(&self, i: usize, j: usize) -> Option<(usize, bool)> {
        let (from, to) = (self.before(i), self.after(j));
        let (head, tail) = (self.after(i), self.before(j));
        let saved = self.links[i] + self.links[j] - self.link(from, to);
        let mut best = (saved - LEAST_GAIN, None);
        if best.0 <= 0.0 {
            return None;
        }
        for k in self.places(i, j) {
            let (from, to) = (self.before(k), self.after(k));
            let now = self.links[k];
            for (first, last, turned) in [(head, tail, false), (tail, head, true)] {
                if let Some(entering) = self.link_below(from, first, best.0 + now)
                    && let Some(leaving) = self.link_below(last, to, best.0 + now - entering)
                {
                    best = (entering + leaving - now, Some((k, turned)));
                }
            }
        }
        best.1
    }

    /// Turns rows of parts round where that gains.
    fn turn_rows(&mut self) {
        let count = self.tour.len();
        for i in 0..count {
            for j in i + 2..=count.min(i + FARTHEST) {
                if !self.is_fresh(i) && !self.is_fresh(j - 1) {
                    continue;
                }
                let (from, to) = (self.before(i), self.after(j));
                let (head, tail) = (self.after(i), self.before(j));
                let now = self.links[i] + self.links[j] - LEAST_GAIN;
                if let Some(one) = self.link_below(from, tail, now)
                    && self.link_below(head, to, now - one).is_some()
                {
                    self.turn(i, j);
                    self.look(i..j);
                    self.note(i);
                    self.note(j);
                }
            }
        }
    }

    fn turn(&mut self, i: usize, j: usize) {
        self.tour[i..j].reverse();
        for k in i..j {
            self.tour[k].1 = self.door(self.tour[k]).back;
        }
    }

    /// The best doors for the tour as it is, by going through all of them stop after stop.
    fn choose_doors(&mut self) {
        // Of every door so far, the way to its exit and the door before it.
        let mut ways: Vec<Vec<(f64, u32)>> = Vec::with_capacity(self.tour.len());
        let start = [Door { enter: self.begin.at, exit: self.begin.at, cost: 0.0, back: 0 }];
        let mut doors = start.as_slice();
        let mut last = vec![(0.0, 0)];
        for &(part, _) in self.tour.iter() {
            let next = &self.parts[part].doors;
            let to = |door: &Door| {
                let (way, before) = shortest(doors, &last, door.enter);
                (way + door.cost, before)
            };
            let row: Vec<_> = next.iter().map(to).collect();
            ways.push(std::mem::replace(&mut last, row));
            doors = next;
        }
        let (_, mut door) = shortest(doors, &last, self.end.at);
        ways.push(last);
        for i in (0..self.tour.len()).rev() {
            if std::mem::replace(&mut self.tour[i].1, door) != door {
                self.note(i);
                self.note(i + 1);
            }
            door = ways[i + 1][door as usize].1;
        }
        self.look(0..self.tour.len());
    }
}

/// The shortest way to a point, by one of the doors that are reached so.
fn shortest(doors: &[Door], ways: &[(f64, u32)], to: Point2) -> (f64, u32) {
    let mut best = (f64::INFINITY, 0);
    for ((door, &(way, _)), number) in doors.iter().zip(ways).zip(0..) {
        if way < best.0 {
            let way = way + door.exit.distance(to);
            if way < best.0 {
                best = (way, number);
            }
        }
    }
    best
}

#[cfg(test)]
#[path = "order_walk_tests.rs"]
mod tests;
