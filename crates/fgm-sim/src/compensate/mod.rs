//! Commands chosen so that the deposit, not the command, follows the design.
//!
//! The deposit is a moving average of the commands ([`Transition`]). The plain lead puts the middle
//! of every change in its place, and leaves the change as long as the transition. Here the
//! commands are chosen by bounded least squares: over cells of equal volume, each a mixture, the
//! deposit comes as near as possible to what is wanted. Since the average can be undone only as
//! far as it is known, the squared error is not that of one machine: it is summed over the measured
//! one and over those with delay and length off by the uncertainty, each with a weight such that
//! none comes out worse than with the plain lead (`tune`). The extrusion is taken block by block
//! (`planner`), each with a stretch of what follows, so that time is linear and memory a few dozen
//! transitions.

mod figures;
mod misfit;
mod planner;
mod preheat;
mod solve;
mod track;
mod tune;

use fgm_core::{ColorId, Mixture, Motion, Role};
use fgm_gcode::{Machine, MotionQueue, State, Step};

use crate::Transition;
use figures::Figures;
use misfit::Matter;
use planner::Planner;
use track::Told;

pub use figures::{Fit, HiddenFit};
pub use preheat::Preheat;

/// The shortest segment where none is given, mm³: a few mm of an ordinary bead.
const SHORTEST: f64 = 0.2;

/// How commands are chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct CompensateOptions {
    /// Whether to choose at all; else the plain lead is written and its error measured.
    pub enabled: bool,
    /// How the deposit follows a command.
    pub transition: Transition,
    /// The plain lead, mm³: commands go out this much before their boundary.
    pub lead: f64,
    /// Share by which the transition's delay and length may each be off, 0 to below 1: there the
    /// deposit is no worse than with the plain lead, over the whole print.
    pub uncertainty: f64,
    /// Least volume that a command lasts, mm³.
    pub shortest: f64,
    /// No ratio lies between 0 and this.
    pub min_fraction: f64,
    /// Decimals of a ratio that the firmware tells apart.
    pub decimals: u32,
}

impl CompensateOptions {
    /// For a machine with a transition, trusted to a fifth; none for one without.
    pub fn of(machine: &Machine) -> Option<Self> {
        let transition = Transition::of(machine)?;
        Some(Self {
            enabled: true,
            transition,
            lead: machine.dead_volume(),
            uncertainty: 0.2,
            shortest: SHORTEST,
            min_fraction: machine.min_fraction,
            decimals: machine.dialect.name.ratio_decimals(),
        })
    }
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensated {
    /// First for the machine as measured, then with its delay and length off by the uncertainty:
    /// both more, both less, delay more and length less, delay less and length more.
    pub fits: Vec<Fit>,
    /// What purges laid into the part; none where there are none. No command is chosen for it, and
    /// it is not part of the fits.
    pub hidden: Option<HiddenFit>,
    /// Commands written.
    pub commands: u64,
}

/// Chooses the commands of a print so that its deposit is as it should be: takes the place of
/// [`Lead`](fgm_gcode::Lead) between the motions and the writer.
///
/// Motions come with [`Motion::Color`] where the *deposit* is to change. What goes on has the
/// commands among them: [`Motion::Command`] for a colour of the palette, [`Step::Tell`] for a
/// mixture between two colours or beyond them, each at its exact volume, where need be inside a
/// bead. Commands are fractions that the firmware can tell apart and last at least the shortest
/// volume; neither the beads nor their order change. Everything extruded counts, but what is no
/// part of the print ([`Role::is_part`]) or takes a purge ([`Role::is_purge`]), such as a tower,
/// may have any mixture: a change is hidden there where it can be.
///
/// Without [`CompensateOptions::enabled`], or with a transition too short to choose anything, the
/// commands are those of the plain lead.
///
/// ```
/// use fgm_core::{ColorId, Mixture, Motion, Point2, Role};
/// use fgm_gcode::{Machine, Step};
/// use fgm_sim::{Compensate, CompensateOptions};
///
/// let machine = Machine::from_toml("[transition]\ndelay = 5.0\nchange = 10.0")?;
/// let options = CompensateOptions::of(&machine).ok_or("no transition")?;
/// let palette = [Mixture::from_weights(&[0.75, 0.25])?, Mixture::from_weights(&[0.25, 0.75])?];
/// let mut compensate = Compensate::new(&options, &palette, &machine.states(&palette)?);
///
/// let mut steps: Vec<Step> = Vec::new();
/// let mut emit = |step| {
///     steps.push(step);
///     Ok::<(), std::convert::Infallible>(())
/// };
/// let line = |x| Motion::Extrude { to: Point2::new(x, 0.0), width: 0.4, role: Role::Infill };
/// compensate.push(Motion::Layer { index: 0, z: 0.2, height: 0.2 }, &mut emit)?;
/// compensate.push(Motion::Color(ColorId(0)), &mut emit)?;
/// compensate.push(Motion::Travel { to: Point2::ZERO }, &mut emit)?;
/// compensate.push(line(2000.0), &mut emit)?;
/// compensate.push(Motion::Color(ColorId(1)), &mut emit)?;
/// compensate.push(line(0.0), &mut emit)?;
/// let fits = compensate.finish(&mut emit)?.fits;
/// assert!(fits[0].told < 0.8 * fits[0].plain);
/// assert!(fits.iter().all(|fit| fit.told <= fit.plain));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Compensate {
    options: CompensateOptions,
    queue: MotionQueue,
    /// What each colour is to be, and what the machine is told for it.
    targets: Vec<Mixture>,
    states: Vec<State>,
    color: ColorId,
    planner: Option<Planner>,
    commands: u64,
}

