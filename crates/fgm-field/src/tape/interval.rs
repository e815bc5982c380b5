//! Interval arithmetic: ranges that hold every value that the tape computes, rounding included.
//!
//! Rounding to nearest never reverses an order, so that the ends of `+ - * /`, square roots and all
//! that is exact need no widening: for these the ends are computed just as values are. Elementary
//! functions are widened by a few units of the last place. Wherever NaN is possible the answer is
//! [`Interval::EVERYTHING`].

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fgm_core::Interval;

use super::op::{Binary, Unary};
use crate::math;

const EVERYTHING: Interval = Interval::EVERYTHING;
const TRUE_OR_FALSE: Interval = Interval::new(0.0, 1.0);

/// How far an elementary function may be off, relative: several units of the last place.
const SLOP: f64 = 8.0 * f64::EPSILON;

/// The range of a number: everything for NaN.
pub(crate) fn constant(value: f64) -> Interval {
    checked(Interval::point(value))
}

/// The range itself, or everything where it is not one.
#[inline]
pub(crate) fn checked(range: Interval) -> Interval {
    if range.lo <= range.hi { range } else { EVERYTHING }
}

/// A range between two ends that may turn out NaN.
fn between(lo: f64, hi: f64) -> Interval {
    checked(Interval::new(lo, hi))
}

/// A range with room for the errors of an elementary function.
pub(crate) fn widened(range: Interval) -> Interval {
    widened_by(range, SLOP)
}

fn widened_by(range: Interval, slop: f64) -> Interval {
    // An end at 0 is exact, and an infinite one has no room.
    let room = |end: f64| {
        let exact = end == 0.0 || end.is_infinite();
        if exact { 0.0 } else { end.abs() * slop + f64::MIN_POSITIVE }
    };
    Interval::new(range.lo - room(range.lo), range.hi + room(range.hi))
}

/// The range between the results at the ends of a growing function.
fn growing(a: Interval, f: impl Fn(f64) -> f64) -> Interval {
    between(f(a.lo), f(a.hi))
}

/// The same for an elementary function with a known range.
fn growing_within(a: Interval, f: impl Fn(f64) -> f64, range: Interval) -> Interval {
    let wide = widened(growing(a, f));
    checked(Interval::new(wide.lo.max(range.lo), wide.hi.min(range.hi)))
}

#[inline]
fn negated(a: Interval) -> Interval {
    Interval::new(-a.hi, -a.lo)
}

/// The range of sizes.
pub(crate) fn abs(a: Interval) -> Interval {
    if a.lo >= 0.0 {
        a
    } else if a.hi <= 0.0 {
        negated(a)
    } else {
        Interval::new(0.0, a.hi.max(-a.lo))
    }
}

