//! Layers that would be over too soon are slowed.

use fgm_core::{ColorId, Point2};
use fgm_gcode::{Machine, Pace, Pacer, State};
use fgm_toolpath::LayerPlan;

use crate::{report::CoolingReport, settings::CoolingSettings};

/// Gives each layer its pace, and counts what that comes to.
pub(crate) struct Cooling {
    pacer: Pacer,
    states: Vec<State>,
    min_layer_time: f64,
    /// Where the layer before ended.
    at: Option<Point2>,
    first: bool,
    report: CoolingReport,
}

/// Shortfall of a layer's time that is not told, s.
const NEARLY: f64 = 1e-3;

impl Cooling {
    /// None where no layer is to be slowed.
    pub(crate) fn new(
        machine: &Machine,
        states: &[State],
        settings: &CoolingSettings,
    ) -> Option<Self> {
        let CoolingSettings { min_layer_time, min_speed } = *settings;
        (min_layer_time > 0.0).then(|| Self {
            pacer: Pacer::new(machine, states, min_layer_time, min_speed),
            states: states.to_vec(),
            min_layer_time,
            at: None,
            first: true,
            report: CoolingReport::default(),
        })
    }

    /// The pace of the next layer, which begins in a colour; none for the usual one.
    pub(crate) fn pace(&mut self, plan: &LayerPlan, color: Option<ColorId>) -> Option<Pace> {
        let state = color.and_then(|color| self.states.get(color.index()));
        let paced =
            self.pacer.pace(|| plan.motions_from(self.at, color), self.at, state, self.first);
        self.first = false;
        self.at = plan.end().or(self.at);
        let paced = paced?;
        let report = &mut self.report;
        report.slowed_layers += 1;
        report.added_s += paced.seconds - paced.usual;
        report.short_layers += usize::from(paced.seconds < self.min_layer_time - NEARLY);
        Some(paced.pace)
    }

    /// What was slowed.
    pub(crate) fn report(&self) -> CoolingReport {
        self.report
    }
}
