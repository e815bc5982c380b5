use fgm_core::{Bounds2, Point2};

use crate::Piece;

/// No bead is wider than so many times what its tag or its section says.
const WIDEST: f64 = 1.5;

/// A piece of a bead seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) from: Point2,
    pub(crate) to: Point2,
    /// Half the width, mm.
    pub(crate) half: f64,
    /// Whether the one before it ends where it begins: then the joint is round.
    pub(crate) joined: bool,
}

/// Places in a row that a stroke covers: from and to, mm.
pub(crate) type Run = (f64, f64);

impl Stroke {
    /// As wide as the volume makes a rectangular section; none for a bead along z alone.
    pub(crate) fn of(piece: &Piece, joined: bool) -> Option<Self> {
        let (from, to) = (piece.from.truncate(), piece.to.truncate());
        let length = from.distance(to);
        if length.is_nan() || length <= 0.0 || piece.height <= 0.0 {
            return None;
        }
        let width = (piece.volume / (length * piece.height)).min(WIDEST * piece.width);
        Some(Self { from, to, half: 0.5 * width, joined })
    }

    pub(crate) fn bounds(&self) -> Bounds2 {
        Bounds2::of([self.from, self.to]).grown(self.half)
    }

    /// The direction, and the length, mm.
    pub(crate) fn direction(&self) -> (Point2, f64) {
        let delta = self.to - self.from;
        let length = delta.length();
        (delta / length, length)
    }

    /// What the bead itself covers of the row at `y`: a rectangle with square ends.
    pub(crate) fn body(&self, direction: Point2, length: f64, y: f64) -> Option<Run> {
        let (c, s) = (direction.x, direction.y);
        let dy = y - self.from.y;
        let across = clip(c * dy, -s, -self.half, self.half)?;
        let along = clip(s * dy, c, 0.0, length)?;
        let (from, to) = (across.0.max(along.0), across.1.min(along.1));
        (from <= to).then_some((self.from.x + from, self.from.x + to))
    }

    /// What the round joint at its beginning covers of the row at `y`.
    pub(crate) fn joint(&self, y: f64) -> Option<Run> {
        let dy = y - self.from.y;
        let rest = self.half * self.half - dy * dy;
        (self.joined && rest >= 0.0).then(|| (self.from.x - rest.sqrt(), self.from.x + rest.sqrt()))
    }
}

/// The x for which `least <= base + slope x <= most`.
fn clip(base: f64, slope: f64, least: f64, most: f64) -> Option<Run> {
    // As good as level: the row is inside or outside as a whole.
    if slope.abs() < 1e-12 {
        return (least..=most).contains(&base).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (a, b) = ((least - base) / slope, (most - base) / slope);
    Some((a.min(b), a.max(b)))
}
