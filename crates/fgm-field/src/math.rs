//! Elementary functions of the tape.
//!
//! The common ones (sine, cosine, exponential, arctangent) are polynomials or rational functions
//! without branches: loops over them vectorise, and one point at a time they give the very same
//! bits. No fused multiply-add is used for that reason: results depend neither on the machine nor
//! on how many points are asked for at once. The rest come from `libm`.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LOG2_E, PI};

/// Added to a number below 2^51 and taken away again: rounds it to the nearest integer, whose bits
/// are meanwhile the lowest of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// The nearest integer, plus a number that is always the same: enough to tell integers apart.
#[inline(always)]
pub(crate) fn rounded_shift(x: f64) -> f64 {
    x + ROUND
}

/// Up to here the reduction of [`sin_near`] and [`cos_near`] is exact; farther out `libm` serves.
pub(crate) const NEAR: f64 = 1e6;

/// pi/2 in three parts; the first two have 33 bits, so that their products with integers below
/// 2^20 are exact (fdlibm, `e_rem_pio2.c`).
const PIO2: [f64; 3] =
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// The polynomial with these coefficients, highest power first.
#[inline(always)]
fn horner<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    let mut sum = coefficients[0];
    for c in &coefficients[1..] {
        sum = sum * x + c;
    }
    sum
}

/// Sine and cosine for |x| <= pi/4 of `x + tail` (fdlibm, `k_sin.c` and `k_cos.c`; below 1 ulp).
#[inline(always)]
fn sin_cos_kernel(x: f64, tail: f64) -> (f64, f64) {
    let z = x * x;
    let p = horner(
        z,
        [
            1.589_690_995_211_55e-10,
            -2.505_076_025_340_686_3e-8,
            2.755_731_370_707_006_8e-6,
            -0.000_198_412_698_298_579_5,
            0.008_333_333_333_322_49,
        ],
    );
    let cube = z * x;
    let sin = x - ((z * (0.5 * tail - cube * p) - tail) + cube * 0.166_666_666_666_666_32);
    let q = horner(
        z,
        [
            -1.135_964_755_778_819_5e-11,
            2.087_572_321_298_175e-9,
            -2.755_731_435_139_066_3e-7,
            2.480_158_728_947_673e-5,
            -0.001_388_888_888_887_411,
            0.041_666_666_666_666_6,
        ],
    );
    let half = 0.5 * z;
    let w = 1.0 - half;
    let cos = w + (((1.0 - w) - half) + (z * (z * q) - x * tail));
    (sin, cos)
}

/// `sin(x + quarters pi / 2)` for `|x| <= NEAR`.
#[inline(always)]
fn sin_turned(x: f64, quarters: u64) -> f64 {
    let shifted = x * FRAC_2_PI + ROUND;
    let k = shifted - ROUND;
    let t = x - k * PIO2[0];
    let w = k * PIO2[1];
    let r = t - w;
    let rest = k * PIO2[2] - ((t - r) - w);
    let head = r - rest;
    let tail = (r - head) - rest;
    let (sin, cos) = sin_cos_kernel(head, tail);
    let quadrant = shifted.to_bits().wrapping_add(quarters);
    let value = if quadrant & 1 == 0 { sin } else { cos };
    f64::from_bits(value.to_bits() ^ ((quadrant & 2) << 62))
}

/// Sine for `|x| <= NEAR`.
#[inline(always)]
pub(crate) fn sin_near(x: f64) -> f64 {
    sin_turned(x, 0)
}

/// Cosine for `|x| <= NEAR`.
#[inline(always)]
pub(crate) fn cos_near(x: f64) -> f64 {
    sin_turned(x, 1)
}

/// Sine of any number, at most 1 in size.
#[inline(always)]
pub(crate) fn sin(x: f64) -> f64 {
    if x.abs() > NEAR { libm::sin(x) } else { sin_near(x) }
}

/// Cosine of any number, at most 1 in size.
#[inline(always)]
pub(crate) fn cos(x: f64) -> f64 {
    if x.abs() > NEAR { libm::cos(x) } else { cos_near(x) }
}

/// `2^n` for an integer `n` in -1022..=1023.
#[inline(always)]
fn exp2_int(n: f64) -> f64 {
    f64::from_bits((n + (ROUND + 1023.0)).to_bits() << 52)
}

