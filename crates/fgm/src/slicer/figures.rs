//! A slice's figures, for its report.

use super::Slicer;
use crate::{
    choice::{Strategy, Zipper},
    job::PlannedLayer,
    report::{Report, material_use},
    stages::StageSeconds,
    stream::Written,
};

impl Slicer<'_> {
    /// Adds a layer's figures.
    pub(super) fn count(
        &self,
        planned: &PlannedLayer,
        report: &mut Report,
        seconds: &mut StageSeconds,
    ) {
        seconds.add(&planned.seconds);
        report.faces += planned.faces;
        report.model_mm3 += planned.model_mm3;
        report.pieces += planned.count;
        report.short_pieces += planned.short;
        if self.settings.palette.zipper != Zipper::NONE
            && self.settings.slice.strategy == Strategy::Sectioned
        {
            let zipper = report.zipper.get_or_insert_default();
            zipper.seam_mm += planned.seams.zipped;
            zipper.straight_mm += planned.seams.straight;
            zipper.gained_mm = zipper.seam_mm - zipper.straight_mm;
        }
    }

    /// Fills in what is known at the end.
    pub(super) fn fill(&self, report: &mut Report, written: Written, colors: usize, layers: usize) {
        let Written { summary, deposit, cooling, purge, onset: _ } = written;
        report.version = env!("CARGO_PKG_VERSION");
        report.design.clone_from(&self.design.name);
        report.printer.clone_from(&self.machine.name);
        report.strategy = self.settings.slice.strategy.to_string();
        report.layers = layers;
        report.colors = colors;
        report.moves = summary.moves;
        report.extruded_mm3 = summary.extruded_mm3;
        report.purge_mm3 = summary.purge_mm3;
        report.travel_mm = summary.travel_mm;
        report.state_changes = summary.state_changes;
        report.bytes = summary.bytes;
        report.print_time_s = summary.print_time_s;
        report.materials = material_use(self.design, self.machine, &summary.filament_mm3);
        report.progress = summary.progress;
        report.deposit = deposit;
        report.purge = purge;
        report.cooling = cooling;
    }
}
