//! Where the old colour goes: which changes are purged, with how much, on a tower or in filling
//! that is hidden in the part.

mod choice;
mod demand;
mod needs;
mod order;
mod tally;

use fgm_core::{Bounds2, Bounds3, ColorId, Point2, Point3, Role, bead};
use fgm_gcode::Machine;
use fgm_toolpath::{Piece, ToolpathError, TowerOptions, Towers};

use crate::{error::SliceError, settings::Settings};
use needs::Arrival;
use tally::Tally;

pub use choice::{PurgeInto, PurgeLayout};
pub use tally::{PurgeReport, PurgeSavings, Saving};

pub(crate) use demand::{Demand, is_needed};
pub(crate) use needs::{Needs, wanted};
pub(crate) use order::hidden_first;

/// The purges of a print.
pub(crate) struct Purge {
    needs: Needs,
    places: Option<Places>,
    /// Whether hidden filling takes what it can.
    hidden: bool,
    tally: Tally,
    /// g/cm³.
    density: f64,
}

/// The towers.
struct Places {
    towers: Towers,
    /// The spot of each colour; empty where all share one.
    spots: Vec<Option<usize>>,
}

/// A change of colour that is purged.
struct Change {
    /// The first piece in the new colour.
    start: usize,
    from: ColorId,
    to: ColorId,
    /// mm³, in all and in hidden filling.
    volume: f64,
    hidden: f64,
    /// Whether the new colour comes out at all.
    arrives: bool,
}

/// Whether filling may take the old colour: it does not show behind a wall.
pub(crate) fn hides(machine: &Machine, settings: &Settings) -> bool {
    settings.purge.into == PurgeInto::Infill
        && settings.walls.count > 0
        && wanted(machine, settings)
}

impl Purge {
    /// Towers beside the part for what is demanded, none where nothing is. `place` is the part with
    /// what is printed around it, and the offset to the bed.
    pub(crate) fn new(
        machine: &Machine,
        settings: &Settings,
        needs: Needs,
        demand: &Demand,
        place: (&Bounds3, Point3),
    ) -> Result<Self, SliceError> {
        let places = match demand.last_change {
            Some(last) if demand.most > 0.0 => {
                Some(Places::new(machine, settings, &needs, demand, last, place)?)
            }
            _ => None,
        };
        let mut tally = Tally::default();
        tally.report.into = settings.purge.into;
        tally.report.layout = places.as_ref().map(Places::layout);
        let hidden = hides(machine, settings);
        Ok(Self { needs, places, hidden, tally, density: machine.filament_density })
    }

    /// Puts a purge before each colour's pieces, and what towers need to grow before all. `color`
    /// comes out before the layer, which is the `count`-th and `height` mm high.
    ///
    /// A purge takes what comes out of the nozzle until the new colour does: up to where that is
    /// its beads count to the colour before, and there is the boundary that the look-ahead works
    /// towards.
    pub(crate) fn lay(
        &mut self,
        pieces: Vec<Piece>,
        color: Option<ColorId>,
        count: usize,
        height: f64,
    ) -> Vec<Piece> {
        let Some(hand) = color.or(pieces.first().map(|piece| piece.color)) else {
            return pieces;
        };
        let changes = self.changes(&pieces, color, height);
        let mut all = Vec::with_capacity(pieces.len() + 2 * changes.len() + 1);
        let mut blocks = self.blocks(&changes, hand, (count, height), &mut all);
        let mut changes = changes.into_iter().zip(&mut blocks).peekable();
        let mut filling: Option<Filling> = None;
        for (i, piece) in pieces.into_iter().enumerate() {
            if let Some((change, block)) = changes.next_if(|(change, _)| change.start == i) {
                let mut begun = Filling::new(&change, block.as_ref(), self.needs.arrival, height);
                block.take().into_iter().for_each(|block| begun.paint(block, &mut all));
                filling = Some(begun);
            }
            match &mut filling {
                Some(filling) if filling.hidden > 0.0 => filling.take(piece, &mut all),
                _ => all.push(piece),
            }
        }
        all
    }

    /// Counts the changes along pieces of a spiral, which cannot leave its wall for a tower. `color`
    /// comes out before them.
    pub(crate) fn pass(&mut self, pieces: &[Piece], color: Option<ColorId>) {
        let mut before = color;
        for piece in pieces {
            let from = before.replace(piece.color);
            let changes = from.is_some_and(|from| from != piece.color);
            self.tally.report.spiral_changes += usize::from(changes);
        }
    }

    /// How towers stand; none where there are none.
    pub(crate) fn layout(&self) -> Option<PurgeLayout> {
        self.places.as_ref().map(Places::layout)
    }

