use crate::{Bounds2, Bounds3, Interval, Mixture, MixtureError, Point2, Point3};

/// Points evaluated at a time where a default method needs a buffer.
const CHUNK: usize = 128;

/// A number at every point of space: a signed distance (negative inside), a volume fraction, a
/// density.
///
/// One method is required. Override [`eval_into`](Self::eval_into) where many points at a time are
/// cheaper, [`bounds`](Self::bounds) where a range over a box is known (contouring then skips what
/// cannot hold a contour), and [`at_z`](Self::at_z) where a layer is cheaper than the space.
pub trait Field: Sync {
    /// The value at `p`.
    fn eval(&self, p: Point3) -> f64;

    /// The values at many points. Both slices have the same length.
    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        for (p, v) in points.iter().zip(out) {
            *v = self.eval(*p);
        }
    }

    /// A range that holds every value inside the box; need not be tight.
    fn bounds(&self, cell: &Bounds3) -> Interval {
        let _ = cell;
        Interval::EVERYTHING
    }

    /// Whether the value may differ between points above each other; `false` only where it surely
    /// does not, so that what was found in one layer holds in all.
    fn varies_with_z(&self) -> bool {
        true
    }

    /// The field of one layer, at height `z`.
    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        Box::new(Slice { field: self, z })
    }
}

/// A number at every point of a plane.
pub trait PlanarField: Sync {
    /// The value at `p`.
    fn eval(&self, p: Point2) -> f64;

    /// The values at many points. Both slices have the same length.
    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        for (p, v) in points.iter().zip(out) {
            *v = self.eval(*p);
        }
    }

    /// A range that holds every value inside the rectangle; need not be tight.
    fn bounds(&self, cell: &Bounds2) -> Interval {
        let _ = cell;
        Interval::EVERYTHING
    }
}

/// Closures are fields of the plane.
impl<F: Fn(Point2) -> f64 + Sync> PlanarField for F {
    fn eval(&self, p: Point2) -> f64 {
        self(p)
    }
}

/// A [`Field`] at one height, as a [`PlanarField`].
#[derive(Debug)]
pub struct Slice<'a, F: ?Sized> {
    /// The field in space.
    pub field: &'a F,
    /// The height, mm.
    pub z: f64,
}

impl<F: Field + ?Sized> PlanarField for Slice<'_, F> {
    fn eval(&self, p: Point2) -> f64 {
        self.field.eval(p.extend(self.z))
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        let mut lifted = [Point3::ZERO; CHUNK];
        for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
            for (p, q) in points.iter().zip(&mut lifted) {
                *q = p.extend(self.z);
            }
            self.field.eval_into(&lifted[..points.len()], out);
        }
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        self.field.bounds(&cell.extrude(Interval::point(self.z)))
    }
}

/// Volume fractions of two or more base materials at every point of space.
pub trait MaterialField: Sync {
    /// How many materials there are; at least 2, at most [`crate::MAX_MATERIALS`].
    fn materials(&self) -> usize;

    /// The fractions at `p`, which sum to 1.
    ///
    /// # Errors
    /// Where the design has no valid mixture at `p`: all fractions zero, or one NaN.
    fn mixture(&self, p: Point3) -> Result<Mixture, MaterialError>;

    /// The fraction of one material, normalised as in [`mixture`](Self::mixture), as a field.
    ///
    /// Where the mixture is not valid the field is NaN. `material` is below
    /// [`materials`](Self::materials).
    fn fraction(&self, material: usize) -> &dyn Field;
}

/// No valid mixture at a point of a design.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no valid mixture at ({:.4}, {:.4}, {:.4}): {reason}", at.x, at.y, at.z)]
pub struct MaterialError {
    /// Where, mm.
    pub at: Point3,
    /// Why.
    #[source]
    pub reason: MixtureError,
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Plane;
    impl Field for Plane {
        fn eval(&self, p: Point3) -> f64 {
            p.x + 10.0 * p.z
        }
    }

    #[test]
    fn a_slice_evaluates_more_than_a_chunk() {
        let layer = Plane.at_z(2.0);
        let points: Vec<_> = (0..300).map(|i| Point2::new(f64::from(i), 0.0)).collect();
        let mut out = vec![0.0; 300];
        layer.eval_into(&points, &mut out);
        assert!(points.iter().zip(&out).all(|(p, v)| *v == p.x + 20.0));
        assert_eq!(layer.bounds(&Bounds2::EMPTY), Interval::EVERYTHING);
    }
}
