use std::{collections::VecDeque, convert::Infallible};

use fgm_core::{ColorId, Motion, Role};

use crate::{Machine, MachineKind, MotionQueue, Step};

/// Moves every change of colour up by a volume of extrusion: the dead volume between the place
/// where the colour is made and the nozzle's tip.
///
/// Takes a stream of motions with [`Motion::Color`] where the *deposit* is to change, and puts in
/// a [`Motion::Command`] where the machine has to be *told*: before the first motion that ends
/// later than the dead volume before the boundary, splitting that motion where the command falls
/// due inside it. Everything extruded counts, purge towers too, across paths and layers; a bead's
/// volume is its length times [`bead::area`](fgm_core::bead::area) times its role's flow. The place is exact to the
/// volume of 0.0001 mm of bead.
///
/// Commands keep their order. One that would fall due before the print begins comes first of all.
/// With a volume of 0 each stands directly before its colour.
///
/// A tool changer cannot change early. [`Lead::notice`] leaves the command at the boundary and
/// puts a [`Step::Notice`] ahead of it, so that the head is hot when it is taken.
///
/// Cost is linear; no more is held than the motions of one dead volume. This is the look-ahead
/// of "dead volume" in the gradient-slicing paper, measured in volume in place of length.
///
/// ```
/// use fgm_core::{ColorId, Motion, Point2, Role, bead};
/// use fgm_gcode::Lead;
///
/// let line = |x| Motion::Extrude { to: Point2::new(x, 0.0), width: 0.4, role: Role::Infill };
/// let print = [
///     Motion::Layer { index: 0, z: 0.2, height: 0.2 },
///     Motion::Travel { to: Point2::ZERO },
///     Motion::Color(ColorId(0)),
///     line(100.0),
///     Motion::Color(ColorId(1)),
///     line(200.0),
/// ];
/// let volume = 30.0 * bead::area(0.4, 0.2);
/// let led: Vec<Motion> = Lead::new(volume).motions(print).collect();
/// assert_eq!(led[0], Motion::Command(ColorId(0)));
/// assert!(matches!(led[4], Motion::Extrude { to, .. } if (to.x - 70.0).abs() < 1e-9));
/// assert_eq!(led[5], Motion::Command(ColorId(1)));
/// assert_eq!(led[6..], [line(100.0), Motion::Color(ColorId(1)), line(200.0)]);
/// ```
#[derive(Clone, Debug)]
pub struct Lead {
    volume: f64,
    early: bool,
    queue: MotionQueue,
    color: Option<ColorId>,
}

impl Lead {
    /// Commands come `volume` mm³ early. A volume that is not above 0 counts as 0.
    pub fn new(volume: f64) -> Self {
        Self {
            volume: if volume > 0.0 { volume } else { 0.0 },
            early: true,
            queue: MotionQueue::default(),
            color: None,
        }
    }

    /// Commands stay at the boundary, and notices come `volume` mm³ early.
    pub fn notice(volume: f64) -> Self {
        Self { early: false, ..Self::new(volume) }
    }

    /// What the machine needs: notices for a tool changer, else early commands; by its own dead
    /// volume.
    pub fn for_machine(machine: &Machine) -> Self {
        Self::with_volume(machine, machine.dead_volume())
    }

    /// As [`for_machine`](Self::for_machine), by another volume, mm³.
    pub fn with_volume(machine: &Machine, volume: f64) -> Self {
        match machine.kind {
            MachineKind::ToolChanger => Self::notice(volume),
            MachineKind::Mixing | MachineKind::Foaming => Self::new(volume),
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
        mut emit: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Motion::Color(color) = motion {
            return self.color(color, &mut emit);
        }
        self.queue.push(motion);
        self.release(&mut emit)
    }

    /// Emits what is held: the print is over.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn finish<E>(mut self, mut emit: impl FnMut(Step) -> Result<(), E>) -> Result<(), E> {
        self.queue.release(f64::INFINITY, &mut |motion| emit(motion.into()))
    }

    /// An iterator over the steps for an iterator of motions.
    pub fn over<I: IntoIterator<Item = Motion>>(self, motions: I) -> Led<I::IntoIter> {
        Led { motions: motions.into_iter(), lead: Some(self), ready: VecDeque::new() }
    }

    /// As [`over`](Self::over), without the notices.
    pub fn motions<I: IntoIterator<Item = Motion>>(
        self,
        motions: I,
    ) -> impl Iterator<Item = Motion> {
        self.over(motions).filter_map(|step| match step {
            Step::Motion(motion) => Some(motion),
            Step::Notice(_) | Step::Tell { .. } | Step::Flow(_) => None,
        })
    }

    fn color<E>(
        &mut self,
        color: ColorId,
        emit: &mut impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let first = self.color.is_none();
        if self.color.replace(color) != Some(color) {
            let due = self.queue.total() - self.volume;
            self.queue.release_exactly(due, &mut |motion| emit(motion.into()))?;
            if self.early || first {
                emit(Step::Motion(Motion::Command(color)))?;
            } else {
                emit(Step::Notice(color))?;
                self.queue.push(Motion::Command(color));
            }
        }
        self.queue.push(Motion::Color(color));
        self.release(emit)
    }

    /// Emits what no command can come before any more.
    fn release<E>(&mut self, emit: &mut impl FnMut(Step) -> Result<(), E>) -> Result<(), E> {
        let due = self.queue.total() - self.volume;
        self.queue.release(due, &mut |motion| emit(motion.into()))
    }
}

/// Iterates over the steps of a print; see [`Lead::over`].
#[derive(Clone, Debug)]
pub struct Led<I> {
    motions: I,
    lead: Option<Lead>,
    ready: VecDeque<Step>,
}

impl<I: Iterator<Item = Motion>> Iterator for Led<I> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        loop {
            if let Some(step) = self.ready.pop_front() {
                return Some(step);
            }
            let ready = &mut self.ready;
            let keep = |step| {
                ready.push_back(step);
                Ok::<(), Infallible>(())
            };
            let Ok(()) = match (self.motions.next(), &mut self.lead) {
                (Some(motion), Some(lead)) => lead.push(motion, keep),
                (None, lead) => lead.take()?.finish(keep),
                (Some(_), None) => return None,
            };
        }
    }
}
