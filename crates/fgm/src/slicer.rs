mod figures;
mod inputs;
mod output;
mod warnings;

use std::{io::Write, ops::Range, time::Instant};

use fgm_core::{Bounds3, Point3};
use fgm_field::Design;
use fgm_gcode::Machine;
use fgm_toolpath::Inset;
use rayon::ThreadPool;

use crate::{
    colors,
    error::SliceError,
    job::{Job, PlannedLayer},
    outlines::Outliner,
    pipeline, placement,
    progress::Progress,
    report::Report,
    settings::Settings,
    spiral::Spiral,
    stages::{StageSeconds, timed},
};
use warnings::{Warnings, unpurged};

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
        self.settings.check()?;
        let settings = self.settings.implied()?;
        Slicer { settings: &settings, ..self.clone() }.slice_as_set(out, progress)
    }

    /// The same with settings that are checked and stand for themselves.
    fn slice_as_set(
        &self,
        out: &mut dyn Write,
        progress: &dyn Progress,
    ) -> Result<Report, SliceError> {
        let start = Instant::now();
        let mut seconds = StageSeconds::default();
        let mut warnings = Warnings::new(progress);
        self.check_inputs()?;
        let pool = self.pool()?;
        let outliner = timed(&mut seconds.read, || {
            Outliner::new(self.design, self.settings.outline_options())
        })?;
        let (heights, layers) = self.layers(&outliner)?;
        warnings.tell(self.known(&outliner, &layers));
        let mut range = self.range(&layers)?;
        let part = Bounds3 {
            min: self.design.bounds.min.with_z(heights.lo),
            max: self.design.bounds.max.with_z(heights.hi),
        };
        placement::check(&part, &self.machine.bed.bounds(), &self.machine.name)?;
        let palette = timed(&mut seconds.read, || self.palette(&outliner, layers))?;
        warnings.tell(colors::narrowed(&palette, self.design, self.settings, &outliner)?);
        let mut job = self.job(&outliner, &palette, layers, pool.current_num_threads())?;
        let offset = self.stand(&mut job, &mut range, &part, &mut warnings)?;
        warnings.tell(job.no_spiral(&range));
        let flat = range.start..job.flat_end(&range);
        let on_bed = range.start == job.first;
        let purge = self.purge(&outliner, &palette, layers, flat, (&part, offset))?;
        job.tower = purge.as_ref().and_then(|purge| purge.place(part.xy().center()));
        let mut stream = self.stream(&palette, layers, offset, &range, purge, out)?;

        let mut report = Report::default();
        let (mut done, mut merged, total) = (0, 1, range.len());
        progress.advance(done, total);
        job.prepare(&pool, range.clone());
        let ahead = AHEAD_PER_THREAD * pool.current_num_threads();
        let make = |index| job.plan(index);
        let mut spiral = Spiral::new(&job, Some(self.machine));
        let mut write = |planned: PlannedLayer| {
            self.count(&planned, &mut report, &mut seconds);
            timed(&mut seconds.write, || stream.push(planned))
        };
        pipeline::ordered(&pool, range, ahead, &make, |planned| {
            if progress.cancelled() {
                return Err(SliceError::Cancelled);
            }
            let planned: PlannedLayer = planned?;
            merged = merged.max(planned.merged);
            let number = planned.index + 1;
            warnings.tell(planned.warnings.iter().map(|w| format!("layer {number}: {w}")));
            spiral.push(planned, &mut write)?;
            done += 1;
            progress.advance(done, total);
            Ok(())
        })?;
        spiral.finish(&mut write)?;
        let written = timed(&mut seconds.write, || stream.finish())?;
        if report.pieces == 0 {
            return Err(SliceError::NothingToPrint {
                reason: "no bead fits into any layer: the part is thinner than a bead".into(),
            });
        }
        seconds.total = start.elapsed().as_secs_f64();
        warnings.tell(self.unled(&written.onset, on_bed.then_some(&job))?);
        self.fill(&mut report, written, palette.colors(), total);
        warnings.tell(self.too_short(&report.cooling));
        warnings.tell(self.too_narrow(merged, palette.colors()));
        warnings.tell(report.purge.as_ref().and_then(unpurged));
        warnings.tell(spiral.warnings());
        report.warnings = warnings.into_vec();
        report.seconds = seconds;
        Ok(report)
    }

    /// The threads that layers are planned on.
    fn pool(&self) -> Result<ThreadPool, SliceError> {
        if self.threads > MAX_THREADS {
            return Err(SliceError::TooManyThreads { asked: self.threads });
        }
        rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build()
            .map_err(|e| SliceError::Threads { message: e.to_string() })
    }

    /// Makes the part stand on the first layer that can be printed; what is added to its places to
    /// put it on the bed.
    fn stand(
        &self,
        job: &mut Job<'_>,
        range: &mut Range<usize>,
        part: &Bounds3,
        warnings: &mut Warnings<'_>,
    ) -> Result<Point3, SliceError> {
        let mut offset = self.machine.bed.centering(part);
        if range.start > 0 {
            return Ok(offset);
        }
        range.start = empty_below(job, range.end)?;
        job.first = range.start;
        if range.start > 0 {
            let first = job.layers.get(range.start);
            offset.z -= first.top - first.height - part.min.z;
            warnings.tell([format!(
                "the lowest {} layers are narrower than a bead and left out",
                range.start
            )]);
        }
        Ok(offset)
    }
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
