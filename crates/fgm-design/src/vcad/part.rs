use std::sync::Arc;

use fgm_core::{Bounds3, Point3, TriangleMesh};
use fgm_field::{FieldError, Geometry, MeshDistance, SharedField, Transformed};
use glam::DAffine3;

use super::density::Density;
use super::paint::Paint;
use crate::mesh;

/// A node made: its shape, where it is, and what it is made of.
#[derive(Clone)]
pub(crate) struct Part {
    pub(crate) shape: Shape,
    /// Around the shape; [`everywhere`] where it has no end.
    pub(crate) bounds: Bounds3,
    /// Whether the bounds touch the shape on every side.
    pub(crate) tight: bool,
    pub(crate) paint: Paint,
    /// How densely it is to be filled.
    pub(crate) density: Density,
    /// Empty space: what it is combined with loses this.
    pub(crate) void: bool,
}

/// A shape: a mesh as long as it is combined with nothing, so that it can be cut exactly.
#[derive(Clone)]
pub(crate) enum Shape {
    Field(SharedField),
    Mesh(Arc<TriangleMesh>),
}

impl Shape {
    /// The signed distance.
    pub(crate) fn field(&self) -> Result<SharedField, FieldError> {
        Ok(match self {
            Self::Field(field) => Arc::clone(field),
            Self::Mesh(mesh) => Arc::new(MeshDistance::new(mesh)?),
        })
    }

    pub(crate) fn geometry(self) -> Geometry {
        match self {
            Self::Field(field) => Geometry::Field(field),
            Self::Mesh(mesh) => Geometry::Mesh(mesh),
        }
    }
}

/// The bounds of a shape without an end.
pub(crate) const EVERYWHERE: Bounds3 =
    Bounds3::new(Point3::splat(f64::NEG_INFINITY), Point3::splat(f64::INFINITY));

impl Part {
    /// The part moved, turned and scaled. `by` can be undone.
    pub(crate) fn transformed(self, by: &DAffine3) -> Result<Self, FieldError> {
        let (shape, bounds, tight) = match self.shape {
            Shape::Mesh(mesh) => {
                let mesh = mesh::transformed(&mesh, by);
                let bounds = mesh.bounds();
                (Shape::Mesh(Arc::new(mesh)), bounds, true)
            }
            Shape::Field(field) => {
                let field: SharedField = Arc::new(Transformed::new(field, *by)?);
                let bounds = transformed_bounds(&self.bounds, by);
                (Shape::Field(field), bounds, self.tight && keeps_axes(by))
            }
        };
        let (paint, density) = (self.paint.transformed(by)?, self.density.transformed(by)?);
        Ok(Self { shape, bounds, tight, paint, density, void: self.void })
    }

    /// What is in both bounds; tight only where one of them is the result.
    pub(crate) fn is_empty(&self) -> bool {
        self.bounds.is_empty()
    }
}

/// The box around a box moved.
fn transformed_bounds(bounds: &Bounds3, by: &DAffine3) -> Bounds3 {
    if bounds.is_empty() {
        return Bounds3::EMPTY;
    }
    if !bounds.is_finite() {
        return EVERYWHERE;
    }
    Bounds3::of(bounds.corners().map(|p| by.transform_point3(p)))
}

/// Whether axes stay along axes, so that a tight box is tight after it.
fn keeps_axes(by: &DAffine3) -> bool {
    let m = by.matrix3;
    [m.x_axis, m.y_axis, m.z_axis]
        .iter()
        .all(|axis| axis.to_array().iter().filter(|v| **v != 0.0).count() == 1)
}
