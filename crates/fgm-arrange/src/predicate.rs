//! Exact answers about points with whole coordinates up to [`crate::lattice::LIMIT`]: first in
//! `f64` with a bound on the error, in `i128` where that does not decide.

use crate::lattice::round;
use fgm_core::Point2;
use robust::{Coord, orient2d};
use std::cmp::Ordering;

/// Relative error of `a * b - c * d` in `f64` for exact factors, with room to spare.
const ERROR: f64 = 4.0 * f64::EPSILON;

#[inline]
fn whole(v: f64) -> i128 {
    i128::from(v as i64)
}

/// The cross product of two lattice vectors.
#[inline]
fn cross_exact(d: Point2, e: Point2) -> i128 {
    whole(d.x) * whole(e.y) - whole(d.y) * whole(e.x)
}

/// The cross product in `f64` and a bound on its error.
#[inline]
pub(crate) fn cross_near(d: Point2, e: Point2) -> (f64, f64) {
    let (l, r) = (d.x * e.y, d.y * e.x);
    (l - r, (l.abs() + r.abs()) * ERROR)
}

/// A number with the sign of the cross product of two lattice vectors: positive where `e` lies to
/// the left of `d`.
#[inline]
pub(crate) fn cross(d: Point2, e: Point2) -> f64 {
    let (det, error) = cross_near(d, e);
    if det.abs() > error { det } else { cross_exact(d, e) as f64 }
}

/// Positive where `c` lies to the left of the line from `a` to `b`; all three on the lattice.
#[inline]
pub(crate) fn orient(a: Point2, b: Point2, c: Point2) -> f64 {
    cross(b - a, c - a)
}

