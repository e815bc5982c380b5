//! What the user should know of a slice.

use super::Slicer;
use crate::{
    choice::{Strategy, Zipper},
    layers::Layers,
    outlines::Outliner,
    progress::Progress,
    purge::PurgeReport,
    report::CoolingReport,
    settings::CoolingSettings,
};

/// Warnings, each told as it is found.
pub(super) struct Warnings<'p> {
    progress: &'p dyn Progress,
    found: Vec<String>,
}

impl<'p> Warnings<'p> {
    pub(super) fn new(progress: &'p dyn Progress) -> Self {
        Self { progress, found: Vec::new() }
    }

    /// Tells what there is to tell.
    pub(super) fn tell(&mut self, warnings: impl IntoIterator<Item = String>) {
        for warning in warnings {
            self.progress.warn(&warning);
            self.found.push(warning);
        }
    }

    /// All of them, for the report.
    pub(super) fn into_vec(self) -> Vec<String> {
        self.found
    }
}

impl Slicer<'_> {
    /// What is known before the first layer.
    pub(super) fn known(&self, outliner: &Outliner<'_>, layers: &Layers) -> Vec<String> {
        let mut warnings = outliner.warnings();
        let last = self.settings.slice.last_layer;
        if let Some(last) = last.filter(|last| *last > layers.count()) {
            warnings
                .push(format!("layer {last} is asked for; the part ends with {}", layers.count()));
        }
        let zipper = self.settings.palette.zipper != Zipper::NONE;
        if zipper && self.settings.slice.strategy == Strategy::Against {
            warnings.push(
                "the zipper is for strategy sectioned; against the gradient it is left out".into(),
            );
        }
        warnings
    }

    /// That colours were taken for one.
    pub(super) fn too_narrow(&self, merged: u16, colors: usize) -> Option<String> {
        let (least, _) = self.settings.bead_widths();
        (merged > 1).then(|| {
            format!(
                "bands narrower than a bead of {least} mm were taken together, mostly up to {merged} \
                 of the {colors} colours for one: at this width the part carries about {} where \
                 it is steepest (--colors, against.min_width)",
                (colors / usize::from(merged)).max(1),
            )
        })
    }

    /// That some layers have less time to cool than they should.
    pub(super) fn too_short(&self, cooling: &CoolingReport) -> Option<String> {
        let CoolingSettings { min_layer_time, min_speed } = self.settings.cooling;
        let short = cooling.short_layers;
        (short > 0).then(|| {
            format!(
                "{short} layers take less than {min_layer_time} s (cooling.min_layer_time) even at \
                 {min_speed} mm/s (cooling.min_speed)"
            )
        })
    }
}

/// That changes were found that no tower was made for.
pub(super) fn unpurged(purge: &PurgeReport) -> Option<String> {
    let (count, changes) = (purge.unpurged, purge.changes);
    (count > 0).then(|| {
        format!(
            "{count} of {changes} changes of colour are above purge.threshold and have no tower: \
             samples of the part had shown none (a lower threshold makes one)"
        )
    })
}
