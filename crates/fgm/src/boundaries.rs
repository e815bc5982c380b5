//! The palette's bands and boundaries in a design, with the overlap of a zipper: a share of the
//! gradient, the palette's own, or a length along it, measured where it is.

use fgm_core::{
    Band, Bounds2, Interval, MaterialError, MaterialField, PlanarField, Point2, Point3,
};
use fgm_palette::{Boundary, Measure, Palette};

use crate::choice::Zipper;

/// Step of the differences that measure a gradient, mm.
const STEP: f64 = 1e-3;

/// A field of a layer with the levels, rising, at which the palette changes.
pub(crate) struct BoundaryField<'a> {
    pub(crate) field: Box<dyn PlanarField + 'a>,
    pub(crate) levels: Vec<f64>,
}

/// The bands of a palette in a material.
#[derive(Clone, Copy)]
pub(crate) struct Bands<'a> {
    pub(crate) material: &'a dyn MaterialField,
    pub(crate) palette: &'a Palette,
    /// Half of how far neighbours overlap along the gradient, mm; 0 where the palette says how far.
    half: f64,
}

impl<'a> Bands<'a> {
    pub(crate) fn new(
        material: &'a dyn MaterialField,
        palette: &'a Palette,
        zipper: Zipper,
    ) -> Self {
        let half = match zipper {
            Zipper::Length(length) => 0.5 * length,
            Zipper::Share(_) => 0.0,
        };
        Self { material, palette, half }
    }

    /// The most by which a fraction in an overlap may be beyond the boundary.
    pub(crate) fn reach(&self) -> f64 {
        if self.half > 0.0 {
            self.palette.widest(Measure::Fraction { material: 0 })
        } else {
            self.palette.overlap()
        }
    }

    /// The band of a place.
    pub(crate) fn at(&self, p: Point3) -> Result<Band, MaterialError> {
        let mixture = self.material.mixture(p)?;
        if self.half <= 0.0 {
            return Ok(self.palette.band(&mixture));
        }
        let fraction = |i: usize, at: Point2| self.material.fraction(i).eval(at.extend(p.z));
        let half = |measure| {
            let at = p.truncate();
            let slope = match measure {
                Measure::Fraction { material } => ahead(|at| fraction(material, at), at).1,
                Measure::Difference { a, b } => ahead(|at| fraction(a, at) - fraction(b, at), at).1,
            };
            // Where the slope is not known nothing overlaps.
            if slope.is_finite() { self.half * slope } else { 0.0 }
        };
        Ok(self.palette.band_within(&mixture, half))
    }

    /// All boundaries at height `z`: shares of one material, and differences of two.
    pub(crate) fn boundary_fields(&self, z: f64) -> Vec<BoundaryField<'a>> {
        let Self { material, palette, .. } = *self;
        let mut out = Vec::new();
        for index in 0..palette.materials() {
            let levels = palette.levels(index);
            if !levels.is_empty() {
                let field = || material.fraction(index).at_z(z);
                self.push(&field, levels, Measure::Fraction { material: index }, &mut out);
            }
        }
        for boundary in palette.boundaries() {
            if let Boundary::Difference { a, b, by } = *boundary {
                let field = || -> Box<dyn PlanarField + 'a> {
                    let (a, b) = (material.fraction(a).at_z(z), material.fraction(b).at_z(z));
                    Box::new(Difference { a, b })
                };
                self.push(&field, &[by], Measure::Difference { a, b }, &mut out);
            }
        }
        out
    }

    /// The levels of a field, or where they lie on either side of an overlap.
    fn push(
        &self,
        field: &dyn Fn() -> Box<dyn PlanarField + 'a>,
        levels: &[f64],
        measure: Measure,
        out: &mut Vec<BoundaryField<'a>>,
    ) {
        let levels = levels.to_vec();
        if self.half <= 0.0 {
            out.push(BoundaryField { field: field(), levels });
            return;
        }
        let widest = self.palette.widest(measure);
        out.extend([self.half, -self.half].map(|half| BoundaryField {
            field: Box::new(Shifted { field: field(), half, widest }),
            levels: levels.clone(),
        }));
    }
}

/// A field at a place, and how steep it is there, from a step each along x and y.
fn ahead(field: impl Fn(Point2) -> f64, p: Point2) -> (f64, f64) {
    value_and_slope([p, p + Point2::X * STEP, p + Point2::Y * STEP].map(field))
}

