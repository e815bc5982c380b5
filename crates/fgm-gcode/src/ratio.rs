//! Ratios that every firmware takes.

use fgm_core::{MAX_MATERIALS, Mixture};

/// The nearest ratios that are safe on every firmware: together exactly 1 at the resolution of
/// `10^-decimals`, none above 0 and below `least`, not all zero.
///
/// What is below half of `least` becomes 0, what is between becomes `least`; the others are scaled
/// so that the sum stays 1. `least` above `1 / 8` counts as that, and below the resolution as the
/// resolution.
///
/// ```
/// use fgm_core::Mixture;
/// let mixture = Mixture::from_weights(&[0.008, 0.992])?;
/// assert_eq!(fgm_gcode::safe_ratios(&mixture, 0.01, 4).fractions(), [0.01, 0.99]);
/// # Ok::<(), fgm_core::MixtureError>(())
/// ```
pub fn safe_ratios(mixture: &Mixture, least: f64, decimals: u32) -> Mixture {
    let count = mixture.materials();
    let units = 10_u32.pow(decimals.clamp(1, 6)) as f64;
    let highest = (units / MAX_MATERIALS as f64).floor();
    let floor = (least.max(0.0) * units - 1e-9).ceil().min(highest).max(1.0);

    let mut parts = [0.0; MAX_MATERIALS];
    for (part, fraction) in parts.iter_mut().zip(mixture.fractions()) {
        *part = if fraction * units < floor / 2.0 { 0.0 } else { fraction * units };
    }
    // Raising one to the floor lowers the others, which may drop another one below it: each turn
    // settles one at least, so there are never more turns than materials.
    let mut low = [false; MAX_MATERIALS];
    for _ in 0..count {
        let fixed = low.iter().filter(|l| **l).count() as f64 * floor;
        let free: f64 = parts.iter().zip(&low).filter(|(_, l)| !**l).map(|(p, _)| p).sum();
        let scale = if free > 0.0 { (units - fixed) / free } else { 1.0 };
        let mut settled = true;
        for (part, low) in parts.iter_mut().zip(&mut low) {
            if *low || *part == 0.0 {
                continue;
            }
            *part *= scale;
            if *part < floor {
                (*part, *low, settled) = (floor, true, false);
            }
        }
        if settled {
            break;
        }
    }
    // What rounding leaves over goes to the largest, where it matters least and fits always.
    parts.iter_mut().for_each(|p| *p = p.round_ties_even());
    let largest = (0..count).fold(0, |best, i| if parts[i] > parts[best] { i } else { best });
    parts[largest] += units - parts.iter().sum::<f64>();
    Mixture::from_weights(&parts[..count]).unwrap_or(*mixture)
}

/// A ratio as a whole share of `total`, for firmwares that count in integers.
pub(crate) fn share(ratio: f64, total: u32) -> u32 {
    (ratio * f64::from(total)).round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn table() {
        for (weights, expected) in [
            (vec![0.25, 0.75], vec![0.25, 0.75]),
            (vec![1.0, 2.0], vec![0.3333, 0.6667]),
            (vec![0.004, 0.996], vec![0.0, 1.0]),
            (vec![0.006, 0.994], vec![0.01, 0.99]),
            (vec![1.0], vec![1.0]),
            (vec![1.0, 1.0, 1.0], vec![0.3334, 0.3333, 0.3333]),
            (vec![0.006, 0.497, 0.497], vec![0.01, 0.495, 0.495]),
        ] {
            let mixture = Mixture::from_weights(&weights).unwrap();
            let safe = safe_ratios(&mixture, 0.01, 4);
            let close = safe.fractions().iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(close, "{weights:?} -> {safe:?}");
        }
    }

    proptest! {
        #[test]
        fn safe_on_every_firmware(
            weights in prop::collection::vec(
                prop_oneof![Just(0.0), 0.0..0.03f64, 0.0..1.0f64, 1e-9..1e-6f64], 1..=8),
            decimals in 2u32..=5,
            least in prop_oneof![Just(0.0), Just(0.01), 0.0..0.1f64],
        ) {
            let Ok(mixture) = Mixture::from_weights(&weights) else { return Ok(()) };
            let safe = safe_ratios(&mixture, least, decimals);
            let units = 10_f64.powi(decimals as i32);
            let counts: Vec<f64> = safe.fractions().iter().map(|f| f * units).collect();
            prop_assert!(counts.iter().all(|c| (c - c.round()).abs() < 1e-6), "{:?}", counts);
            prop_assert_eq!(counts.iter().map(|c| c.round()).sum::<f64>(), units);
            prop_assert!(safe.fractions().iter().all(|&f| f == 0.0 || f > least - 1e-12), "{:?}", safe);
            // Nothing moves further than the snapping of all the others can move it.
            let moved = least.max(1.0 / units) * mixture.materials() as f64;
            prop_assert!(safe.distance(&mixture) <= moved + 1.0 / units, "{:?} {:?}", mixture, safe);
        }
    }
}
