//! Numbers with a fixed count of decimals, rounded correctly and printed fast.

use crate::GcodeError;

/// A number kept as a whole count of `10^-D`: the resolution it is printed at.
///
/// ```
/// use fgm_gcode::Fixed;
/// let x = Fixed::<3>::round(12.34567)?;
/// assert_eq!((x.to_string(), x.units()), ("12.346".to_owned(), 12346));
/// assert!(Fixed::<3>::round(f64::NAN).is_err());
/// # Ok::<(), fgm_gcode::GcodeError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fixed<const D: u32>(i64);

/// Above this a double has no digit left after the point at any resolution used here.
const LIMIT: f64 = 4_503_599_627_370_496.0; // 2^52

const PAIRS: [u8; 200] = pairs();

/// "00" "01" .. "99".
const fn pairs() -> [u8; 200] {
    let mut table = [0; 200];
    let mut i = 0;
    while i < 100 {
        table[2 * i] = b'0' + (i / 10) as u8;
        table[2 * i + 1] = b'0' + (i % 10) as u8;
        i += 1;
    }
    table
}

impl<const D: u32> Fixed<D> {
    const SCALE: u64 = 10_u64.pow(D);

    /// The nearest number of the resolution; of two equally near ones the even one, exactly as
    /// `format!("{:.D$}")` rounds.
    ///
    /// # Errors
    /// [`GcodeError::NotANumber`] for NaN and infinities, and for magnitudes of `2^52` units and
    /// above, which no machine has a use for.
    #[inline]
    pub fn round(value: f64) -> Result<Self, GcodeError> {
        let scale = Self::SCALE as f64;
        let scaled = value * scale;
        if scaled.is_nan() || scaled.abs() >= LIMIT {
            return Err(GcodeError::NotANumber { value });
        }
        let magnitude = scaled.abs();
        let whole = magnitude as i64;
        let rest = magnitude - whole as f64;
        let up = if rest == 0.5 {
            // A tie may come from rounding the product: its exact error decides.
            let error = value.abs().mul_add(scale, -magnitude);
            error > 0.0 || (error == 0.0 && whole & 1 == 1)
        } else {
            rest > 0.5
        };
        let units = whole + i64::from(up);
        Ok(Self(if scaled < 0.0 { -units } else { units }))
    }

    /// From a count of `10^-D`.
    pub const fn from_units(units: i64) -> Self {
        Self(units)
    }

    /// The count of `10^-D`.
    pub const fn units(self) -> i64 {
        self.0
    }

    /// As a double.
    pub fn value(self) -> f64 {
        self.0 as f64 / Self::SCALE as f64
    }

    /// Appends the decimal digits: a minus sign where below zero (never for zero itself), at
    /// least one digit before the point and `D` after it.
    #[inline]
    pub fn write(self, out: &mut Vec<u8>) {
        let mut digits = [0_u8; 24];
        let mut at = digits.len();
        let magnitude = self.0.unsigned_abs();
        let (mut whole, mut rest) = (magnitude / Self::SCALE, magnitude % Self::SCALE);
        let mut left = D;
        while left >= 2 {
            at -= 2;
            let pair = 2 * (rest % 100) as usize;
            digits[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
            rest /= 100;
            left -= 2;
        }
        if left == 1 {
            at -= 1;
            digits[at] = b'0' + rest as u8;
        }
        if D > 0 {
            at -= 1;
            digits[at] = b'.';
        }
        while whole >= 100 {
            at -= 2;
            let pair = 2 * (whole % 100) as usize;
            digits[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
            whole /= 100;
        }
        if whole >= 10 {
            at -= 2;
            let pair = 2 * whole as usize;
            digits[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
        } else {
            at -= 1;
            digits[at] = b'0' + whole as u8;
        }
        if self.0 < 0 {
            at -= 1;
            digits[at] = b'-';
        }
        out.extend_from_slice(&digits[at..]);
    }

    /// As [`write`](Self::write), without the zeros that end the decimals.
    pub fn write_trimmed(self, out: &mut Vec<u8>) {
        self.write(out);
        if D > 0 {
            while out.last() == Some(&b'0') {
                out.pop();
            }
            if out.last() == Some(&b'.') {
                out.pop();
            }
        }
    }
}

impl<const D: u32> std::fmt::Display for Fixed<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut digits = Vec::with_capacity(24);
        self.write(&mut digits);
        f.write_str(&String::from_utf8_lossy(&digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check<const D: u32>(value: f64) {
        let expected = format!("{value:.*}", D as usize);
        // A negative number that rounds to zero has no sign here.
        let zero = expected.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
        let expected = if zero { expected.trim_start_matches('-') } else { &expected };
        assert_eq!(Fixed::<D>::round(value).unwrap().to_string(), expected, "{value:?}");
    }

    #[test]
    fn ties_and_near_ties_round_as_the_standard_library_rounds() {
        for value in [0.0, -0.0, 0.5, 1.5, 2.5, 0.0005, 0.0015, 1.0005, 0.125, 0.375, 1e-320] {
            for value in [value, -value, f64::next_up(value), f64::next_down(value)] {
                check::<0>(value);
                check::<1>(value);
                check::<2>(value);
                check::<3>(value);
                check::<5>(value);
            }
        }
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e14] {
            assert!(
                matches!(Fixed::<3>::round(value), Err(GcodeError::NotANumber { .. })),
                "{value}"
            );
        }
    }

    #[test]
    fn trimmed() {
        for (value, text) in [(0.2, "0.2"), (10.0, "10"), (0.0, "0"), (-0.25, "-0.25")] {
            let mut out = Vec::new();
            Fixed::<4>::round(value).unwrap().write_trimmed(&mut out);
            assert_eq!(out, text.as_bytes());
        }
    }

    proptest! {
        #[test]
        fn any_number_rounds_correctly(value in -1e6..1e6f64, units in -9_999_999i64..9_999_999) {
            check::<3>(value);
            check::<5>(value);
            check::<3>(units as f64 / 1000.0);
            // Halfway between two printed numbers, as near as a double can be.
            check::<3>((units as f64 + 0.5) / 1000.0);
            check::<5>((units as f64 + 0.5) / 100_000.0);
        }

        #[test]
        fn units_come_back(units in -1_000_000_000i64..1_000_000_000) {
            let fixed = Fixed::<5>::from_units(units);
            prop_assert_eq!(Fixed::<5>::round(fixed.value()).unwrap(), fixed);
        }
    }
}
