//! Materials blurred.

use std::sync::Arc;

use fgm_core::{
    Bounds3, Field, Interval, MAX_MATERIALS, MaterialError, MaterialField, Mixture, Point3,
};

use super::{FractionOf, SharedMaterial, field_at};
use crate::FieldError;

/// A material blurred: at every point the weighted mean of the mixtures at points around it.
///
/// Near the surface this reads the material beyond it; there is no valid mixture where there is none
/// at one of the points.
pub struct Convolved {
    material: SharedMaterial,
    kernel: Arc<Kernel>,
    fractions: Vec<Blurred>,
}

/// Offsets with their shares, which sum to 1.
struct Kernel {
    samples: Vec<(Point3, f64)>,
    /// Around all offsets.
    reach: Bounds3,
}

impl Convolved {
    /// The most samples of a kernel.
    pub const MAX_SAMPLES: usize = 1 << 15;

    /// The material under a kernel of offsets, mm, with weights. The weights need not sum to 1.
    ///
    /// # Errors
    /// [`FieldError::KernelSize`] for no samples or more than [`MAX_SAMPLES`](Self::MAX_SAMPLES);
    /// [`FieldError::KernelWeight`] for a weight that is negative or not finite, an offset that is
    /// not finite, or weights that are all 0.
    pub fn new(material: SharedMaterial, samples: Vec<(Point3, f64)>) -> Result<Self, FieldError> {
        let (count, limit) = (samples.len(), Self::MAX_SAMPLES);
        if !(1..=limit).contains(&count) {
            return Err(FieldError::KernelSize { count, limit });
        }
        let bad = |(offset, weight): &(Point3, f64)| {
            !(offset.is_finite() && weight.is_finite() && *weight >= 0.0)
        };
        let sum: f64 = samples.iter().map(|s| s.1).sum();
        let all_zero = (!(sum > 0.0 && sum.is_finite())).then_some(0);
        if let Some(sample) = samples.iter().position(bad).or(all_zero) {
            return Err(FieldError::KernelWeight { sample, weight: samples[sample].1 });
        }
        // What has no weight needs no evaluation.
        let samples: Vec<_> = samples
            .into_iter()
            .filter(|s| s.1 > 0.0)
            .map(|(offset, weight)| (offset, weight / sum))
            .collect();
        let reach = Bounds3::of(samples.iter().map(|s| s.0));
        let kernel = Arc::new(Kernel { samples, reach });
        let fractions = FractionOf::all(&material)
            .map(|fraction| Blurred { fraction, kernel: Arc::clone(&kernel) })
            .collect();
        Ok(Self { material, kernel, fractions })
    }

    /// The mean over a box of `counts` cells of side `cell`, mm, around each point, sampled at the
    /// middle of every cell.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn boxed(
        material: SharedMaterial,
        counts: [usize; 3],
        cell: Point3,
    ) -> Result<Self, FieldError> {
        let count = counts.iter().fold(1usize, |n, c| n.saturating_mul(*c));
        if count > Self::MAX_SAMPLES {
            return Err(FieldError::KernelSize { count, limit: Self::MAX_SAMPLES });
        }
        let [nx, ny, nz] = counts;
        let at = |i: usize, n: usize| i as f64 - 0.5 * (n as f64 - 1.0);
        let sample = |i: usize| {
            let (ix, iy, iz) = (i % nx, i / nx % ny, i / (nx * ny));
            (Point3::new(at(ix, nx), at(iy, ny), at(iz, nz)) * cell, 1.0)
        };
        Self::new(material, (0..count).map(sample).collect())
    }
}

impl MaterialField for Convolved {
    fn materials(&self) -> usize {
        self.fractions.len()
    }

    fn mixture(&self, p: Point3) -> Result<Mixture, MaterialError> {
        let mut mean = [0.0; MAX_MATERIALS];
        for &(offset, share) in &self.kernel.samples {
            let mixture = self.material.mixture(p + offset)?;
            mean.iter_mut().zip(mixture.fractions()).for_each(|(m, f)| *m += share * f);
        }
        let mean = mean.get(..self.materials()).unwrap_or(&mean);
        Mixture::from_weights(mean).map_err(|reason| MaterialError { at: p, reason })
    }

    fn fraction(&self, material: usize) -> &dyn Field {
        field_at(&self.fractions, material)
    }
}

/// One fraction of a blurred material.
struct Blurred {
    fraction: FractionOf,
    kernel: Arc<Kernel>,
}

const CHUNK: usize = crate::sampled::CHUNK;

impl Field for Blurred {
    fn eval(&self, p: Point3) -> f64 {
        let field = self.fraction.field();
        let parts =
            self.kernel.samples.iter().map(|&(offset, share)| share * field.eval(p + offset));
        parts.fold(0.0, |sum, part| sum + part)
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        let field = self.fraction.field();
        let mut moved = [Point3::ZERO; CHUNK];
        let mut values = [0.0; CHUNK];
        out.fill(0.0);
        for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
            let values = &mut values[..points.len()];
            for &(offset, share) in &self.kernel.samples {
                moved.iter_mut().zip(points).for_each(|(m, p)| *m = *p + offset);
                field.eval_into(&moved[..points.len()], values);
                out.iter_mut().zip(&*values).for_each(|(o, v)| *o += share * v);
            }
        }
    }

    /// A mean lies within the range over the cell grown by the kernel.
    fn bounds(&self, cell: &Bounds3) -> Interval {
        let reach = self.kernel.reach;
        let grown = Bounds3::new(cell.min + reach.min, cell.max + reach.max);
        let range = self.fraction.field().bounds(&grown);
        if range == Interval::EVERYTHING {
            return range;
        }
        // The shares' sum is 1 but for rounding.
        let room = self.kernel.samples.len() as f64 * f64::EPSILON;
        Interval::new(range.lo - room, range.hi + room)
    }
}
