//! What a slice is written through, and the settings that the file names.

use std::{io::Write, ops::Range};

use fgm_core::{Mixture, Point3};
use fgm_field::USUAL_DENSITY;
use fgm_gcode::{Writer, WriterOptions};
use fgm_palette::Palette;

use super::Slicer;
use crate::{
    ahead::Ahead, choice::ColorCount, colors, cooling::Cooling, density::Density,
    error::SliceError, head, layers::Layers, onset::Onset, purge::Purge, settings::Settings,
    stream::Stream, target::Target,
};

impl Slicer<'_> {
    pub(super) fn stream<'s>(
        &'s self,
        palette: &'s Palette,
        layers: Layers,
        offset: Point3,
        range: &Range<usize>,
        purge: Option<Purge>,
        out: &'s mut dyn Write,
    ) -> Result<Stream<'s>, SliceError> {
        let mixtures: Vec<Mixture> = colors::ids(palette).map(|c| palette.state(c)).collect();
        let states = self.machine.states(&mixtures)?;
        let lead = self.lead();
        let resolved = self.resolved(&mixtures, lead, range, purge.as_ref());
        let mut comments = vec![format!("fgm {}", env!("CARGO_PKG_VERSION"))];
        comments.extend(self.head.iter().cloned());
        comments.extend(head::lines(&resolved, self.machine));
        let options = WriterOptions {
            offset,
            comments,
            colors: mixtures.iter().map(|m| colors::shown(self.design, m)).collect(),
            ..WriterOptions::of(self.machine)
        };
        let (machine, settings) = (self.machine, self.settings);
        let ahead = Ahead::new(machine, settings, lead, &mixtures, &states);
        let late = if ahead.comes_early(machine) { lead } else { 0.0 };
        Ok(Stream {
            onset: Onset::new(late, settings.purge.threshold, &mixtures),
            ahead,
            writer: Writer::new(out, machine, &states, &options)?,
            purge,
            target: Target::of(self.design, settings),
            cooling: Cooling::new(machine, &states, &settings.cooling),
            layers,
            color: None,
            end: None,
            ways: settings.way_options().map(|options| (options, self.inset())),
            count: 0,
        })
    }

    /// The settings with what was left to the machine or to other settings.
    fn resolved(
        &self,
        palette: &[Mixture],
        lead: f64,
        range: &Range<usize>,
        purge: Option<&Purge>,
    ) -> Settings {
        let mut resolved = self.settings.clone();
        if resolved.infill.density == Density::Design && self.design.density.is_none() {
            resolved.infill.density = Density::Percent(100.0 * USUAL_DENSITY);
        }
        let (least, most) = self.settings.bead_widths();
        resolved.slice.first_layer = range.start + 1;
        resolved.slice.last_layer = Some(range.end);
        resolved.layer.first_height = Some(self.settings.first_height());
        resolved.palette.colors = Some(ColorCount::Count(palette.len()));
        resolved.against.min_width = Some(least);
        resolved.against.max_width = Some(most);
        let corner = self.design.bounds.max.truncate();
        resolved.order.seam_point = Some(self.settings.order.seam_point.unwrap_or(corner.into()));
        resolved.purge.enabled = Some(purge.is_some());
        resolved.purge.volume = Some(self.needs(palette.to_vec()).most());
        resolved.purge.layout = purge.and_then(Purge::layout);
        let shapes = self.machine.transition.volumes().is_some();
        let compensation = &mut resolved.compensation;
        compensation.enabled = Some(compensation.enabled.unwrap_or(true) && shapes);
        compensation.aim = Some(self.settings.aim());
        resolved.lead.volume = Some(lead);
        resolved
    }
}
