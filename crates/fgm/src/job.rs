use std::ops::Range;

use fgm_contour::ContourOptions;
use fgm_core::{ColorId, Point2, Polygon, Role};
use fgm_field::Design;
use fgm_palette::Palette;
use fgm_toolpath::{
    Change, ClipperInset, ColorOrder, OrderOptions, Piece, Rise, Support, begin_at_seams, brim,
    find_ways, join_ends, mark_overhangs, order_routes, order_with, skirt,
};

use rayon::ThreadPool;

use crate::{
    against,
    boundaries::Bands,
    boundary_lines::BoundaryLines,
    choice::Strategy,
    colors,
    covers::Covers,
    density::Filling,
    error::SliceError,
    foot,
    layers::{Layer, Layers},
    outlines::{Outline, OutlineWindow, SharedOutline},
    purge::{Needs, hidden_first},
    sectioned,
    settings::Settings,
    spiral::Wall,
    stages::{StageSeconds, timed},
};

/// What every layer of a slice is planned from; shared by the threads.
pub(crate) struct Job<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) design: &'a Design,
    pub(crate) palette: &'a Palette,
    pub(crate) bands: Bands<'a>,
    /// The palette without a zipper, where there is one, to compare with.
    pub(crate) straight: Option<Palette>,
    pub(crate) layers: Layers,
    pub(crate) outlines: OutlineWindow<'a>,
    /// How isolines of the material are traced.
    pub(crate) isolines: ContourOptions,
    pub(crate) boundaries: BoundaryLines<'a>,
    pub(crate) inset: ClipperInset,
    pub(crate) filling: Filling,
    /// What lies above, for infill that asks.
    pub(crate) covers: Option<Covers>,
    /// What changes of colour need, where hidden filling is to take it.
    pub(crate) hidden_purges: Option<Needs>,
    /// What a whole change of mixture is worth, mm of travel; infinite where a layer comes back to no
    /// colour.
    pub(crate) change: f64,
    /// The tower that the nozzle goes to between colours, mm.
    pub(crate) tower: Option<Point2>,
    /// The layer that lies on the bed, from 0.
    pub(crate) first: usize,
}

/// Lengths over which colours touch, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Seams {
    pub(crate) zipped: f64,
    /// Without the zipper.
    pub(crate) straight: f64,
}

/// A layer ready to be written.
#[derive(Default)]
pub(crate) struct PlannedLayer {
    /// From 0 at the part's bottom.
    pub(crate) index: usize,
    /// In printing order.
    pub(crate) pieces: Vec<Piece>,
    /// The loop of a spiral, whose pieces are made in the order of the layers.
    pub(crate) wall: Option<Wall>,
    /// How these pieces rise.
    pub(crate) rise: Option<Rise>,
    /// How many of them there are, before they are cut where they hang over, and how many of these
    /// are short.
    pub(crate) count: usize,
    pub(crate) short: usize,
    /// Faces of one colour.
    pub(crate) faces: usize,
    /// How long the seams between colours are, where a zipper makes them longer.
    pub(crate) seams: Seams,
    /// Volume of the part in this layer, mm³.
    pub(crate) model_mm3: f64,
    pub(crate) seconds: StageSeconds,
    pub(crate) warnings: Vec<String>,
    /// Its outline.
    pub(crate) outline: SharedOutline,
    /// How many colours were taken for one where bands are narrower than a bead; 1 for none.
    pub(crate) merged: u16,
}

