mod change;
mod head;
mod layer;
mod moves;
mod options;
mod position;
mod summary;

use std::{collections::VecDeque, io};

use fgm_core::{ColorId, Motion, Point2};

use crate::{
    Dialect, GcodeError, Machine, MachineKind, Pace, ProgressLines, State, Step, Text,
    TimeEstimate, dialect::Change,
};
use change::Heads;
use moves::Bead;
use position::Position;

pub use options::WriterOptions;
pub use summary::Summary;

/// Text is handed on in blocks of about this many bytes.
const BLOCK: usize = 1 << 16;
/// Steps that may come before the first colour.
const EARLIEST: usize = 1024;

/// Writes a stream of motions as G-code.
///
/// Motions come in the design's coordinates and are moved by the options' offset. Every position
/// is checked against the bed, every number is finite, nothing is extruded before the nozzle is
/// hot. E is relative; what rounding leaves over goes to the next bead, so that the sum of all E
/// is the true one to the last decimal. Beads shorter than the resolution are not written, and
/// their filament goes to the next one.
///
/// On a layer that rises every bead has its own height, which never falls.
///
/// Travels that follow each other are one: whether the filament is pulled back goes by their whole
/// length.
///
/// A stream without any [`Motion::Command`] has its commands where its colours change; put a
/// [`Lead`](crate::Lead) before the writer to have them earlier.
///
/// The start template, in which the first colour is set, is written when that colour is known,
/// which is at the first [`Motion::Command`] or [`Motion::Color`].
pub struct Writer<W: io::Write> {
    out: W,
    text: Text,
    /// The last tag, kept for its memory.
    tag: Vec<u8>,
    machine: Machine,
    states: Vec<State>,
    options: WriterOptions,
    dialect: Box<dyn Dialect + Send>,
    /// Steps before the first colour; none once the print has begun.
    early: Option<Vec<Step>>,
    heads: Heads,
    position: Position,
    bead: Bead,
    /// Where a travel goes that has not been written: it may go on.
    travel: Vec<Point2>,
    /// Of this layer, and of those to come, by their index.
    pace: Pace,
    paces: VecDeque<(u32, Pace)>,
    time: TimeEstimate,
    /// Fed since the last command, mm³.
    fed: f64,
    summary: Summary,
}

impl<W: io::Write> Writer<W> {
    /// Writes to `out`, in the dialect of the machine's profile. Nothing is written yet.
    ///
    /// # Errors
    /// [`GcodeError::NoColors`]; [`GcodeError::Cold`] for a nozzle below the least temperature for
    /// extrusion; [`GcodeError::Setting`], [`GcodeError::Template`] and
    /// [`GcodeError::DialectMismatch`] for a faulty profile.
    pub fn new(
        out: W,
        machine: &Machine,
        states: &[State],
        options: &WriterOptions,
    ) -> Result<Self, GcodeError> {
        machine.validate_dialect()?;
        Self::with_dialect(out, machine, states, options, machine.dialect())
    }

