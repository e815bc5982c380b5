//! What there is to print.

use std::sync::Arc;

use fgm_core::{Bounds3, MaterialField, TriangleMesh};

use crate::SharedField;

/// The share of the inside that is filled where neither the design nor anybody else says.
pub const USUAL_DENSITY: f64 = 0.15;

/// The shape of a design.
#[derive(Clone)]
pub enum Geometry {
    /// A solid where the field is not above 0.
    Field(SharedField),
    /// A plain mesh, in its place, to be cut exactly.
    Mesh(Arc<TriangleMesh>),
}

/// A base material.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// How to show it: red, green, blue.
    pub color: Option<[u8; 3]>,
}

/// A shape, and of what it is made at every point.
#[derive(Clone)]
pub struct Design {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub geometry: Geometry,
    /// The base materials, in the order of the fractions.
    pub materials: Vec<Material>,
    /// The volume fractions of the materials.
    pub fractions: Arc<dyn MaterialField + Send + Sync>,
    /// The share of the inside to be filled at each place, 0 to 1, where the design says.
    pub density: Option<SharedField>,
    /// A box around the solid, mm; nothing outside it is looked at.
    pub bounds: Bounds3,
}