fn value_and_slope([value, x, y]: [f64; 3]) -> (f64, f64) {
    (value, (x - value).hypot(y - value) / STEP)
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

/// A field whose levels are moved along its gradient: up it by `half` mm, down it where that is
/// negative, but by no more of its value than `widest`.
struct Shifted<'a> {
    field: Box<dyn PlanarField + 'a>,
    half: f64,
    widest: f64,
}

impl Shifted<'_> {
    fn shifted(&self, (value, slope): (f64, f64)) -> f64 {
        if !slope.is_finite() {
            return value;
        }
        value - (self.half * slope).clamp(-self.widest, self.widest)
    }
}

impl PlanarField for Shifted<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.shifted(ahead(|at| self.field.eval(at), p))
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        let steps = [Point2::X * STEP, Point2::Y * STEP];
        let all: Vec<Point2> =
            points.iter().flat_map(|&p| [p, p + steps[0], p + steps[1]]).collect();
        let mut values = vec![0.0; all.len()];
        self.field.eval_into(&all, &mut values);
        for (out, v) in out.iter_mut().zip(values.chunks_exact(3)) {
            *out = self.shifted(value_and_slope([v[0], v[1], v[2]]));
        }
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        let of = self.field.bounds(cell);
        if self.half > 0.0 {
            Interval::new(of.lo - self.widest, of.hi)
        } else {
            Interval::new(of.lo, of.hi + self.widest)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where along x from 0 to 40 the colours of a zipper overlap, mm.
    fn overlaps(fraction: &str, colors: usize, zipper: f64) -> Vec<(f64, f64)> {
        let source = format!(
            "fgrade([\"{fraction}\", \"1 - ({fraction})\"], [\"a\", \"b\"]) {{ cube(90); }}"
        );
        let loaded = fgm_design::parse_vcad(&source, ".".as_ref(), &Default::default()).unwrap();
        let palette = Palette::new(2, colors).unwrap();
        let material = loaded.design.fractions.as_ref();
        let bands = Bands::new(material, &palette, Zipper::Length(zipper));
        let line = [Point2::ZERO, Point2::new(40.0, 0.0)];
        let mut cuts = vec![0.0, 1.0];
        for BoundaryField { field, levels } in bands.boundary_fields(0.0) {
            let mut found = Vec::new();
            fgm_contour::Crossings::new(0.1, 1e-9).find(field.as_ref(), &line, &levels, &mut found);
            cuts.extend(found.iter().map(|crossing| crossing.at));
        }
        cuts.sort_by(f64::total_cmp);
        let place = |at: f64| (at * 4e4).round() / 1e3;
        let between = |w: &&[f64]| {
            let middle = Point3::new(20.0 * (w[0] + w[1]), 0.0, 0.0);
            !bands.at(middle).unwrap().is_pure()
        };
        cuts.windows(2).filter(between).map(|w| (place(w[0]), place(w[1]))).collect()
    }

    #[test]
    fn an_overlap_in_mm_is_as_wide_whatever_the_slope() {
        assert_eq!(overlaps("x/40", 4, 3.0), [(8.5, 11.5), (18.5, 21.5), (28.5, 31.5)]);
        // Boundaries at 20, 28.284 and 34.641, where the gradient differs by a factor of 1.7.
        for (found, at) in
            overlaps("x*x/1600", 4, 3.0).into_iter().zip([20.0, 28.284_27, 34.641_02])
        {
            let (from, to) = found;
            assert!((to - from - 3.0).abs() < 0.08, "{found:?}");
            assert!((0.5 * (from + to) - at).abs() < 0.12, "{found:?}");
        }
        // No wider than a band, less a fiftieth.
        assert_eq!(overlaps("x/40", 4, 90.0), [(5.1, 14.9), (15.1, 24.9), (25.1, 34.9)]);
        // Half of a band, half of nothing.
        assert_eq!(overlaps("0.3", 2, 3.0), []);
    }

    #[test]
    fn materials_that_are_not_mixed_overlap_by_the_length_too() {
        let source = "fgrade([\"x/40\", \"(1 - x/40)*0.6\", \"(1 - x/40)*0.4\"], [\"a\", \"b\", \"c\"]) { cube(90); }";
        let loaded = fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap();
        let palette = Palette::pure(3).unwrap();
        let bands = Bands::new(loaded.design.fractions.as_ref(), &palette, Zipper::Length(4.0));
        // x/40 = 0.6 (1 - x/40) at 15.
        for (x, pure) in [(12.9, true), (13.1, false), (16.9, false), (17.1, true)] {
            let band = bands.at(Point3::new(x, 0.0, 0.0)).unwrap();
            assert_eq!(band.is_pure(), pure, "{x}: {band:?}");
        }
    }
}
