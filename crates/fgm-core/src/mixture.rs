/// The most base materials a [`Mixture`] holds: Marlin mixes six, tool changers carry five to
/// eight.
pub const MAX_MATERIALS: usize = 8;

/// Volume fractions of `n` base materials: each in 0..=1, together 1.
#[derive(Clone, Copy, PartialEq)]
pub struct Mixture {
    fractions: [f64; MAX_MATERIALS],
    len: u8,
}

/// Why numbers are not volume fractions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// A mixture needs 1 to [`MAX_MATERIALS`] materials.
    #[error("{count} materials, where 1 to {MAX_MATERIALS} are possible")]
    Count {
        /// How many were given.
        count: usize,
    },
    /// A weight is NaN or infinite.
    #[error("the fraction of material {material} is {value}")]
    NotFinite {
        /// Which, from 0.
        material: usize,
        /// What it is.
        value: f64,
    },
    /// No weight is above zero.
    #[error("all fractions are zero")]
    AllZero,
}

impl Mixture {
    /// Fractions from weights: negative ones become 0, then all are divided by their sum.
    ///
    /// # Errors
    /// [`MixtureError`] for no or too many weights, one that is not finite, or all zero.
    ///
    /// ```
    /// use fgm_core::Mixture;
    /// assert_eq!(Mixture::from_weights(&[3.0, 1.0, -2.0])?.fractions(), [0.75, 0.25, 0.0]);
    /// # Ok::<(), fgm_core::MixtureError>(())
    /// ```
    pub fn from_weights(weights: &[f64]) -> Result<Self, MixtureError> {
        if weights.is_empty() || weights.len() > MAX_MATERIALS {
            return Err(MixtureError::Count { count: weights.len() });
        }
        let mut fractions = [0.0; MAX_MATERIALS];
        for (material, (&value, slot)) in weights.iter().zip(&mut fractions).enumerate() {
            if !value.is_finite() {
                return Err(MixtureError::NotFinite { material, value });
            }
            *slot = value.max(0.0);
        }
        // Scaled by the greatest first, so that neither tiny nor huge weights lose their sum.
        let greatest = fractions.iter().fold(0.0_f64, |a, &b| a.max(b));
        if greatest == 0.0 {
            return Err(MixtureError::AllZero);
        }
        fractions.iter_mut().for_each(|f| *f /= greatest);
        let sum: f64 = fractions.iter().sum();
        fractions.iter_mut().for_each(|f| *f /= sum);
        Ok(Self { fractions, len: weights.len() as u8 })
    }

    /// All of one material out of `count`.
    ///
    /// # Errors
    /// [`MixtureError::Count`] for no or too many materials, [`MixtureError::AllZero`] where
    /// `material` is not one of them.
    pub fn pure(material: usize, count: usize) -> Result<Self, MixtureError> {
        let mut weights = [0.0; MAX_MATERIALS];
        if let Some(weight) = weights.get_mut(material) {
            *weight = 1.0;
        }
        Self::from_weights(weights.get(..count).ok_or(MixtureError::Count { count })?)
    }

    /// The fractions, one a material, in the design's order.
    pub fn fractions(&self) -> &[f64] {
        &self.fractions[..usize::from(self.len)]
    }

    /// How many materials there are.
    pub fn materials(&self) -> usize {
        usize::from(self.len)
    }

    /// The greatest difference of a fraction between the two, 0..=1.
    pub fn distance(&self, other: &Self) -> f64 {
        self.fractions
            .iter()
            .zip(&other.fractions)
            .fold(0.0, |d, (a, b)| f64::max(d, (a - b).abs()))
    }
}

impl std::fmt::Debug for Mixture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.fractions()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bad_weights_are_told_apart() {
        assert_eq!(Mixture::from_weights(&[]), Err(MixtureError::Count { count: 0 }));
        assert_eq!(Mixture::from_weights(&[0.0; 9]), Err(MixtureError::Count { count: 9 }));
        assert_eq!(Mixture::from_weights(&[0.0, -1.0]), Err(MixtureError::AllZero));
        assert!(matches!(
            Mixture::from_weights(&[0.0, f64::NAN]),
            Err(MixtureError::NotFinite { material: 1, .. })
        ));
        assert_eq!(Mixture::pure(3, 2), Err(MixtureError::AllZero));
        assert_eq!(Mixture::pure(0, 9), Err(MixtureError::Count { count: 9 }));
    }

    proptest! {
        #[test]
        fn fractions_sum_to_one(w in prop::collection::vec(-1e300..1e300f64, 1..=MAX_MATERIALS)) {
            if let Ok(m) = Mixture::from_weights(&w) {
                prop_assert!((m.fractions().iter().sum::<f64>() - 1.0).abs() < 1e-12);
                prop_assert!(m.fractions().iter().all(|f| (0.0..=1.0).contains(f)));
            }
        }
    }
}
