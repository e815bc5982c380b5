//! The palette's boundaries in one layer, as levels of fields.

use fgm_core::{Bounds2, Interval, MaterialField, PlanarField, Point2};
use fgm_palette::{Boundary, Palette};

/// A field of a layer with the levels, rising, at which the palette changes.
pub(crate) struct BoundaryField<'a> {
    pub(crate) field: Box<dyn PlanarField + 'a>,
    pub(crate) levels: Vec<f64>,
}

/// All of them at height `z`: shares of one material, and differences of two.
pub(crate) fn boundary_fields<'a>(
    material: &'a dyn MaterialField,
    palette: &Palette,
    z: f64,
) -> Vec<BoundaryField<'a>> {
    let mut out = Vec::new();
    for index in 0..palette.materials() {
        let levels = palette.levels(index);
        if !levels.is_empty() {
            let field = material.fraction(index).at_z(z);
            out.push(BoundaryField { field, levels: levels.to_vec() });
        }
    }
    for boundary in palette.boundaries() {
        if let Boundary::Difference { a, b, by } = *boundary {
            let (a, b) = (material.fraction(a).at_z(z), material.fraction(b).at_z(z));
            out.push(BoundaryField { field: Box::new(Difference { a, b }), levels: vec![by] });
        }
    }
    out
}

/// How much more there is of one material than of another.
struct Difference<'a> {
    a: Box<dyn PlanarField + 'a>,
    b: Box<dyn PlanarField + 'a>,
}

impl PlanarField for Difference<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.a.eval(p) - self.b.eval(p)
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        self.a.eval_into(points, out);
        let mut other = vec![0.0; points.len()];
        self.b.eval_into(points, &mut other);
        out.iter_mut().zip(other).for_each(|(value, other)| *value -= other);
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        let (a, b) = (self.a.bounds(cell), self.b.bounds(cell));
        Interval::new(a.lo - b.hi, a.hi - b.lo)
    }
}
