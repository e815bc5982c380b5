//! Turning the short travels between neighbouring lines into beads.

use fgm_core::{Point2, Role, bead};

use crate::{Piece, order::MEETS};

/// The longest travel, in line spacings, that may lie between neighbours, whatever the boundary.
const FARTHEST: f64 = 30.0;
/// How much longer than the boundary's angle says a travel may be: boundaries curve.
const SLACK: f64 = 1.025;
/// How far apart the lines themselves may be, in line spacings: no line lies between them.
pub(crate) const BESIDE: f64 = 1.3;
/// What a piece must have for every millimetre of the travel, mm.
const LEAST: f64 = 3.0;
/// Steps towards the length that is cut off; each halves the error where lines run side by side.
const STEPS: usize = 40;

/// How lines turn round at a boundary between colours.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Turns {
    /// The layer's height, mm.
    pub height: f64,
    /// The greatest angle, radians, between lines and the boundary's normal at which they turn round
    /// along the boundary. The steeper, the longer the turns, and the less of the area between them
    /// is covered: at 60 degrees they are two spacings long.
    pub steepest: f64,
}

impl Turns {
    /// The longest travel that becomes a turn, in line spacings.
    pub(crate) fn reach(&self) -> f64 {
        (SLACK / self.steepest.cos().max(0.0)).min(FARTHEST)
    }

    /// Whether what has this role may turn round.
    pub(crate) fn may_turn(&self, role: Role) -> bool {
        role.is_part() && role != Role::OuterWall
    }
}

/// Joins pieces that follow each other and end beside each other, as the lines of an infill do at
/// a boundary between colours, so that the nozzle turns round there instead of travelling.
///
/// Both are cut back by half the length of the bead that joins them: the volume stays, and the beads
/// that turn on either side of the boundary come to lie a line's spacing apart, like those of walls.
/// Only pieces of one colour, role and width are joined, not outer walls, and not what would run
/// on in the same direction. Where the boundary is steeper than that, [`order_with`](crate::order_with)
/// has brought ends to one level, if it was told of the turns ([`OrderOptions::turns`](crate::OrderOptions::turns)).
pub fn join_ends(pieces: &mut Vec<Piece>, turns: &Turns) {
    pieces.dedup_by(|piece, into| {
        let alike =
            piece.role == into.role && piece.width == into.width && piece.color == into.color;
        alike
            && turns.may_turn(piece.role)
            && join(into, piece, turns.reach(), bead::spacing(into.width, turns.height))
    });
}

/// Appends a piece to another if it begins beside that one's end, at most `reach` spacings away.
fn join(into: &mut Piece, piece: &mut Piece, reach: f64, spacing: f64) -> bool {
    let (Some(&end), Some(&start)) = (into.points.last(), piece.points.first()) else {
        return false;
    };
    let gap = end.distance(start);
    if !(gap > MEETS && gap <= reach * spacing) || into.is_loop() || piece.is_loop() {
        return false;
    }
    let steps = |w: &[Point2]| w[0].distance(w[1]);
    let least = LEAST * gap;
    if !reaches(into.points.windows(2).rev().map(steps), least)
        || !reaches(piece.points.windows(2).map(steps), least)
        || aside(&into.points, start) > BESIDE * spacing
    {
        return false;
    }
    let Some(cut) = cut(&into.points, &piece.points, gap) else { return false };
    shorten(&mut into.points, cut);
    piece.points.reverse();
    shorten(&mut piece.points, cut);
    into.points.extend(piece.points.drain(..).rev());
    true
}

/// Whether lengths add up to at least `least`.
fn reaches(mut lengths: impl Iterator<Item = f64>, least: f64) -> bool {
    let mut left = least;
    lengths.any(|length| {
        left -= length;
        left <= 0.0
    })
}

/// How far a point lies to the side of a line's last segment.
fn aside(line: &[Point2], p: Point2) -> f64 {
    let [.., a, b] = line else { return f64::INFINITY };
    let along = *b - *a;
    (along.perp_dot(p - *b) / along.length().max(1e-300)).abs()
}

/// How much to cut off both lines, so that the way between the new ends is twice as long; none
/// where they run apart.
fn cut(one: &[Point2], other: &[Point2], gap: f64) -> Option<f64> {
    let mut cut = 0.5 * gap;
    for _ in 0..STEPS {
        let (p, q) = (before_end(one.iter().rev(), cut), before_end(other.iter(), cut));
        let next = 0.5 * p.distance(q);
        if (next - cut).abs() < 1e-9 {
            return Some(next);
        }
        // Half a step: where the lines run towards each other a whole one overshoots.
        cut = 0.5 * (cut + next);
        if cut > 0.8 * gap {
            return None;
        }
    }
    None
}

