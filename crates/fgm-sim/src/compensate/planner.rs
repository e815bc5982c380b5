//! What to tell the machine, chosen block by block along the extruded volume.

mod choice;

use fgm_core::{ColorId, Mixture};
use fgm_gcode::safe_ratios;

use super::{
    CompensateOptions,
    figures::Figures,
    misfit::{Matter, Wanted, misfit},
    track::{Told, Track},
    tune,
};
use crate::Transition;
use choice::Choice;

/// Cells that the transition's length is divided into, where the shortest segment lets it.
const CELLS: f64 = 64.0;
/// With fewer cells in the transition there is nothing to choose.
const FEWEST_CELLS: f64 = 4.0;
/// Volume that is settled at a time with the plain lead, mm³, at least.
const PLAIN_BLOCK: f64 = 20.0;
/// Steps of the solver for a block.
const STEPS: usize = 120;
/// What is nearer to the plain lead, or to what was told last, is not told, as a share.
const SAME: f64 = 2e-3;
/// Blends with the plain lead that are tried for a block, and how much of the rest each keeps.
const BLENDS: usize = 4;
const LESS: f64 = 0.95;
/// Solutions that are tried for a block, and the share of one that is taken as it is.
const TRIES: usize = 4;
const ENOUGH: f64 = 0.3;

/// Turns what is wanted along the volume into commands.
///
/// There is always a plan for what is not settled yet, the plain lead at first, with which the
/// print is no worse than with the plain lead, in whatever corner of the uncertainty the machine
/// is. A better plan for the next block and a stretch beyond takes its place if that stays so; if
/// it does not, the two are blended until it does. So the whole is never worse.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    options: CompensateOptions,
    corners: Vec<Transition>,
    /// None where nothing can be chosen: the plain lead is all there is.
    choice: Option<Choice>,
    materials: usize,
    /// What the plain lead tells.
    plain: Track,
    /// What is told, and beyond what is settled the plan; from `planned` on the plain lead.
    told: Track,
    wanted: Vec<Wanted>,
    total: f64,
    settled: f64,
    planned: f64,
    figures: Figures,
}

/// A block whose commands are being chosen.
struct Trial {
    /// From here on there is the plain lead; the errors count up to the horizon. Volumes, mm³.
    planned: f64,
    horizon: f64,
    /// What each corner's error may come to.
    allowed: Vec<f64>,
    /// The plan before.
    before: Track,
}

impl Planner {
    /// A print that begins with a mixture, the state of a colour.
    pub(super) fn new(options: &CompensateOptions, first: Mixture, color: ColorId) -> Self {
        let CompensateOptions { transition, uncertainty, shortest, .. } = *options;
        let corners = tune::corners(&transition, uncertainty);
        let cell = (transition.length / CELLS).max(shortest);
        let free = options.enabled && transition.length >= FEWEST_CELLS * cell;
        let choice = free.then(|| Choice::new(&corners, options.lead, cell));
        let first = Told { at: 0.0, mixture: first, color: Some(color) };
        let shortest = if choice.is_some() { shortest } else { 0.0 };
        let track = Track::new(first, shortest);
        Self {
            options: options.clone(),
            figures: Figures::new(&corners),
            corners,
            choice,
            materials: first.mixture.materials(),
            plain: track.clone(),
            told: track,
            wanted: Vec::new(),
            total: 0.0,
            settled: 0.0,
            planned: 0.0,
        }
    }

    /// Up to this volume all commands are known, mm³.
    pub(super) fn settled(&self) -> f64 {
        self.settled
    }

    /// From here on another colour is wanted: the plain lead tells it so much earlier.
    pub(super) fn boundary(&mut self, mixture: Mixture, color: ColorId) {
        let at = (self.total - self.options.lead).max(0.0);
        self.plain.tell(Told { at, mixture, color: Some(color) });
    }

    /// So much is extruded, in which this mixture is wanted.
    pub(super) fn want(&mut self, volume: f64, mixture: Mixture, matter: Matter) {
        if !(volume.is_finite() && volume > 0.0) {
            return;
        }
        self.total += volume;
        match self.wanted.last_mut() {
            Some(last)
                if last.matter == matter
                    && (matter == Matter::Waste
                        || (last.mixture == mixture && last.scatter == 0.0)) =>
            {
                last.end = self.total;
            }
            _ => self.wanted.push(Wanted { end: self.total, mixture, scatter: 0.0, matter }),
        }
    }

