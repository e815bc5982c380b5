//! The wall of a spiral: a loop for each layer, made in parallel, and here, in their order, joined
//! to one line that rises without a step.

use std::ops::Range;

use fgm_core::{ColorId, Point2, Polygon, Ring, Role};
use fgm_gcode::{Machine, MachineKind};
use fgm_toolpath::{
    Inset, Piece, Rise, Turn, WallOptions, fade, mark_overhangs, region::intersection, walls,
};

use crate::{
    colors,
    error::SliceError,
    heights::Heights,
    job::{Job, PlannedLayer},
    layers::Layer,
    outlines::{Outline, SharedOutline},
    sectioned,
    stages::{StageSeconds, timed},
};

/// The loop of a layer, before it is turned.
#[derive(Default)]
pub(crate) struct Wall {
    /// Its points, the first not repeated; none where no loop fits.
    ring: Vec<Point2>,
    /// The outline that it runs in.
    around: SharedOutline,
    /// Whether the design has more than the outer wall there: holes, or what is too thin for a loop.
    left_out: bool,
}

impl Wall {
    /// The only loop around a layer's region, filled.
    fn of(job: &Job<'_>, layer: &Layer, region: &[Polygon]) -> Result<(Self, Outline), SliceError> {
        let area = |polygon: &&Polygon| polygon.outer.area();
        let largest = region.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
        let Some(largest) = largest else { return Ok(Default::default()) };
        // An island in a hole is inside the wall like the hole itself.
        let inside =
            |p: &Polygon| p.outer.points.first().is_some_and(|p| largest.outer.contains(*p));
        let filled: Vec<Polygon> = region
            .iter()
            .filter(|polygon| std::ptr::eq(*polygon, largest) || !inside(polygon))
            .map(|polygon| Polygon::simple(polygon.outer.clone()))
            .collect();
        let options = WallOptions::new(1, job.settings.layer.bead_width, layer.height);
        let paths = walls(&filled, &options, &job.inset).paths;
        let (loops, thin): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| path.closed);
        if loops.len() > 1 {
            let (layer, z, outlines) = (layer.index + 1, layer.cut, loops.len());
            return Err(SliceError::SpiralOutlines { layer, z, outlines });
        }
        let holes = region.iter().any(|polygon| !polygon.holes.is_empty());
        let left_out = holes || !thin.is_empty() || filled.len() > loops.len();
        let simple = |path: fgm_toolpath::Path| path.simplified(job.settings.contour.resolution);
        let ring = loops.into_iter().next().map_or_else(Vec::new, |path| simple(path).points);
        let runs_in = |p: &&Polygon| ring.first().is_some_and(|at| p.outer.contains(*at));
        let around = filled.iter().find(runs_in).cloned().into_iter().collect();
        let around = SharedOutline::new(Outline::new(around, Vec::new()));
        Ok((Self { ring, around, left_out }, Outline::new(filled, Vec::new())))
    }
}

impl Job<'_> {
    /// Whether a layer belongs to the spiral, which begins on the solid bottom, or on one wall.
    pub(crate) fn spirals(&self, index: usize) -> bool {
        self.settings.walls.spiral && index >= self.settings.flat_layers(self.first)
    }

    /// Where the flat layers of a print of these layers end: with it, or where the spiral begins.
    pub(crate) fn flat_end(&self, range: &Range<usize>) -> usize {
        range.clone().find(|&index| self.spirals(index)).unwrap_or(range.end)
    }

    /// That a spiral was asked for and none of these layers belongs to it.
    pub(crate) fn no_spiral(&self, range: &Range<usize>) -> Option<String> {
        if !self.settings.walls.spiral || self.flat_end(range) < range.end {
            return None;
        }
        let (bottom, count) = (self.settings.flat_layers(self.first), self.layers.count());
        let why = if bottom >= count {
            format!("the part has {count} layers")
        } else {
            format!("the layers asked for end with {}", range.end)
        };
        Some(format!(
            "no spiral is printed (walls.spiral): the bottom below it ends with layer {bottom} \
             (skins.bottom, --bottom), and {why}"
        ))
    }

    /// The loop of a layer of the spiral.
    pub(crate) fn plan_wall(&self, layer: &Layer) -> Result<PlannedLayer, SliceError> {
        let mut seconds = StageSeconds::default();
        let outline = timed(&mut seconds.contour, || self.outlines.get(layer))?;
        let (wall, filled) =
            timed(&mut seconds.toolpath, || Wall::of(self, layer, &outline.region))?;
        Ok(PlannedLayer {
            index: layer.index,
            wall: Some(wall),
            model_mm3: outline.region.iter().map(Polygon::area).sum::<f64>() * layer.height,
            seconds,
            warnings: outline.warnings.clone(),
            outline: SharedOutline::new(filled),
            merged: 1,
            ..PlannedLayer::default()
        })
    }
}

