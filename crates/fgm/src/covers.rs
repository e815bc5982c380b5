//! What lies above each place of a layer: how deep below a roof it is.

use std::sync::{Arc, Mutex, PoisonError};

use fgm_core::{Bounds2, PlanarField, Point2, Polygon, Ring};
use fgm_field::Design;

use crate::{
    error::SliceError,
    layers::{Layer, Layers},
    outlines::OutlineWindow,
    settings::Settings,
};

/// Side of a cell, in widths of a bead.
const CELL: f64 = 2.0;
/// The most cells.
const MOST_CELLS: f64 = (1 << 20) as f64;

/// The outlines of neighbouring layers as cells, each made once, only so many kept.
pub(crate) struct Covers {
    grid: Grid,
    layers: Layers,
    /// Solid layers under a top.
    skin: usize,
    /// Deeper places count as this deep, mm.
    reach: f64,
    /// Layers above one that are looked at.
    above: usize,
    slots: Vec<Mutex<Option<Covered>>>,
}

/// The index of a layer and the cells that its outline covers, as bits.
type Covered = (usize, Arc<Vec<u64>>);

/// Square cells over a design.
#[derive(Clone, Copy)]
struct Grid {
    min: Point2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Words of 64 cells in a row.
    words: usize,
}

impl Grid {
    fn new(bounds: &Bounds2, cell: f64) -> Self {
        let size = bounds.size();
        let cell = cell.max((size.x * size.y / MOST_CELLS).sqrt());
        let count = |side: f64| ((side / cell).ceil() as usize).max(1);
        let (columns, rows) = (count(size.x), count(size.y));
        Self { min: bounds.min, cell, columns, rows, words: columns.div_ceil(64) }
    }

    /// The cells whose middle is in a region, as bits, row by row.
    fn covered(&self, region: &[Polygon]) -> Vec<u64> {
        let mut crossings: Vec<(usize, f64)> = Vec::new();
        for (a, b) in region.iter().flat_map(Polygon::rings).flat_map(Ring::edges) {
            let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
            let row = |y: f64| (((y - self.min.y) / self.cell - 0.5).ceil().max(0.0)) as usize;
            for row in row(low.y)..row(high.y).min(self.rows) {
                let y = self.min.y + (row as f64 + 0.5) * self.cell;
                let share = (y - low.y) / (high.y - low.y);
                crossings.push((row, low.x + share * (high.x - low.x)));
            }
        }
        crossings.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut bits = vec![0; self.words * self.rows];
        for pair in crossings.chunks_exact(2) {
            let (row, from) = pair[0];
            let column = |x: f64| ((x - self.min.x) / self.cell - 0.5).ceil().max(0.0) as usize;
            for column in column(from)..column(pair[1].1).min(self.columns) {
                bits[row * self.words + column / 64] |= 1 << (column % 64);
            }
        }
        bits
    }

    fn index(&self, p: Point2) -> usize {
        let at = ((p - self.min) / self.cell).max(Point2::ZERO);
        let (column, row) = (at.x as usize, at.y as usize);
        row.min(self.rows - 1) * self.columns + column.min(self.columns - 1)
    }
}

impl Covers {
    /// For layers of which `span` are in use at a time.
    pub(crate) fn new(design: &Design, settings: &Settings, span: usize, layers: Layers) -> Self {
        let (skin, reach) = (settings.skins.top, settings.infill.reach);
        let above = (reach / settings.layer.height).ceil() as usize + skin + 1;
        let grid = Grid::new(&design.bounds.xy(), CELL * settings.layer.bead_width);
        let slots = (0..(span + above).min(layers.count())).map(|_| Mutex::default()).collect();
        Self { grid, layers, skin, reach, above, slots }
    }

    /// How many layers above one are looked at.
    pub(crate) fn layers(&self) -> usize {
        self.above
    }

    fn covered(
        &self,
        outlines: &OutlineWindow<'_>,
        index: usize,
    ) -> Result<Arc<Vec<u64>>, SliceError> {
        let slot = &self.slots[index % self.slots.len()];
        let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((made, bits)) = &*slot
            && *made == index
        {
            return Ok(Arc::clone(bits));
        }
        let outline = outlines.get(&self.layers.get(index))?;
        let bits = Arc::new(self.grid.covered(&outline.region));
        *slot = Some((index, Arc::clone(&bits)));
        Ok(bits)
    }

