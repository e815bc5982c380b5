use std::collections::VecDeque;

use fgm_core::Point3;

use crate::MotionLimits;

/// Moves looked ahead over, as firmwares do.
const WINDOW: usize = 32;
/// Moves shorter than this follow a curve, mm, where they turn by less than 45 degrees.
const CURVED: f64 = 1.0;

/// Estimates how long moves take, as they stream by, in bounded memory.
///
/// Every move speeds up, cruises and slows down at constant acceleration (a trapezoid of speed
/// over time), both within the limits of each axis. The speed through a corner is the one at which
/// a circle that stays within the junction deviation of it needs no more than the acceleration:
/// `v² = a d s / (1 - s)`, with `s` the sine of half the angle between the two moves, as Grbl,
/// Marlin and Klipper have it; `a` is that of the move after the corner, within the limits of the
/// axes along the change of direction. Between short moves that turn by less than 45 degrees it is
/// also no more than that on the circle they follow, `v² = a l / t` for a length `l` and a turn `t`
/// (Marlin's rule for small segments; `t` is taken as its chord, at
/// most 3 % less than the angle). A move of the filament alone has a direction of its own, at right
/// angles to the others. Over the last 32 moves no one enters faster than the moves after it can
/// brake.
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
    retract_acceleration: f64,
    max_speed: [f64; 4],
    max_acceleration: [f64; 4],
    window: VecDeque<Block>,
    /// Of the moves in the window, at their full speed, s.
    window_cruise: f64,
    seconds: f64,
}

/// Along x, y, z and the filament.
type Direction = [f64; 4];

