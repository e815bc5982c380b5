//! Fields moved, turned and scaled.

use fgm_core::{Bounds3, Field, Interval, PlanarField, Point2, Point3, Slice};
use glam::{DAffine3, DMat3};

use crate::sampled::{Layer, Map, MappedLayer};
use crate::{FieldError, SharedField};

/// The way from the world back to a field's own coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    inverse: DAffine3,
    /// Whether the horizontal stays horizontal, so that a layer is one of the field's own layers.
    level: bool,
}

impl Frame {
    pub(crate) fn new(affine: DAffine3) -> Result<Self, FieldError> {
        let determinant = affine.matrix3.determinant();
        let inverse = affine.inverse();
        if determinant == 0.0 || !determinant.is_finite() || !inverse.is_finite() {
            return Err(FieldError::SingularTransform { determinant });
        }
        let level = inverse.x_axis.z == 0.0 && inverse.y_axis.z == 0.0;
        Ok(Self { inverse, level })
    }

    /// Whether the vertical stays vertical.
    pub(crate) fn upright(&self) -> bool {
        self.inverse.z_axis.x == 0.0 && self.inverse.z_axis.y == 0.0
    }

    /// A point in the field's own coordinates.
    pub(crate) fn local(&self, p: Point3) -> Point3 {
        self.inverse.transform_point3(p)
    }

    /// The least box in the field's own coordinates around a box.
    ///
    /// The terms are added in the order in which [`local`](Self::local) adds them: rounding then
    /// leaves no point outside.
    pub(crate) fn local_box(&self, cell: &Bounds3) -> Bounds3 {
        let axes = [self.inverse.x_axis, self.inverse.y_axis, self.inverse.z_axis];
        let ends = |i: usize| {
            let (a, b) = (axes[i] * cell.min[i], axes[i] * cell.max[i]);
            (a.min(b), a.max(b))
        };
        let [(x0, x1), (y0, y1), (z0, z1)] = [ends(0), ends(1), ends(2)];
        let t = self.inverse.translation;
        Bounds3::new(((x0 + y0) + z0) + t, ((x1 + y1) + z1) + t)
    }
}

/// A solid under an affine map of space.
///
/// The value is scaled so that it stays a distance: exactly where all lengths change alike, else by
/// the least factor of any direction, which makes it a lower bound of the distance.
#[derive(Clone)]
pub struct Transformed {
    field: SharedField,
    frame: Frame,
    scale: f64,
}

impl Transformed {
    /// The field as `affine` maps it.
    ///
    /// # Errors
    /// [`FieldError::SingularTransform`] where `affine` cannot be undone.
    pub fn new(field: SharedField, affine: DAffine3) -> Result<Self, FieldError> {
        let frame = Frame::new(affine)?;
        Ok(Self { field, frame, scale: least_stretch(affine.matrix3) })
    }
}

/// A field of any other kind, a volume fraction or a density, under an affine map of space: the
/// values stay as they are.
#[derive(Clone)]
pub struct Placed {
    field: SharedField,
    frame: Frame,
}

impl Placed {
    /// The field as `affine` maps it.
    ///
    /// # Errors
    /// [`FieldError::SingularTransform`] where `affine` cannot be undone.
    pub fn new(field: SharedField, affine: DAffine3) -> Result<Self, FieldError> {
        Ok(Self { field, frame: Frame::new(affine)? })
    }
}

/// The least factor by which a linear map changes a length: its least singular value.
fn least_stretch(m: DMat3) -> f64 {
    let gram = m.transpose() * m;
    let least = least_eigenvalue(gram).max(0.0).sqrt();
    // A rotation changes no length, whatever rounding says.
    if (least - 1.0).abs() < 1e-12 { 1.0 } else { least }
}