/// Layers that something is told of.
#[derive(Default)]
struct Layered {
    count: usize,
    /// From 1.
    first: usize,
}

impl Layered {
    fn add(&mut self, index: usize) {
        self.count += 1;
        if self.count == 1 {
            self.first = index + 1;
        }
    }
}

/// Takes planned layers in their order and hands them on, with the spiral's loops turned, led from
/// one to the next and cut by colour: each one layer late, since the last of them is different.
pub(crate) struct Spiral<'j> {
    job: &'j Job<'j>,
    /// A printer that cannot change colours without leaving the part.
    changer: Option<&'j str>,
    /// The last turn of the spiral, not handed on yet.
    last: Option<(Turn, PlannedLayer)>,
    /// What the next layer lies on, and where that ended.
    below: Option<SharedOutline>,
    /// The outline of the layer below in the design.
    outline: Option<SharedOutline>,
    end: Option<Point2>,
    color: Option<ColorId>,
    over: bool,
    /// Layers of which a part is left out, and those that step outward over air.
    left_out: Layered,
    leaning: Layered,
}

impl<'j> Spiral<'j> {
    /// Of a print without a spiral every layer is handed on as it is. No machine is asked whether it
    /// can print the spiral's colours where there is `None`.
    pub(crate) fn new(job: &'j Job<'j>, machine: Option<&'j Machine>) -> Self {
        let changer = machine.filter(|machine| machine.kind == MachineKind::ToolChanger);
        Self {
            job,
            changer: changer.map(|machine| machine.name.as_str()),
            last: None,
            below: None,
            outline: None,
            end: None,
            color: None,
            over: false,
            left_out: Layered::default(),
            leaning: Layered::default(),
        }
    }

    /// Takes the next layer.
    pub(crate) fn push(
        &mut self,
        mut planned: PlannedLayer,
        emit: &mut dyn FnMut(PlannedLayer) -> Result<(), SliceError>,
    ) -> Result<(), SliceError> {
        let Some(wall) = planned.wall.take() else {
            let end = planned.pieces.last().and_then(|piece| piece.points.last());
            self.end = end.copied().or(self.end);
            self.below = Some(SharedOutline::clone(&planned.outline));
            self.outline = Some(SharedOutline::clone(&planned.outline));
            return emit(planned);
        };
        if wall.left_out {
            self.left_out.add(planned.index);
        }
        let layer = self.job.layers.get(planned.index);
        let near = self.last.as_ref().map(|(turn, _)| turn.start()).or(self.end);
        let near = near.or(wall.ring.first().copied());
        let Some(turn) = near.and_then(|near| Turn::new(&wall.ring, near)) else {
            self.finish(emit)?;
            return emit(planned);
        };
        if self.over {
            return Err(SliceError::SpiralGap { layer: layer.index + 1, z: layer.cut });
        }
        let around = self.outline.replace(SharedOutline::clone(&wall.around));
        if around.is_some_and(|below| !overlap(&wall.around.region, &below.region)) {
            return Err(SliceError::SpiralIsland { layer: layer.index + 1, z: layer.cut });
        }
        self.wind(&turn, &layer, &mut planned)?;
        match self.last.replace((turn, planned)) {
            Some((_, before)) => emit(before),
            None => Ok(()),
        }
    }

    /// Hands on what is held: nothing of the spiral comes any more. Its rim is made flat.
    pub(crate) fn finish(
        &mut self,
        emit: &mut dyn FnMut(PlannedLayer) -> Result<(), SliceError>,
    ) -> Result<(), SliceError> {
        let Some((turn, mut planned)) = self.last.take() else { return Ok(()) };
        self.over = true;
        let layer = self.job.layers.get(planned.index);
        let (line, heights) = (turn.line().to_vec(), Heights::flat(layer.cut));
        let rim = sectioned::rising_wall(self.job, &layer, line, heights)?;
        self.check_colors(&rim, &layer)?;
        planned.pieces.extend(fade(rim, layer.height, 1.0, 0.0));
        emit(planned)
    }

