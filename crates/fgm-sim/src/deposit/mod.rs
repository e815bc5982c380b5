//! From beads as commanded to pieces as laid down.

mod model;
mod thermal;
mod window;

use std::sync::Arc;

use fgm_core::{MAX_MATERIALS, Mixture};
use fgm_gcode::Foaming;

use crate::{Bead, Event, Piece, foam};
use window::{Values, Window};

pub use model::Model;
pub use thermal::Thermal;

/// A nozzle whose temperature changes is followed in steps of this, °C.
const STEP: f64 = 0.5;
/// The temperature of foam changes by no more than this along a piece, °C.
const SPAN: f64 = 1.0;
/// Pieces of less than this are not split off, mm³: a few times what E is rounded to, and a
/// thousandth of a mm of a common bead.
const LEAST: f64 = 1e-4;

/// Lays beads down through a [`Model`]: takes [`Event`]s, gives [`Piece`]s.
///
/// Along a piece the composition changes evenly, so that its ends tell all of it. Cost is linear
/// in the beads and the changes of command; memory is what was commanded within the model's delay
/// and length.
///
/// ```
/// use fgm_gcode::{Machine, Reader};
/// use fgm_sim::{Deposit, Model, Replay, ReplayOptions, Transition};
///
/// let gcode = b"M83\nM163 S0 P1\nM163 S1 P0\nM164 S0\nG1 X0 Y0\nG1 X10 E1\n\
///     M163 S0 P0\nM163 S1 P1\nM164 S0\nG1 X20 E1\n";
/// let machine = Machine::default();
/// let half = 0.5 * machine.filament_area();
/// let model = Model::of(&machine).with_transition(Transition { delay: half, length: half });
/// let options = ReplayOptions { machine: Some(machine), ..ReplayOptions::default() };
///
/// let mut deposit = Deposit::new(&model);
/// let mut seen = Vec::new();
/// for event in Replay::new(Reader::new(&gcode[..]), &options) {
///     deposit.push(&event?, &mut |piece| {
///         seen.push((piece.to.x.round(), piece.deposited[1].fractions()[1]));
///     });
/// }
/// // The change at x = 10 comes 5 mm late and takes 5 mm.
/// assert_eq!(seen, [(10.0, 0.0), (15.0, 0.0), (20.0, 1.0)]);
/// # Ok::<(), fgm_sim::SimError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Deposit {
    model: Model,
    /// The model's, held apart so that it can be used while nozzles change.
    foaming: Option<Arc<Foaming>>,
    heads: Vec<Nozzle>,
    /// The last values made into a mixture: most pieces have the same as the one before.
    last: Option<(Values, Mixture)>,
}

/// One nozzle.
#[derive(Clone, Debug)]
struct Nozzle {
    window: Window,
    /// As it is, °C; none before it is told one.
    celsius: Option<f64>,
    told: f64,
}

impl Deposit {
    /// Nothing laid down yet.
    pub fn new(model: &Model) -> Self {
        let foaming = model.foaming.clone().map(Arc::new);
        Self { model: model.clone(), foaming, heads: Vec::new(), last: None }
    }

    /// Follows what the machine does, and emits what it lays down.
    #[inline]
    pub fn push(&mut self, event: &Event, emit: &mut impl FnMut(&Piece)) {
        match event {
            Event::Bead(bead) => self.bead(bead, emit),
            Event::Travel(travel) => self.wait(travel.seconds),
            Event::Pause { seconds, .. } => self.wait(*seconds),
            Event::Heat(heat) => {
                let nozzle = self.nozzle(heat.head);
                nozzle.told = heat.celsius;
                if heat.wait || nozzle.celsius.is_none() {
                    nozzle.celsius = Some(heat.celsius);
                }
            }
            Event::Layer(_) => {}
        }
    }

    fn nozzle(&mut self, head: u16) -> &mut Nozzle {
        let head = usize::from(head);
        if self.heads.len() <= head {
            let window = Window::new(&self.model.transition);
            self.heads.resize(head + 1, Nozzle { window, celsius: None, told: 0.0 });
        }
        &mut self.heads[head]
    }

    /// Time passes.
    #[inline]
    fn wait(&mut self, seconds: f64) {
        let Some(thermal) = self.model.thermal else { return };
        for nozzle in &mut self.heads {
            if let Some(celsius) = &mut nozzle.celsius {
                *celsius = thermal.after(*celsius, nozzle.told, seconds);
            }
        }
    }

    fn bead(&mut self, bead: &Bead, emit: &mut impl FnMut(&Piece)) {
        let Some(foaming) = self.foaming.clone() else {
            let mut values = [0.0; MAX_MATERIALS];
            values[..bead.mixture.materials()].copy_from_slice(bead.mixture.fractions());
            self.nozzle(bead.head).window.command(&values);
            return self.lay(bead, (0.0, 1.0), None, emit);
        };
        let Some(thermal) = self.model.thermal else {
            let celsius = bead.celsius.unwrap_or(foaming.low);
            self.nozzle(bead.head).window.command(&celsius_values(celsius));
            return self.lay(bead, (0.0, 1.0), Some(&foaming), emit);
        };
        // The temperature changes along the bead: told in steps, each at its middle.
        let nozzle = self.nozzle(bead.head);
        let start = nozzle.celsius.or(bead.celsius).unwrap_or(foaming.low);
        let told = bead.celsius.unwrap_or(start);
        let end = thermal.after(start, told, bead.seconds);
        let steps = ((end - start).abs() / STEP).ceil().clamp(1.0, 1024.0) as u32;
        for step in 0..steps {
            let share = |i: f64| i / f64::from(steps);
            let middle = thermal.after(start, told, bead.seconds * share(f64::from(step) + 0.5));
            self.nozzle(bead.head).window.command(&celsius_values(middle));
            let part = (share(f64::from(step)), share(f64::from(step) + 1.0));
            self.lay(bead, part, Some(&foaming), emit);
        }
        self.wait(bead.seconds);
    }