/// The point `length` mm along a line.
fn before_end<'a>(mut points: impl Iterator<Item = &'a Point2>, mut length: f64) -> Point2 {
    let mut at = points.next().copied().unwrap_or_default();
    for &next in points {
        let step = at.distance(next);
        if step >= length {
            return at + (next - at) * (length / step.max(1e-300));
        }
        length -= step;
        at = next;
    }
    at
}

/// Takes `length` mm, less than the line has, off its end.
fn shorten(points: &mut Vec<Point2>, length: f64) {
    let end = before_end(points.iter().rev(), length);
    let mut left = length;
    while let [.., a, b] = points[..] {
        let step = a.distance(b);
        points.pop();
        if step > left {
            break;
        }
        left -= step;
    }
    points.push(end);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::ColorId;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_3;

    fn piece(points: &[(f64, f64)], color: u16, role: Role) -> Piece {
        let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        Piece::new(points, role, 0.4, ColorId(color))
    }

    fn joined(mut pieces: Vec<Piece>) -> Vec<Vec<(f64, f64)>> {
        join_ends(&mut pieces, &Turns { height: 0.2, steepest: FRAC_PI_3 });
        let round = |v: f64| (v * 1e6).round() / 1e6;
        let points = |p: &Piece| p.points.iter().map(|q| (round(q.x), round(q.y))).collect();
        pieces.iter().map(points).collect()
    }

    #[test]
    fn lines_that_end_beside_each_other_become_one() {
        let line = |points: &[(f64, f64)]| piece(points, 0, Role::Infill);
        let right = line(&[(0.0, 0.0), (9.0, 0.0)]);
        let back = line(&[(9.0, 0.4), (0.0, 0.4)]);
        let turn = vec![(0.0, 0.0), (8.8, 0.0), (8.8, 0.4), (0.0, 0.4)];
        let apart = |pieces: Vec<Piece>| {
            let count = pieces.len();
            assert_eq!(joined(pieces).len(), count);
        };
        assert_eq!(joined(vec![right.clone(), back.clone()]), [turn]);
        // At an angle to the boundary the turn is longer; both lose half of it.
        let slant = line(&[(9.3, 0.4), (0.0, 0.4)]);
        let [one] = &joined(vec![right.clone(), slant])[..] else { panic!("not joined") };
        assert_eq!(one[1..3], [(8.75, 0.0), (9.05, 0.4)]);
        // In the same direction nothing turns; far ends, other colours and roles stay apart.
        apart(vec![right.clone(), line(&[(9.4, 0.0), (18.0, 0.0)])]);
        apart(vec![right.clone(), line(&[(9.0, 0.8), (0.0, 0.8)])]);
        apart(vec![right.clone(), piece(&[(9.0, 0.4), (0.0, 0.4)], 1, Role::Infill)]);
        apart(vec![right.clone(), piece(&[(9.0, 0.4), (0.0, 0.4)], 0, Role::InnerWall)]);
        apart(vec![right.clone(), line(&[(9.0, 0.4), (8.5, 0.4)])]);
        apart(vec![line(&[]), right, line(&[(9.0, 0.4)])]);
        let wall = |points: &[(f64, f64)]| piece(points, 0, Role::OuterWall);
        apart(vec![wall(&[(0.0, 0.0), (9.0, 0.0)]), wall(&[(9.0, 0.4), (0.0, 0.4)])]);
    }

    proptest! {
        #[test]
        fn the_length_stays(
            lines in prop::collection::vec((0.0..6.0f64, 6.0..12.0f64, -0.2..0.2f64), 2..20),
            steepest in 0.0..1.6f64,
        ) {
            let line = |(i, &(from, to, tilt)): (usize, &(f64, f64, f64))| {
                let y = 0.36 * i as f64;
                let ends = [(from, y), (to, y + tilt)];
                let points = if i % 2 == 0 { ends } else { [ends[1], ends[0]] };
                piece(&points, 0, Role::Infill)
            };
            let mut pieces: Vec<Piece> = lines.iter().enumerate().map(line).collect();
            let before: f64 = pieces.iter().map(Piece::length).sum();
            join_ends(&mut pieces, &Turns { height: 0.2, steepest });
            let after: f64 = pieces.iter().map(Piece::length).sum();
            prop_assert!((after / before - 1.0).abs() < 1e-7, "{before} to {after}");
        }
    }
}
