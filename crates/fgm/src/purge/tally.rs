//! What was purged, and what was not.

use fgm_core::ColorId;
use fgm_toolpath::Piece;
use serde::Serialize;

use super::{PurgeInto, PurgeLayout, needs::Needs};

/// Where the old colour went.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PurgeReport {
    /// How towers stand; none where there is no tower.
    pub layout: Option<PurgeLayout>,
    /// What takes the old colour first.
    pub into: PurgeInto,
    /// Changes of colour where a purge is possible; what comes out first is none, though a tower
    /// takes what was in the nozzle before it.
    pub changes: usize,
    /// Of them, those that were purged.
    pub purged: usize,
    /// Changes along a spiral, besides: none of them is purged.
    pub spiral_changes: usize,
    /// Of them, those above the threshold for which there was no tower: samples of the part had
    /// shown no such change.
    pub unpurged: usize,
    /// Laid into hidden filling, mm³.
    pub infill_mm3: f64,
    /// What towers take besides the purges so that they stand, mm³.
    pub standing_mm3: f64,
    /// What purging on towers at every change takes with the colours of all layers in the same
    /// order, mm³; what makes the towers stand not counted.
    pub every_change_mm3: f64,
    /// What of that was not printed on towers.
    pub saved: PurgeSavings,
}

/// Material that purges on towers at every change would have taken besides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PurgeSavings {
    /// By laying it into hidden filling, and for colours that have no more than that in a layer.
    pub infill: Saving,
    /// By leaving out changes at or below `purge.threshold`.
    pub threshold: Saving,
    /// By beginning each layer in the colour in which the one below ended.
    pub order: Saving,
    /// Together.
    pub total: Saving,
}

/// An amount of material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Saving {
    /// mm³.
    pub mm3: f64,
    /// Grams, by the profile's density.
    pub g: f64,
}

/// Counts as the print goes on.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) report: PurgeReport,
    /// The first and last of the palette's colours in the layer before.
    span: Option<(ColorId, ColorId)>,
}

impl Tally {
    /// A layer that follows one that ended in `color`.
    pub(super) fn layer(&mut self, needs: &Needs, pieces: &[Piece], color: Option<ColorId>) {
        let used = || pieces.iter().map(|piece| piece.color);
        let (Some(low), Some(high)) = (used().min(), used().max()) else { return };
        let before = self.span.replace((low, high));
        if let (Some((_, last)), Some(first)) = (before, used().next()) {
            let order = needs.whole(Some(last), low) - needs.whole(color, first);
            self.report.saved.order.mm3 += order;
            self.report.every_change_mm3 += order;
        }
    }

    /// A change of colour.
    pub(super) fn change(&mut self, needs: &Needs, from: Option<ColorId>, to: ColorId) {
        let (whole, volume) = (needs.whole(from, to), needs.volume(from, to));
        self.report.changes += usize::from(from.is_some());
        self.report.every_change_mm3 += whole;
        self.report.saved.threshold.mm3 += whole - volume;
    }

    /// The report, with masses by a density in g/cm³.
    pub(super) fn finish(mut self, density: f64) -> PurgeReport {
        let saved = &mut self.report.saved;
        saved.total.mm3 = saved.infill.mm3 + saved.threshold.mm3 + saved.order.mm3;
        let parts = [&mut saved.infill, &mut saved.threshold, &mut saved.order, &mut saved.total];
        parts.into_iter().for_each(|saving| saving.g = saving.mm3 * density / 1000.0);
        self.report
    }
}
