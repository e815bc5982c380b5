//! Materials that change from one part of a design to the next.

use std::sync::Arc;

use fgm_core::{
    Bounds3, Field, Interval, MaterialError, MaterialField, Mixture, MixtureError, PlanarField,
    Point3,
};

use super::{FractionOf, SharedMaterial, field_at};
use crate::sampled::{CHUNK, Layer, Sampled, layers, planar_by_sampled};
use crate::{FieldError, SharedField};

/// A part of a design and what it is made of.
#[derive(Clone)]
pub struct Region {
    /// Its signed distance, mm.
    pub geometry: SharedField,
    /// Its material.
    pub fractions: SharedMaterial,
}

/// A material made of regions: each point has the mixture of the region whose distance there is
/// least, the first of equal ones.
///
/// There is no valid mixture where no region has a distance, all being NaN.
pub struct MaterialRegions {
    regions: Vec<Region>,
    fractions: Vec<Piecewise<SharedField>>,
}

impl MaterialRegions {
    /// A material of one or more regions.
    ///
    /// # Errors
    /// [`FieldError::NoRegion`] for none; [`FieldError::RegionMaterials`] where they differ in the
    /// number of materials.
    pub fn new(regions: Vec<Region>) -> Result<Self, FieldError> {
        let Some(first) = regions.first() else { return Err(FieldError::NoRegion) };
        let expected = first.fractions.materials();
        for (region, Region { fractions, .. }) in regions.iter().enumerate() {
            let found = fractions.materials();
            if found != expected {
                return Err(FieldError::RegionMaterials { region, expected, found });
            }
        }
        let fraction = |index| Piecewise {
            geometries: regions.iter().map(|r| Arc::clone(&r.geometry)).collect(),
            values: regions
                .iter()
                .map(|r| {
                    let material = Arc::clone(&r.fractions);
                    Arc::new(FractionOf { material, index }) as SharedField
                })
                .collect(),
        };
        Ok(Self { fractions: (0..expected).map(fraction).collect(), regions })
    }
}

impl MaterialField for MaterialRegions {
    fn materials(&self) -> usize {
        self.fractions.len()
    }

    fn mixture(&self, p: Point3) -> Result<Mixture, MaterialError> {
        match nearest(self.regions.iter().map(|r| r.geometry.eval(p))) {
            Some(region) => self.regions[region].fractions.mixture(p),
            None => {
                let reason = MixtureError::NotFinite { material: 0, value: f64::NAN };
                Err(MaterialError { at: p, reason })
            }
        }
    }

    fn fraction(&self, material: usize) -> &dyn Field {
        field_at(&self.fractions, material)
    }
}

/// The index of the least number, the first of equal ones; NaN is never least.
fn nearest(distances: impl Iterator<Item = f64>) -> Option<usize> {
    let mut best = None;
    for (region, distance) in distances.enumerate() {
        let nearer = match best {
            None => !distance.is_nan(),
            Some((_, least)) => distance < least,
        };
        if nearer {
            best = Some((region, distance));
        }
    }
    best.map(|(region, _)| region)
}

/// The value of the field whose geometry is nearest.
struct Piecewise<S> {
    geometries: Vec<S>,
    values: Vec<S>,
}

impl<S: Sampled> Piecewise<S> {
    /// The region of each point of a chunk; `regions.len()` where there is none.
    fn regions(&self, points: &[S::Point], region: &mut [usize]) {
        let mut least = [f64::NAN; CHUNK];
        let mut distances = [0.0; CHUNK];
        let least = &mut least[..points.len()];
        let distances = &mut distances[..points.len()];
        region.fill(self.geometries.len());
        for (index, geometry) in self.geometries.iter().enumerate() {
            geometry.values(points, distances);
            for ((least, region), distance) in least.iter_mut().zip(&mut *region).zip(&*distances) {
                if *distance < *least || (least.is_nan() && !distance.is_nan()) {
                    (*least, *region) = (*distance, index);
                }
            }
        }
    }
}

impl<S: Sampled> Sampled for Piecewise<S> {
    type Point = S::Point;
    type Cell = S::Cell;

    fn value(&self, p: S::Point) -> f64 {
        let region = nearest(self.geometries.iter().map(|g| g.value(p)));
        region.map_or(f64::NAN, |region| self.values[region].value(p))
    }

    fn values(&self, points: &[S::Point], out: &mut [f64]) {
        let mut region = [0; CHUNK];
        let mut gathered = [0.0; CHUNK];
        for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
            let region = &mut region[..points.len()];
            self.regions(points, region);
            // Most chunks lie in one region.
            let first = region[0];
            if region.iter().all(|r| *r == first) {
                match self.values.get(first) {
                    Some(field) => field.values(points, out),
                    None => out.fill(f64::NAN),
                }
                continue;
            }
            out.fill(f64::NAN);
            for (index, field) in self.values.iter().enumerate() {
                let mut own = [points[0]; CHUNK];
                let mut count = 0;
                for (p, _) in points.iter().zip(&*region).filter(|(_, r)| **r == index) {
                    own[count] = *p;
                    count += 1;
                }
                if count == 0 {
                    continue;
                }
                field.values(&own[..count], &mut gathered[..count]);
                let slots = out.iter_mut().zip(&*region).filter(|(_, r)| **r == index);
                slots.zip(&gathered).for_each(|((o, _), v)| *o = *v);
            }
        }
    }

    /// The ranges of all regions that may be the nearest somewhere in the cell, together.
    fn range(&self, cell: &S::Cell) -> Interval {
        // Asked once for each geometry, unless there are very many.
        let mut kept = [Interval::EVERYTHING; 16];
        let mut greatest = f64::INFINITY;
        for (i, geometry) in self.geometries.iter().enumerate() {
            let range = geometry.range(cell);
            greatest = greatest.min(range.hi);
            if let Some(slot) = kept.get_mut(i) {
                *slot = range;
            }
        }
        // Above the least upper end a region is nowhere the nearest. Without one there may be no
        // nearest region at all.
        if greatest == f64::INFINITY {
            return Interval::EVERYTHING;
        }
        let lower_end = |i: usize| match kept.get(i) {
            Some(range) => range.lo,
            None => self.geometries[i].range(cell).lo,
        };
        let near = self.values.iter().enumerate().filter(|(i, _)| lower_end(*i) <= greatest);
        near.map(|(_, value)| value.range(cell))
            .reduce(|a, b| a.union(&b))
            .unwrap_or(Interval::EVERYTHING)
    }
}

planar_by_sampled!(['a] Piecewise<Layer<'a>>);

impl Field for Piecewise<SharedField> {
    fn eval(&self, p: Point3) -> f64 {
        self.value(p)
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        self.values(points, out);
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        self.range(cell)
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        Box::new(Piecewise {
            geometries: layers(&self.geometries, z),
            values: layers(&self.values, z),
        })
    }
}