    /// Lays down the part of a bead between two shares of its length, split where the composition
    /// takes another course.
    fn lay(
        &mut self,
        bead: &Bead,
        (first, last): (f64, f64),
        foaming: Option<&Foaming>,
        emit: &mut impl FnMut(&Piece),
    ) {
        let mut share = first;
        // Too little for a piece of its own: what lies there, and what is fed for it.
        let mut carried = (0.0, 0.0);
        loop {
            let window = &mut self.nozzle(bead.head).window;
            let start = window.at(0.0);
            let left = ((last - share) * bead.fed - carried.1).max(0.0);
            let Step { volume, flow, end } = Step::next(window, left, foaming);
            if end == End::Course && volume < LEAST {
                window.extrude_to_break();
                carried = (carried.0 + volume, carried.1 + volume * flow);
                continue;
            }
            let finish = if window.is_steady() { start } else { window.at(volume) };
            match end {
                End::Bead | End::Part => window.extrude(volume),
                End::Course => window.extrude_to_break(),
            }
            let done = end == End::Bead;
            let (volume, fed) = (carried.0 + volume, carried.1 + volume * flow);
            carried = (0.0, 0.0);
            let to = if done { last } else { share + fed / bead.fed };
            let deposited = self.mixtures(&start, &finish, bead, foaming);
            let place = |s: f64| bead.from + (bead.to - bead.from) * s;
            emit(&Piece {
                line: bead.line,
                layer: bead.layer,
                from: if share == 0.0 { bead.from } else { place(share) },
                to: if to == 1.0 { bead.to } else { place(to) },
                volume,
                fed,
                height: bead.height,
                width: bead.width,
                role: bead.role,
                head: bead.head,
                commanded: bead.mixture,
                deposited,
                celsius: foaming.map(|_| 0.5 * (start[0] + finish[0])),
            });
            share = to;
            if done {
                return;
            }
        }
    }

    fn mixtures(
        &mut self,
        start: &Values,
        end: &Values,
        bead: &Bead,
        foaming: Option<&Foaming>,
    ) -> [Mixture; 2] {
        [start, end].map(|values| {
            let materials = bead.mixture.materials();
            if let Some((last, mixture)) = self.last
                && last == *values
                && mixture.materials() == materials
            {
                return mixture;
            }
            let mixture = match foaming {
                Some(f) => foam::mixture(f.low, f.high, values[0]),
                None => Mixture::from_weights(&values[..materials]).ok(),
            };
            let mixture = mixture.unwrap_or(bead.mixture);
            self.last = Some((*values, mixture));
            mixture
        })
    }
}

fn celsius_values(celsius: f64) -> Values {
    let mut values = [0.0; MAX_MATERIALS];
    values[0] = celsius;
    values
}

/// How far a piece goes.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// What lies there, mm³.
    volume: f64,
    /// Filament fed for each mm³ of it.
    flow: f64,
    end: End,
}

/// Why a piece ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// The bead does.
    Bead,
    /// The composition takes another course.
    Course,
    /// The foam's temperature has changed by as much as a piece may have.
    Part,
}

impl Step {
    /// The next piece of a bead of which `left` mm³ of filament are to be fed.
    #[inline]
    fn next(window: &Window, left: f64, foaming: Option<&Foaming>) -> Self {
        let course = window.until_break();
        let Some(foaming) = foaming else {
            return Self::within(left, 1.0, course, f64::INFINITY);
        };
        if window.is_steady() {
            let flow = flow(foaming, window, 0.0);
            return Self::within(left, flow, course, f64::INFINITY);
        }
        // So short that the flow in the middle stands for all of it.
        let near = course.min(1.0);
        let slope = (window.at(near)[0] - window.at(0.0)[0]) / near;
        let part = (SPAN / slope.abs()).max(2.0 * LEAST);
        let most = course.min(part);
        let about = left / flow(foaming, window, 0.0);
        Self::within(left, flow(foaming, window, 0.5 * most.min(about)), course, part)
    }

    fn within(left: f64, flow: f64, course: f64, part: f64) -> Self {
        let whole = left / flow;
        let (volume, end) = match course.min(part) {
            most if most >= whole - LEAST => (whole, End::Bead),
            _ if course <= part => (course.max(0.0), End::Course),
            _ => (part, End::Part),
        };
        Self { volume, flow, end }
    }
}

/// The factor from what lies there to what is fed, after `ahead` mm³ more.
fn flow(foaming: &Foaming, window: &Window, ahead: f64) -> f64 {
    let (low, high) = (foaming.low.min(foaming.high), foaming.low.max(foaming.high));
    foaming.flow_at(window.at(ahead)[0].clamp(low, high)).max(0.01)
}