/// The range of an operation on one number.
pub(crate) fn unary(op: Unary, a: Interval) -> Interval {
    if a == EVERYTHING {
        // Possibly NaN: only what is never NaN has a range.
        return if op == Unary::Not { TRUE_OR_FALSE } else { EVERYTHING };
    }
    const REALS: Interval = EVERYTHING;
    const POSITIVE: Interval = Interval::new(0.0, f64::INFINITY);
    let inside = |lo: f64, hi: f64| lo <= a.lo && a.hi <= hi;
    match op {
        Unary::Neg => negated(a),
        Unary::Abs => abs(a),
        Unary::Square => growing(abs(a), |v| v * v),
        Unary::Sqrt if a.lo >= 0.0 => growing(a, f64::sqrt),
        Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc | Unary::Sgn => {
            growing(a, |v| op.apply(v))
        }
        Unary::Frac => fraction(a, 1.0, math::frac),
        Unary::Sin => wave(a, FRAC_PI_2, math::sin_near),
        Unary::Cos => wave(a, 0.0, math::cos_near),
        Unary::Tan => tangent(a),
        Unary::Asin if inside(-1.0, 1.0) => growing_within(a, libm::asin, REALS),
        Unary::Acos if inside(-1.0, 1.0) => widened(between(libm::acos(a.hi), libm::acos(a.lo))),
        Unary::Atan => growing_within(a, math::atan, REALS),
        Unary::Sinh => growing_within(a, libm::sinh, REALS),
        Unary::Cosh => growing_within(abs(a), libm::cosh, Interval::new(1.0 - SLOP, f64::INFINITY)),
        Unary::Tanh => growing_within(a, libm::tanh, REALS),
        Unary::Asinh => growing_within(a, libm::asinh, REALS),
        Unary::Acosh if a.lo >= 1.0 => growing_within(a, libm::acosh, POSITIVE),
        Unary::Atanh if inside(-1.0, 1.0) => growing_within(a, libm::atanh, REALS),
        Unary::Exp => growing_within(a, math::exp, POSITIVE),
        Unary::Expm1 => growing_within(a, libm::expm1, REALS),
        Unary::Log if a.lo >= 0.0 => growing_within(a, libm::log, REALS),
        Unary::Log2 if a.lo >= 0.0 => growing_within(a, libm::log2, REALS),
        Unary::Log10 if a.lo >= 0.0 => growing_within(a, libm::log10, REALS),
        Unary::Log1p if a.lo >= -1.0 => growing_within(a, libm::log1p, REALS),
        Unary::Erf => growing_within(a, libm::erf, REALS),
        Unary::Erfc => widened(between(libm::erfc(a.hi), libm::erfc(a.lo))),
        Unary::Weight if a.lo.is_finite() && a.hi.is_finite() => growing(a, math::weight),
        Unary::Not => truth(!can_be_zero(a), a == Interval::point(0.0)),
        _ => EVERYTHING,
    }
}

/// The range of an operation on two numbers.
#[inline]
pub(crate) fn binary(op: Binary, a: Interval, b: Interval) -> Interval {
    // The usual ones first, and without a call.
    match op {
        Binary::Add => sum(a, b),
        Binary::Sub => sum(a, negated(b)),
        Binary::Mul => product(a, b),
        _ => other_binary(op, a, b),
    }
}

/// The range of an operation on a range and a number.
#[inline]
pub(crate) fn binary_right(op: Binary, a: Interval, value: f64) -> Interval {
    match op {
        Binary::Add => checked(Interval::new(a.lo + value, a.hi + value)),
        Binary::Mul if value >= 0.0 => checked(Interval::new(a.lo * value, a.hi * value)),
        Binary::Mul => checked(Interval::new(a.hi * value, a.lo * value)),
        _ => binary(op, a, constant(value)),
    }
}

fn other_binary(op: Binary, a: Interval, b: Interval) -> Interval {
    match op {
        Binary::Less => truth(a.lo >= b.hi, a.hi < b.lo).unless_unknown(a, b),
        Binary::LessEqual => truth(a.lo > b.hi, a.hi <= b.lo).unless_unknown(a, b),
        Binary::Equal => equal(a, b).unless_unknown(a, b),
        Binary::NotEqual => {
            let equal = equal(a, b).unless_unknown(a, b);
            Interval::new(1.0 - equal.hi, 1.0 - equal.lo)
        }
        Binary::And => truth(
            a == Interval::point(0.0) || b == Interval::point(0.0),
            !can_be_zero(a) && !can_be_zero(b),
        ),
        Binary::Or => truth(
            a == Interval::point(0.0) && b == Interval::point(0.0),
            !can_be_zero(a) || !can_be_zero(b),
        ),
        _ if a == EVERYTHING || b == EVERYTHING => EVERYTHING,
        Binary::Div if !can_be_zero(b) => corners(a, b, |a, b| a / b),
        Binary::Rem if b.lo == b.hi && b.lo != 0.0 => fraction(a, b.lo.abs(), |v| v % b.lo),
        // A negative power of a negative zero may be a negative infinity.
        Binary::Pow if a.lo > 0.0 || (a.lo == 0.0 && b.lo >= 0.0) => powers(a, b),
        Binary::Root if a.lo >= 0.0 && b.lo > 0.0 => widened(corners(a, b, math::root)),
        Binary::Root if b.lo == b.hi && b.lo > 0.0 && b.lo % 2.0 == 1.0 => {
            widened(growing(a, |v| math::root(v, b.lo)))
        }
        Binary::Hypot => {
            let (a, b) = (abs(a), abs(b));
            between(math::hypot(a.lo, b.lo), math::hypot(a.hi, b.hi))
        }
        Binary::Atan2 => angle(a, b),
        Binary::Min => Interval::new(a.lo.min(b.lo), a.hi.min(b.hi)),
        Binary::Max => Interval::new(a.lo.max(b.lo), a.hi.max(b.hi)),
        Binary::Share => share(a, b),
        _ => EVERYTHING,
    }
}

