//! How densely parts are to be filled.

use std::sync::Arc;

use fgm_core::{Bounds3, Field, Interval, Point3};
use fgm_field::{FieldError, Placed, SharedField, Transformed, USUAL_DENSITY};
use glam::DAffine3;

/// How densely a part is to be filled; a tree, like what it is made of, until the whole design is
/// read: a `density` node speaks for those parts inside it that have none yet.
#[derive(Clone)]
pub(crate) enum Density {
    /// That of the node around, if there is one.
    Inherit,
    /// A share at every point.
    Own(SharedField),
    /// Of a union: that of the part where a point is.
    Regions(Vec<(SharedField, Density)>),
}

impl Density {
    /// Of a union of parts.
    pub(crate) fn of_union(parts: Vec<(SharedField, Self)>) -> Self {
        if parts.iter().all(|(_, density)| matches!(density, Self::Inherit)) {
            return Self::Inherit;
        }
        Self::Regions(parts)
    }

    /// Gives `outer` to what has no density yet.
    pub(crate) fn filled(self, outer: &SharedField) -> Self {
        match self {
            Self::Inherit => Self::Own(Arc::clone(outer)),
            Self::Regions(parts) => Self::Regions(
                parts.into_iter().map(|(shape, density)| (shape, density.filled(outer))).collect(),
            ),
            own @ Self::Own(_) => own,
        }
    }

    /// Moved with the shape. What is inherited stays: its node is outside of the move.
    pub(crate) fn transformed(self, by: &DAffine3) -> Result<Self, FieldError> {
        let moved = |field| Ok(Arc::new(Placed::new(field, *by)?) as SharedField);
        Ok(match self {
            Self::Inherit => Self::Inherit,
            Self::Own(field) => Self::Own(moved(field)?),
            Self::Regions(parts) => Self::Regions(
                parts
                    .into_iter()
                    .map(|(shape, density)| {
                        let shape: SharedField = Arc::new(Transformed::new(shape, *by)?);
                        Ok((shape, density.transformed(by)?))
                    })
                    .collect::<Result<_, FieldError>>()?,
            ),
        })
    }

    /// The field, if any part has a density.
    pub(crate) fn field(self) -> Option<SharedField> {
        match self {
            Self::Inherit => None,
            Self::Own(field) => Some(field),
            Self::Regions(parts) => {
                let value = |density: Self| density.field().unwrap_or_else(|| Arc::new(Usual));
                let parts = parts.into_iter().map(|(shape, density)| (shape, value(density)));
                Some(Arc::new(Nearest { parts: parts.collect() }))
            }
        }
    }
}

/// Of parts without a density, where others have one.
struct Usual;

impl Field for Usual {
    fn eval(&self, _: Point3) -> f64 {
        USUAL_DENSITY
    }

    fn bounds(&self, _: &Bounds3) -> Interval {
        Interval::point(USUAL_DENSITY)
    }

    fn varies_with_z(&self) -> bool {
        false
    }
}

/// The value of the part that a point is in: the one whose distance is least.
struct Nearest {
    parts: Vec<(SharedField, SharedField)>,
}

impl Field for Nearest {
    fn eval(&self, p: Point3) -> f64 {
        let distances = self.parts.iter().map(|(shape, value)| (shape.eval(p), value));
        let least = distances.filter(|(distance, _)| !distance.is_nan());
        let least = least.min_by(|a, b| a.0.total_cmp(&b.0));
        least.map_or(f64::NAN, |(_, value)| value.eval(p))
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let all = self.parts.iter().map(|(_, value)| value.bounds(cell));
        let wider = |a: Interval, b: Interval| Interval::new(a.lo.min(b.lo), a.hi.max(b.hi));
        all.reduce(wider).unwrap_or(Interval::EVERYTHING)
    }
}
