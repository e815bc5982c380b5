//! What the user should know of a slice.

use fgm_core::{ColorId, bead};
use fgm_toolpath::{Piece, SkirtOptions, skirt};

use super::Slicer;
use crate::{
    choice::{Strategy, Zipper},
    error::SliceError,
    job::Job,
    layers::Layers,
    onset::Onset,
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

    /// That colours at the start of the print would have to be commanded before it begins, and how
    /// large a skirt takes them. `job` is there if the print has a layer on the bed.
    pub(super) fn unled(
        &self,
        onset: &Onset,
        job: Option<&Job<'_>>,
    ) -> Result<Option<String>, SliceError> {
        let Some((off, missing)) = onset.off() else { return Ok(None) };
        let loops = job.map(|job| self.skirt_for(missing, job)).transpose()?.flatten();
        let way = match loops {
            Some(loops) => format!("a skirt takes it with --set skirt.loops={loops}"),
            None => format!("{missing:.1} mm3 printed before would take it"),
        };
        Ok(Some(format!(
            "{off:.1} mm3 at the start of the print cannot have their colour and come out in the \
             first one: {:.1} mm3 of dead volume (lead.volume) lie between a command and what comes \
             out; {way}",
            self.lead()
        )))
    }

    /// How many loops a skirt has that takes a volume more than now; none if that is too many.
    fn skirt_for(&self, volume: f64, job: &Job<'_>) -> Result<Option<u32>, SliceError> {
        let layer = job.layers.get(job.first);
        let outline = job.outlines.get(&layer)?;
        let now = self.settings.skirt_options();
        let options = SkirtOptions { loops: MOST_LOOPS, ..now };
        let mut pieces = Vec::new();
        skirt(&outline.region, ColorId(0), &options, &mut pieces);
        let of = |piece: &Piece| piece.length() * bead::area(piece.width, layer.height);
        let mut taken = 0.0;
        let more = pieces.iter().skip(now.loops as usize).position(|piece| {
            taken += of(piece);
            taken >= volume
        });
        Ok(more.and_then(|more| u32::try_from(more + 1).ok()).map(|more| now.loops + more))
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

/// The most loops that skirt.loops may be.
const MOST_LOOPS: u32 = 100;

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