/// The exponential (Cephes, `exp.c`: a rational function after taking out powers of two).
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    // Beyond these the answer is infinite or zero; written so that NaN passes.
    let x = if x > 710.0 { 710.0 } else { x };
    let x = if x < -746.0 { -746.0 } else { x };
    let n = (x * LOG2_E + ROUND) - ROUND;
    let r = (x - n * 0.693_145_751_953_125) - n * 1.428_606_820_309_417_3e-6;
    let z = r * r;
    let p = r * horner(z, [0.000_126_177_193_074_810_58, 0.030_299_440_770_744_195, 1.0]);
    let q = horner(
        z,
        [3.001_985_051_386_644_6e-6, 0.002_524_483_403_496_841, 0.227_265_548_208_155_03, 2.0],
    );
    let value = 1.0 + 2.0 * (p / (q - p));
    // In two steps: 2^n itself may lie outside of the range of normal numbers.
    let half = (n * 0.5 + ROUND) - ROUND;
    (value * exp2_int(half)) * exp2_int(n - half)
}

/// The arctangent of a number in 0..=1 (Cephes, `atan.c`).
#[inline(always)]
fn atan_unit(t: f64) -> f64 {
    let upper = t > 0.66;
    let u = if upper { (t - 1.0) / (t + 1.0) } else { t };
    let z = u * u;
    let p = horner(
        z,
        [
            -0.875_060_860_003_190_4,
            -16.157_537_187_333_652,
            -75.008_557_923_147_05,
            -122.886_668_449_013_61,
            -64.850_219_049_420_25,
        ],
    );
    let q = horner(
        z,
        [
            1.0,
            24.858_464_901_423_062,
            165.027_009_831_698_85,
            432.881_060_491_290_27,
            485.390_399_635_913_7,
            194.550_657_148_261_4,
        ],
    );
    let value = u + u * (z * p / q);
    if upper { FRAC_PI_4 + (value + 0.5 * 6.123_233_995_736_766e-17) } else { value }
}

/// The angle of the point `(x, y)`, in -pi..=pi; 0 or pi in size at the origin, as in IEEE 754.
#[inline(always)]
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    let (a, b) = (y.abs(), x.abs());
    let steep = a > b;
    let (least, greatest) = if steep { (b, a) } else { (a, b) };
    let ratio = least / greatest;
    // Equal infinities lie on the diagonal; the origin on the axis.
    let ratio = if least == greatest { 1.0 } else { ratio };
    let ratio = if a + b == 0.0 { 0.0 } else { ratio };
    let angle = atan_unit(ratio);
    let angle = if steep { (FRAC_PI_2 - angle) + 6.123_233_995_736_766e-17 } else { angle };
    let angle =
        if x.is_sign_negative() { (PI - angle) + 1.224_646_799_147_353_2e-16 } else { angle };
    angle.copysign(y)
}

#[inline(always)]
pub(crate) fn atan(x: f64) -> f64 {
    atan2(x, 1.0)
}

#[inline(always)]
pub(crate) fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// The lesser; NaN where either is.
#[inline(always)]
pub(crate) fn min(a: f64, b: f64) -> f64 {
    if (a < b) | a.is_nan() { a } else { b }
}

/// The greater; NaN where either is.
#[inline(always)]
pub(crate) fn max(a: f64, b: f64) -> f64 {
    if (a > b) | a.is_nan() { a } else { b }
}

/// -1, 0 or 1; NaN of NaN.
#[inline(always)]
pub(crate) fn sgn(x: f64) -> f64 {
    let unit = if x < 0.0 { -1.0 } else { x };
    if x > 0.0 { 1.0 } else { unit }
}

/// What is left of the number towards zero, with its sign.
#[inline(always)]
pub(crate) fn frac(x: f64) -> f64 {
    x - x.trunc()
}

/// The real `n`-th root: of a negative number for odd whole `n` only.
pub(crate) fn root(x: f64, n: f64) -> f64 {
    let odd = n % 2.0 == 1.0 || n % 2.0 == -1.0;
    if n == 2.0 {
        x.sqrt()
    } else if n == 3.0 {
        libm::cbrt(x)
    } else if x < 0.0 && odd {
        -libm::pow(-x, 1.0 / n)
    } else {
        libm::pow(x, 1.0 / n)
    }
}

/// `x^n`: by squaring for small whole powers, wherever they come from.
pub(crate) fn pow(x: f64, n: f64) -> f64 {
    match small_power(n) {
        Some(n) => powi(x, n),
        None => libm::pow(x, n),
    }
}