/// The range of `c ? a : b`.
pub(crate) fn select(c: Interval, a: Interval, b: Interval) -> Interval {
    if !can_be_zero(c) {
        a
    } else if c == Interval::point(0.0) {
        b
    } else {
        a.union(&b)
    }
}

/// The range of `a^b` for `a` not negative. A whole power by squaring may be off by half a unit of
/// the last place for each power, up to 64; the ends and a value between them may differ in that.
fn powers(a: Interval, b: Interval) -> Interval {
    widened_by(corners(a, b, math::pow), 80.0 * f64::EPSILON)
}

/// The range of `a^n` by squaring.
pub(crate) fn powi(a: Interval, n: i8) -> Interval {
    if a == EVERYTHING || (n < 0 && can_be_zero(a)) {
        return EVERYTHING;
    }
    let a = if n % 2 == 0 { abs(a) } else { a };
    let (lo, hi) = (math::powi(a.lo, n), math::powi(a.hi, n));
    if n < 0 { between(hi, lo) } else { between(lo, hi) }
}

fn can_be_zero(a: Interval) -> bool {
    a.lo <= 0.0 && 0.0 <= a.hi
}

/// 0 if surely false, 1 if surely true, else either.
fn truth(surely_false: bool, surely_true: bool) -> Interval {
    if surely_true {
        Interval::point(1.0)
    } else if surely_false {
        Interval::point(0.0)
    } else {
        TRUE_OR_FALSE
    }
}

/// For comparisons, of which nothing is known where an operand may be NaN.
trait UnlessUnknown {
    fn unless_unknown(self, a: Interval, b: Interval) -> Self;
}

impl UnlessUnknown for Interval {
    fn unless_unknown(self, a: Interval, b: Interval) -> Self {
        if a == EVERYTHING || b == EVERYTHING { TRUE_OR_FALSE } else { self }
    }
}

fn equal(a: Interval, b: Interval) -> Interval {
    truth(a.hi < b.lo || b.hi < a.lo, a.lo == a.hi && a == b)
}

/// Infinities of opposite signs, whose sum is NaN, leave no end finite: the answer is everything.
#[inline]
fn sum(a: Interval, b: Interval) -> Interval {
    checked(Interval::new(a.lo + b.lo, a.hi + b.hi))
}

#[inline]
fn product(a: Interval, b: Interval) -> Interval {
    let (p, q, r, s) = (a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi);
    // Also NaN for infinities of both signs, which leave no end finite.
    if (p + q + r + s).is_nan() {
        return EVERYTHING;
    }
    let least = |a: f64, b: f64| if a < b { a } else { b };
    let greatest = |a: f64, b: f64| if a > b { a } else { b };
    Interval::new(least(least(p, q), least(r, s)), greatest(greatest(p, q), greatest(r, s)))
}

