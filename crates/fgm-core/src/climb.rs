use crate::{Motion, Point2};

/// The height of the beads' tops along a print, where layers may [rise](Motion::Rise).
///
/// Whoever follows a stream of motions tells it every one of them, or the same by
/// [`layer`](Self::layer), [`rise`](Self::rise) and [`advance`](Self::advance).
///
/// ```
/// use fgm_core::{Climb, Motion, Point2, Role};
///
/// let bead = |x| Motion::Extrude { to: Point2::new(x, 0.0), width: 0.4, role: Role::OuterWall };
/// let mut climb = Climb::default();
/// let mut heights = Vec::new();
/// for motion in [
///     Motion::Layer { index: 4, z: 1.0, height: 0.2 },
///     Motion::Rise { from: 0.75, length: 10.0 },
///     Motion::Travel { to: Point2::ZERO },
///     bead(4.0),
///     bead(10.0),
///     bead(30.0),
/// ] {
///     climb.follow(&motion);
///     heights.push(climb.z());
/// }
/// assert_eq!(heights, [1.0, 0.75, 0.75, 0.85, 1.0, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Climb {
    from: f64,
    top: f64,
    length: f64,
    done: f64,
    at: Option<Point2>,
}

/// A share of a rise that is left where rounding made its beads shorter.
const LEFT: f64 = 1e-9;

impl Climb {
    /// A layer begins, whose beads' tops lie at `top`, mm.
    pub fn layer(&mut self, top: f64) {
        (self.from, self.top, self.length, self.done) = (top, top, 0.0, 0.0);
    }

    /// The layer rises from a height, along beads of this length, mm.
    pub fn rise(&mut self, from: f64, length: f64) {
        (self.from, self.length, self.done) = (from, length, 0.0);
    }

    /// A bead of this length was laid, mm.
    pub fn advance(&mut self, length: f64) {
        self.done += length;
    }

    /// Follows a motion.
    pub fn follow(&mut self, motion: &Motion) {
        match *motion {
            Motion::Layer { z, .. } => self.layer(z),
            Motion::Rise { from, length } => self.rise(from, length),
            Motion::Travel { to } => self.at = Some(to),
            Motion::Extrude { to, .. } => {
                let from = self.at.replace(to).unwrap_or(to);
                self.advance(from.distance(to));
            }
            Motion::Color(_) | Motion::Command(_) => {}
        }
    }

    /// Height of the beads' tops where the last one ended, mm. It never falls within a layer, and
    /// begins and ends at the very numbers that were told.
    pub fn z(&self) -> f64 {
        let share = self.done / self.length;
        // Of no length, too, and of what is no number.
        if share < 1.0 - LEFT { self.from + (self.top - self.from) * share } else { self.top }
    }

    /// How far it still has to rise to the layer's own height, mm.
    pub fn left(&self) -> f64 {
        self.top - self.z()
    }
}
