//! Where the old colour goes: which changes are purged, on which tower, with how much.

use std::ops::Range;

use fgm_core::{Bounds2, Bounds3, ColorId, Mixture, Point3};
use fgm_gcode::{Machine, MachineKind};
use fgm_sim::Transition;
use fgm_toolpath::{Piece, TowerOptions, Towers};

use crate::{choice::Strategy, error::SliceError, settings::Settings};

/// The purge towers of a print.
pub(crate) struct Purge {
    towers: Towers,
    /// The spot of each colour that may occur.
    spots: Vec<Option<ColorId>>,
    palette: Vec<Mixture>,
    volumes: Volumes,
    /// Change of mixture above which a tower is printed.
    threshold: f64,
}

/// How much a change takes.
#[derive(Clone, Copy)]
enum Volumes {
    /// Each the same, mm³.
    Same(f64),
    /// Until the transition is within a tolerance of its goal.
    Until(Transition, f64),
}

impl Volumes {
    fn of(machine: &Machine, settings: &Settings, lead: f64) -> Self {
        match (settings.purge.volume, Transition::of(machine)) {
            (Some(volume), _) => Self::Same(volume),
            (None, Some(transition)) => Self::Until(transition, settings.purge.tolerance),
            (None, None) => Self::Same(lead),
        }
    }

    /// For a change by this much, mm³.
    fn volume(self, distance: f64) -> f64 {
        match self {
            Self::Same(volume) => volume,
            Self::Until(transition, tolerance) => transition.purge(distance, tolerance),
        }
    }
}

/// Whether purge towers are wanted.
pub(crate) fn wanted(machine: &Machine, settings: &Settings) -> bool {
    let usual = machine.kind != MachineKind::ToolChanger;
    settings.slice.strategy == Strategy::Sectioned && settings.purge.enabled.unwrap_or(usual)
}

/// The most that a change between two colours of a palette takes, mm³.
pub(crate) fn largest(
    machine: &Machine,
    settings: &Settings,
    lead: f64,
    palette: &[Mixture],
) -> f64 {
    let volumes = Volumes::of(machine, settings, lead);
    let pairs =
        palette.iter().enumerate().flat_map(|(i, a)| palette[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| volumes.volume(a.distance(b))).fold(0.0, f64::max)
}

impl Purge {
    /// Towers beside the part for the colours that occur, each up to its last layer; none where
    /// nothing is to be purged. `place` is the part with what is printed around it, and the offset
    /// to the bed.
    pub(crate) fn new(
        machine: &Machine,
        settings: &Settings,
        lead: f64,
        palette: &[Mixture],
        last_layers: &[Option<usize>],
        (part, offset): (&Bounds3, Point3),
    ) -> Result<Option<Self>, SliceError> {
        let colors = last_layers.iter().flatten().count();
        let occurring: Vec<Mixture> = palette
            .iter()
            .zip(last_layers)
            .filter_map(|(mixture, last)| last.map(|_| *mixture))
            .collect();
        let volume = largest(machine, settings, lead, &occurring);
        if !wanted(machine, settings) || volume <= 0.0 || colors < 2 {
            return Ok(None);
        }
        let bed = machine.bed.bounds().xy();
        let bed = Bounds2::new(bed.min - offset.truncate(), bed.max - offset.truncate());
        let options = TowerOptions {
            volume,
            width: settings.layer.bead_width,
            height: settings.layer.height.min(settings.first_height()),
            clearance: settings.purge.clearance,
            ..TowerOptions::default()
        };
        let around = part.xy().grown(settings.reach());
        let mut towers = Towers::place(&around, &bed, colors, &options)?;
        // A colour that cannot occur has no spot, and none is kept above its last layer.
        let mut next = (0..).map(ColorId);
        let spots: Vec<Option<ColorId>> =
            last_layers.iter().map(|last| last.and_then(|_| next.next())).collect();
        for (spot, last) in spots.iter().flatten().zip(last_layers.iter().flatten()) {
            towers.finish(*spot, *last);
        }
        let volumes = Volumes::of(machine, settings, lead);
        let threshold = settings.purge.threshold;
        Ok(Some(Self { towers, spots, palette: palette.to_vec(), volumes, threshold }))
    }

    /// Puts each colour's tower before its pieces, and what the other towers need to grow before
    /// all. `color` comes out before the layer, which is the `count`-th.
    ///
    /// A tower takes what comes out of the nozzle until the new colour does, so its beads count to
    /// the colour before: the boundary that the look-ahead works towards is the tower's end.
    pub(crate) fn with_towers(
        &self,
        pieces: Vec<Piece>,
        color: Option<ColorId>,
        count: usize,
    ) -> Vec<Piece> {
        let Some(hand) = color.or(pieces.first().map(|piece| piece.color)) else {
            return pieces;
        };
        let changes = self.changes(&pieces, color);
        let mut all = Vec::with_capacity(pieces.len() + self.palette.len());
        let spots: Vec<ColorId> =
            changes.iter().filter_map(|(range, _)| self.spot(pieces[range.start].color)).collect();
        self.towers.keep_others(&spots, hand, count, &mut all);
        let mut changes = changes.into_iter().peekable();
        let mut last = color;
        for (i, piece) in pieces.into_iter().enumerate() {
            if let Some((_, volume)) = changes.next_if(|(range, _)| range.start == i)
                && let Some(spot) = self.spot(piece.color)
            {
                let first = all.len();
                self.towers.purge_volume(spot, volume, count, &mut all);
                let before = last.unwrap_or(piece.color);
                all[first..].iter_mut().for_each(|block| block.color = before);
            }
            last = Some(piece.color);
            all.push(piece);
        }
        all
    }

    fn spot(&self, color: ColorId) -> Option<ColorId> {
        self.spots.get(color.index()).copied().flatten()
    }

    /// The stretches of pieces whose colour is worth a purge, with its volume.
    fn changes(&self, pieces: &[Piece], mut color: Option<ColorId>) -> Vec<(Range<usize>, f64)> {
        let mut changes = Vec::new();
        let mut start = 0;
        for run in pieces.chunk_by(|a, b| a.color == b.color) {
            let end = start + run.len();
            let to = run[0].color;
            if color != Some(to) {
                let distance = color.map_or(1.0, |from| self.distance(from, to));
                let volume = self.volumes.volume(distance);
                if distance > self.threshold && volume > 0.0 {
                    changes.push((start..end, volume));
                }
            }
            (start, color) = (end, Some(to));
        }
        changes
    }

    fn distance(&self, from: ColorId, to: ColorId) -> f64 {
        let mixture = |color: ColorId| self.palette.get(color.index());
        mixture(from).zip(mixture(to)).map_or(1.0, |(from, to)| from.distance(to))
    }
}
