//! What the benchmarks measure on: the designs of `designs/` and one layer of them, so that the
//! stages and the whole slices speak of the same parts.

use std::path::{Path, PathBuf};

use fgm::{
    contour::{ContourOptions, isolines, outline},
    core::{Bounds2, Point2, Polygon},
    design::{self, LoadOptions},
    field::{Design, Geometry},
};

/// Layer height and bead width of the paper, mm.
pub const HEIGHT: f64 = 0.2;
/// See [`HEIGHT`].
pub const WIDTH: f64 = 0.4;

/// A design of `designs/` by its name.
pub fn builtin(name: &str) -> Design {
    let path = root().join("designs").join(name).with_extension("vcad");
    design::load(&path, &LoadOptions::default()).expect("a design of this repository").design
}

/// A mesh with fractions, where a folder of real models is at hand: `FGM_MODELS` names it.
pub fn model(file: &str, fraction: &str) -> Option<Design> {
    let path = PathBuf::from(std::env::var_os("FGM_MODELS")?).join(file);
    let options = LoadOptions { fractions: vec![fraction.into()], ..LoadOptions::default() };
    design::load(&path, &options).ok().map(|loaded| loaded.design)
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// A height in the middle of a design, mm.
pub fn middle(design: &Design) -> f64 {
    design.bounds.center().z
}

/// The window that a design's layers are traced in.
pub fn window(design: &Design) -> Bounds2 {
    design.bounds.xy().grown(1.0)
}

/// The outline of a design of a function, at a height.
pub fn layer(design: &Design, z: f64) -> Vec<Polygon> {
    let Geometry::Field(field) = &design.geometry else { return Vec::new() };
    let options = ContourOptions { sharp: true, ..ContourOptions::default() };
    outline(field.at_z(z).as_ref(), &window(design), &options).expect("a good field")
}

/// The levels between `colors` colours.
pub fn levels(colors: usize) -> Vec<f64> {
    (1..colors).map(|i| i as f64 / colors as f64).collect()
}

/// Outline and palette boundaries of a layer, as closed and open lines.
pub fn lines(design: &Design, z: f64, colors: usize, cell: f64) -> Vec<(Vec<Point2>, bool)> {
    let options = ContourOptions { cell, ..ContourOptions::default() };
    let fraction = design.fractions.fraction(0).at_z(z);
    let region = layer(design, z);
    let mut lines: Vec<_> =
        region.iter().flat_map(Polygon::rings).map(|r| (r.points.clone(), true)).collect();
    let found = isolines(fraction.as_ref(), &window(design), &levels(colors), &options);
    for level in found.expect("a good field") {
        lines.extend(level.rings.into_iter().map(|r| (r.points, true)));
        lines.extend(level.lines.into_iter().map(|l| (l.points, false)));
    }
    lines
}