impl Job<'_> {
    /// Plans one layer, from its own inputs alone.
    pub(crate) fn plan(&self, index: usize) -> Result<PlannedLayer, SliceError> {
        let layer = self.layers.get(index);
        let planned =
            if self.spirals(index) { self.plan_wall(&layer) } else { self.plan_layer(&layer) };
        planned.map_err(|e| e.in_layer(index))
    }

    /// Makes what the first layers have in common, on one thread, and their outlines on another.
    pub(crate) fn prepare(&self, pool: &ThreadPool, range: Range<usize>) {
        let (Strategy::Against, Some(first)) = (self.settings.slice.strategy, range.clone().next())
        else {
            return;
        };
        let cut = self.layers.get(first).cut;
        let outlines = || {
            for index in range.take(self.outlines.span()) {
                // What goes wrong there goes wrong in its layer, too, and is told with that.
                if self.outlines.get(&self.layers.get(index)).is_err() {
                    break;
                }
            }
        };
        pool.install(|| rayon::join(|| self.boundaries.prepare(cut), outlines));
    }

    fn plan_layer(&self, layer: &Layer) -> Result<PlannedLayer, SliceError> {
        let mut seconds = StageSeconds::default();
        let outline = timed(&mut seconds.contour, || self.outlines.get(layer))?;
        let area: f64 = outline.region.iter().map(Polygon::area).sum();
        let foot = self.settings.layer.elephant_foot;
        let drawn = (layer.index == self.first && foot > 0.0).then(|| {
            let width = self.settings.layer.bead_width;
            timed(&mut seconds.toolpath, || {
                foot::drawn_in(&outline.region, foot, width, &self.inset)
            })
        });
        let region = drawn.as_ref().unwrap_or(&outline.region).as_slice();
        let below = timed(&mut seconds.contour, || self.below(layer))?;
        let start = region.first().map_or(Point2::ZERO, |polygon| polygon.bounds().min);
        let change = |a: ColorId, b: ColorId| {
            self.change * self.palette.state(a).distance(&self.palette.state(b))
        };
        let (mut merged, mut seams) = (1, Seams::default());
        let (pieces, faces) = match self.settings.slice.strategy {
            Strategy::Sectioned => {
                let sectioned::Sectioned { pieces, faces, seams: of_layer } =
                    sectioned::pieces(self, layer, region, below.as_deref(), &mut seconds)?;
                seams = of_layer;
                let colors = self.colors(pieces.iter(), layer);
                let corner = self.design.bounds.max.truncate();
                let options = OrderOptions {
                    direction: sectioned::skin_direction(self, layer),
                    ..self.settings.order_options(layer, corner)
                };
                let order = || {
                    let order = self.color_order(&colors, &change);
                    let mut pieces = match &self.hidden_purges {
                        Some(needs) => {
                            hidden_first(pieces, &colors, start, &options, needs, layer.height)
                        }
                        None => order_with(pieces, order, start, &options),
                    };
                    join_ends(&mut pieces, &self.settings.turns(layer.height));
                    pieces
                };
                (timed(&mut seconds.toolpath, order), faces)
            }
            Strategy::Against => {
                let filled = against::routes(self, layer, region, below.as_deref(), &mut seconds)?;
                merged = filled.merged;
                let colors = self.colors(filled.routes.iter().flatten(), layer);
                let corner = self.design.bounds.max.truncate();
                let options = self.settings.order_options(layer, corner);
                let order = || {
                    let order = self.color_order(&colors, &change);
                    let mut pieces = order_routes(filled.routes, order, start);
                    begin_at_seams(&mut pieces, &options);
                    pieces
                };
                (timed(&mut seconds.toolpath, order), filled.faces)
            }
        };
        let count = pieces.len();
        let short = pieces.iter().filter(|p| colors::is_short(p, self.settings)).count();
        let pieces = timed(&mut seconds.toolpath, || {
            let pieces = self.with_overhangs(pieces, below.as_deref());
            let mut pieces = self.with_loops(layer, region, pieces);
            if let Some(options) = self.settings.way_options() {
                let drawn = drawn.as_ref().map(|drawn| Support::new(drawn));
                let border = drawn.as_ref().unwrap_or_else(|| outline.border());
                find_ways(&mut pieces, None, region, border, &options, &self.inset);
            }
            pieces
        });
        Ok(PlannedLayer {
            index: layer.index,
            pieces,
            wall: None,
            rise: None,
            count,
            short,
            faces,
            seams,
            model_mm3: area * layer.height,
            seconds,
            warnings: outline.warnings.clone(),
            outline,
            merged,
        })
    }

    /// The outline that holds a layer; none for the one on the bed.
    fn below(&self, layer: &Layer) -> Result<Option<SharedOutline>, SliceError> {
        let below = layer.index.checked_sub(1).filter(|_| layer.index > self.first);
        below.map(|index| self.outlines.get(&self.layers.get(index))).transpose()
    }

    /// Cuts walls where they begin to hang over; against the gradient, where there are no walls,
    /// every bead but those of bridges.
    pub(crate) fn with_overhangs(&self, pieces: Vec<Piece>, below: Option<&Outline>) -> Vec<Piece> {
        let share = self.settings.walls.overhang;
        let (true, Some(below)) = (share > 0.0, below) else { return pieces };
        let all = self.settings.slice.strategy == Strategy::Against;
        let is_wall = |role| matches!(role, Role::OuterWall | Role::InnerWall | Role::GapFill);
        mark_overhangs(pieces, below.border(), share, |role| {
            is_wall(role) || (all && role != Role::Bridge)
        })
    }

    /// The colours of pieces in the order of printing.
    fn colors<'p>(&self, pieces: impl Iterator<Item = &'p Piece>, layer: &Layer) -> Vec<ColorId> {
        let mut occurs = vec![false; self.palette.colors()];
        for piece in pieces {
            if let Some(occurs) = occurs.get_mut(piece.color.index()) {
                *occurs = true;
            }
        }
        let used: Vec<ColorId> = (0..)
            .map(ColorId)
            .zip(&occurs)
            .filter(|(_, occurs)| **occurs)
            .map(|(id, _)| id)
            .collect();
        self.palette.order_of(&used, layer.index)
    }

    /// One colour after the other, or as changes and travels cost least.
    fn color_order<'c>(&self, colors: &'c [ColorId], change: Change<'c>) -> ColorOrder<'c> {
        let change = self.change.is_finite().then_some(change);
        ColorOrder { sequence: colors, change, via: self.tower }
    }

    /// On the first layer, skirt and brim around the part in the colour that comes first.
    fn with_loops(&self, layer: &Layer, region: &[Polygon], pieces: Vec<Piece>) -> Vec<Piece> {
        let first = pieces.first().map(|piece| piece.color);
        let (true, Some(color)) = (layer.index == self.first, first) else { return pieces };
        let mut all = Vec::new();
        skirt(region, color, &self.settings.skirt_options(), &mut all);
        let mut loops = Vec::new();
        brim(region, color, &self.settings.brim_options(), &self.inset, &mut loops);
        let start = all.last().and_then(|piece| piece.points.last().copied());
        let start = start.or(loops.first().and_then(|piece| piece.points.first().copied()));
        let start = start.unwrap_or(Point2::ZERO);
        all.extend(order_with(loops, &[color], start, &OrderOptions::default()));
        all.extend(pieces);
        all
    }
}