    /// The place of the tower, if all colours share one, that is nearest to a point.
    pub(crate) fn place(&self, p: Point2) -> Option<Point2> {
        let places = self.places.as_ref().filter(|places| places.spots.is_empty())?;
        let bounds = places.towers.spot(0)?;
        Some(p.clamp(bounds.min, bounds.max))
    }

    /// What was purged and saved.
    pub(crate) fn finish(self) -> PurgeReport {
        self.tally.finish(self.density)
    }

    /// The changes that are purged.
    fn changes(&mut self, pieces: &[Piece], color: Option<ColorId>, height: f64) -> Vec<Change> {
        self.tally.layer(&self.needs, pieces, color);
        let mut changes = Vec::new();
        let (mut start, mut color) = (0, color);
        for run in pieces.chunk_by(|a, b| a.color == b.color) {
            let to = run[0].color;
            if color != Some(to) {
                let change = self.change((start, run), color, height);
                if change.as_ref().is_none_or(|change| change.arrives) {
                    color = Some(to);
                }
                changes.extend(change);
            }
            start += run.len();
        }
        changes
    }

    /// The change to the colour of a run of pieces, where it is purged.
    fn change(
        &mut self,
        (start, run): (usize, &[Piece]),
        color: Option<ColorId>,
        height: f64,
    ) -> Option<Change> {
        let to = run.first()?.color;
        self.tally.change(&self.needs, color, to);
        let needed = self.needs.volume(color, to);
        let hidden = if self.hidden { hidden_in(run, needed, height) } else { 0.0 };
        let report = &mut self.tally.report;
        if needed <= 0.0 || (self.places.is_none() && hidden <= 0.0) {
            report.unpurged += usize::from(needed > 0.0 && color.is_some());
            return None;
        }
        report.purged += usize::from(color.is_some());
        report.infill_mm3 += hidden;
        // A run that nobody sees and that would take the purge as a whole needs none.
        let shown = !self.hidden || run.iter().any(|piece| !piece.role.is_hidden());
        let arrives = color.is_none() || shown || hidden >= needed - SCRAP;
        let volume = if arrives { needed } else { hidden };
        report.saved.infill.mm3 += if arrives { hidden } else { needed };
        Some(Change { start, from: color.unwrap_or(to), to, volume, hidden, arrives })
    }

    /// A block on a tower for each change that hidden filling does not take all of; what else
    /// towers need to grow goes to `standing`.
    fn blocks(
        &mut self,
        changes: &[Change],
        hand: ColorId,
        at: (usize, f64),
        standing: &mut Vec<Piece>,
    ) -> Vec<Option<Piece>> {
        let mut blocks: Vec<Option<Piece>> = changes.iter().map(|_| None).collect();
        let Some(Places { towers, spots }) = &self.places else { return blocks };
        let shown = |change: &Change| change.volume - change.hidden;
        let wanted: Vec<usize> =
            (0..changes.len()).filter(|&i| shown(&changes[i]) > SCRAP).collect();
        let purge = |i: &usize| (shown(&changes[*i]), changes[*i].from);
        let (layer, height) = at;
        if spots.is_empty() {
            let purges: Vec<_> = wanted.iter().map(purge).collect();
            let made = towers.grow(0, &purges, hand, layer, height);
            if purges.is_empty() {
                standing.extend(made);
            } else {
                wanted.iter().zip(made).for_each(|(i, block)| blocks[*i] = Some(block));
            }
        } else {
            let spot = |color: ColorId| spots.get(color.index()).copied().flatten();
            for other in 0..towers.count() {
                let here = wanted.iter().find(|i| spot(changes[**i].to) == Some(other));
                let purges: Vec<_> = here.iter().map(|i| purge(i)).collect();
                let made = towers.grow(other, &purges, hand, layer, height).pop();
                match here {
                    Some(i) => blocks[*i] = made,
                    None => standing.extend(made),
                }
            }
        }
        let area = |piece: &Piece| piece.length() * bead::area(piece.width, height);
        let printed: f64 = blocks.iter().flatten().chain(standing.iter()).map(area).sum();
        let purged: f64 = wanted.iter().map(|i| shown(&changes[*i])).sum();
        self.tally.report.standing_mm3 += printed - purged;
        blocks
    }
}

/// What is left of a purge below this, mm³, is not worth the way to the tower.
const SCRAP: f64 = 0.1;

