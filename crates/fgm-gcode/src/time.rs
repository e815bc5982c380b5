use std::collections::VecDeque;

use fgm_core::Point3;

use crate::MotionLimits;

/// Moves looked ahead over, as firmwares do.
const WINDOW: usize = 32;

/// Estimates how long moves take, as they stream by, in bounded memory.
///
/// Every move speeds up, cruises and slows down at constant acceleration (a trapezoid of speed
/// over time). The speed through a corner is the one at which a circle that stays within the
/// junction deviation of it needs no more than the acceleration: `v² = a d s / (1 - s)`, with `s`
/// the sine of half the corner's angle, as Grbl, Marlin and Klipper have it. Over the last 32
/// moves no one enters faster than the moves after it can brake.
///
/// ```
/// use fgm_core::Point3;
/// use fgm_gcode::{MotionLimits, TimeEstimate};
///
/// let limits = MotionLimits { acceleration: 1000.0, ..MotionLimits::default() };
/// let mut time = TimeEstimate::new(&limits);
/// time.push(Point3::new(100.0, 0.0, 0.0), 50.0, limits.acceleration);
/// // 50 ms each to speed up and to brake, over 1.25 mm each; 97.5 mm at 50 mm/s.
/// assert!((time.seconds() - (0.1 + 97.5 / 50.0)).abs() < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct TimeEstimate {
    junction_deviation: f64,
    max_z_speed: f64,
    window: VecDeque<Block>,
    seconds: f64,
}

/// A move; speeds are squared, since a constant acceleration changes the square by `2 a d`.
#[derive(Clone, Copy, Debug)]
struct Block {
    direction: Point3,
    length: f64,
    acceleration: f64,
    cruise: f64,
    /// Limit at the corner before it.
    corner: f64,
    /// Planned speed at its beginning.
    entry: f64,
}

impl TimeEstimate {
    /// No move yet.
    pub fn new(limits: &MotionLimits) -> Self {
        Self {
            junction_deviation: limits.junction_deviation,
            max_z_speed: limits.max_z_speed,
            window: VecDeque::with_capacity(WINDOW + 1),
            seconds: 0.0,
        }
    }

    /// A straight move by `delta` mm, at `speed` mm/s at most, with `acceleration` mm/s². Moves
    /// that are no move, or have no speed or acceleration, take no time.
    pub fn push(&mut self, delta: Point3, speed: f64, acceleration: f64) {
        let length = delta.length();
        if !(length > 0.0 && speed > 0.0 && acceleration > 0.0 && length.is_finite()) {
            return;
        }
        let direction = delta / length;
        let mut speed = speed;
        if direction.z != 0.0 {
            speed = speed.min(self.max_z_speed / direction.z.abs());
        }
        let cruise = speed * speed;
        let corner = self.window.back().map_or(0.0, |last| {
            let least = acceleration.min(last.acceleration);
            corner_speed(last.direction.dot(direction), least * self.junction_deviation)
                .min(cruise)
                .min(last.cruise)
        });
        let entry = corner.min(2.0 * acceleration * length);
        self.window.push_back(Block { direction, length, acceleration, cruise, corner, entry });
        self.plan();
        if self.window.len() > WINDOW {
            self.pop();
        }
    }

    /// The machine stops, and stands for a while.
    pub fn dwell(&mut self, seconds: f64) {
        while !self.window.is_empty() {
            self.pop();
        }
        if seconds > 0.0 {
            self.seconds += seconds;
        }
    }

    /// The time for everything so far, with a stop at the end, s.
    pub fn seconds(&self) -> f64 {
        let mut rest = self.clone();
        rest.dwell(0.0);
        rest.seconds
    }

    /// Raises the entry speeds that the newest move allows, from the newest back.
    fn plan(&mut self) {
        let mut next = self.window.back().map_or(0.0, |b| b.entry);
        for block in self.window.iter_mut().rev().skip(1) {
            let entry = block.corner.min(next + 2.0 * block.acceleration * block.length);
            // Further back nothing is limited by what follows any more.
            if entry <= block.entry {
                break;
            }
            block.entry = entry;
            next = entry;
        }
    }