    /// The same for one of many mixtures that change little by little: those along less than half
    /// a cell are taken together.
    pub(super) fn want_about(&mut self, volume: f64, mixture: Mixture, matter: Matter) {
        let grain = 0.5 * self.options.transition.length / CELLS;
        let end = self.total + volume;
        if let [.., before, last] = self.wanted.as_mut_slice()
            && volume.is_finite()
            && last.matter == matter
            && end - before.end <= grain
        {
            last.extend(before.end, end, &mixture);
            self.total = end;
        } else {
            self.want(volume, mixture, matter);
        }
    }

    /// Settles the next block, where enough is known of what follows or nothing does; gives
    /// whether it did. The new commands go to `emit`.
    pub(super) fn settle<E>(
        &mut self,
        finished: bool,
        emit: &mut impl FnMut(&Told) -> Result<(), E>,
    ) -> Result<bool, E> {
        let (block, known) = match &self.choice {
            Some(choice) => (choice.block, choice.known(&self.corners)),
            None => (self.options.lead.max(PLAIN_BLOCK), self.options.lead),
        };
        let waits = self.total < self.settled + block + known;
        let over = self.settled >= self.total;
        if (finished && over) || (!finished && waits) {
            return Ok(false);
        }
        let mut end = self.settled + block;
        self.follow_plain(end);
        if let Some(mut choice) = self.choice.take() {
            if self.is_busy(&choice, end) {
                end = self.choose(&mut choice);
            }
            self.choice = Some(choice);
        }
        // What would come after the last bead is not worth telling.
        let new = self.settled..self.total;
        self.told
            .told()
            .iter()
            .filter(|told| new.contains(&told.at) && told.at < end)
            .try_for_each(&mut *emit)?;
        self.settled = end;
        self.measure();
        Ok(true)
    }

    /// The figures of the whole print; all blocks are settled.
    pub(super) fn figures(self) -> Figures {
        self.figures
    }

    /// Makes the plain lead the plan up to the volume `to`, where there is none yet.
    fn follow_plain(&mut self, to: f64) {
        if self.planned < to {
            add_plain(&mut self.told, &self.plain, (self.planned, to));
            self.planned = to;
        }
    }

    /// Whether anything changes near a block.
    fn is_busy(&self, choice: &Choice, end: f64) -> bool {
        let beyond = end + choice.overlap;
        let plain = self.plain.told();
        let changes = plain.get(self.plain.index(self.settled) + 1);
        let told = self.told.told();
        let reach = self.settled - choice.pad as f64 * choice.cell;
        changes.is_some_and(|t| t.at < beyond)
            || told[self.told.index(reach)..]
                .iter()
                .any(|t| t.mixture != self.plain.at(self.settled).mixture)
    }

    /// Takes the best plan for a block and the stretch beyond, or the best blend with the one
    /// there is that keeps the whole no worse than the plain lead. Where that leaves little of it,
    /// the corners that it fails in are given more weight and it is made anew.
    ///
    /// Gives the end of the block.
    fn choose(&mut self, choice: &mut Choice) -> f64 {
        let planned = self.cut(choice);
        let horizon = self.settled + choice.block + choice.known(&self.corners);
        self.follow_plain(planned);
        choice.fill(self, planned);
        choice.tuned.adapt(self.figures.shares());
        let before = self.told.after(self.settled - choice.pad as f64 * choice.cell);
        let trial = Trial {
            planned,
            horizon,
            allowed: self.figures.allowance(&self.errors(
                &self.plain.before(planned),
                planned,
                horizon,
            )),
            before,
        };
        let mut best = self.errors(&trial.before, planned, horizon)[0];
        let mut chosen = None;
        for _ in 0..TRIES {
            choice.problem.solve(&choice.tuned.cases, STEPS);
            let (share, found) = self.possible(choice, &trial);
            if let Some((error, track)) = found.filter(|(error, _)| *error < best) {
                best = error;
                chosen = Some(track);
            }
            if share >= ENOUGH {
                break;
            }
            let all = self.commands(choice, &trial, 1.0);
            let now = self.errors(&all, planned, horizon);
            choice.tuned.insist(now.iter().zip(&trial.allowed).map(|(now, most)| now / most));
        }
        if let Some(track) = chosen {
            self.told = track;
            self.planned = planned;
        }
        planned - choice.overlap
    }

