use std::{io::Write, ops::Range, time::Instant};

use fgm_core::{Bounds3, Interval, Mixture, Point3};
use fgm_field::{Design, USUAL_DENSITY};
use fgm_gcode::{Machine, MachineKind, Summary, Writer, WriterOptions};
use fgm_palette::Palette;
use fgm_toolpath::{ClipperInset, Inset, Pattern};

use crate::{
    ahead::Ahead,
    boundaries::Bands,
    boundary_lines::BoundaryLines,
    choice::{ColorCount, Strategy, Zipper},
    colors,
    cooling::Cooling,
    covers::Covers,
    density::Density,
    error::SliceError,
    extent, head,
    job::{Job, PlannedLayer},
    layers::Layers,
    outlines::{OutlineWindow, Outliner},
    pipeline, placement,
    progress::Progress,
    purge::{self, Demand, Needs, Purge, PurgeReport},
    report::{CoolingReport, Report, material_use},
    samples,
    settings::{CoolingSettings, Settings},
    stages::{StageSeconds, timed},
    stream::Stream,
    target::Target,
};

/// Slices a design for a machine.
///
/// ```
/// use fgm::{Quiet, Settings, Slicer, design, gcode::Machine};
///
/// let source = "fgrade([\"x/10 + 0.5\", \"0.5 - x/10\"], [\"a\", \"b\"]) { cube(10); }";
/// let loaded = design::parse_vcad(source, ".".as_ref(), &Default::default())?;
/// let machine = Machine::builtin("generic-mixing").ok_or("no such printer")?;
/// let settings = Settings::default();
///
/// let mut gcode = Vec::new();
/// let report = Slicer::new(&loaded.design, &machine, &settings).slice(&mut gcode, &Quiet)?;
/// assert_eq!(report.layers, 50);
/// assert!((report.model_mm3 - 1000.0).abs() < 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Slicer<'a> {
    design: &'a Design,
    machine: &'a Machine,
    settings: &'a Settings,
    threads: usize,
    head: Vec<String>,
}

/// Layers in flight for each thread: enough that none waits for the writing.
const AHEAD_PER_THREAD: usize = 2;

/// The most threads: more than any machine this runs on has, and each costs memory.
pub const MAX_THREADS: usize = 512;

/// Layers whose pieces are made to choose the number of colours.
const AUTO_LAYERS: usize = 5;

impl<'a> Slicer<'a> {
    /// A slicer with all threads. The settings' changes to the machine are already in `machine`
    /// (see [`crate::machine`]).
    pub fn new(design: &'a Design, machine: &'a Machine, settings: &'a Settings) -> Self {
        Self { design, machine, settings, threads: 0, head: Vec::new() }
    }

    /// How many threads to plan layers on; 0 for all cores. The output does not depend on it.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Comment lines for the head of the file, before the settings.
    #[must_use]
    pub fn head(mut self, lines: Vec<String>) -> Self {
        self.head = lines;
        self
    }

