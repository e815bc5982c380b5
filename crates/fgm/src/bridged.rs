//! Bridges in a layer, of either strategy.

use fgm_core::{Polygon, Role, bead};
use fgm_toolpath::{Bridge, BridgeOptions, InfillOptions, Path, Pattern, bridges, infill, region};

use crate::{job::Job, layers::Layer, outlines::Outline};

/// A region whose bridges are filled.
pub(crate) struct Bridged {
    /// The lines of each bridge.
    pub(crate) lines: Vec<Vec<Path>>,
    /// What is left to be filled otherwise.
    pub(crate) rest: Vec<Polygon>,
}

/// Fills the bridges in a region over the layer `below`.
pub(crate) fn bridged(
    job: &Job<'_>,
    layer: &Layer,
    region: Vec<Polygon>,
    below: &Outline,
    options: &BridgeOptions,
) -> Bridged {
    let found = bridges(&region, &below.region, below.border(), options, &job.inset);
    let rest = found.iter().fold(region, |rest, bridge| region::difference(&rest, &bridge.region));
    let lines = found.iter().map(|bridge| lines(job, layer, bridge)).collect();
    Bridged { lines, rest }
}

/// Lines straight across, as far apart as ever, of more or less volume as `bridges.flow` says.
fn lines(job: &Job<'_>, layer: &Layer, bridge: &Bridge) -> Vec<Path> {
    let (width, height) = (job.settings.layer.bead_width, layer.height);
    let options = InfillOptions {
        pattern: Pattern::Aligned,
        angle: bridge.angle,
        role: Role::Bridge,
        z: layer.cut,
        ..InfillOptions::new(width, height)
    };
    let flow = job.settings.bridges.flow;
    let scaled = |mut path: Path| {
        path.width = bead::width(flow * bead::area(path.width, height), height);
        path.role = Role::Bridge;
        path
    };
    infill(&bridge.region, &options, &job.inset).into_iter().map(scaled).collect()
}