    /// The greatest share of a solution, blended with the plan before it, that is possible and
    /// keeps every corner within what it may come to: the commands with the measured error.
    fn possible(&self, choice: &Choice, trial: &Trial) -> (f64, Option<(f64, Track)>) {
        let Trial { planned, horizon, allowed, before } = trial;
        let errors = |track: &Track| self.errors(track, *planned, *horizon);
        let mut share = 1.0;
        for turn in 0..BLENDS {
            let track = self.commands(choice, trial, share);
            let now = errors(&track);
            if now.iter().zip(allowed).all(|(now, allowed)| now <= allowed) {
                return (share, Some((now[0], track)));
            }
            share = if turn == 0 {
                let half = errors(&self.commands(choice, trial, 0.5));
                let none = errors(before);
                let shares = (0..now.len()).map(|k| within(none[k], half[k], now[k], allowed[k]));
                shares.fold(1.0, f64::min) * 0.998
            } else {
                share * LESS
            };
            if share <= 0.0 {
                break;
            }
        }
        (0.0, None)
    }

    /// The errors of each corner with these commands up to the volume `planned` and the plain lead
    /// from there on, from what is settled to the volume `horizon`.
    fn errors(&self, track: &Track, planned: f64, horizon: f64) -> Vec<f64> {
        let mut track = track.clone();
        add_plain(&mut track, &self.plain, (planned, horizon));
        let part = (self.settled, horizon.min(self.total));
        let error = |t: &Transition| misfit(t, track.told(), &self.wanted, part);
        self.corners.iter().map(error).collect()
    }

    /// Where the plan is to go over into the plain lead: as far from its changes as can be, since
    /// one whose surroundings are cut off comes out badly.
    fn cut(&self, choice: &Choice) -> f64 {
        let cells = |volume: f64| (volume / choice.cell).round() as usize;
        let (last, least) = (choice.block + choice.overlap, choice.block / 2.0 + choice.overlap);
        let plain = self.plain.told();
        let room = |cells: &usize| {
            let at = self.settled + *cells as f64 * choice.cell;
            let next = self.plain.index(at) + 1;
            let after = plain.get(next).map_or(f64::INFINITY, |t| t.at - at);
            after.min(at - plain[next - 1].at)
        };
        let best = (cells(least)..=cells(last)).rev().max_by(|a, b| room(a).total_cmp(&room(b)));
        self.settled + best.unwrap_or(cells(last)) as f64 * choice.cell
    }

    /// The commands of the solution, blended with the plan before it, after those settled.
    fn commands(&self, choice: &Choice, trial: &Trial, share: f64) -> Track {
        let mut track = trial.before.before(self.settled);
        let cells = ((trial.planned - self.settled) / choice.cell).round() as usize;
        for i in 0..cells {
            let at = self.settled + i as f64 * choice.cell;
            let values = choice.cell_values(i, share, self.materials);
            let plain = self.plain.at(at + 0.5 * choice.cell);
            let mixture = Mixture::from_weights(&values[..self.materials]).ok().map(|mixture| {
                let CompensateOptions { min_fraction, decimals, .. } = self.options;
                safe_ratios(&mixture, min_fraction, decimals)
            });
            let next = match mixture {
                Some(mixture) if mixture.distance(&plain.mixture) > SAME => {
                    Told { at, mixture, color: None }
                }
                _ => Told { at, ..plain },
            };
            let last = track.at(at);
            if next.color.is_some() || last.mixture.distance(&next.mixture) > SAME {
                track.tell(next);
            }
        }
        track
    }

    /// Adds what was settled to the figures, and lets go of what no longer counts.
    fn measure(&mut self) {
        let upto = self.settled.min(self.total);
        self.figures.measure(&self.wanted, upto, self.plain.told(), self.told.told());
        let longest = self.corners.iter().map(Transition::reach).fold(0.0, f64::max);
        let cell = self.choice.as_ref().map_or(0.0, |choice| choice.cell);
        let behind = self.settled - longest - 4.0 * cell;
        self.plain.forget(behind);
        self.told.forget(behind);
        let past = self.wanted.partition_point(|w| w.end <= upto);
        self.wanted.drain(..past);
    }
}

/// The greatest share of a blend whose error is allowed: along a blend the error is a parabola,
/// here given at 0, 1/2 and 1.
fn within(none: f64, half: f64, all: f64, allowed: f64) -> f64 {
    let curve = 2.0 * (all + none - 2.0 * half);
    let slope = all - none - curve;
    let room = (allowed - none).max(0.0);
    if curve <= 0.0 {
        return if slope > 0.0 { room / slope } else { 1.0 };
    }
    (-slope + (slope * slope + 4.0 * curve * room).sqrt()) / (2.0 * curve)
}

/// Adds the plain lead's commands over the volume `from..to`.
fn add_plain(track: &mut Track, plain: &Track, (from, to): (f64, f64)) {
    track.tell(Told { at: from, ..plain.at(from) });
    let later = plain.told().get(plain.index(from) + 1..).unwrap_or_default();
    later.iter().take_while(|t| t.at < to).for_each(|t| track.tell(*t));
}
