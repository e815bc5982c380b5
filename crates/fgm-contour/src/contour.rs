use crate::bands::{self, Assembler, Band, Border, Rings};
use crate::graph::{Chains, Graph};
use crate::lattice::Lattice;
use crate::lines::Lines;
use crate::options::{check_levels, check_window};
use crate::place::Placer;
use crate::prune::Blocks;
use crate::refine::Refiner;
use crate::rim::window_border;
use crate::simplify::Simplifier;
use crate::sweep::{Sweep, Task};
use crate::{ContourError, ContourOptions, nest};
use fgm_core::{Bounds2, PlanarField, Point2, Polygon, Polyline, Ring};

/// The lines of one level.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelLines {
    /// The level.
    pub level: f64,
    /// Closed lines.
    pub rings: Vec<Ring>,
    /// Open lines: those that end at the window's edge, or where the field is not a number.
    pub lines: Vec<Polyline>,
}

/// The lines along which a field has the given levels, in a window; one answer a level, in the
/// order asked for.
///
/// Lower values lie on the **left** of the direction of travel; a value that is exactly the level
/// counts as higher. Lines are open where they leave the window and end exactly on its edge.
/// Lines of different levels do not cross.
///
/// # Errors
/// [`ContourError`] for a window, levels or options out of range, and where the field is NaN
/// (unless [`ContourOptions::skip_nan`]).
///
/// ```
/// use fgm_contour::{ContourOptions, isolines};
/// use fgm_core::{Bounds2, Point2};
///
/// let window = Bounds2::new(Point2::ZERO, Point2::new(30.0, 20.0));
/// let lines = isolines(&|p: Point2| p.x, &window, &[10.0], &ContourOptions::default())?;
/// let line = &lines[0].lines[0].points;
/// assert!(line[0].abs_diff_eq(Point2::new(10.0, 0.0), 1e-6)); // Low values on the left:
/// assert!(line[1].abs_diff_eq(Point2::new(10.0, 20.0), 1e-6)); // upwards.
/// # Ok::<(), fgm_contour::ContourError>(())
/// ```
pub fn isolines(
    field: &dyn PlanarField,
    window: &Bounds2,
    levels: &[f64],
    options: &ContourOptions,
) -> Result<Vec<LevelLines>, ContourError> {
    Contourer::default().isolines(field, window, levels, options)
}

/// The region of a window in which a field is negative, as polygons: outer rings anticlockwise,
/// holes clockwise, none crossing itself or another.
///
/// Always closed: what lies beyond the window counts as outside, and where the region reaches the
/// window its border runs along the edge.
///
/// # Errors
/// [`ContourError`] for a window or options out of range, where the field is NaN, and where its
/// bounds are false.
///
/// ```
/// use fgm_contour::{ContourOptions, outline};
/// use fgm_core::{Bounds2, Point2};
///
/// let square = |p: Point2| p.abs().max_element() - 5.0;
/// let window = Bounds2::new(Point2::splat(-7.2), Point2::splat(7.2));
/// let region = outline(&square, &window, &ContourOptions::default())?;
/// assert_eq!(region.len(), 1);
/// assert_eq!(region[0].outer.points.len(), 4);
/// assert!((region[0].area() - 100.0).abs() < 1e-6);
/// # Ok::<(), fgm_contour::ContourError>(())
/// ```
pub fn outline(
    field: &dyn PlanarField,
    window: &Bounds2,
    options: &ContourOptions,
) -> Result<Vec<Polygon>, ContourError> {
    Contourer::default().outline(field, window, options)
}

/// The regions of a window below, between and above levels of a field: one more than there are
/// different levels, from the lowest up. Their borders are the lines of [`isolines`], the same for
/// both neighbours to the last bit, and the window's edge; together they are the window.
///
/// Where the field jumps over several levels, the bands between have no width there and borders
/// may touch.
///
/// # Errors
/// [`ContourError`] for a window, levels or options out of range, where the field is NaN, and
/// where its bounds are false.
///
/// ```
/// use fgm_contour::{ContourOptions, isobands};
/// use fgm_core::{Bounds2, Point2};
///
/// let window = Bounds2::new(Point2::splat(-6.0), Point2::splat(6.0));
/// let distance = |p: Point2| p.length();
/// let bands = isobands(&distance, &window, &[2.0, 4.0], &ContourOptions::default())?;
/// assert_eq!(bands[1].polygons[0].holes.len(), 1);
/// let total: f64 = bands.iter().flat_map(|b| &b.polygons).map(|p| p.area()).sum();
/// assert!((total - 144.0).abs() < 1e-9);
/// # Ok::<(), fgm_contour::ContourError>(())
/// ```
pub fn isobands(
    field: &dyn PlanarField,
    window: &Bounds2,
    levels: &[f64],
    options: &ContourOptions,
) -> Result<Vec<Band>, ContourError> {
    Contourer::default().isobands(field, window, levels, options)
}

/// [`isolines`], [`isobands`] and [`outline`] with scratch memory that is kept from one call to the next: one
/// for each thread that contours layer after layer. The answers are the same.
#[derive(Debug, Default)]
pub struct Contourer {
    blocks: Blocks,
    sweep: Sweep,
    trace: Trace,
}

/// From crossings to lines.
#[derive(Debug, Default)]
struct Trace {
    graph: Graph,
    positions: Vec<Point2>,
    chains: Chains,
    lines: Lines,
    placer: Placer,
    refiner: Refiner,
    simplifier: Simplifier,
}

