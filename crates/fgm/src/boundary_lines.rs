//! The lines at which the palette changes.

use std::{borrow::Cow, sync::OnceLock};

use fgm_contour::{ContourOptions, isolines};
use fgm_core::{Bounds2, Point2, Polygon, Polyline};
use fgm_field::Design;

use crate::{
    boundaries::{Bands, BoundaryField},
    error::SliceError,
};

/// A line between two colours.
#[derive(Clone, Debug)]
pub(crate) struct BoundaryLine {
    pub(crate) points: Vec<Point2>,
    pub(crate) closed: bool,
    bounds: Bounds2,
}

/// The palette's boundaries in all layers of a design: traced in each, or once where the material
/// is the same at every height.
pub(crate) struct BoundaryLines<'a> {
    bands: Bands<'a>,
    options: ContourOptions,
    /// What the lines of all layers were traced in.
    window: Bounds2,
    /// Those lines, once asked for; none where a layer has to find its own.
    shared: Option<OnceLock<Option<Vec<BoundaryLine>>>>,
}

impl<'a> BoundaryLines<'a> {
    pub(crate) fn new(design: &Design, bands: Bands<'a>, options: ContourOptions) -> Self {
        let material = bands.material;
        let varies = (0..material.materials()).any(|i| material.fraction(i).varies_with_z());
        // The outline of a layer may reach past the design's bounds by a cell or two.
        let window = design.bounds.xy().grown(4.0 * options.cell);
        let shared = (!varies && window.is_finite()).then(OnceLock::new);
        Self { bands, options, window, shared }
    }

    /// Traces the lines that all layers share, if there are any, at the height of one of them: the
    /// first layers would wait for each other.
    pub(crate) fn prepare(&self, z: f64) {
        if let Some(shared) = &self.shared {
            shared.get_or_init(|| self.trace(&self.window, z).ok());
        }
    }

    /// The lines that may meet `region`, a layer's part at height `z`.
    pub(crate) fn in_layer(
        &self,
        region: &[Polygon],
        z: f64,
    ) -> Result<Vec<Cow<'_, BoundaryLine>>, SliceError> {
        let bounds = region.iter().fold(Bounds2::EMPTY, |b, p| b.union(&p.bounds()));
        if bounds.is_empty() {
            return Ok(Vec::new());
        }
        let window = bounds.grown(self.options.cell);
        if let Some(shared) = &self.shared
            && self.window.contains(window.min)
            && self.window.contains(window.max)
            // What goes wrong there is told by the layer, which knows its number.
            && let Some(lines) = shared.get_or_init(|| self.trace(&self.window, z).ok())
        {
            let near = |line: &&BoundaryLine| line.bounds.intersects(&window);
            return Ok(lines.iter().filter(near).map(Cow::Borrowed).collect());
        }
        Ok(self.trace(&window, z)?.into_iter().map(Cow::Owned).collect())
    }

    fn trace(&self, window: &Bounds2, z: f64) -> Result<Vec<BoundaryLine>, SliceError> {
        let mut lines = Vec::new();
        let mut add = |points: Vec<Point2>, closed| {
            let bounds = Bounds2::of(points.iter().copied());
            lines.push(BoundaryLine { points, closed, bounds });
        };
        for BoundaryField { field, levels } in self.bands.boundary_fields(z) {
            for level in isolines(field.as_ref(), window, &levels, &self.options)? {
                level.rings.into_iter().for_each(|ring| add(ring.points, true));
                level.lines.into_iter().for_each(|Polyline { points }| add(points, false));
            }
        }
        Ok(lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(source: &str, region: [f64; 4], z: f64) -> (bool, usize) {
        let loaded = fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap();
        let palette = fgm_palette::Palette::new(2, 4).unwrap();
        let material = loaded.design.fractions.as_ref();
        let bands = Bands::new(material, &palette, crate::Zipper::NONE);
        let lines = BoundaryLines::new(&loaded.design, bands, ContourOptions::default());
        let [x, y, u, v] = region;
        let corners = [(x, y), (u, y), (u, v), (x, v)].map(|(x, y)| Point2::new(x, y));
        let region = [Polygon::simple(fgm_core::Ring::new(corners.into()))];
        let found = lines.in_layer(&region, z).unwrap();
        (found.iter().all(|line| matches!(line, Cow::Borrowed(_))), found.len())
    }

    #[test]
    fn they_are_traced_once_where_all_layers_have_the_same() {
        let cube = |x: &str, y: &str| {
            format!("fgrade([\"{x}\", \"{y}\"], [\"a\", \"b\"]) {{ cube(20); }}")
        };
        let flat = cube("x/20 + 0.5", "0.5 - x/20");
        assert_eq!(lines(&flat, [-10.0, -10.0, 10.0, 10.0], 1.0), (true, 3));
        // Only those that come near.
        assert_eq!(lines(&flat, [2.0, -10.0, 10.0, 10.0], 1.0), (true, 1));
        // A region that reaches out of the design has its own.
        assert_eq!(lines(&flat, [-30.0, -10.0, 10.0, 10.0], 1.0), (false, 3));
        let tilted = cube("(x + z)/20 + 0.5", "0.5 - (x + z)/20");
        assert_eq!(lines(&tilted, [-10.0, -10.0, 10.0, 10.0], 1.0), (false, 3));
        assert_eq!(lines(&tilted, [-10.0, -10.0, 10.0, 10.0], 9.0), (false, 2));
        let moved = format!("translate(0, 0, 5) {{ {flat} }}");
        assert_eq!(lines(&moved, [-10.0, -10.0, 10.0, 10.0], 6.0), (true, 3));
    }
}
