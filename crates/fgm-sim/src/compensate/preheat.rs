//! Temperatures told early enough, and the flow of what is predicted to come out.

use std::collections::VecDeque;

use fgm_core::{ColorId, Motion, Point2, bead};
use fgm_gcode::{Machine, MachineKind, MotionQueue, Pace, State, Step};

use crate::Thermal;

/// The flow follows the predicted temperature in steps of this, °C.
const STEP: f64 = 1.0;
/// Changes of flow below this are not told.
const SAME: f64 = 1e-3;

/// Moves the changes of a foaming filament's temperature up, by the time that the nozzle takes to
/// heat or cool and by the volume between the melting and the tip, and lets the flow follow the
/// temperature that is predicted for what comes out: takes the place of
/// [`Lead`](fgm_gcode::Lead) where the profile names the rates (`foaming.heating` and `cooling`).
///
/// A change is centred on its boundary, so that on both sides of it as much is off; after a purge
/// tower it is over at the boundary. Motions come with [`Motion::Color`] where the deposit is to
/// change and go on without, since the flow no longer changes there: with [`Motion::Command`]
/// where the temperature is told and [`Step::Flow`] where the flow changes.
///
/// Time goes by the speeds of the profile, without acceleration. What is held is the motions of
/// the volume to the tip and of the longest change of temperature.
#[derive(Clone, Debug)]
pub struct Preheat {
    machine: Machine,
    thermal: Thermal,
    lead: f64,
    states: Vec<State>,
    queue: MotionQueue,
    clock: Clock,
    color: Option<ColorId>,
    at: Option<Point2>,
    height: f64,
    layers: u32,
    pace: Pace,
    /// Whether the last bead was a purge tower's.
    purged: bool,
    /// Temperatures told, in order of time; those before `written` are out.
    told: VecDeque<Told>,
    written: usize,
    melt: Melt,
}

#[derive(Clone, Copy, Debug)]
struct Told {
    seconds: f64,
    celsius: f64,
    color: ColorId,
}

/// What melts: followed along the time, a lead behind what comes out.
#[derive(Clone, Copy, Debug)]
struct Melt {
    seconds: f64,
    celsius: f64,
    told: f64,
    flow: f64,
}

impl Preheat {
    /// For a palette's states; none for a machine that does not foam or names no rates.
    pub fn of(machine: &Machine, lead: f64, states: &[State]) -> Option<Self> {
        let thermal = Thermal::of(machine).filter(|_| machine.kind == MachineKind::Foaming)?;
        let celsius = machine.foaming.low;
        Some(Self {
            machine: machine.clone(),
            thermal,
            lead: lead.max(0.0),
            states: states.to_vec(),
            queue: MotionQueue::default(),
            clock: Clock::default(),
            color: None,
            at: None,
            height: 0.0,
            layers: 0,
            pace: Pace::USUAL,
            purged: false,
            told: VecDeque::new(),
            written: 0,
            melt: Melt { seconds: 0.0, celsius, told: celsius, flow: 1.0 },
        })
    }

    /// Beads of the motions that come from here on go at this pace.
    pub fn set_pace(&mut self, pace: Pace) {
        self.pace = pace;
    }

