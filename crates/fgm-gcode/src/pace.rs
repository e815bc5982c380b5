use fgm_core::{Motion, Point2, Point3, Role, bead};

use crate::{Machine, State, TimeEstimate};

/// Steps by which the factor of a layer is found: to a share of 1e-5.
const STEPS: u32 = 17;

/// How much slower than usual the beads of a layer go, so that it can cool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Factor on the speed of the walls that are seen.
    pub outer_walls: f64,
    /// Factor on that of all other beads.
    pub rest: f64,
    /// No bead is slowed below this, mm/s.
    pub least: f64,
}

impl Pace {
    /// As the profile says.
    pub const USUAL: Self = Self { outer_walls: 1.0, rest: 1.0, least: 0.0 };

    /// The speed of a bead that usually has `speed`, mm/s.
    pub fn speed(&self, role: Role, speed: f64) -> f64 {
        let factor = if role == Role::OuterWall { self.outer_walls } else { self.rest };
        (speed * factor).max(speed.min(self.least))
    }
}

/// Slows the beads of layers that would take less than a time.
///
/// All beads but the walls that are seen are slowed first, by one factor; then those walls, too.
/// Travels and retractions keep their speed. The time is that of [`TimeEstimate`], with the
/// retractions and lifts that the writer puts before travels, but for its last bits of rounding.
#[derive(Clone, Debug)]
pub struct Pacer {
    machine: Machine,
    states: Vec<State>,
    min_layer_time: f64,
    min_speed: f64,
}

/// How long a layer takes, and its pace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paced {
    /// What its beads go by.
    pub pace: Pace,
    /// With the profile's speeds, s.
    pub usual: f64,
    /// At the pace, s: less than the time asked for where not even the least speed is slow enough.
    pub seconds: f64,
}

impl Pacer {
    /// For layers of at least `min_layer_time` s, with beads of at least `min_speed` mm/s (or
    /// their own speed, where that is less), in colours of these states.
    pub fn new(machine: &Machine, states: &[State], min_layer_time: f64, min_speed: f64) -> Self {
        let (machine, states) = (machine.clone(), states.to_vec());
        Self { machine, states, min_layer_time, min_speed }
    }

    /// The pace of a layer whose motions `motions` gives each time it is called, which comes after
    /// a place, in a colour's state; none for one that needs none.
    pub fn pace<I: Iterator<Item = Motion>>(
        &self,
        motions: impl Fn() -> I,
        from: Option<Point2>,
        state: Option<&State>,
        first_layer: bool,
    ) -> Option<Paced> {
        let at = |pace: Pace, enough: f64| {
            let mut layer = LayerTime::new(self, pace, from, state, first_layer);
            // Without speeding up and braking it takes no more: most layers are long enough even so.
            for motion in motions() {
                layer.push(&motion);
                if layer.cruise >= enough {
                    return f64::INFINITY;
                }
            }
            layer.time.seconds()
        };
        let usual = at(Pace::USUAL, self.min_layer_time);
        if usual >= self.min_layer_time || usual == 0.0 {
            return None;
        }
        let least = Pace { outer_walls: 1.0, rest: 0.0, least: self.min_speed };
        let rest = |factor| Pace { rest: factor, ..least };
        let walls = |factor| Pace { outer_walls: factor, ..least };
        let seconds = |pace| at(pace, f64::INFINITY);
        let pace = if seconds(least) >= self.min_layer_time {
            self.search(rest, seconds)
        } else {
            self.search(walls, seconds)
        };
        Some(Paced { pace, usual, seconds: seconds(pace) })
    }

    /// The greatest factor with which the layer takes the time asked for, or 0.
    fn search(&self, pace: impl Fn(f64) -> Pace, seconds: impl Fn(Pace) -> f64) -> Pace {
        let (mut slow, mut fast) = (0.0, 1.0);
        for _ in 0..STEPS {
            let middle = 0.5 * (slow + fast);
            if seconds(pace(middle)) >= self.min_layer_time { slow = middle } else { fast = middle }
        }
        pace(slow)
    }
}

/// The time of a layer, motion after motion.
struct LayerTime<'a> {
    pacer: &'a Pacer,
    pace: Pace,
    first_layer: bool,
    time: TimeEstimate,
    /// Of the beads, without speeding up and braking, s.
    cruise: f64,
    at: Option<Point2>,
    height: f64,
    state: Option<&'a State>,
    /// Length of the travel so far, mm.
    way: f64,
    retracted: bool,
}

impl<'a> LayerTime<'a> {
    fn new(
        pacer: &'a Pacer,
        pace: Pace,
        at: Option<Point2>,
        state: Option<&'a State>,
        first_layer: bool,
    ) -> Self {
        let time = TimeEstimate::new(&pacer.machine.motion);
        let (cruise, height, way, retracted) = (0.0, 0.0, 0.0, false);
        Self { pacer, pace, first_layer, time, cruise, at, height, state, way, retracted }
    }