impl Contourer {
    /// See [`isolines`].
    ///
    /// # Errors
    /// As [`isolines`].
    pub fn isolines(
        &mut self,
        field: &dyn PlanarField,
        window: &Bounds2,
        levels: &[f64],
        options: &ContourOptions,
    ) -> Result<Vec<LevelLines>, ContourError> {
        options.check()?;
        check_window(window)?;
        check_levels(levels)?;
        let sorted = Sorted::new(levels);
        let lattice = Lattice::new(window, options.cell, false)?;
        let task =
            Task { lattice: &lattice, field, levels: &sorted.levels, skip_nan: options.skip_nan };
        self.trace(&task, options)?;
        Ok(sorted.collect(levels, &self.trace.lines))
    }

    /// See [`isobands`].
    ///
    /// # Errors
    /// As [`isobands`].
    pub fn isobands(
        &mut self,
        field: &dyn PlanarField,
        window: &Bounds2,
        levels: &[f64],
        options: &ContourOptions,
    ) -> Result<Vec<Band>, ContourError> {
        let (Sorted { levels }, border) = self.bordered(field, window, levels, options)?;
        let mut rings = Rings::default();
        let assembler = Assembler { lines: &self.trace.lines, border: &border };
        assembler.run(|_| true, |_| true, &mut rings);
        Ok(bands::bands_of(&levels, rings.list))
    }

    /// For each level, in the order asked for, the region of the window below it: the lines of
    /// [`isolines`], closed along the window's edge.
    ///
    /// # Errors
    /// As [`isobands`].
    pub fn below(
        &mut self,
        field: &dyn PlanarField,
        window: &Bounds2,
        levels: &[f64],
        options: &ContourOptions,
    ) -> Result<Vec<Band>, ContourError> {
        let (sorted, border) = self.bordered(field, window, levels, options)?;
        let regions = bands::below(&sorted.levels, &self.trace.lines, &border);
        Ok(sorted.in_order(levels, regions))
    }

    /// Traces all lines, with the window's edge.
    fn bordered(
        &mut self,
        field: &dyn PlanarField,
        window: &Bounds2,
        levels: &[f64],
        options: &ContourOptions,
    ) -> Result<(Sorted, Border), ContourError> {
        options.check()?;
        check_window(window)?;
        check_levels(levels)?;
        let sorted = Sorted::new(levels);
        let lattice = Lattice::new(window, options.cell, false)?;
        let task = Task { lattice: &lattice, field, levels: &sorted.levels, skip_nan: false };
        self.trace(&task, options)?;
        let Trace { graph, chains, lines, .. } = &self.trace;
        let border = window_border(&task, graph, chains, lines)?;
        Ok((sorted, border))
    }

    /// See [`outline`].
    ///
    /// # Errors
    /// As [`outline`].
    pub fn outline(
        &mut self,
        field: &dyn PlanarField,
        window: &Bounds2,
        options: &ContourOptions,
    ) -> Result<Vec<Polygon>, ContourError> {
        options.check()?;
        check_window(window)?;
        let lattice = Lattice::new(window, options.cell, true)?;
        let task = Task { lattice: &lattice, field, levels: &[0.0], skip_nan: false };
        self.trace(&task, options)?;
        let lines = &self.trace.lines;
        if let Some(open) = lines.list.iter().find(|l| !l.closed) {
            return Err(ContourError::FalseBounds { at: lines.points[open.from] });
        }
        Ok(nest(lines.list.iter().map(|l| Ring::new(lines.points(l).to_vec())).collect()))
    }

    fn trace(&mut self, task: &Task<'_>, options: &ContourOptions) -> Result<(), ContourError> {
        let trace = &mut self.trace;
        self.blocks.mark(task.lattice, task.field, task.levels);
        trace.graph.clear();
        self.sweep.run(task, &self.blocks, &mut trace.graph)?;
        let tolerance = options.root_tolerance;
        trace.placer.place(task, &trace.graph, tolerance, &mut trace.positions)?;
        trace.graph.chains(&trace.positions, tolerance, &mut trace.chains);
        trace.refiner.run(
            task,
            options,
            &trace.graph,
            &trace.chains,
            &trace.positions,
            &mut trace.lines,
        )?;
        trace.simplifier.run(&mut trace.lines, options.simplify_budget());
        Ok(())
    }
}

/// Levels in order and without repetition.
pub(crate) struct Sorted {
    pub(crate) levels: Vec<f64>,
}

impl Sorted {
    pub(crate) fn new(levels: &[f64]) -> Self {
        let mut levels = levels.to_vec();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        Self { levels }
    }

    /// Lines by level, in the order asked for.
    pub(crate) fn collect(&self, levels: &[f64], lines: &Lines) -> Vec<LevelLines> {
        let mut found = vec![LevelLines::default(); self.levels.len()];
        for line in lines.list.iter().filter(|l| l.from < l.to) {
            let points = lines.points(line).to_vec();
            let slot = &mut found[usize::from(line.level)];
            if line.closed {
                slot.rings.push(Ring::new(points));
            } else {
                slot.lines.push(Polyline::new(points));
            }
        }
        for (lines, &level) in found.iter_mut().zip(&self.levels) {
            lines.level = level;
        }
        self.in_order(levels, found)
    }

    /// What was found for each level, in the order asked for.
    pub(crate) fn in_order<T: Clone>(&self, levels: &[f64], found: Vec<T>) -> Vec<T> {
        let mut found: Vec<Option<T>> = found.into_iter().map(Some).collect();
        let mut last = vec![0; found.len()];
        let place = |&level: &f64| self.levels.partition_point(|&l| l < level);
        levels.iter().enumerate().for_each(|(k, level)| last[place(level)] = k);
        let take = |(k, level): (usize, &f64)| {
            let slot = &mut found[place(level)];
            if last[place(level)] == k { slot.take() } else { slot.clone() }
        };
        levels.iter().enumerate().filter_map(take).collect()
    }
}