    /// Takes the next motion and emits what no command can come before any more.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn push<E>(
        &mut self,
        motion: Motion,
        mut emit: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Motion::Color(color) = motion {
            return self.boundary(color, &mut emit);
        }
        let seconds = self.duration(&motion);
        self.queue.push(motion);
        self.clock.push(self.queue.total(), seconds);
        let longest = (self.machine.foaming.high - self.machine.foaming.low).abs()
            / self.thermal.heating.min(self.thermal.cooling);
        let now = self.clock.seconds_at(self.queue.total() - self.lead) - longest;
        self.release(now, &mut emit)
    }

    /// Emits what is held: the print is over.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn finish<E>(mut self, mut emit: impl FnMut(Step) -> Result<(), E>) -> Result<(), E> {
        self.release(f64::INFINITY, &mut emit)
    }

    fn boundary<E>(
        &mut self,
        color: ColorId,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let first = self.color.is_none();
        if self.color.replace(color) == Some(color) {
            return Ok(());
        }
        let Some(state) = self.states.get(color.index()) else { return Ok(()) };
        let celsius = state.temperature.unwrap_or(self.machine.foaming.low);
        if first {
            self.melt = Melt { seconds: 0.0, celsius, told: celsius, flow: state.flow };
            return emit(Step::Motion(Motion::Command(color)));
        }
        let last = self.told.back();
        let change = celsius - last.map_or(self.melt.told, |told| told.celsius);
        let rate = if change > 0.0 { self.thermal.heating } else { self.thermal.cooling };
        let share = if self.purged { 1.0 } else { 0.5 };
        let melts = self.clock.seconds_at(self.queue.total() - self.lead);
        let earliest = last.map_or(0.0, |told| told.seconds);
        let seconds = (melts - share * change.abs() / rate).max(earliest);
        self.told.push_back(Told { seconds, celsius, color });
        Ok(())
    }

    /// Emits what ends before a time, with the commands and flows that fall due.
    fn release<E>(
        &mut self,
        seconds: f64,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        if seconds <= 0.0 {
            return Ok(());
        }
        let volume = self.clock.volume_at(seconds);
        while let Some(told) = self.told.get(self.written).copied() {
            if told.seconds > seconds {
                break;
            }
            let due = self.clock.volume_at(told.seconds);
            self.flows(due, emit)?;
            self.queue.release_exactly(due, &mut |motion| emit(motion.into()))?;
            emit(Step::Motion(Motion::Command(told.color)))?;
            self.written += 1;
        }
        self.flows(volume, emit)?;
        self.queue.release(volume, &mut |motion| emit(motion.into()))?;
        self.clock.forget(volume - self.lead);
        Ok(())
    }

    /// Follows what melts until it comes out at a volume, and tells the flows on the way.
    fn flows<E>(
        &mut self,
        volume: f64,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        if volume <= self.lead {
            return Ok(());
        }
        let end = self.clock.seconds_at(volume - self.lead);
        loop {
            let next = self.told.front().filter(|_| self.written > 0).map(|told| told.seconds);
            let until = next.unwrap_or(f64::INFINITY).min(end);
            while self.melt.celsius != self.melt.told {
                let gap = self.melt.told - self.melt.celsius;
                let rate = if gap > 0.0 { self.thermal.heating } else { self.thermal.cooling };
                let by = gap.abs().min(STEP);
                let seconds = self.melt.seconds + by / rate;
                // The flow of a step is that of its middle.
                self.tell_flow(self.melt.celsius + 0.5 * by * gap.signum(), emit)?;
                if seconds > until {
                    break;
                }
                self.melt.seconds = seconds;
                let reached = self.melt.celsius + by * gap.signum();
                self.melt.celsius = if by < STEP { self.melt.told } else { reached };
            }
            if self.melt.celsius == self.melt.told {
                self.tell_flow(self.melt.celsius, emit)?;
                self.melt.seconds = self.melt.seconds.max(until);
            }
            match self.told.front().filter(|_| self.written > 0 && next.is_some_and(|t| t <= end)) {
                Some(told) => {
                    // What is between two steps stays as it is: a degree is not seen.
                    self.melt.seconds = self.melt.seconds.max(told.seconds);
                    self.melt.told = told.celsius;
                    self.told.pop_front();
                    self.written -= 1;
                }
                None => return Ok(()),
            }
        }
    }

    /// Tells the flow of what melts from now on, where it comes out.
    fn tell_flow<E>(
        &mut self,
        celsius: f64,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let flow = self.machine.foaming.flow_at(celsius);
        if (flow - self.melt.flow).abs() < SAME || flow.is_nan() {
            return Ok(());
        }
        self.melt.flow = flow;
        let due = self.clock.volume_at(self.melt.seconds) + self.lead;
        self.queue.release_exactly(due, &mut |motion| emit(motion.into()))?;
        emit(Step::Flow(flow))
    }

    /// How long a motion takes, s.
    fn duration(&mut self, motion: &Motion) -> f64 {
        let (to, speed) = match *motion {
            Motion::Layer { height, .. } => {
                (self.height, self.layers) = (height, self.layers + 1);
                return 0.0;
            }
            Motion::Travel { to } => (to, self.machine.speed.travel),
            Motion::Extrude { to, width, role } => {
                self.purged = role.is_purge();
                let fed = bead::area(width, self.height) * self.melt.flow;
                let state = self.states.first();
                let usual = self.machine.bead_speed(role, fed, state, self.layers <= 1);
                (to, self.pace.speed(role, usual))
            }
            Motion::Rise { .. } | Motion::Color(_) | Motion::Command(_) => return 0.0,
        };
        let from = self.at.replace(to).unwrap_or(to);
        let seconds = from.distance(to) / speed;
        if seconds.is_finite() { seconds } else { 0.0 }
    }
}

/// Volume and time along the print.
#[derive(Clone, Debug)]
struct Clock {
    /// Volume and time at the ends of motions.
    moments: VecDeque<(f64, f64)>,
}

impl Default for Clock {
    fn default() -> Self {
        Self { moments: VecDeque::from([(0.0, 0.0)]) }
    }
}

impl Clock {
    fn push(&mut self, volume: f64, seconds: f64) {
        let last = self.moments.back().map_or(0.0, |moment| moment.1);
        if seconds > 0.0 {
            self.moments.push_back((volume, last + seconds));
        }
    }

    /// When a volume is reached first.
    fn seconds_at(&self, volume: f64) -> f64 {
        let next = self.moments.partition_point(|moment| moment.0 < volume);
        self.between(next, |(v0, t0), (v1, t1)| t0 + (t1 - t0) * (volume - v0) / (v1 - v0)).1
    }

    /// What is extruded by a time.
    fn volume_at(&self, seconds: f64) -> f64 {
        let next = self.moments.partition_point(|moment| moment.1 < seconds);
        self.between(next, |(v0, t0), (v1, t1)| v0 + (v1 - v0) * (seconds - t0) / (t1 - t0)).0
    }

    /// The moment before `next`, or between it and that one as `inside` says, in both places.
    fn between(&self, next: usize, inside: impl Fn((f64, f64), (f64, f64)) -> f64) -> (f64, f64) {
        match (next.checked_sub(1).and_then(|i| self.moments.get(i)), self.moments.get(next)) {
            (Some(before), Some(after)) => {
                let value = inside(*before, *after);
                (value, value)
            }
            (None, Some(first)) => *first,
            (Some(last), None) => *last,
            (None, None) => (0.0, 0.0),
        }
    }

    /// Drops the moments before a volume, but for one.
    fn forget(&mut self, volume: f64) {
        while self.moments.get(1).is_some_and(|moment| moment.0 < volume) {
            self.moments.pop_front();
        }
    }
}
