use std::sync::Arc;

use fgm_core::Point3;
use fgm_field::{
    Convolved, FieldError, MaterialRegions, PlacedMaterial, Region, SharedField, SharedMaterial,
    Transformed, VolumeFractions,
};
use glam::DAffine3;

/// What a part is made of.
///
/// Kept as a tree until the whole design is read: an fgrade gives its material to those parts
/// inside it that have none yet.
#[derive(Clone)]
pub(crate) enum Paint {
    /// That of the fgrade around.
    Inherit,
    /// One of the design's materials.
    Pure(usize),
    /// Fractions of all of the design's materials.
    Own(SharedMaterial),
    /// Of a union: that of the part where a point is.
    Regions(Vec<(SharedField, Paint)>),
    /// The average over points at these offsets, with these weights.
    Blended { paint: Box<Paint>, kernel: Vec<(Point3, f64)> },
}

impl Paint {
    /// Of a union of parts. One paint where there is only one.
    pub(crate) fn of_union(parts: Vec<(SharedField, Self)>) -> Self {
        let same = |a: &Self, b: &Self| match (a, b) {
            (Self::Inherit, Self::Inherit) => true,
            (Self::Pure(a), Self::Pure(b)) => a == b,
            _ => false,
        };
        match parts.first() {
            Some((_, first)) if parts.len() == 1 || parts.iter().all(|(_, p)| same(first, p)) => {
                first.clone()
            }
            Some(_) => Self::Regions(parts),
            None => Self::Inherit,
        }
    }

    /// Gives `outer` to what has no material yet.
    pub(crate) fn filled(self, outer: &SharedMaterial) -> Self {
        match self {
            Self::Inherit => Self::Own(Arc::clone(outer)),
            Self::Regions(parts) => Self::Regions(
                parts.into_iter().map(|(shape, paint)| (shape, paint.filled(outer))).collect(),
            ),
            Self::Blended { paint, kernel } => {
                Self::Blended { paint: Box::new(paint.filled(outer)), kernel }
            }
            own @ (Self::Pure(_) | Self::Own(_)) => own,
        }
    }

    /// Moved with the shape. What is inherited stays: its fgrade is outside of the move.
    pub(crate) fn transformed(self, by: &DAffine3) -> Result<Self, FieldError> {
        Ok(match self {
            Self::Own(material) => Self::Own(Arc::new(PlacedMaterial::new(material, *by)?)),
            Self::Regions(parts) => {
                let mut moved = Vec::with_capacity(parts.len());
                for (shape, paint) in parts {
                    let shape: SharedField = Arc::new(Transformed::new(shape, *by)?);
                    moved.push((shape, paint.transformed(by)?));
                }
                Self::Regions(moved)
            }
            Self::Blended { paint, kernel } => Self::Blended {
                paint: Box::new(paint.transformed(by)?),
                kernel: kernel.into_iter().map(|(p, w)| (by.transform_vector3(p), w)).collect(),
            },
            same @ (Self::Inherit | Self::Pure(_)) => same,
        })
    }

    /// The fractions of `count` materials. Nothing in it is inherited any more.
    pub(crate) fn fractions(self, count: usize) -> Result<SharedMaterial, FieldError> {
        Ok(match self {
            Self::Inherit => Arc::new(VolumeFractions::uniform(count, 0)?),
            Self::Pure(material) => Arc::new(VolumeFractions::uniform(count, material)?),
            Self::Own(material) => material,
            Self::Regions(parts) => {
                let mut regions = Vec::with_capacity(parts.len());
                for (geometry, paint) in parts {
                    regions.push(Region { geometry, fractions: paint.fractions(count)? });
                }
                Arc::new(MaterialRegions::new(regions)?)
            }
            Self::Blended { paint, kernel } => {
                Arc::new(Convolved::new(paint.fractions(count)?, kernel)?)
            }
        })
    }
}