impl Compensate {
    /// For a palette: what each colour is to be, and the machine's state for it.
    pub fn new(options: &CompensateOptions, targets: &[Mixture], states: &[State]) -> Self {
        Self {
            options: options.clone(),
            queue: MotionQueue::default(),
            targets: targets.to_vec(),
            states: states.to_vec(),
            color: ColorId(0),
            planner: None,
            commands: 0,
        }
    }

    /// Counts the beads of a role with a factor, as they are extruded.
    #[must_use]
    pub fn with_flow(mut self, role: Role, factor: f64) -> Self {
        self.queue.set_flow(role, factor);
        self
    }

    /// Takes the next motion and emits what no command can come before any more.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn push<E>(
        &mut self,
        motion: Motion,
        emit: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        self.push_toward(motion, &[], emit)
    }

    /// As [`push`](Self::push), for a bead whose deposit is to be these mixtures, each over an
    /// equal share of its length, rather than its colour's. With none it is the colour's.
    ///
    /// The colours still say what the plain lead tells. Mixtures along less than half a cell are
    /// taken together, so that memory does not grow with their number.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn push_toward<E>(
        &mut self,
        motion: Motion,
        wanted: &[Mixture],
        mut emit: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Motion::Color(color) = motion {
            self.boundary(color, &mut emit)?;
        }
        let volume = self.queue.push(motion);
        let Motion::Extrude { role, .. } = motion else { return Ok(()) };
        if let (Some(planner), Some(target)) =
            (&mut self.planner, self.targets.get(self.color.index()))
        {
            let matter = Matter::of(role);
            if wanted.is_empty() {
                planner.want(volume, *target, matter);
            }
            let part = volume / wanted.len() as f64;
            wanted.iter().for_each(|mixture| planner.want_about(part, *mixture, matter));
        }
        self.settle(false, &mut emit)
    }

    /// Emits what is held: the print is over.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn finish<E>(
        mut self,
        mut emit: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<Compensated, E> {
        self.settle(true, &mut emit)?;
        self.queue.release(f64::INFINITY, &mut |motion| emit(motion.into()))?;
        let figures = self.planner.map(Planner::figures);
        let fits = figures.as_ref().map(Figures::fits).unwrap_or_default();
        let hidden = figures.as_ref().and_then(Figures::hidden);
        Ok(Compensated { fits, hidden, commands: self.commands })
    }

    fn boundary<E>(
        &mut self,
        color: ColorId,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let changes = self.planner.is_none() || self.color != color;
        self.color = color;
        let Some(state) = self.states.get(color.index()).filter(|_| changes) else { return Ok(()) };
        if let Some(planner) = &mut self.planner {
            planner.boundary(state.mixture, color);
            return Ok(());
        }
        self.planner = Some(Planner::new(&self.options, state.mixture, color));
        emit(Step::Motion(Motion::Command(color)))
    }

    fn settle<E>(
        &mut self,
        finished: bool,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let Self { planner: Some(planner), queue, states, commands, .. } = self else {
            return Ok(());
        };
        loop {
            let settled = planner.settle(finished, &mut |told: &Told| {
                queue.release_exactly(told.at, &mut |motion| emit(motion.into()))?;
                *commands += 1;
                emit(step(told, states))
            })?;
            if !settled {
                return Ok(());
            }
            queue.release(planner.settled(), &mut |motion| emit(motion.into()))?;
        }
    }
}

/// A command as the writer takes it: a colour, or a mixture shown as the nearest colour.
fn step(told: &Told, states: &[State]) -> Step {
    if let Some(color) = told.color {
        return Step::Motion(Motion::Command(color));
    }
    let distance = |state: &State| state.mixture.distance(&told.mixture);
    let nearest = states.iter().zip((0..).map(ColorId));
    let nearest = nearest.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
    let (state, color) =
        nearest.map_or((State::plain(told.mixture), ColorId(0)), |(state, color)| (*state, color));
    Step::Tell { color, state: State { mixture: told.mixture, ..state } }
}
