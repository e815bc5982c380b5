//! What a slice is made of: its layers, its palette, and what every layer is planned from.

use std::ops::Range;

use fgm_core::{Bounds3, Interval, Mixture, Point3};
use fgm_gcode::MachineKind;
use fgm_palette::Palette;
use fgm_toolpath::{ClipperInset, Pattern};

use super::{AHEAD_PER_THREAD, Slicer};
use crate::{
    boundaries::Bands,
    boundary_lines::BoundaryLines,
    choice::{ColorCount, Strategy, Zipper},
    colors,
    covers::Covers,
    error::SliceError,
    extent,
    job::{Job, PlannedLayer},
    layers::Layers,
    outlines::{OutlineWindow, Outliner},
    purge::{self, Demand, Needs, Purge},
    samples,
    spiral::Spiral,
};

/// As `order.change`: each colour is printed once a layer.
const NEVER: f64 = 1e6;
/// Layers whose pieces are made to choose the number of colours.
const AUTO_LAYERS: usize = 5;

impl Slicer<'_> {
    pub(super) fn check_inputs(&self) -> Result<(), SliceError> {
        let (materials, inputs) = (self.design.materials.len(), self.machine.inputs());
        // A tool changer's heads carry colours that are mixed beforehand.
        if self.machine.kind != MachineKind::ToolChanger && materials > inputs {
            let printer = self.machine.name.clone();
            return Err(SliceError::Inputs { materials, inputs, printer });
        }
        Ok(())
    }

    pub(super) fn layers(&self, outliner: &Outliner<'_>) -> Result<(Interval, Layers), SliceError> {
        let height = self.settings.layer.height;
        let heights = extent::heights(outliner, &self.design.bounds, height)?.ok_or_else(|| {
            SliceError::NothingToPrint {
                reason: "the design is empty, or smaller than the cells it is sampled in \
                         (contour.cell)"
                    .into(),
            }
        })?;
        let layers = Layers::new(heights, self.settings.first_height(), height);
        if layers.count() == 0 {
            let reason = format!(
                "the part is {:.4} mm high, less than half a layer of {height} mm",
                heights.width()
            );
            return Err(SliceError::NothingToPrint { reason });
        }
        Ok((heights, layers))
    }

    /// The layers asked for, as indices from 0.
    pub(super) fn range(&self, layers: &Layers) -> Result<Range<usize>, SliceError> {
        let first = self.settings.slice.first_layer - 1;
        let last = self.settings.slice.last_layer.unwrap_or(usize::MAX).min(layers.count());
        if first < last {
            return Ok(first..last);
        }
        Err(SliceError::NothingToPrint {
            reason: format!("layers from {} on, of a part with {}", first + 1, layers.count()),
        })
    }

    pub(super) fn palette(
        &self,
        outliner: &Outliner<'_>,
        layers: Layers,
    ) -> Result<Palette, SliceError> {
        let (design, settings) = (self.design, self.settings);
        let count = match settings.palette.colors {
            Some(ColorCount::Count(count)) => count,
            None => colors::default_count(self.machine.max_colors(), design.materials.len()),
            Some(ColorCount::Auto) => {
                let most = self.machine.max_colors();
                colors::auto_count(design, settings, outliner, most, &|count| {
                    let palette = colors::palette(count, design, settings)?;
                    let job = self.job(outliner, &palette, layers, 1)?;
                    let (mut short, mut pieces) = (0, 0);
                    for index in spread(layers.count(), AUTO_LAYERS) {
                        let mut spiral = Spiral::new(&job, None);
                        let mut count = |planned: PlannedLayer| {
                            (short, pieces) = (short + planned.short, pieces + planned.count);
                            Ok(())
                        };
                        spiral.push(job.plan(index)?, &mut count)?;
                        spiral.finish(&mut count)?;
                    }
                    Ok(short as f64 / pieces.max(1) as f64)
                })?
            }
        };
        colors::palette(count, design, settings)
    }

    pub(super) fn job<'j>(
        &'j self,
        outliner: &'j Outliner<'j>,
        palette: &'j Palette,
        layers: Layers,
        threads: usize,
    ) -> Result<Job<'j>, SliceError> {
        let skins = &self.settings.skins;
        let span = AHEAD_PER_THREAD * threads + skins.top + skins.bottom + 1;
        let infill = &self.settings.infill;
        let filling = infill.density.filling(self.design)?;
        if filling.same().is_none() && !infill.pattern.is_straight() {
            return Err(SliceError::GradedPattern { pattern: infill.pattern });
        }
        let sees = infill.pattern == Pattern::Lightning && !filling.is_solid();
        let covers = sees.then(|| Covers::new(self.design, self.settings, span, layers));
        let span = span + covers.as_ref().map_or(0, Covers::layers);
        let bands = self.bands(palette);
        let zipped = bands.reach() > 0.0;
        Ok(Job {
            settings: self.settings,
            design: self.design,
            palette,
            bands,
            straight: zipped.then(|| palette.clone().with_overlap(0.0)).transpose()?,
            layers,
            outlines: OutlineWindow::new(outliner, span.min(layers.count())),
            isolines: self.settings.isoline_options(),
            boundaries: BoundaryLines::new(self.design, bands, self.settings.isoline_options()),
            inset: self.inset(),
            filling,
            covers,
            hidden_purges: purge::hides(self.machine, self.settings)
                .then(|| self.needs(colors::ids(palette).map(|c| palette.state(c)).collect())),
            change: self.change_of_color(),
            tower: None,
            first: 0,
        })
    }

    /// What a whole change of mixture is worth, mm of travel: the more heads and temperatures change
    /// and the more is purged, the better is one colour at a time.
    fn change_of_color(&self) -> f64 {
        let settings = self.settings;
        let free = self.machine.kind == MachineKind::Mixing
            && !purge::wanted(self.machine, settings)
            && settings.order.change < NEVER;
        if free { settings.order.change } else { f64::INFINITY }
    }

    /// The palette's bands, with the zipper of strategy 1.
    pub(super) fn bands<'p>(&'p self, palette: &'p Palette) -> Bands<'p> {
        let zipper = match self.settings.slice.strategy {
            Strategy::Sectioned => self.settings.palette.zipper,
            Strategy::Against => Zipper::NONE,
        };
        Bands::new(self.design.fractions.as_ref(), palette, zipper)
    }

    /// The dead volume that commands go ahead by, mm³.
    pub(super) fn lead(&self) -> f64 {
        self.settings.lead.volume.unwrap_or_else(|| self.machine.dead_volume())
    }

    pub(super) fn needs(&self, palette: Vec<Mixture>) -> Needs {
        Needs::new(self.machine, self.settings, self.lead(), palette)
    }

    /// The purges of a print; none where none are wanted.
    pub(super) fn purge(
        &self,
        outliner: &Outliner<'_>,
        palette: &Palette,
        layers: Layers,
        range: Range<usize>,
        place: (&Bounds3, Point3),
    ) -> Result<Option<Purge>, SliceError> {
        if !purge::wanted(self.machine, self.settings) || range.is_empty() {
            return Ok(None);
        }
        let needs = self.needs(colors::ids(palette).map(|c| palette.state(c)).collect());
        let window = place.0.xy();
        let occurring = colors::occurring(self.design, self.bands(palette), window, layers, range);
        let mut demand = Demand::of(&needs, occurring);
        // Bounds cannot tell that colours between two others do occur, so that no step is large.
        if self.settings.purge.threshold > 0.0 && demand.last_change.is_some() {
            let points = samples::inside(outliner, &self.design.bounds)?;
            let material = self.design.fractions.as_ref();
            if !purge::is_needed(&needs, palette, material, &points)? {
                demand.last_change = None;
            }
        }
        Purge::new(self.machine, self.settings, needs, &demand, place).map(Some)
    }

    pub(super) fn inset(&self) -> ClipperInset {
        ClipperInset { simplify: self.settings.inset_simplification() }
    }
}

/// `count` indices spread evenly below `of`.
fn spread(of: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(of);
    (0..count).map(move |i| (2 * i + 1) * of / (2 * count))
}
