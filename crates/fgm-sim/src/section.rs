//! A bead's width from its section.

use std::f64::consts::FRAC_PI_4;

/// The width of the capsule of a section `area` mm² and a height, mm: the inverse of
/// [`fgm_core::bead::area`]. 0 where either is not above 0.
pub(crate) fn width(area: f64, height: f64) -> f64 {
    if !(area > 0.0 && height > 0.0) {
        return 0.0;
    }
    let round = FRAC_PI_4 * height * height;
    if area < round { area / (FRAC_PI_4 * height) } else { height + (area - round) / height }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::bead;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn inverts_the_section(w in 1e-3..5.0f64, h in 1e-3..2.0f64) {
            prop_assert!((width(bead::area(w, h), h) / w - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn nothing_has_no_width() {
        assert_eq!((width(0.0, 0.2), width(0.1, 0.0), width(f64::NAN, 1.0)), (0.0, 0.0, 0.0));
    }
}
