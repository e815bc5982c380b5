use fgm_core::{Bounds2, MAX_MATERIALS, Mixture, Point2, Point3, Polygon};

use super::{Picture, PictureKind};
use crate::{
    Piece, Reference, Shades, SimError,
    raster::{Grid, Stroke, fill_region},
};

/// Where there is nothing.
const PAPER: [u8; 3] = [255, 255, 255];
/// Where something should have been laid down.
const MISSING: [u8; 3] = [160, 160, 160];
/// Colours of errors: up to which error, and the colour there.
const HEAT: [(f64, [f64; 3]); 5] = [
    (0.0, [250.0, 250.0, 250.0]),
    (0.05, [255.0, 225.0, 110.0]),
    (0.15, [230.0, 60.0, 40.0]),
    (0.5, [60.0, 0.0, 20.0]),
    (1.0, [0.0, 0.0, 0.0]),
];
/// The longer side of a picture, pixels.
const LONGEST: f64 = 1600.0;

/// Gathers one layer and paints it.
pub(crate) struct Painter {
    shades: Shades,
    pieces: Vec<Piece>,
    /// Side of a pixel, mm, where the picture does not get too large.
    pixel: f64,
}

/// A picture's pixels as cells, with the piece on top of each, from 1; 0 for none.
struct Cells {
    grid: Grid,
    top: Vec<u32>,
}

impl Painter {
    pub(crate) fn new(shades: Shades, pixel: f64) -> Self {
        Self { shades, pieces: Vec::new(), pixel }
    }

    pub(crate) fn piece(&mut self, piece: &Piece) {
        if piece.layer.is_some() && piece.length() > 0.0 {
            self.pieces.push(*piece);
        }
    }