/// The least eigenvalue of a symmetric matrix, by Jacobi's rotations.
fn least_eigenvalue(mut m: DMat3) -> f64 {
    for sweep in 0..24 {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][sweep % 3];
        let off = m.col(p)[q];
        if off == 0.0 {
            continue;
        }
        let theta = (m.col(q)[q] - m.col(p)[p]) / (2.0 * off);
        let t = theta.signum() / (theta.abs() + crate::math::hypot(theta, 1.0));
        let cos = 1.0 / crate::math::hypot(t, 1.0);
        let sin = t * cos;
        let mut rotation = DMat3::IDENTITY;
        rotation.col_mut(p)[p] = cos;
        rotation.col_mut(q)[q] = cos;
        rotation.col_mut(p)[q] = -sin;
        rotation.col_mut(q)[p] = sin;
        m = rotation.transpose() * m * rotation;
    }
    m.x_axis.x.min(m.y_axis.y).min(m.z_axis.z)
}

/// By the stretch: lengths of the field's own to lengths in the world.
#[derive(Clone, Copy)]
struct Scale(f64);

impl Map for Scale {
    fn apply(self, value: f64) -> f64 {
        value * self.0
    }

    fn apply_range(self, range: Interval) -> Interval {
        Interval::new(range.lo * self.0, range.hi * self.0)
    }
}

const CHUNK: usize = crate::sampled::CHUNK;

/// The values of `field` at points moved into its own coordinates.
fn values(field: &SharedField, frame: &Frame, points: &[Point3], out: &mut [f64]) {
    let mut local = [Point3::ZERO; CHUNK];
    for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
        local.iter_mut().zip(points).for_each(|(l, p)| *l = frame.local(*p));
        field.eval_into(&local[..points.len()], out);
    }
}

/// A layer of `field`, where its own layers are level too.
fn level<'a>(field: &'a SharedField, frame: &Frame, z: f64) -> Option<Level<'a>> {
    let own_z = frame.local(Point3::new(0.0, 0.0, z)).z;
    frame.level.then(|| Level { layer: field.at_z(own_z), frame: *frame, z })
}

impl Field for Placed {
    fn eval(&self, p: Point3) -> f64 {
        self.field.eval(self.frame.local(p))
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        values(&self.field, &self.frame, points, out);
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        self.field.bounds(&self.frame.local_box(cell))
    }

    fn varies_with_z(&self) -> bool {
        !self.frame.upright() || self.field.varies_with_z()
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        match level(&self.field, &self.frame, z) {
            Some(level) => Box::new(level),
            None => Box::new(Slice { field: self, z }),
        }
    }
}

/// A layer of a field whose own layers are level too.
struct Level<'a> {
    layer: Layer<'a>,
    frame: Frame,
    z: f64,
}

impl PlanarField for Level<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.layer.eval(self.frame.local(p.extend(self.z)).truncate())
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        let mut local = [Point2::ZERO; CHUNK];
        for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
            for (l, p) in local.iter_mut().zip(points) {
                *l = self.frame.local(p.extend(self.z)).truncate();
            }
            self.layer.eval_into(&local[..points.len()], out);
        }
    }

    fn bounds(&self, cell: &fgm_core::Bounds2) -> Interval {
        self.layer.bounds(&self.frame.local_box(&cell.extrude(Interval::point(self.z))).xy())
    }
}

impl Field for Transformed {
    fn eval(&self, p: Point3) -> f64 {
        Scale(self.scale).apply(self.field.eval(self.frame.local(p)))
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        values(&self.field, &self.frame, points, out);
        out.iter_mut().for_each(|v| *v = Scale(self.scale).apply(*v));
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let range = self.field.bounds(&self.frame.local_box(cell));
        Scale(self.scale).apply_range(range)
    }

    fn varies_with_z(&self) -> bool {
        !self.frame.upright() || self.field.varies_with_z()
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        match level(&self.field, &self.frame, z) {
            Some(level) => Box::new(MappedLayer { field: Box::new(level), map: Scale(self.scale) }),
            None => Box::new(Slice { field: self, z }),
        }
    }
}
