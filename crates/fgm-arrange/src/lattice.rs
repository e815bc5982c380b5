use crate::ArrangeError;
use fgm_core::Point2;

/// The least and the greatest lattice step, mm.
const STEPS: (f64, f64) = (1e-15, 1e6);

/// The greatest coordinate in lattice steps. Differences then have 41 bits, cross products 83,
/// and the numerator of a rounded crossing 126: exact in `i128`; coordinates and differences are
/// exact in `f64`.
pub(crate) const LIMIT: f64 = (1u64 << 40) as f64;

/// How near (in steps) a point must be to a lattice point to be taken for it when paths and
/// queries are scaled. The product with the scale may miss a lattice point by 2^-12 steps.
const NEAR: f64 = 1e-3;

/// The lattice of points that vertices lie on. Its points are `Point2`s with whole coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    pub(crate) step: f64,
    scale: f64,
    divide: bool,
}

impl Default for Lattice {
    fn default() -> Self {
        Self { step: 1e-6, scale: 1e6, divide: true }
    }
}

impl Lattice {
    pub(crate) fn new(step: f64) -> Result<Self, ArrangeError> {
        if !(STEPS.0..=STEPS.1).contains(&step) {
            return Err(ArrangeError::Lattice { step, least: STEPS.0, greatest: STEPS.1 });
        }
        // 1 / 1e-6 is a whole number: dividing by it gives the nearest decimal, multiplying by
        // 1e-6 would give 12.499999999999998 for 12.5.
        let scale = 1.0 / step;
        Ok(Self { step, scale, divide: scale.fract() == 0.0 })
    }

    /// The greatest coordinate, mm.
    pub(crate) fn limit(&self) -> f64 {
        LIMIT * self.step
    }

    /// The lattice point whose half-open pixel holds `p`.
    #[inline]
    pub(crate) fn snap(&self, p: Point2) -> Point2 {
        Point2::new(round(p.x * self.scale), round(p.y * self.scale))
    }

    /// `p` in lattice steps, not rounded unless a lattice point is as near as makes no difference.
    #[inline]
    pub(crate) fn scaled(&self, p: Point2) -> Point2 {
        let q = p * self.scale;
        let r = Point2::new(round(q.x), round(q.y));
        let near = |q: f64, r: f64| if (q - r).abs() < NEAR { r } else { q };
        Point2::new(near(q.x, r.x), near(q.y, r.y))
    }

    /// Lattice steps to mm.
    #[inline]
    pub(crate) fn unscaled(&self, p: Point2) -> Point2 {
        if self.divide { p / self.scale } else { p * self.step }
    }

    /// Square lattice steps to mm².
    pub(crate) fn area(&self, steps: f64) -> f64 {
        if self.divide { steps / self.scale / self.scale } else { steps * self.step * self.step }
    }
}

/// To the nearest whole number, half up, as pixels are closed below and open above; for numbers
/// below 2^51.
///
/// Adding and taking away 1.5 * 2^52 leaves no room for a fraction. `floor` would be a call where
/// the target has no instruction for it.
#[inline]
pub(crate) fn round(v: f64) -> f64 {
    const SHIFT: f64 = 1.5 * (1u64 << 52) as f64;
    let even = (v + SHIFT) - SHIFT;
    if v - even >= 0.5 { even + 1.0 } else { even }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn useless_steps_are_refused() {
        for step in [0.0, -1e-6, f64::NAN, f64::INFINITY, 1e-300, 1e7] {
            assert!(matches!(Lattice::new(step), Err(ArrangeError::Lattice { .. })), "{step}");
        }
    }

    #[test]
    fn halves_are_rounded_up() {
        for k in [-(1i64 << 40), -3, -2, -1, 0, 1, 2, 3, (1 << 40) - 1] {
            let k = k as f64;
            let cases = [(k, k), (k + 0.5, k + 1.0), (k + 0.25, k), (k + 0.75, k + 1.0)];
            for (v, expected) in cases {
                assert_eq!(round(v), expected, "{v}");
            }
        }
    }

    proptest! {
        #[test]
        fn lattice_points_survive_the_way_there_and_back(
            k in -(1i64 << 40)..=(1i64 << 40),
            step in prop::sample::select(vec![1e-6, 1e-3, 0.25, 3.7e-5, 1e-9, 1.0, 7.0]),
        ) {
            let lattice = Lattice::new(step).unwrap();
            let p = Point2::new(k as f64, -k as f64);
            prop_assert_eq!(lattice.snap(lattice.unscaled(p)), p);
            prop_assert_eq!(lattice.scaled(lattice.unscaled(p)), p);
        }
    }
}