/// Positive where `c` lies to the left of the line from `a` to `b`; the points are any.
#[inline]
pub(crate) fn orient_any(a: Point2, b: Point2, c: Point2) -> f64 {
    let (d, e) = (b - a, c - a);
    let (l, r) = (d.x * e.y, d.y * e.x);
    // Shewchuk's bound for rounded differences, products and difference is 3.33e-16.
    if (l - r).abs() > 4.0e-16 * (l.abs() + r.abs()) {
        return l - r;
    }
    let coord = |p: Point2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Whether `c` lies in the least rectangle around `a` and `b`.
#[inline]
pub(crate) fn in_box(a: Point2, b: Point2, c: Point2) -> bool {
    a.min(b).cmple(c).all() && c.cmple(a.max(b)).all()
}

/// Whether the segment from `a` to `b` passes through the half-open pixel (a unit square, closed
/// left and below) around the lattice point `c`; its ends are lattice points.
///
/// The ends being pixel centres, a segment can touch a pixel without entering it only at a corner,
/// and only the lower left corner belongs to the pixel.
#[inline]
pub(crate) fn passes(a: Point2, b: Point2, c: Point2) -> bool {
    if !in_box(a, b, c) {
        return false;
    }
    let (d, e) = (b - a, c - a);
    let reach = d.x.abs() + d.y.abs();
    let (det, error) = cross_near(d, e);
    if 2.0 * (det.abs() - error) > reach {
        return false;
    }
    if 2.0 * (det.abs() + error) < reach {
        return true;
    }
    let twice = 2 * cross_exact(d, e);
    match twice.abs().cmp(&whole(reach)) {
        Ordering::Less => true,
        Ordering::Greater => false,
        Ordering::Equal => twice - whole(d.x) + whole(d.y) == 0,
    }
}

/// The lattice point whose pixel holds the crossing of two segments that cross properly.
pub(crate) fn crossing(a: Point2, b: Point2, c: Point2, d: Point2) -> Point2 {
    let (u, v, w) = (b - a, d - c, c - a);
    let (den, den_error) = cross_near(u, v);
    let (num, num_error) = cross_near(w, v);
    let t = num / den;
    // First order, doubled: only where `den` is far from 0.
    let error = 2.0 * ((num_error + t.abs() * den_error) / den.abs() + t.abs() * ERROR);
    if den.abs() > 1e6 * den_error {
        let one = |a: f64, u: f64| {
            let x = a + u * t;
            let rounded = round(x);
            let margin = 0.5 - (x - rounded).abs();
            (margin > u.abs() * error + x.abs() * ERROR).then_some(rounded)
        };
        if let (Some(x), Some(y)) = (one(a.x, u.x), one(a.y, u.y)) {
            return Point2::new(x, y);
        }
    }
    let (mut den, mut num) = (cross_exact(u, v), cross_exact(w, v));
    if den < 0 {
        (den, num) = (-den, -num);
    }
    // floor(u num / den + 1/2), half up like `round`.
    let one = |a: f64, u: f64| a + (2 * whole(u) * num + den).div_euclid(2 * den) as f64;
    Point2::new(one(a.x, u.x), one(a.y, u.y))
}

/// The order of two directions by angle, anticlockwise from +x.
pub(crate) fn by_angle(d: Point2, e: Point2) -> Ordering {
    let lower = |d: Point2| d.y < 0.0 || (d.y == 0.0 && d.x < 0.0);
    lower(d).cmp(&lower(e)).then_with(|| 0.0.partial_cmp(&cross(d, e)).unwrap_or(Ordering::Equal))
}

/// The order of lattice points by x, then y.
#[inline]
pub(crate) fn by_place(a: Point2, b: Point2) -> Ordering {
    a.x.total_cmp(&b.x).then_with(|| a.y.total_cmp(&b.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(reach: i64) -> impl Strategy<Value = Point2> {
        (-reach..=reach, -reach..=reach).prop_map(|(x, y)| Point2::new(x as f64, y as f64))
    }

    /// Points of a small and of the greatest range.
    fn points() -> impl Strategy<Value = [Point2; 4]> {
        prop::sample::select(vec![3i64, 40, 1 << 20, 1 << 40])
            .prop_flat_map(|r| [point(r), point(r), point(r), point(r)])
    }

    /// Does the segment pass the pixel? Clipped in rationals: the parameters at which it is inside
    /// each of the four half-planes, open or closed.
    fn passes_slowly(a: Point2, b: Point2, c: Point2) -> bool {
        // lo < t or lo <= t, as fractions with a positive denominator.
        let mut lo = ((0i128, 1i128), true);
        let mut hi = ((1i128, 1i128), true);
        let less = |p: (i128, i128), q: (i128, i128)| (p.0 * q.1).cmp(&(q.0 * p.1));
        for (from, to, at) in [(a.x, b.x, c.x), (a.y, b.y, c.y)] {
            let (start, step) = (2 * (whole(from) - whole(at)), 2 * (whole(to) - whole(from)));
            if step == 0 {
                if !(-1..1).contains(&start) {
                    return false;
                }
                continue;
            }
            let (mut enter, mut leave) = (((-1 - start), step), ((1 - start), step));
            let (mut enter_closed, mut leave_closed) = (true, false);
            if step < 0 {
                enter = (start - 1, -step);
                leave = (start + 1, -step);
                (enter_closed, leave_closed) = (false, true);
            }
            match less(lo.0, enter) {
                Ordering::Less => lo = (enter, enter_closed),
                Ordering::Equal => lo.1 &= enter_closed,
                Ordering::Greater => {}
            }
            match less(leave, hi.0) {
                Ordering::Less => hi = (leave, leave_closed),
                Ordering::Equal => hi.1 &= leave_closed,
                Ordering::Greater => {}
            }
        }
        match less(lo.0, hi.0) {
            Ordering::Less => true,
            Ordering::Equal => lo.1 && hi.1,
            Ordering::Greater => false,
        }
    }

    #[test]
    fn every_small_segment_and_pixel() {
        let side = -3..=3;
        let all: Vec<_> = side
            .clone()
            .flat_map(|x| side.clone().map(move |y| Point2::new(f64::from(x), f64::from(y))))
            .collect();
        for &a in &all {
            for &b in &all {
                if a != b {
                    for &c in &all {
                        assert_eq!(passes(a, b, c), passes_slowly(a, b, c), "{a} {b} {c}");
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn signs_are_exact([a, b, c, _] in points()) {
            prop_assert_eq!(orient(a, b, c).signum(), {
                let s = orient_any(a, b, c);
                if s == 0.0 { orient(a, b, c).signum() } else { s.signum() }
            });
            prop_assert_eq!(orient(a, b, c) == 0.0, orient_any(a, b, c) == 0.0);
        }

        #[test]
        fn both_segments_pass_the_pixel_of_their_crossing([a, b, c, d] in points()) {
            let proper = |a, b, c, d| {
                let (s, t) = (orient(a, b, c), orient(a, b, d));
                s != 0.0 && t != 0.0 && (s > 0.0) != (t > 0.0)
            };
            if proper(a, b, c, d) && proper(c, d, a, b) {
                let p = crossing(a, b, c, d);
                prop_assert!(passes(a, b, p) && passes(c, d, p), "{} {} {} {} -> {}", a, b, c, d, p);
                prop_assert_eq!(p, crossing(d, c, a, b));
            }
        }
    }
}