impl Places {
    fn new(
        machine: &Machine,
        settings: &Settings,
        needs: &Needs,
        demand: &Demand,
        last: usize,
        (part, offset): (&Bounds3, Point3),
    ) -> Result<Self, SliceError> {
        let bed = machine.bed.bounds().xy();
        let bed = Bounds2::new(bed.min - offset.truncate(), bed.max - offset.truncate());
        let around = part.xy().grown(settings.reach());
        let options = |volume| TowerOptions {
            volume,
            width: settings.layer.bead_width,
            height: settings.layer.height.min(settings.first_height()),
            clearance: settings.purge.clearance,
            ..TowerOptions::default()
        };
        let one = || -> Result<Self, ToolpathError> {
            let mut towers = Towers::place(&around, &bed, 1, &options(demand.most))?;
            towers.finish(0, last);
            Ok(Self { towers, spots: Vec::new() })
        };
        let apart = || -> Result<Self, ToolpathError> {
            let mut next = 0..;
            let spots: Vec<Option<usize>> =
                demand.last.iter().map(|last| last.and_then(|_| next.next())).collect();
            let colors: Vec<ColorId> =
                (0..).map(ColorId).zip(&spots).filter_map(|(c, s)| s.map(|_| c)).collect();
            let first = colors.iter().map(|to| needs.volume(None, *to)).fold(0.0, f64::max);
            let most = needs.most_between(&colors, &colors).max(first);
            let mut towers = Towers::place(&around, &bed, colors.len(), &options(most))?;
            // A colour that cannot occur has no spot, and none is kept above its last layer.
            for (spot, layer) in spots.iter().zip(&demand.last) {
                if let (Some(spot), Some(layer)) = (spot, layer) {
                    towers.finish(*spot, *layer.min(&last));
                }
            }
            Ok(Self { towers, spots })
        };
        Ok(match settings.purge.layout {
            Some(PurgeLayout::One) => one()?,
            Some(PurgeLayout::Spots) => apart()?,
            // Where there is no room for one, spots may fit around the part.
            None => one().or_else(|error| apart().map_err(|_| error))?,
        })
    }

    fn layout(&self) -> PurgeLayout {
        if self.spots.is_empty() { PurgeLayout::One } else { PurgeLayout::Spots }
    }
}

/// How much of a volume the hidden filling at the start of a run takes, mm³.
fn hidden_in(run: &[Piece], volume: f64, height: f64) -> f64 {
    let mut taken = 0.0;
    for piece in run.iter().take_while(|piece| piece.role.is_hidden()) {
        if taken >= volume {
            break;
        }
        taken += piece.length() * bead::area(piece.width, height);
    }
    taken.min(volume)
}

/// A purge being laid down.
struct Filling {
    from: ColorId,
    to: ColorId,
    height: f64,
    /// What is still to be laid down before the boundary, mm³.
    before: f64,
    /// What is still to be laid into hidden filling, mm³.
    hidden: f64,
}

impl Filling {
    fn new(change: &Change, block: Option<&Piece>, arrival: Arrival, height: f64) -> Self {
        let volume = |piece: &Piece| piece.length() * bead::area(piece.width, height);
        let whole = block.map_or(0.0, volume) + change.hidden;
        let before = match arrival {
            _ if !change.arrives => whole,
            Arrival::Start => 0.0,
            Arrival::Middle => (whole - 0.5 * change.volume).max(0.0),
            Arrival::End => whole,
        };
        Self { from: change.from, to: change.to, height, before, hidden: change.hidden }
    }

    /// Lays down a piece in the old colour up to the boundary and in the new one from there on.
    fn paint(&mut self, piece: Piece, out: &mut Vec<Piece>) {
        let area = bead::area(piece.width, self.height);
        let volume = piece.length() * area;
        if volume <= self.before + SLACK {
            out.push(Piece { color: self.from, ..piece });
        } else if self.before <= SLACK {
            out.push(Piece { color: self.to, ..piece });
        } else {
            let (old, new) = piece.split(self.before / area);
            out.extend([Piece { color: self.from, ..old }, Piece { color: self.to, ..new }]);
        }
        self.before -= volume;
    }

    /// Lays down hidden filling, as much of it as takes part in the purge.
    fn take(&mut self, piece: Piece, out: &mut Vec<Piece>) {
        let area = bead::area(piece.width, self.height);
        let volume = piece.length() * area;
        let (first, rest) = if volume <= self.hidden + SLACK {
            (piece, None)
        } else {
            let (first, rest) = piece.split(self.hidden / area);
            (first, Some(rest))
        };
        self.hidden -= volume;
        if self.hidden <= SLACK {
            self.hidden = 0.0;
        }
        self.paint(Piece { role: Role::PurgeInfill, ..first }, out);
        out.extend(rest);
    }
}

/// Volumes nearer than this are the same, mm³.
const SLACK: f64 = 1e-9;

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