    /// Adds the time of the oldest move, and fixes the speed it ends with.
    fn pop(&mut self) {
        let Some(block) = self.window.pop_front() else { return };
        let gain = 2.0 * block.acceleration * block.length;
        let exit = match self.window.front_mut() {
            Some(next) => {
                next.entry = next.entry.min(block.entry + gain);
                // The next one's corner no longer depends on this one.
                next.corner = next.entry;
                next.entry
            }
            None => 0.0,
        };
        let peak = ((gain + block.entry + exit) / 2.0).min(block.cruise).max(exit);
        let (v0, v, v1) = (block.entry.sqrt(), peak.sqrt(), exit.sqrt());
        let ramps = (2.0 * peak - block.entry - exit) / (2.0 * block.acceleration);
        self.seconds += (2.0 * v - v0 - v1) / block.acceleration
            + (block.length - ramps).max(0.0) / v.max(1e-9);
    }
}

/// The square of the speed through a corner, for the cosine of its change of direction and the
/// acceleration times the junction deviation.
fn corner_speed(cosine: f64, reach: f64) -> f64 {
    let sine = ((1.0 + cosine) / 2.0).max(0.0).sqrt();
    if sine > 0.999_999 { f64::INFINITY } else { reach * sine / (1.0 - sine) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const A: f64 = 1000.0;

    fn limits() -> MotionLimits {
        MotionLimits { acceleration: A, ..MotionLimits::default() }
    }

    fn time(moves: &[(f64, f64)], speed: f64) -> f64 {
        let mut time = TimeEstimate::new(&limits());
        for &(x, y) in moves {
            time.push(Point3::new(x, y, 0.0), speed, A);
        }
        time.seconds()
    }

    #[test]
    fn a_straight_line_takes_as_long_in_pieces() {
        let whole = time(&[(20.0, 0.0)], 60.0);
        // 1.8 mm each to speed up and brake.
        assert!((whole - (0.12 + 16.4 / 60.0)).abs() < 1e-9);
        for pieces in [2, 7, 20] {
            let parts = vec![(20.0 / pieces as f64, 0.0); pieces];
            assert!((time(&parts, 60.0) - whole).abs() < 1e-9, "{pieces}");
        }
    }

    #[test]
    fn short_moves_never_reach_their_speed() {
        // Half the way up, half the way down: 2 sqrt(d / a).
        assert!((time(&[(1.0, 0.0)], 1e3) - 2.0 * (1.0_f64 / A).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn turning_back_is_a_stop() {
        let there = time(&[(10.0, 0.0)], 60.0);
        let back = time(&[(10.0, 0.0), (-10.0, 0.0)], 60.0);
        assert!((back - 2.0 * there).abs() < 1e-9);
        let corner = time(&[(10.0, 0.0), (0.0, 10.0)], 60.0);
        assert!(corner < back && corner > time(&[(20.0, 0.0)], 60.0));
    }

    #[test]
    fn dwelling_and_nothing() {
        let mut time = TimeEstimate::new(&limits());
        time.push(Point3::ZERO, 10.0, A);
        time.push(Point3::X, 0.0, A);
        time.push(Point3::splat(f64::NAN), 10.0, A);
        time.dwell(2.5);
        assert_eq!(time.seconds(), 2.5);
    }

    proptest! {
        #[test]
        fn between_no_inertia_and_a_stop_at_every_corner(
            moves in prop::collection::vec((-20.0..20.0f64, -20.0..20.0f64), 1..120),
            speed in 5.0..200.0f64,
        ) {
            let total = time(&moves, speed);
            let alone: f64 = moves.iter().map(|m| time(&[*m], speed)).sum();
            let length: f64 = moves.iter().map(|m| m.0.hypot(m.1)).sum();
            prop_assert!(total <= alone + 1e-9, "{} {}", total, alone);
            prop_assert!(total >= length / speed - 1e-9, "{} {}", total, length / speed);
        }
    }
}
