//! Materials moved, turned and scaled.

use std::sync::Arc;

use fgm_core::{Field, MaterialError, MaterialField, Mixture, Point3};
use glam::DAffine3;

use super::{FractionOf, SharedMaterial, field_at};
use crate::solid::Placed;
use crate::solid::transform::Frame;
use crate::{FieldError, SharedField};

/// A material under an affine map of space: what is at a point of the design moves with it.
pub struct PlacedMaterial {
    material: SharedMaterial,
    frame: Frame,
    fractions: Vec<Placed>,
}

impl PlacedMaterial {
    /// The material as `affine` maps it.
    ///
    /// # Errors
    /// [`FieldError::SingularTransform`] where `affine` cannot be undone.
    pub fn new(material: SharedMaterial, affine: DAffine3) -> Result<Self, FieldError> {
        let frame = Frame::new(affine)?;
        let place = |fraction: FractionOf| {
            let field: SharedField = Arc::new(fraction);
            Placed::new(field, affine)
        };
        let fractions = FractionOf::all(&material).map(place).collect::<Result<_, _>>()?;
        Ok(Self { material, frame, fractions })
    }
}

impl MaterialField for PlacedMaterial {
    fn materials(&self) -> usize {
        self.fractions.len()
    }

    fn mixture(&self, p: Point3) -> Result<Mixture, MaterialError> {
        let mixture = self.material.mixture(self.frame.local(p));
        mixture.map_err(|error| MaterialError { at: p, ..error })
    }

    fn fraction(&self, material: usize) -> &dyn Field {
        field_at(&self.fractions, material)
    }
}
