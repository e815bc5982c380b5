//! The cross-section of a bead: a rectangle with round sides, the capsule of eq. A.1 of the
//! gradient-slicing paper.
//!
//! Lines laid side by side overlap at their round sides. Laid [`spacing`] apart they fill a layer
//! to exactly its volume.

use std::f64::consts::FRAC_PI_4;

/// Area of a bead's cross-section, mm²: `h (w - h) + pi h² / 4`; 0 for a width or height that is
/// not positive.
///
/// Below `w = h` there is no capsule; the section is then the ellipse `pi w h / 4`, which meets
/// the capsule at `w = h`.
///
/// ```
/// assert!((fgm_core::bead::area(0.4, 0.2) - 0.07142) < 1e-5);
/// ```
pub fn area(width: f64, height: f64) -> f64 {
    if !(width > 0.0 && height > 0.0) {
        return 0.0;
    }
    if width < height {
        return FRAC_PI_4 * width * height;
    }
    height * (width - height) + FRAC_PI_4 * height * height
}

/// The width of the bead that has a section of `area` mm² at a height, mm: the inverse of [`area`].
/// 0 where either is not above 0.
pub fn width(area: f64, height: f64) -> f64 {
    if !(area > 0.0 && height > 0.0) {
        return 0.0;
    }
    let round = FRAC_PI_4 * height * height;
    if area < round { area / (FRAC_PI_4 * height) } else { height + (area - round) / height }
}

/// The distance between neighbouring lines that fills a layer to its volume, mm: `A / h`.
pub fn spacing(width: f64, height: f64) -> f64 {
    area(width, height) / height
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn width_inverts_the_section(w in 1e-3..5.0f64, h in 1e-3..2.0f64) {
            prop_assert!((width(area(w, h), h) / w - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn capsule_and_ellipse_meet() {
        assert!((area(0.2, 0.2) - area(0.2 - 1e-12, 0.2)).abs() < 1e-9);
        assert_eq!(area(0.0, 0.2), 0.0);
        assert_eq!(area(f64::NAN, 0.2), 0.0);
        assert_eq!((width(0.0, 0.2), width(0.1, 0.0), width(f64::NAN, 1.0)), (0.0, 0.0, 0.0));
        assert!((spacing(0.4, 0.2) * 0.2 - area(0.4, 0.2)).abs() < 1e-15);
    }
}