    fn push(&mut self, motion: &Motion) {
        let machine = &self.pacer.machine;
        match *motion {
            Motion::Layer { height, .. } => self.height = height,
            Motion::Color(color) => {
                let state = self.pacer.states.get(color.index());
                let heads = |state: Option<&State>| state.and_then(|state| state.tool);
                if heads(state) != heads(self.state) {
                    self.time.dwell(machine.tool_change.seconds);
                }
                self.state = state;
            }
            Motion::Rise { .. } | Motion::Command(_) => {}
            Motion::Travel { to } => {
                let by = to - self.at.replace(to).unwrap_or(to);
                self.way += by.length();
                if self.way >= machine.retraction.min_travel {
                    self.retract(true);
                }
                let acceleration = machine.motion.travel_acceleration;
                self.time.push(by.extend(0.0), machine.speed.travel, acceleration);
            }
            Motion::Extrude { to, width, role } => {
                self.retract(false);
                self.way = 0.0;
                let by = to - self.at.replace(to).unwrap_or(to);
                let state = self.state;
                let fed = bead::area(width, self.height) * state.map_or(1.0, |state| state.flow);
                let usual = machine.bead_speed(role, fed, state, self.first_layer);
                let speed = self.pace.speed(role, usual);
                self.cruise += by.length() / speed;
                self.time.push(by.extend(0.0), speed, machine.motion.acceleration);
            }
        }
    }

    /// Pulls the filament back and lifts the nozzle, or the other way round.
    fn retract(&mut self, wanted: bool) {
        if std::mem::replace(&mut self.retracted, wanted) == wanted {
            return;
        }
        let machine = &self.pacer.machine;
        let (sign, retraction) = (if wanted { 1.0 } else { -1.0 }, &machine.retraction);
        let (lift, speed) = (Point3::Z * (sign * retraction.z_hop), machine.speed.z);
        if !wanted {
            self.time.push(lift, speed, machine.motion.travel_acceleration);
        }
        self.time.push_filament(-sign * retraction.length, retraction.speed);
        if wanted {
            self.time.push(lift, speed, machine.motion.travel_acceleration);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn machine() -> Machine {
        let mut machine = Machine::default();
        (machine.speed.outer_wall, machine.speed.inner_wall) = (40.0, 60.0);
        machine
    }

    /// A square wall of each role, `side` mm long.
    fn square(side: f64) -> Vec<Motion> {
        let mut motions = vec![Motion::Layer { index: 3, z: 0.8, height: 0.2 }];
        for (role, side) in [(Role::InnerWall, side - 0.8), (Role::OuterWall, side)] {
            let corner = |x: f64, y: f64| Point2::new(x * side, y * side);
            motions.push(Motion::Travel { to: corner(0.0, 0.0) });
            motions.extend(
                [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)].map(|(x, y)| Motion::Extrude {
                    to: corner(x, y),
                    width: 0.4,
                    role,
                }),
            );
        }
        motions
    }

    fn paced(side: f64, least_time: f64, least_speed: f64) -> Option<Paced> {
        let pacer = Pacer::new(&machine(), &[], least_time, least_speed);
        let motions = square(side);
        pacer.pace(|| motions.iter().copied(), None, None, false)
    }

    #[test]
    fn walls_that_are_seen_are_slowed_last() {
        // About 80 mm at 40 and 60 mm/s: 3.5 s and corners.
        assert_eq!(paced(20.0, 3.0, 10.0), None);
        let little = paced(20.0, 5.0, 10.0).unwrap();
        assert!(little.pace.outer_walls == 1.0 && little.pace.rest < 1.0, "{little:?}");
        let much = paced(20.0, 12.0, 10.0).unwrap();
        assert!(much.pace.outer_walls < 1.0 && much.pace.rest == 0.0, "{much:?}");
        assert_eq!(much.pace.speed(Role::InnerWall, 60.0), 10.0);
        let most = paced(20.0, 60.0, 10.0).unwrap();
        assert!((15.0..20.0).contains(&most.seconds), "{most:?}");
        // What is slow by itself stays as it is.
        assert_eq!(most.pace.speed(Role::OuterWall, 4.0), 4.0);
    }

    #[test]
    fn a_layer_of_nothing_needs_no_time() {
        let pacer = Pacer::new(&machine(), &[], 5.0, 10.0);
        let motions = [Motion::Layer { index: 0, z: 0.2, height: 0.2 }];
        assert_eq!(pacer.pace(|| motions.into_iter(), None, None, true), None);
    }

    proptest! {
        #[test]
        fn a_slowed_layer_takes_the_time_asked_for(
            side in 1.0..60.0f64,
            least_time in 0.0..30.0f64,
            least_speed in 1.0..20.0f64,
        ) {
            let Some(paced) = paced(side, least_time, least_speed) else { return Ok(()) };
            prop_assert!(paced.usual < least_time && paced.seconds >= paced.usual);
            let slowest = paced.pace == Pace { outer_walls: 0.0, rest: 0.0, least: least_speed };
            if !slowest {
                prop_assert!(paced.seconds >= least_time, "{:?}", paced);
                prop_assert!(paced.seconds <= least_time * 1.001 + 1e-3, "{:?}", paced);
            }
        }
    }
}