    /// Writes the G-code and returns the figures.
    ///
    /// # Errors
    /// [`SliceError`]; `out` then holds a part of the file, which is the caller's to drop.
    pub fn slice(
        &self,
        out: &mut dyn Write,
        progress: &dyn Progress,
    ) -> Result<Report, SliceError> {
        let start = Instant::now();
        let mut seconds = StageSeconds::default();
        self.settings.check()?;
        self.check_inputs()?;
        if self.threads > MAX_THREADS {
            return Err(SliceError::TooManyThreads { asked: self.threads });
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build()
            .map_err(|e| SliceError::Threads { message: e.to_string() })?;

        let outliner = timed(&mut seconds.read, || {
            Outliner::new(self.design, self.settings.outline_options())
        })?;
        let (heights, layers) = self.layers(&outliner)?;
        let mut warnings = self.warnings(&outliner, &layers);
        warnings.iter().for_each(|w| progress.warn(w));
        let mut range = self.range(&layers)?;
        let part = Bounds3 {
            min: self.design.bounds.min.with_z(heights.lo),
            max: self.design.bounds.max.with_z(heights.hi),
        };
        let bed = self.machine.bed.bounds();
        placement::check(&part, &bed, &self.machine.name)?;
        let threads = pool.current_num_threads();
        let palette = timed(&mut seconds.read, || self.palette(&outliner, layers))?;
        if let Some(warning) = colors::narrowed(&palette, self.design, self.settings, &outliner)? {
            progress.warn(&warning);
            warnings.push(warning);
        }
        let mut job = self.job(&outliner, &palette, layers, threads)?;

        let mut offset = self.machine.bed.centering(&part);
        if range.start == 0 {
            range.start = empty_below(&job, range.end)?;
            job.first = range.start;
            if range.start > 0 {
                // The part stands on the first layer that can be printed.
                let first = layers.get(range.start);
                offset.z -= first.top - first.height - heights.lo;
                warnings.push(format!(
                    "the lowest {} layers are narrower than a bead and left out",
                    range.start
                ));
                warnings.last().into_iter().for_each(|w| progress.warn(w));
            }
        }
        let place = (&part, offset);
        let purge = self.purge(&outliner, &palette, layers, range.clone(), place)?;
        let mut stream = self.stream(&palette, layers, offset, &range, purge, out)?;
        let mut report = Report::default();
        let (mut done, total) = (0, range.len());
        let mut merged = 1;
        progress.advance(done, total);
        job.prepare(&pool, range.clone());
        let make = |index| job.plan(index);
        pipeline::ordered(&pool, range, AHEAD_PER_THREAD * threads, &make, |planned| {
            if progress.cancelled() {
                return Err(SliceError::Cancelled);
            }
            let planned: PlannedLayer = planned?;
            merged = merged.max(planned.merged);
            for warning in &planned.warnings {
                let warning = format!("layer {}: {warning}", planned.index + 1);
                progress.warn(&warning);
                warnings.push(warning);
            }
            self.count(&planned, &mut report, &mut seconds);
            timed(&mut seconds.write, || stream.push(planned))?;
            done += 1;
            progress.advance(done, total);
            Ok(())
        })?;
        let written = timed(&mut seconds.write, || stream.finish())?;
        if report.pieces == 0 {
            return Err(SliceError::NothingToPrint {
                reason: "no bead fits into any layer: the part is thinner than a bead".into(),
            });
        }
        seconds.total = start.elapsed().as_secs_f64();
        self.fill(&mut report, &written.summary, palette.colors(), total);
        report.progress = written.summary.progress;
        report.deposit = written.deposit;
        report.purge = written.purge;
        report.cooling = written.cooling;
        let told = [
            self.too_short(&written.cooling),
            self.too_narrow(merged, palette.colors()),
            report.purge.as_ref().and_then(unpurged),
        ];
        for warning in told.into_iter().flatten() {
            progress.warn(&warning);
            warnings.push(warning);
        }
        report.warnings = warnings;
        report.seconds = seconds;
        Ok(report)
    }

    /// What the user should know before the first layer.
    fn warnings(&self, outliner: &Outliner<'_>, layers: &Layers) -> Vec<String> {
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
    fn too_narrow(&self, merged: u16, colors: usize) -> Option<String> {
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
    fn too_short(&self, cooling: &CoolingReport) -> Option<String> {
        let CoolingSettings { min_layer_time, min_speed } = self.settings.cooling;
        let short = cooling.short_layers;
        (short > 0).then(|| {
            format!(
                "{short} layers take less than {min_layer_time} s (cooling.min_layer_time) even at \
                 {min_speed} mm/s (cooling.min_speed)"
            )
        })
    }

    fn check_inputs(&self) -> Result<(), SliceError> {
        let (materials, inputs) = (self.design.materials.len(), self.machine.inputs());
        // A tool changer's heads carry colours that are mixed beforehand.
        if self.machine.kind != MachineKind::ToolChanger && materials > inputs {
            let printer = self.machine.name.clone();
            return Err(SliceError::Inputs { materials, inputs, printer });
        }
        Ok(())
    }

    fn layers(&self, outliner: &Outliner<'_>) -> Result<(Interval, Layers), SliceError> {
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
    fn range(&self, layers: &Layers) -> Result<Range<usize>, SliceError> {
        let first = self.settings.slice.first_layer - 1;
        let last = self.settings.slice.last_layer.unwrap_or(usize::MAX).min(layers.count());
        if first < last {
            return Ok(first..last);
        }
        Err(SliceError::NothingToPrint {
            reason: format!("layers from {} on, of a part with {}", first + 1, layers.count()),
        })
    }

    fn palette(&self, outliner: &Outliner<'_>, layers: Layers) -> Result<Palette, SliceError> {
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
                        let planned = job.plan(index)?;
                        (short, pieces) = (short + planned.short, pieces + planned.count);
                    }
                    Ok(short as f64 / pieces.max(1) as f64)
                })?
            }
        };
        colors::palette(count, design, settings)
    }

    fn job<'j>(
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
            first: 0,
        })
    }

    /// The palette's bands, with the zipper of strategy 1.
    fn bands<'p>(&'p self, palette: &'p Palette) -> Bands<'p> {
        let zipper = match self.settings.slice.strategy {
            Strategy::Sectioned => self.settings.palette.zipper,
            Strategy::Against => Zipper::NONE,
        };
        Bands::new(self.design.fractions.as_ref(), palette, zipper)
    }

    /// The dead volume that commands go ahead by, mm³.
    fn lead(&self) -> f64 {
        self.settings.lead.volume.unwrap_or_else(|| self.machine.dead_volume())
    }

    fn needs(&self, palette: Vec<Mixture>) -> Needs {
        Needs::new(self.machine, self.settings, self.lead(), palette)
    }

    /// The purges of a print; none where none are wanted.
    fn purge(
        &self,
        outliner: &Outliner<'_>,
        palette: &Palette,
        layers: Layers,
        range: Range<usize>,
        place: (&Bounds3, Point3),
    ) -> Result<Option<Purge>, SliceError> {
        if !purge::wanted(self.machine, self.settings) {
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

    fn inset(&self) -> ClipperInset {
        ClipperInset { simplify: self.settings.inset_simplification() }
    }

    fn stream<'s>(
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
        Ok(Stream {
            ahead: Ahead::new(machine, settings, lead, &mixtures, &states),
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

    fn count(&self, planned: &PlannedLayer, report: &mut Report, seconds: &mut StageSeconds) {
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

    fn fill(&self, report: &mut Report, summary: &Summary, colors: usize, layers: usize) {
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
    }
}

/// That changes were found that no tower was made for.
fn unpurged(purge: &PurgeReport) -> Option<String> {
    let (count, changes) = (purge.unpurged, purge.changes);
    (count > 0).then(|| {
        format!(
            "{count} of {changes} changes of colour are above purge.threshold and have no tower: \
             samples of the part had shown none (a lower threshold makes one)"
        )
    })
}

/// How many of the lowest layers have nothing to print: the tip of a sphere or of a tilted part.
fn empty_below(job: &Job<'_>, end: usize) -> Result<usize, SliceError> {
    let half = 0.5 * job.settings.layer.bead_width;
    for index in 0..end {
        let outline = job.outlines.get(&job.layers.get(index))?;
        // Where a bead fits there is something to print; else planning tells.
        if !job.inset.inset(&outline.region, half).is_empty() || !job.plan(index)?.pieces.is_empty()
        {
            return Ok(index);
        }
    }
    Ok(0)
}

/// `count` indices spread evenly below `of`.
fn spread(of: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(of);
    (0..count).map(move |i| (2 * i + 1) * of / (2 * count))
}
