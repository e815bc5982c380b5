//! From planned layers to bytes, in order: towers, motions, look-ahead, G-code.

use std::io::Write;

use fgm_core::{ColorId, Mixture};
use fgm_gcode::{GcodeError, Lead, Summary, Writer};
use fgm_palette::Palette;
use fgm_toolpath::{LayerPlan, Piece, Towers};

use crate::{error::SliceError, job::PlannedLayer, layers::Layers};

/// What a print is written through.
pub(crate) struct Stream<'a> {
    pub(crate) lead: Lead,
    pub(crate) writer: Writer<&'a mut dyn Write>,
    pub(crate) towers: Option<Towers>,
    /// The spot of each colour that may occur.
    pub(crate) spots: Vec<Option<ColorId>>,
    pub(crate) palette: &'a Palette,
    pub(crate) layers: Layers,
    /// Change of mixture above which a tower is printed.
    pub(crate) threshold: f64,
    /// The colour that comes out at the end of what was pushed.
    pub(crate) color: Option<ColorId>,
    /// Layers pushed.
    pub(crate) count: usize,
}

impl Stream<'_> {
    /// Writes a layer.
    pub(crate) fn push(&mut self, planned: PlannedLayer) -> Result<(), SliceError> {
        let layer = self.layers.get(planned.index);
        let pieces = self.with_towers(planned.pieces);
        let index = u32::try_from(planned.index).unwrap_or(u32::MAX);
        let plan = LayerPlan::new(index, layer.top, layer.height, pieces)?;
        for motion in plan.motions(self.color) {
            let writer = &mut self.writer;
            self.lead.push(motion, |step| writer.push(step))?;
        }
        self.color = plan.last_color().or(self.color);
        self.count += 1;
        Ok(())
    }

    /// Puts each colour's tower before its pieces, and what the other towers need to grow before
    /// all.
    ///
    /// A tower takes what comes out of the nozzle until the new colour does, so its beads count to
    /// the colour before: the boundary that the look-ahead works towards is the tower's end.
    fn with_towers(&self, pieces: Vec<Piece>) -> Vec<Piece> {
        let Some(towers) = &self.towers else { return pieces };
        let Some(hand) = self.color.or(pieces.first().map(|piece| piece.color)) else {
            return pieces;
        };
        let purged = self.purged(&pieces);
        let mut all = Vec::with_capacity(pieces.len() + self.palette.colors());
        let spots: Vec<ColorId> = purged.iter().filter_map(|&color| self.spot(color)).collect();
        towers.keep_others(&spots, hand, self.count, &mut all);
        let mut color = self.color;
        for piece in pieces {
            if color != Some(piece.color) {
                if let (true, Some(spot)) = (purged.contains(&piece.color), self.spot(piece.color))
                {
                    let first = all.len();
                    towers.purge(spot, self.count, &mut all);
                    let before = color.unwrap_or(piece.color);
                    all[first..].iter_mut().for_each(|block| block.color = before);
                }
                color = Some(piece.color);
            }
            all.push(piece);
        }
        all
    }

    fn spot(&self, color: ColorId) -> Option<ColorId> {
        self.spots.get(color.index()).copied().flatten()
    }

    /// The colours of a layer that the change to is worth a purge.
    fn purged(&self, pieces: &[Piece]) -> Vec<ColorId> {
        let mut purged = Vec::new();
        let mut color = self.color;
        for piece in pieces {
            if color != Some(piece.color) && self.is_change(color, piece.color) {
                purged.push(piece.color);
            }
            color = Some(piece.color);
        }
        purged
    }

    fn is_change(&self, from: Option<ColorId>, to: ColorId) -> bool {
        let mixture = |color: ColorId| -> Mixture { self.palette.state(color) };
        from.is_none_or(|from| mixture(from).distance(&mixture(to)) > self.threshold)
    }

    /// Writes the rest.
    pub(crate) fn finish(self) -> Result<Summary, GcodeError> {
        let Self { lead, mut writer, .. } = self;
        lead.finish(|step| writer.push(step))?;
        writer.finish()
    }
}
