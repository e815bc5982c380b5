//! A layer as cells: what its beads cover, once or more often.

mod canvas;
mod region;
mod stroke;

use fgm_core::{Bounds2, Polygon};
use serde::Serialize;

use crate::{Piece, SimError};
use canvas::Canvas;

pub(crate) use canvas::Grid;
pub(crate) use region::fill as fill_region;
pub(crate) use stroke::Stroke;

/// What the beads of a layer cover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LayerFigures {
    /// From 1.
    pub layer: u32,
    /// Height of the beads' tops over the bed, mm.
    pub z: f64,
    /// Thickness, mm: that of most of its volume.
    pub height: f64,
    /// Laid down for the part, mm³.
    pub volume_mm3: f64,
    /// Area that the part's beads cover, mm².
    pub covered_mm2: f64,
    /// Share of that area which more than one pass covers.
    pub overlap: f64,
    /// Area of the design, mm²; none without a design.
    pub design_mm2: Option<f64>,
    /// Share of the design's area that is covered.
    pub coverage: Option<f64>,
    /// Covered area outside the design, as a share of the design's.
    pub outside: Option<f64>,
    /// Volume laid down, as a share of the design's area times the height.
    pub filled: Option<f64>,
}

/// Gathers the beads of one layer at a time and measures what they cover.
///
/// A bead counts as wide as its volume makes it where its section is a rectangle (volume over
/// length and height), so that lines laid at their spacing cover each place once. A place that
/// the same path passes twice within twice its width, as at a corner, is covered once.
#[derive(Debug)]
pub struct Coverage {
    cell: f64,
    canvas: Canvas,
    strokes: Vec<Stroke>,
    layer: Option<u32>,
    volume: f64,
    /// Heights times volume, and the top.
    heights: f64,
    z: f64,
}

impl Coverage {
    /// With square cells of this side, mm.
    ///
    /// # Errors
    /// [`SimError::Option`] for a side that is not above 0.
    pub fn new(cell: f64) -> Result<Self, SimError> {
        if !(1e-3..=100.0).contains(&cell) {
            let expected = "0.001 to 100 mm";
            return Err(SimError::Option { name: "cell", value: cell, expected });
        }
        Ok(Self {
            cell,
            canvas: Canvas::default(),
            strokes: Vec::new(),
            layer: None,
            volume: 0.0,
            heights: 0.0,
            z: 0.0,
        })
    }

    /// Adds a piece of the layer; what is not of the part is left out.
    #[inline]
    pub fn piece(&mut self, piece: &Piece) {
        if !piece.is_part() {
            return;
        }
        self.layer = piece.layer;
        self.volume += piece.volume;
        self.heights += piece.volume * piece.height;
        self.z = piece.to.z;
        let joined = self.strokes.last().is_some_and(|last| last.to == piece.from.truncate());
        self.strokes.extend(Stroke::of(piece, joined));
    }

    /// Height of the layer's beads' tops and its thickness, mm; none where there are no beads.
    pub fn height(&self) -> Option<(f64, f64)> {
        (self.volume > 0.0).then(|| (self.z, self.heights / self.volume))
    }

    /// Measures the layer, and begins the next one. `region` is the design's, on the bed.
    ///
    /// # Errors
    /// [`SimError::Raster`] for more cells than a raster may have.
    pub fn finish(&mut self, region: Option<&[Polygon]>) -> Result<Option<LayerFigures>, SimError> {
        let Some(((z, height), layer)) = self.height().zip(self.layer.take()) else {
            self.strokes.clear();
            return Ok(None);
        };
        let mut bounds = Bounds2::EMPTY;
        for stroke in &self.strokes {
            bounds = bounds.union(&stroke.bounds());
        }
        for polygon in region.into_iter().flatten() {
            bounds = bounds.union(&polygon.bounds());
        }
        let grid = Grid::over(&bounds, self.cell, layer)?;
        self.canvas.clear(grid);
        self.canvas.draw(&self.strokes);
        let counts = self.canvas.count(region);
        let area = self.cell * self.cell;
        let design: Option<f64> = region.map(|r| r.iter().map(Polygon::area).sum());
        let share =
            |part: u64, whole: u64| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
        let figures = LayerFigures {
            layer: layer.saturating_add(1),
            z,
            height,
            volume_mm3: self.volume,
            covered_mm2: counts.covered as f64 * area,
            overlap: share(counts.twice, counts.covered),
            design_mm2: design,
            coverage: region.map(|_| share(counts.inside, counts.region)),
            outside: region.map(|_| share(counts.covered - counts.inside, counts.region)),
            filled: design.map(|d| if d > 0.0 { self.volume / (d * height) } else { 0.0 }),
        };
        self.strokes.clear();
        (self.volume, self.heights) = (0.0, 0.0);
        Ok(Some(figures))
    }
}

#[cfg(test)]
mod tests;
