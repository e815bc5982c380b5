//! A wall that rises without a step: loops that follow each other, each led over to the next.

use fgm_core::{Point2, bead};

use crate::{Piece, inset::grid::EdgeGrid, order::MEETS};

/// Side of a cell, mm.
const CELL: f64 = 1.0;
/// The volume of beads that fade is set in so many steps.
const STEPS: u32 = 32;

/// One turn of a spiral: a loop that begins, and ends, where the turn before it ended.
pub struct Turn {
    /// The loop, its first point repeated at the end.
    line: Vec<Point2>,
    grid: EdgeGrid,
}

impl Turn {
    /// The loop through the points of a ring, the first of them not repeated, turned to begin at
    /// its place nearest to `near`. None for a ring that is no loop, or not finite.
    pub fn new(ring: &[Point2], near: Point2) -> Option<Self> {
        if ring.len() < 3 || !ring.iter().all(|p| p.is_finite()) || !near.is_finite() {
            return None;
        }
        let edge = |i: usize| (ring[i], ring[(i + 1) % ring.len()]);
        let (index, start) = (0..ring.len())
            .map(|i| (i, nearest_of(edge(i), near)))
            .min_by(|a, b| a.1.distance_squared(near).total_cmp(&b.1.distance_squared(near)))?;
        let mut line = Vec::with_capacity(ring.len() + 2);
        line.push(start);
        let rest = (1..=ring.len()).map(|i| ring[(index + i) % ring.len()]);
        line.extend(rest.filter(|p| p.distance(start) > MEETS));
        line.push(start);
        let edges = line.windows(2).map(|w| (w[0], w[1])).collect();
        (line.len() > 3).then(|| Self { line, grid: EdgeGrid::for_along(edges, CELL) })
    }

    /// The loop, its first point repeated at the end.
    pub fn line(&self) -> &[Point2] {
        &self.line
    }

    /// Where it begins and ends.
    pub fn start(&self) -> Point2 {
        self.line[0]
    }

    /// The way from the turn before, where that began, to this one: near that loop at first, on
    /// this one in the end, between them by the share of the length. So there is no step from turn
    /// to turn where a part widens or narrows with its height.
    ///
    /// Where the loops lie farther apart than `reach` mm, it runs on this one.
    pub fn led_from(&self, before: &Self, reach: f64) -> Vec<Point2> {
        let whole: f64 = self.line.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut way = Vec::with_capacity(self.line.len() + 1);
        way.push(before.start());
        if before.start().distance(self.start()) > reach {
            way.push(self.start());
        }
        let mut length = 0.0;
        for (i, w) in self.line.windows(2).enumerate() {
            length += w[0].distance(w[1]);
            let next = self.line.get(i + 2).unwrap_or(&self.line[1]);
            let along = [w[1] - w[0], *next - w[1]];
            let led = before.nearest(w[1], along, reach);
            way.push(led.map_or(w[1], |from| from.lerp(w[1], (length / whole).min(1.0))));
        }
        // Rounding must not open the loop that the next turn begins at.
        if let Some(last) = way.last_mut() {
            *last = self.start();
        }
        way
    }

    /// The place of the loop nearest to `p`, within `reach`, where it runs the same way as one of
    /// two directions: not the other side of a thin part.
    fn nearest(&self, p: Point2, along: [Point2; 2], reach: f64) -> Option<Point2> {
        let mut best = None;
        let mut least = reach * reach;
        self.grid.along(p, p, reach, |_, _, edge| {
            let at = nearest_of(edge, p);
            let squared = at.distance_squared(p);
            let way = edge.1 - edge.0;
            if squared < least && along.iter().any(|along| along.dot(way) > 0.0) {
                (best, least) = (Some(at), squared);
            }
        });
        best
    }
}

/// The place of a segment nearest to a point.
fn nearest_of((a, b): (Point2, Point2), p: Point2) -> Point2 {
    let along = b - a;
    let squared = along.length_squared();
    if squared > 0.0 { a + along * ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { a }
}

/// Gives the beads of pieces in a row a volume that changes evenly, by length, from a share of their
/// own to another: in steps, whose sum is the volume's exactly. `height` is the layer's, mm.
///
/// A spiral begins so, from nothing on the flat layer below it, and ends so below its flat rim.
pub fn fade(pieces: Vec<Piece>, height: f64, from: f64, to: f64) -> Vec<Piece> {
    let whole: f64 = pieces.iter().map(Piece::length).sum();
    // So short a row is one step.
    let step = (whole / f64::from(STEPS)).max(MEETS);
    let mut out = Vec::with_capacity(pieces.len() + STEPS as usize);
    let mut done = 0.0;
    let mut push = |mut piece: Piece, done: &mut f64| {
        let length = piece.length();
        let share = from + (to - from) * (*done + 0.5 * length) / whole;
        piece.width = bead::width(share * bead::area(piece.width, height), height);
        *done += length;
        out.push(piece);
    };
    for mut rest in pieces {
        // The steps that end inside the piece.
        loop {
            let next = ((done / step + 1e-6).floor() + 1.0) * step - done;
            if rest.length() <= next + MEETS {
                break;
            }
            let (one, other) = rest.split(next);
            push(one, &mut done);
            rest = other;
        }
        push(rest, &mut done);
    }
    out
}

#[cfg(test)]
#[path = "spiral_tests.rs"]
mod tests;
