//! Volume fractions.

mod convolved;
mod fractions;
mod placed;
mod regions;

use std::sync::Arc;

use fgm_core::{Bounds3, Field, Interval, MaterialField, PlanarField, Point3};

pub use convolved::Convolved;
pub use fractions::{FractionMode, VolumeFractions};
pub use placed::PlacedMaterial;
pub use regions::{MaterialRegions, Region};

/// Volume fractions that several owners and threads share.
pub type SharedMaterial = Arc<dyn MaterialField + Send + Sync>;

/// One fraction of a shared material, as a field of its own.
struct FractionOf {
    material: SharedMaterial,
    index: usize,
}

impl FractionOf {
    /// The field of every material.
    fn all(material: &SharedMaterial) -> impl Iterator<Item = Self> + '_ {
        (0..material.materials()).map(|index| Self { material: Arc::clone(material), index })
    }

    fn field(&self) -> &dyn Field {
        self.material.fraction(self.index)
    }
}

impl Field for FractionOf {
    fn eval(&self, p: Point3) -> f64 {
        self.field().eval(p)
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        self.field().eval_into(points, out);
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        self.field().bounds(cell)
    }

    fn varies_with_z(&self) -> bool {
        self.field().varies_with_z()
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        self.field().at_z(z)
    }
}

/// What stands for a material that does not exist.
struct Nowhere;

impl Field for Nowhere {
    fn eval(&self, _: Point3) -> f64 {
        f64::NAN
    }
}

/// The field at `index`, NaN everywhere if there is none.
fn field_at<F: Field>(fields: &[F], index: usize) -> &dyn Field {
    fields.get(index).map_or(&Nowhere, |field| field)
}