/// A move; speeds are squared, since a constant acceleration changes the square by `2 a d`.
#[derive(Clone, Copy, Debug)]
struct Block {
    direction: Direction,
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
            retract_acceleration: limits.retract_acceleration,
            max_speed: limits.max_speed,
            max_acceleration: limits.max_acceleration,
            window: VecDeque::with_capacity(WINDOW + 1),
            window_cruise: 0.0,
            seconds: 0.0,
        }
    }

    /// A straight move by `delta` mm, at `speed` mm/s at most, with `acceleration` mm/s² at most.
    /// Moves that are no move, or have no speed or acceleration, take no time.
    #[inline]
    pub fn push(&mut self, delta: Point3, speed: f64, acceleration: f64) {
        let length = delta.length();
        let d = delta / length;
        self.block([d.x, d.y, d.z, 0.0], length, speed, acceleration);
    }

    /// Filament moved by `length` mm without the nozzle, at `speed` mm/s at most; negative for
    /// pulling it back.
    pub fn push_filament(&mut self, length: f64, speed: f64) {
        let direction = [0.0, 0.0, 0.0, length.signum()];
        self.block(direction, length.abs(), speed, self.retract_acceleration);
    }

    fn block(&mut self, direction: Direction, length: f64, speed: f64, acceleration: f64) {
        if !(length > 0.0 && speed > 0.0 && acceleration > 0.0 && length.is_finite()) {
            return;
        }
        let speed = within(speed, &direction, &self.max_speed);
        let acceleration = within(acceleration, &direction, &self.max_acceleration);
        let cruise = speed * speed;
        let corner = self.window.back().map_or(0.0, |last| {
            let most = cruise.min(last.cruise);
            self.corner(&last.direction, &direction, length, acceleration, most)
        });
        let entry = corner.min(2.0 * acceleration * length);
        self.window.push_back(Block { direction, length, acceleration, cruise, corner, entry });
        self.window_cruise += length / speed;
        self.plan();
        if self.window.len() > WINDOW {
            self.pop();
        }
    }

    /// The square of the speed through a corner, `most` at most.
    #[inline]
    fn corner(
        &self,
        from: &Direction,
        to: &Direction,
        length: f64,
        acceleration: f64,
        most: f64,
    ) -> f64 {
        let cosine: f64 = from.iter().zip(to).map(|(a, b)| a * b).sum();
        let sine = ((1.0 + cosine) / 2.0).max(0.0).sqrt();
        if sine > 0.999_999 {
            return most;
        }
        let turn = (2.0 - 2.0 * cosine).sqrt();
        let change: Direction = std::array::from_fn(|i| (to[i] - from[i]) / turn);
        let acceleration = within(acceleration, &change, &self.max_acceleration);
        let corner = acceleration * self.junction_deviation * sine / (1.0 - sine);
        let follows = length < CURVED && cosine > std::f64::consts::FRAC_1_SQRT_2;
        let curve = if follows { acceleration * length / turn } else { f64::INFINITY };
        corner.min(curve).min(most)
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

    /// No more than [`seconds`](Self::seconds), at no cost: of the last 32 moves without speeding
    /// up and braking.
    pub fn at_least(&self) -> f64 {
        self.seconds + self.window_cruise
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
        let most = block.cruise.sqrt();
        // The sum of an empty window is 0, whatever rounding leaves of it.
        let empty = self.window.is_empty();
        self.window_cruise = if empty { 0.0 } else { self.window_cruise - block.length / most };
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

/// A value along a direction, so that no axis has more than its limit.
#[inline]
fn within(value: f64, direction: &Direction, most: &[f64; 4]) -> f64 {
    direction.iter().zip(most).fold(value, |value, (share, most)| {
        let share = share.abs();
        if share * value > *most { most / share } else { value }
    })
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

    /// Speeds up to a corner speed, or slows down from it, s.
    fn ramp(length: f64, speed: f64, corner: f64) -> f64 {
        let ramps = (2.0 * speed * speed - corner * corner) / (2.0 * A);
        (2.0 * speed - corner) / A + (length - ramps) / speed
    }

    #[test]
    fn a_right_angle_is_taken_by_the_junction_deviation() {
        let limits = MotionLimits { junction_deviation: 0.02, ..limits() };
        let mut time = TimeEstimate::new(&limits);
        time.push(Point3::X * 10.0, 60.0, A);
        time.push(Point3::Y * 10.0, 60.0, A);
        let sine = 0.5_f64.sqrt();
        let corner = (A * 0.02 * sine / (1.0 - sine)).sqrt();
        assert!((time.seconds() - 2.0 * ramp(10.0, 60.0, corner)).abs() < 1e-9);
    }

    #[test]
    fn short_moves_keep_to_the_circle_they_follow() {
        // A quarter of a circle of 1 mm in chords of a degree: the junction deviation alone would
        // let it pass at 60 mm/s, the acceleration across it at sqrt(a r) = 31.6 mm/s.
        let degree = std::f64::consts::PI / 180.0;
        let mut time = TimeEstimate::new(&limits());
        time.push(Point3::X * 50.0, 60.0, A);
        let before = time.seconds();
        for i in 0..90 {
            let (y, x) = ((f64::from(i) + 0.5) * degree).sin_cos();
            time.push(Point3::new(x, y, 0.0) * degree, 60.0, A);
        }
        time.push(Point3::Y * 50.0, 60.0, A);
        let round = A.sqrt();
        let want = 2.0 * ramp(50.0, 60.0, round) + 90.0 * degree / round;
        assert!((time.seconds() - want).abs() < 1e-3, "{} {want} {before}", time.seconds());
    }

    #[test]
    fn axes_have_limits_of_their_own() {
        let limits = MotionLimits {
            max_speed: [40.0, 500.0, 10.0, 20.0],
            max_acceleration: [500.0, 3000.0, 100.0, 200.0],
            retract_acceleration: 1000.0,
            ..limits()
        };
        let alone = |delta: Point3| {
            let mut time = TimeEstimate::new(&limits);
            time.push(delta, 60.0, A);
            time.seconds()
        };
        let filament = |length: f64| {
            let mut time = TimeEstimate::new(&limits);
            time.push_filament(length, 35.0);
            time.seconds()
        };
        // At the speed v with the acceleration a: l / v + v / a.
        for (seconds, want) in [
            (alone(Point3::X * 20.0), 20.0 / 40.0 + 40.0 / 500.0),
            (alone(Point3::Y * 20.0), 20.0 / 60.0 + 60.0 / A),
            (alone(Point3::Z * -5.0), 5.0 / 10.0 + 10.0 / 100.0),
            // Along the diagonal, in x half as fast.
            (alone(Point3::new(0.5, 0.75_f64.sqrt(), 0.0) * 40.0), 40.0 / 60.0 + 60.0 / 1000.0),
            (filament(5.0), 5.0 / 20.0 + 20.0 / 200.0),
            (filament(-5.0), 5.0 / 20.0 + 20.0 / 200.0),
            (filament(0.2), 2.0 * (0.2_f64 / 200.0).sqrt()),
        ] {
            assert!((seconds - want).abs() < 1e-9, "{seconds} {want}");
        }
    }

    #[test]
    fn dwelling_and_nothing() {
        let mut time = TimeEstimate::new(&limits());
        time.push(Point3::ZERO, 10.0, A);
        time.push(Point3::X, 0.0, A);
        time.push(Point3::splat(f64::NAN), 10.0, A);
        time.push_filament(0.0, 10.0);
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
            let mut time = TimeEstimate::new(&limits());
            for &(x, y) in &moves {
                time.push(Point3::new(x, y, 0.0), speed, A);
                let (least, seconds) = (time.at_least(), time.seconds());
                prop_assert!(least <= seconds + 1e-9, "{} {}", least, seconds);
            }
        }
    }
}