    /// How far above a layer's top the solid layers of the next roof begin, at every place.
    pub(crate) fn depths(
        &self,
        outlines: &OutlineWindow<'_>,
        layer: &Layer,
    ) -> Result<Depths, SliceError> {
        let Grid { columns, words, .. } = self.grid;
        let mut depth = vec![self.reach; columns * self.grid.rows];
        let mut left = vec![u64::MAX; words * self.grid.rows];
        for above in layer.index + 1..=layer.index + self.above {
            let covered = match above < self.layers.count() {
                true => Some(self.covered(outlines, above)?),
                false => None,
            };
            // The layer below the lowest solid one.
            let last = above.saturating_sub(self.skin + 1).max(layer.index);
            let open = (self.layers.get(last).top - layer.top).min(self.reach);
            for (word, left) in left.iter_mut().enumerate() {
                let mut bare = *left & !covered.as_ref().map_or(0, |bits| bits[word]);
                *left &= !bare;
                while bare != 0 {
                    let column = word % words * 64 + bare.trailing_zeros() as usize;
                    if column < columns {
                        depth[word / words * columns + column] = open;
                    }
                    bare &= bare - 1;
                }
            }
            if covered.is_none() {
                break;
            }
        }
        Ok(Depths { grid: self.grid, depth })
    }
}

/// How far above a layer's top the next roof begins, mm, cell by cell.
pub(crate) struct Depths {
    grid: Grid,
    depth: Vec<f64>,
}

impl PlanarField for Depths {
    fn eval(&self, p: Point2) -> f64 {
        self.depth[self.grid.index(p)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Interval;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        Polygon { outer: Ring::new(points), holes: Vec::new() }
    }

    #[test]
    fn cells_are_covered_as_their_middles_are() {
        let bounds = Bounds2::new(Point2::new(-10.0, -5.0), Point2::new(90.0, 45.0));
        let grid = Grid::new(&bounds, 0.7);
        let mut region = polygon(&[(-8.0, -4.0), (88.0, 3.0), (60.0, 44.0), (2.0, 30.0)]);
        let hole = polygon(&[(20.0, 5.0), (22.0, 20.0), (40.0, 22.0)]);
        region.holes.push(Ring::new(hole.outer.points.iter().rev().copied().collect()));
        let bits = grid.covered(std::slice::from_ref(&region));
        for row in 0..grid.rows {
            for column in 0..grid.columns {
                let at = Point2::new(column as f64 + 0.5, row as f64 + 0.5);
                let p = grid.min + at * grid.cell;
                let bit = bits[row * grid.words + column / 64] >> (column % 64) & 1;
                assert_eq!(bit == 1, region.contains(p), "{p}");
                assert_eq!(grid.index(p), row * grid.columns + column);
            }
        }
    }

    /// A block 10 mm high with a step 4 mm lower on its right.
    #[test]
    fn depths_are_those_below_the_skins() {
        let source = r#"fgrade(["z/10", "1 - z/10"], ["a", "b"]) {
            difference() {
                translate(0, 0, 5) { rectprism(40, 20, 10); }
                translate(15, 0, 10) { rectprism(30, 30, 8); }
            }
        }"#;
        let design =
            fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap().design;
        let mut settings = Settings::default();
        settings.infill.reach = 5.0;
        let outliner = crate::outlines::Outliner::new(&design, settings.outline_options()).unwrap();
        let layers = Layers::new(Interval::new(0.0, 10.0), 0.2, 0.2);
        let covers = Covers::new(&design, &settings, 3, layers);
        let outlines = OutlineWindow::new(&outliner, 60);
        // The left has a roof of 4 layers below 10 mm, the right below 6 mm.
        for (index, left, right) in
            [(0, 5.0, 5.0), (12, 5.0, 2.6), (24, 4.2, 0.2), (25, 4.0, 0.0), (45, 0.0, 0.0)]
        {
            let depths = covers.depths(&outlines, &layers.get(index)).unwrap();
            let found = [-10.0, 10.0].map(|x| depths.eval(Point2::new(x, 0.0)));
            assert!((found[0] - left).abs() < 1e-9, "{index}: {found:?}");
            assert!((found[1] - right).abs() < 1e-9, "{index}: {found:?}");
        }
    }
}