/// The range between the least and the greatest of the four corners, for a function that only
/// grows or only falls along either axis.
fn corners(a: Interval, b: Interval, f: impl Fn(f64, f64) -> f64) -> Interval {
    let values = [f(a.lo, b.lo), f(a.lo, b.hi), f(a.hi, b.lo), f(a.hi, b.hi)];
    if values.iter().any(|v| v.is_nan()) {
        return EVERYTHING;
    }
    let least = values.iter().fold(f64::INFINITY, |m, v| m.min(*v));
    let greatest = values.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v));
    Interval::new(least, greatest)
}

/// The range of what is left after taking away whole periods towards zero, `f`.
fn fraction(a: Interval, period: f64, f: impl Fn(f64) -> f64) -> Interval {
    let (lo, hi) = (f(a.lo), f(a.hi));
    let periods = |v: f64, left: f64| ((v - left) / period).round();
    let (first, last) = (periods(a.lo, lo), periods(a.hi, hi));
    if first == last && first.abs() < 1e15 {
        return between(lo, hi);
    }
    if !(a.lo.is_finite() && a.hi.is_finite()) {
        return EVERYTHING;
    }
    Interval::new(if a.lo < 0.0 { -period } else { 0.0 }, if a.hi > 0.0 { period } else { 0.0 })
}

/// The range of a sine-like function with a crest at `crest`; `near` is the function for arguments
/// up to [`math::NEAR`].
#[inline]
fn wave(a: Interval, crest: f64, near: impl Fn(f64) -> f64) -> Interval {
    const FULL: Interval = Interval::new(-1.0, 1.0);
    let known = -math::NEAR <= a.lo && a.hi <= math::NEAR;
    if !known || a.hi - a.lo >= TAU {
        return if a.lo.is_infinite() || a.hi.is_infinite() { EVERYTHING } else { FULL };
    }
    // Which turn an end lies in may come out one off next to a crest; the end's own value, widened,
    // is then that of the crest.
    let (first, last) = ((a.lo - crest) * TAU.recip(), (a.hi - crest) * TAU.recip());
    let passes = |from: f64| math::rounded_shift(first - from) != math::rounded_shift(last - from);
    let (lo, hi) = (near(a.lo), near(a.hi));
    let room = |v: f64| v.abs() * SLOP + 1e-18;
    let (least, greatest) = if lo < hi { (lo, hi) } else { (hi, lo) };
    Interval::new(
        if passes(1.0) { -1.0 } else { (least - room(least)).max(-1.0) },
        if passes(0.5) { 1.0 } else { (greatest + room(greatest)).min(1.0) },
    )
}

fn tangent(a: Interval) -> Interval {
    let turn = |v: f64| ((v - FRAC_PI_2) / PI).floor();
    let near_pole = |v: f64| (v.abs() % PI - FRAC_PI_2).abs() < 1e-6;
    let branch = turn(a.lo) == turn(a.hi) && a.width() < PI && a.hi.abs().max(-a.lo) < math::NEAR;
    if branch && !near_pole(a.lo) && !near_pole(a.hi) {
        widened(growing(a, libm::tan))
    } else {
        EVERYTHING
    }
}

/// The range of `atan2(y, x)`: its extremes lie at corners unless the box touches the cut along
/// the negative x axis.
fn angle(y: Interval, x: Interval) -> Interval {
    if can_be_zero(y) && x.lo <= 0.0 {
        let infinite = [y.lo, y.hi, x.lo, x.hi].iter().any(|v| v.is_infinite());
        return if infinite { EVERYTHING } else { Interval::new(-PI, PI) };
    }
    widened(corners(y, x, math::atan2))
}

/// The range of `a / (a + rest)` for weights that are not negative.
fn share(a: Interval, rest: Interval) -> Interval {
    let known = a.lo >= 0.0 && rest.lo >= 0.0 && a.lo + rest.lo > 0.0;
    if !known || !(a.hi + rest.hi).is_finite() {
        return EVERYTHING;
    }
    let lo = a.lo / (a.lo + rest.hi);
    let hi = a.hi / (a.hi + rest.lo);
    Interval::new((lo - lo * SLOP).max(0.0), (hi + hi * SLOP).min(1.0))
}