    /// That more than one wall was wanted somewhere, and that it has nothing below.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let Layered { count, first } = self.left_out;
        if count > 0 {
            warnings.push(format!(
                "walls.spiral prints the outer wall only: in {count} layers, from layer {first} on, \
                 holes or what is too thin for a loop are left out"
            ));
        }
        let Layered { count, first } = self.leaning;
        if count > 0 {
            warnings.push(format!(
                "the wall of the spiral (walls.spiral) leans outward by more than a bead's width, \
                 {} mm, from one layer to the next: in {count} layers, from layer {first} on, it is \
                 printed over air",
                self.job.settings.layer.bead_width
            ));
        }
        warnings
    }

    /// Makes the pieces of a turn.
    fn wind(
        &mut self,
        turn: &Turn,
        layer: &Layer,
        planned: &mut PlannedLayer,
    ) -> Result<(), SliceError> {
        let job = self.job;
        let mut seconds = std::mem::take(&mut planned.seconds);
        timed(&mut seconds.toolpath, || {
            // Walls that lean by more than that have a step instead.
            let reach = job.settings.layer.bead_width;
            let line = match &self.last {
                Some((before, _)) => turn.led_from(before, reach),
                None => turn.line().to_vec(),
            };
            // The middle of a bead of full height below the nozzle.
            let heights = Heights { from: layer.cut - layer.height, to: layer.cut };
            let border = covered(job, &line);
            if self.below.as_ref().is_some_and(|below| leans(&line, below, reach)) {
                self.leaning.add(layer.index);
            }
            let mut pieces = sectioned::rising_wall(job, layer, line, heights)?;
            self.check_colors(&pieces, layer)?;
            let length = pieces.iter().map(Piece::length).sum();
            let from = layer.top - layer.height;
            let below = layer.index.checked_sub(1).map(|below| job.layers.get(below).top);
            planned.rise = Some(Rise { from: below.unwrap_or(from), length });
            planned.count = pieces.len();
            planned.short = pieces.iter().filter(|p| colors::is_short(p, job.settings)).count();
            planned.faces = pieces.chunk_by(|a, b| a.color == b.color).count();
            pieces = job.with_overhangs(pieces, self.below.replace(border).as_deref());
            if self.last.is_none() {
                pieces = fade(pieces, layer.height, 0.0, 1.0);
            }
            planned.pieces = pieces;
            Ok::<(), SliceError>(())
        })?;
        planned.seconds = seconds;
        Ok(())
    }

    /// Whether the printer can print these pieces without leaving the wall.
    fn check_colors(&mut self, pieces: &[Piece], layer: &Layer) -> Result<(), SliceError> {
        for piece in pieces {
            let before = self.color.replace(piece.color);
            if let (Some(printer), Some(from)) = (self.changer, before)
                && from != piece.color
            {
                return Err(SliceError::SpiralHeads {
                    layer: layer.index + 1,
                    z: layer.cut,
                    from: from.index(),
                    to: piece.color.index(),
                    printer: printer.to_owned(),
                });
            }
        }
        Ok(())
    }
}

/// Whether two regions have an area in common.
fn overlap(a: &[Polygon], b: &[Polygon]) -> bool {
    // Where walls stand on each other, a point tells.
    let inside = |of: &[Polygon], within: &[Polygon]| {
        let points = of.iter().filter_map(|polygon| polygon.outer.points.first());
        points.into_iter().any(|p| within.iter().any(|polygon| polygon.contains(*p)))
    };
    inside(a, b) || inside(b, a) || !intersection(a, b).is_empty()
}

/// Whether a bead lies beside what is below with its whole width, over more than that of its length.
fn leans(line: &[Point2], below: &Outline, width: f64) -> bool {
    let bead = Piece::new(line.to_vec(), Role::OuterWall, width, ColorId(0));
    let marked = mark_overhangs(vec![bead], below.border(), WHOLE, |_| true);
    let over = marked.iter().filter(|piece| piece.role == Role::FullOverhang);
    over.map(Piece::length).sum::<f64>() > width
}

/// The share of its width that a bead over air may have on what is below.
const WHOLE: f64 = 1e-3;

/// What lies inside the outer border of a turn's bead: what holds the next turn. The layer's own
/// outline would hold it only where the turn has been led over to that.
fn covered(job: &Job<'_>, line: &[Point2]) -> SharedOutline {
    let mut ring = line.to_vec();
    ring.dedup();
    if ring.first() == ring.last() {
        ring.pop();
    }
    let inside = [Polygon::simple(Ring::new(ring))];
    let half = 0.5 * job.settings.layer.bead_width;
    SharedOutline::new(Outline::new(job.inset.inset(&inside, -half), Vec::new()))
}