    /// As [`new`](Self::new), in a dialect of your own.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_dialect(
        out: W,
        machine: &Machine,
        states: &[State],
        options: &WriterOptions,
        dialect: Box<dyn Dialect + Send>,
    ) -> Result<Self, GcodeError> {
        let mut used = machine.clone();
        used.speed = options.speeds.clone();
        used.temperature = options.temperatures.clone();
        used.retraction = options.retraction.clone();
        used.fan = options.fan.clone();
        used.motion = options.limits.clone();
        used.max_flow = options.max_flow;
        used.validate()?;
        let mut dialect = dialect;
        dialect.palette(states);
        let first = *states.first().ok_or(GcodeError::NoColors)?;
        let inputs = Summary::inputs(machine.kind, states, machine.inputs);
        let writer = Self {
            out,
            text: Text::new(),
            tag: Vec::new(),
            time: TimeEstimate::new(&options.limits),
            position: Position::new(machine.bed.bounds(), options.offset),
            machine: used,
            states: states.to_vec(),
            options: options.clone(),
            dialect,
            early: Some(Vec::new()),
            heads: Heads::new(states, first),
            bead: Bead::default(),
            travel: Vec::new(),
            pace: Pace::USUAL,
            paces: VecDeque::new(),
            fed: 0.0,
            summary: Summary::new(inputs),
        };
        writer.check_hot()?;
        Ok(writer)
    }

    /// Writes the next motion, or heats for a notice.
    ///
    /// # Errors
    /// [`GcodeError`]: outside the bed, an unknown colour, a bead too large, no number, or what
    /// the output gives. The print cannot go on after an error.
    pub fn push(&mut self, step: impl Into<Step>) -> Result<(), GcodeError> {
        let step = step.into();
        if let Some(early) = &mut self.early {
            let color = match step {
                Step::Motion(Motion::Command(color) | Motion::Color(color))
                | Step::Tell { color, .. } => color,
                Step::Motion(Motion::Extrude { .. }) => ColorId(0),
                _ if early.len() >= EARLIEST => ColorId(0),
                _ => {
                    early.push(step);
                    return Ok(());
                }
            };
            self.begin(color)?;
        }
        self.step(step)?;
        if self.options.progress
            && self.time.at_least() - self.summary.progress.last() >= ProgressLines::STEP
        {
            self.mark_progress(self.time.seconds());
        }
        if self.text.as_bytes().len() >= BLOCK { self.flush() } else { Ok(()) }
    }

    /// Slows the beads of a layer that is still to come, by the index that it will have. Layers come
    /// in the order of their paces.
    pub fn slow(&mut self, layer: u32, pace: Pace) {
        self.paces.push_back((layer, pace));
    }

    /// Ends the print, and hands the last bytes on.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    pub fn finish(mut self) -> Result<Summary, GcodeError> {
        if self.early.is_some() {
            self.begin(ColorId(0))?;
        }
        self.end_travel()?;
        self.count_fed();
        self.tail()?;
        self.flush()?;
        self.out.flush()?;
        self.summary.bytes = self.text.written();
        Ok(self.summary)
    }

    /// Writes the head and what came before the first colour.
    fn begin(&mut self, color: ColorId) -> Result<(), GcodeError> {
        let early = self.early.take().unwrap_or_default();
        self.head(color)?;
        early.into_iter().try_for_each(|step| self.step(step))
    }

    #[inline]
    fn step(&mut self, step: Step) -> Result<(), GcodeError> {
        if let Step::Motion(Motion::Travel { to }) = step {
            self.travel.push(self.position.place(to)?);
            return Ok(());
        }
        self.end_travel()?;
        match step {
            Step::Motion(Motion::Extrude { to, width, role }) => self.extrude(to, width, role),
            Step::Motion(Motion::Travel { .. }) => Ok(()),
            Step::Motion(Motion::Layer { index, z, height }) => self.layer(index, z, height),
            Step::Motion(Motion::Rise { from, length }) => self.rise(from, length),
            Step::Motion(Motion::Command(color)) => self.command(color),
            Step::Motion(Motion::Color(color)) => self.deposit(color),
            Step::Notice(color) => self.notice(color),
            Step::Tell { color, state } => self.tell(color, state),
            Step::Flow(flow) => self.flow(flow),
        }
    }

    /// A line that tells the progress, where the firmware takes it.
    fn mark_progress(&mut self, seconds: f64) {
        if self.options.progress {
            self.summary.progress.mark(seconds, &mut self.text);
        }
    }

    fn flush(&mut self) -> Result<(), GcodeError> {
        self.out.write_all(self.text.as_bytes())?;
        self.text.taken();
        Ok(())
    }

    /// Whether every nozzle is hot enough to extrude.
    fn check_hot(&self) -> Result<(), GcodeError> {
        let temperatures = &self.options.temperatures;
        let least = temperatures.min_extrusion;
        let cold = |what: String, celsius: f64| match celsius >= least {
            true => Ok(()),
            false => Err(GcodeError::Cold { what, celsius, least }),
        };
        for (i, state) in self.states.iter().enumerate() {
            match state.temperature {
                Some(celsius) => cold(format!("colour {i}"), celsius)?,
                None => {
                    cold("the first layer".into(), temperatures.first_layer)?;
                    cold("the nozzle".into(), temperatures.nozzle)?;
                }
            }
        }
        Ok(())
    }

    fn state(&self, color: ColorId) -> Result<State, GcodeError> {
        self.states
            .get(color.index())
            .copied()
            .ok_or(GcodeError::UnknownColor { color: color.index(), colors: self.states.len() })
    }

    /// The temperature that a state prints at, now, °C.
    fn temperature_of(&self, state: &State) -> f64 {
        let usual = &self.options.temperatures;
        let now = if self.summary.layers <= 1 { usual.first_layer } else { usual.nozzle };
        state.temperature.unwrap_or(now)
    }

    fn is_tool_changer(&self) -> bool {
        self.machine.kind == MachineKind::ToolChanger
    }

    /// Writes the colour's comment and the dialect's commands.
    fn set_state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        out.raw(";COLOR:").number(f64::from(change.color.0))?;
        for &fraction in change.state.mixture.fractions() {
            out.raw(" ").number(fraction)?;
        }
        out.end();
        self.dialect.state(change, out)
    }
}