/// The power as one that [`powi`] takes, if it is whole, small and not 0.
pub(crate) fn small_power(n: f64) -> Option<i8> {
    let small = n == n.trunc() && n != 0.0 && n.abs() <= 64.0;
    small.then_some(n as i8)
}

/// `x^n` by squaring, in the order in which the chunked tape does it.
pub(crate) fn powi(x: f64, n: i8) -> f64 {
    let mut value = x;
    for bit in PowerSteps::of(n) {
        value *= value;
        if bit {
            value *= x;
        }
    }
    if n < 0 { 1.0 / value } else { value }
}

/// The binary digits of a power after its first, highest first: square for each, and multiply where
/// it is one.
pub(crate) struct PowerSteps {
    power: u8,
    left: u32,
}

impl PowerSteps {
    /// For a power that is not 0.
    pub(crate) fn of(n: i8) -> Self {
        let power = n.unsigned_abs();
        Self { power, left: 7u32.saturating_sub(power.leading_zeros()) }
    }
}

impl Iterator for PowerSteps {
    type Item = bool;

    fn next(&mut self) -> Option<bool> {
        self.left = self.left.checked_sub(1)?;
        Some(self.power >> self.left & 1 == 1)
    }
}

/// A volume-fraction weight: 0 for a negative number, NaN for an infinite one.
#[inline(always)]
pub(crate) fn weight(x: f64) -> f64 {
    // NaN for what is not finite, else 0.
    max(x, 0.0) + x * 0.0
}

/// `a / (a + rest)`, the share of one weight; NaN where both are 0.
#[inline(always)]
pub(crate) fn share(a: f64, rest: f64) -> f64 {
    a / (a + rest)
}

/// 1 where the condition holds, else 0.
#[inline(always)]
pub(crate) fn flag(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

/// Degrees to radians and back.
pub(crate) const DEGREE: f64 = PI / 180.0;
/// Radians to degrees.
pub(crate) const RADIAN: f64 = 180.0 * FRAC_1_PI;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(ours: f64, theirs: f64, ulps: f64) -> bool {
        ours == theirs || (ours - theirs).abs() <= ulps * theirs.abs() * f64::EPSILON
    }

    #[test]
    fn exact_at_the_landmarks() {
        assert_eq!(cos(0.0), 1.0);
        assert_eq!(sin(0.0), 0.0);
        assert_eq!(sin(FRAC_PI_2), 1.0);
        assert_eq!(cos(PI), -1.0);
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(atan2(0.0, 1.0), 0.0);
        assert_eq!(atan2(0.0, -1.0), PI);
        assert_eq!(atan2(-0.0, -1.0), -PI);
        assert_eq!(atan2(1.0, 0.0), FRAC_PI_2);
        assert_eq!(atan2(1.0, 1.0), FRAC_PI_4);
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!(exp(800.0), f64::INFINITY);
        assert_eq!(exp(-800.0), 0.0);
        for nan in [sin(f64::NAN), cos(f64::INFINITY), exp(f64::NAN), atan2(f64::NAN, 0.0)] {
            assert!(nan.is_nan());
        }
    }

    #[test]
    fn powers_by_squaring() {
        for n in 1..=64i8 {
            assert!(close(powi(1.3, n), 1.3f64.powi(n.into()), 40.0));
            assert!(close(powi(-1.3, -n), (-1.3f64).powi((-n).into()), 40.0));
        }
    }

    proptest! {
        #[test]
        fn within_two_units_of_the_last_place(x in -1e6..1e6f64, y in -10.0..10.0f64) {
            for x in [x, y, x * 1e-9] {
                prop_assert!(close(sin(x), libm::sin(x), 2.0), "sin {x}");
                prop_assert!(close(cos(x), libm::cos(x), 2.0), "cos {x}");
                prop_assert!(close(atan2(y, x), libm::atan2(y, x), 3.0), "atan2 {y} {x}");
                prop_assert!(close(atan(x), libm::atan(x), 3.0), "atan {x}");
            }
            let e = y * 70.0;
            prop_assert!(close(exp(e), libm::exp(e), 3.0), "exp {e}");
        }

        #[test]
        fn near_multiples_of_a_quarter_turn(k in -600_000i32..600_000, off in -1e-6..1e-6f64) {
            let x = f64::from(k) * FRAC_PI_2 + off;
            prop_assert!(close(sin(x), libm::sin(x), 2.0), "sin {x}");
            prop_assert!(close(cos(x), libm::cos(x), 2.0), "cos {x}");
        }
    }
}
