//! From planned layers to bytes, in order: towers, motions, look-ahead, G-code.

use std::io::Write;

use fgm_core::{ColorId, Point2};
use fgm_gcode::{GcodeError, Pace, Summary, Writer};
use fgm_toolpath::{ClipperInset, LayerPlan, WayOptions, find_ways};

use crate::{
    ahead::Ahead,
    cooling::Cooling,
    error::SliceError,
    job::PlannedLayer,
    layers::Layers,
    onset::Onset,
    purge::{Purge, PurgeReport},
    report::{CoolingReport, DepositReport},
    target::Target,
};

/// What a print is written through.
pub(crate) struct Stream<'a> {
    pub(crate) ahead: Ahead,
    pub(crate) writer: Writer<&'a mut dyn Write>,
    pub(crate) purge: Option<Purge>,
    /// What cannot have its colour at the start.
    pub(crate) onset: Onset,
    /// What the deposit is to be, where commands are chosen for the design.
    pub(crate) target: Option<Target<'a>>,
    pub(crate) cooling: Option<Cooling>,
    pub(crate) layers: Layers,
    /// The colour that comes out at the end of what was pushed.
    pub(crate) color: Option<ColorId>,
    /// Where that is.
    pub(crate) end: Option<Point2>,
    /// How travels from layer to layer keep off the outer wall.
    pub(crate) ways: Option<(WayOptions, ClipperInset)>,
    /// Layers pushed.
    pub(crate) count: usize,
}

/// What was written.
pub(crate) struct Written {
    pub(crate) summary: Summary,
    pub(crate) deposit: Option<DepositReport>,
    pub(crate) cooling: CoolingReport,
    pub(crate) purge: Option<PurgeReport>,
    pub(crate) onset: Onset,
}

impl Stream<'_> {
    /// Writes a layer.
    pub(crate) fn push(&mut self, planned: PlannedLayer) -> Result<(), SliceError> {
        let layer = self.layers.get(planned.index);
        let outline = planned.outline;
        let mut pieces = match &mut self.purge {
            Some(purge) if planned.rise.is_some() => {
                purge.pass(&planned.pieces, self.color);
                planned.pieces
            }
            Some(purge) => purge.lay(planned.pieces, self.color, self.count, layer.height),
            None => planned.pieces,
        };
        self.onset.follow(&pieces, layer.height);
        if let (Some((options, inset)), Some(first)) = (&self.ways, pieces.first_mut()) {
            // Only now is known where the layer below ended.
            let (first, border) = (std::slice::from_mut(first), outline.border());
            find_ways(first, self.end, &outline.region, border, options, inset);
        }
        let index = u32::try_from(planned.index).unwrap_or(u32::MAX);
        let mut plan = LayerPlan::new(index, layer.top, layer.height, pieces)?;
        if let Some(rise) = planned.rise {
            plan = plan.rising(rise)?;
        }
        let pace = self.cooling.as_mut().and_then(|c| c.pace(&plan, self.color));
        self.ahead.set_pace(pace.unwrap_or(Pace::USUAL));
        if let Some(pace) = pace {
            self.writer.slow(index, pace);
        }
        for motion in plan.motions_from(self.end, self.color) {
            let writer = &mut self.writer;
            let target = self.target.as_mut().filter(|_| self.ahead.aims());
            let wanted = target.map_or(&[][..], |target| target.along(&motion, layer.cut));
            self.ahead.push(motion, wanted, |step| writer.push(step))?;
        }
        self.end = plan.end().or(self.end);
        self.color = plan.last_color().or(self.color);
        self.count += 1;
        Ok(())
    }

    /// Writes the rest.
    pub(crate) fn finish(self) -> Result<Written, GcodeError> {
        let Self { ahead, mut writer, cooling, purge, onset, .. } = self;
        let deposit = ahead.finish(|step| writer.push(step))?;
        let cooling = cooling.map_or_else(CoolingReport::default, |c| c.report());
        let purge = purge.map(Purge::finish);
        Ok(Written { summary: writer.finish()?, deposit, cooling, purge, onset })
    }
}