    /// The pictures of the layer; none where nothing was laid down.
    pub(crate) fn finish(
        &mut self,
        layer: u32,
        design: Option<(&Reference<'_>, &[Polygon])>,
        (z, thickness): (f64, f64),
    ) -> Result<Vec<Picture>, SimError> {
        let Some(cells) = self.cells(layer, design.map(|d| d.1))? else { return Ok(Vec::new()) };
        let mut pictures = vec![
            self.paint(&cells, layer, PictureKind::Commanded, |piece, _| piece.commanded),
            self.paint(&cells, layer, PictureKind::Deposited, Piece::mixture_at),
        ];
        if let Some((reference, region)) = design {
            let middle = z - 0.5 * thickness;
            let wanted = wanted(&cells.grid, reference, region, middle);
            pictures.insert(0, self.designed(&cells, layer, &wanted));
            pictures.push(self.errors(&cells, layer, &wanted));
        }
        self.pieces.clear();
        Ok(pictures)
    }

    /// Lays the pieces over each other.
    fn cells(&self, layer: u32, region: Option<&[Polygon]>) -> Result<Option<Cells>, SimError> {
        let strokes: Vec<_> = self.pieces.iter().map(|p| Stroke::of(p, true)).collect();
        let mut bounds = Bounds2::EMPTY;
        for stroke in strokes.iter().flatten() {
            bounds = bounds.union(&stroke.bounds());
        }
        for polygon in region.into_iter().flatten() {
            bounds = bounds.union(&polygon.bounds());
        }
        if bounds.is_empty() {
            return Ok(None);
        }
        let pixel = self.pixel.max(bounds.size().max_element() / LONGEST);
        let grid = Grid::over(&bounds.grown(5.0 * pixel), pixel, layer)?;
        let mut top = vec![0; grid.cells()];
        for (number, stroke) in (1..).zip(&strokes) {
            let Some(stroke) = stroke else { continue };
            let (direction, length) = stroke.direction();
            let bounds = stroke.bounds();
            for row in grid.rows(bounds.min.y, bounds.max.y) {
                let y = grid.y(row);
                for (from, to) in
                    [stroke.joint(y), stroke.body(direction, length, y)].into_iter().flatten()
                {
                    let columns = grid.columns(from, to);
                    let start = row * grid.width;
                    top[start + columns.start..start + columns.end].fill(number);
                }
            }
        }
        Ok(Some(Cells { grid, top }))
    }

    /// A picture of a mixture of each piece.
    fn paint(
        &self,
        cells: &Cells,
        layer: u32,
        kind: PictureKind,
        mixture: impl Fn(&Piece, f64) -> Mixture,
    ) -> Picture {
        picture(&cells.grid, layer, kind, |cell, at| match self.piece_at(cells, cell) {
            None => PAPER,
            Some(piece) => self.shades.rgb(&mixture(piece, share(piece, at))),
        })
    }

    fn designed(&self, cells: &Cells, layer: u32, wanted: &[Option<Mixture>]) -> Picture {
        picture(&cells.grid, layer, PictureKind::Designed, |cell, _| {
            wanted[cell].as_ref().map_or(PAPER, |mixture| self.shades.rgb(mixture))
        })
    }

    fn errors(&self, cells: &Cells, layer: u32, wanted: &[Option<Mixture>]) -> Picture {
        picture(&cells.grid, layer, PictureKind::Error, |cell, at| {
            match (&wanted[cell], self.piece_at(cells, cell)) {
                (None, _) => PAPER,
                (Some(_), None) => MISSING,
                (Some(wanted), Some(piece)) => {
                    heat(wanted.distance(&piece.mixture_at(share(piece, at))))
                }
            }
        })
    }

    fn piece_at(&self, cells: &Cells, cell: usize) -> Option<&Piece> {
        self.pieces.get((cells.top[cell] as usize).checked_sub(1)?)
    }
}

/// The share of a piece's length that is next to a place.
fn share(piece: &Piece, at: Point2) -> f64 {
    let (from, along) = (piece.from.truncate(), (piece.to - piece.from).truncate());
    let squared = along.length_squared();
    if squared > 0.0 { ((at - from).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// The colour of an error.
fn heat(error: f64) -> [u8; 3] {
    let (below, above) = HEAT
        .windows(2)
        .map(|w| (w[0], w[1]))
        .find(|(_, above)| error <= above.0)
        .unwrap_or((HEAT[HEAT.len() - 2], HEAT[HEAT.len() - 1]));
    let share = ((error - below.0) / (above.0 - below.0)).clamp(0.0, 1.0);
    std::array::from_fn(|i| (below.1[i] + (above.1[i] - below.1[i]) * share).round() as u8)
}

/// The design's mixtures in the cells inside its outline.
fn wanted(
    grid: &Grid,
    reference: &Reference<'_>,
    region: &[Polygon],
    z: f64,
) -> Vec<Option<Mixture>> {
    let mut wanted = vec![None; grid.cells()];
    let materials = reference.materials.materials().min(MAX_MATERIALS);
    let (mut points, mut values) = (Vec::new(), Vec::new());
    fill_region(grid, region, |row, columns| {
        points.clear();
        let place = |column| Point3::new(grid.x(column), grid.y(row), z) - reference.offset;
        points.extend(columns.clone().map(place));
        values.resize(materials * points.len(), 0.0);
        for (material, out) in values.chunks_mut(points.len()).take(materials).enumerate() {
            reference.materials.fraction(material).eval_into(&points, out);
        }
        for (i, column) in columns.enumerate() {
            let mut weights = [0.0; MAX_MATERIALS];
            for (material, weight) in weights.iter_mut().take(materials).enumerate() {
                *weight = values[material * points.len() + i];
            }
            wanted[row * grid.width + column] = Mixture::from_weights(&weights[..materials]).ok();
        }
    });
    wanted
}

/// Paints every pixel; row 0 of a picture is the greatest y.
fn picture(
    grid: &Grid,
    layer: u32,
    kind: PictureKind,
    color: impl Fn(usize, Point2) -> [u8; 3],
) -> Picture {
    let mut rgb = Vec::with_capacity(3 * grid.cells());
    for row in (0..grid.height).rev() {
        for column in 0..grid.width {
            let at = Point2::new(grid.x(column), grid.y(row));
            rgb.extend(color(row * grid.width + column, at));
        }
    }
    let (width, height) = (grid.width as u32, grid.height as u32);
    Picture { kind, layer: layer.saturating_add(1), width, height, rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_grows_with_the_error() {
        let light = |error| heat(error).map(u32::from).iter().sum::<u32>();
        let errors = [0.0, 0.02, 0.05, 0.1, 0.15, 0.3, 0.5, 0.9, 1.0, 2.0];
        assert!(errors.windows(2).all(|w| light(w[0]) >= light(w[1])));
        assert_eq!((heat(0.0), heat(1.0)), ([250; 3], [0; 3]));
    }
}
