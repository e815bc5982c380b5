//! `G2` and `G3`.

use fgm_core::{Point2, Point3};

/// Most chords of an arc.
const MOST: f64 = 4096.0;

/// How an arc is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Center {
    /// `I J`: from the beginning to the centre, mm.
    Offset(Point2),
    /// `R`: the radius, mm; negative for the longer way round.
    Radius(f64),
}

/// Ends of the chords that stay within `tolerance` mm of an arc in the plane, the arc's end
/// included; z changes evenly. None for an arc that there is not.
pub(super) fn chords(
    from: Point3,
    to: Point3,
    center: Center,
    clockwise: bool,
    tolerance: f64,
) -> Option<impl Iterator<Item = Point3>> {
    let (a, b) = (from.truncate(), to.truncate());
    let center = match center {
        Center::Offset(offset) => a + offset,
        Center::Radius(radius) => by_radius(a, b, radius, clockwise)?,
    };
    let (start, end) = (a - center, b - center);
    let radius = start.length();
    if !(radius > 0.0 && radius.is_finite() && end.length() > 0.0) {
        return None;
    }
    let turn = std::f64::consts::TAU;
    let mut angle = start.angle_to(end);
    if clockwise {
        angle = -angle;
    }
    // An arc that ends where it begins goes all the way round.
    if angle <= 1e-12 {
        angle += turn;
    }
    let step = 2.0 * (1.0 - (tolerance / radius).min(1.0)).acos().max(1e-6);
    let count = (angle / step).ceil().clamp(1.0, MOST);
    let angle = if clockwise { -angle } else { angle };
    // The end need not lie on the circle to the last digit: the radius goes there evenly.
    let growth = end.length() - radius;
    Some((1..=count as u32).map(move |i| {
        let share = f64::from(i) / count;
        if share == 1.0 {
            return to;
        }
        let turned = Point2::from_angle(angle * share).rotate(start);
        let plane = center + turned * (1.0 + growth * share / radius);
        plane.extend(from.z + (to.z - from.z) * share)
    }))
}

/// The centre of the arc of a radius.
fn by_radius(a: Point2, b: Point2, radius: f64, clockwise: bool) -> Option<Point2> {
    let chord = b - a;
    let half = 0.5 * chord.length();
    if !(half > 0.0 && radius.abs() >= half * (1.0 - 1e-6)) {
        return None;
    }
    let height = (radius * radius - half * half).max(0.0).sqrt();
    let side = if clockwise == (radius > 0.0) { -1.0 } else { 1.0 };
    Some(a + 0.5 * chord + chord.perp() * (side * height / (2.0 * half)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn length(from: Point3, center: Center, to: Point3, clockwise: bool) -> Option<f64> {
        let mut at = from;
        let mut sum = 0.0;
        for p in chords(from, to, center, clockwise, 1e-4)? {
            sum += at.distance(p);
            at = p;
        }
        assert_eq!(at, to);
        Some(sum)
    }

    #[test]
    fn quarters_halves_and_circles() {
        let p = |x: f64, y: f64| Point3::new(x, y, 0.0);
        let pi = std::f64::consts::PI;
        let by = |x, y| Center::Offset(Point2::new(x, y));
        for (to, center, clockwise, expected) in [
            (p(10.0, 10.0), by(0.0, 10.0), false, Some(5.0 * pi)),
            (p(10.0, 10.0), by(0.0, 10.0), true, Some(15.0 * pi)),
            (p(0.0, 0.0), by(10.0, 0.0), false, Some(20.0 * pi)),
            (p(10.0, 10.0), Center::Radius(10.0), false, Some(5.0 * pi)),
            (p(10.0, 10.0), Center::Radius(10.0), true, Some(5.0 * pi)),
            (p(10.0, 10.0), Center::Radius(-10.0), false, Some(15.0 * pi)),
            (p(20.0, 0.0), Center::Radius(10.0), false, Some(10.0 * pi)),
            (p(30.0, 0.0), Center::Radius(10.0), false, None),
            (p(0.0, 0.0), Center::Radius(10.0), false, None),
            (p(1.0, 0.0), by(0.0, 0.0), false, None),
        ] {
            let found = length(Point3::ZERO, center, to, clockwise);
            let close = match (found, expected) {
                (Some(a), Some(b)) => (a / b - 1.0).abs() < 1e-4,
                (a, b) => a == b,
            };
            assert!(close, "{to} {center:?} {clockwise}: {found:?}");
        }
    }

    proptest! {
        #[test]
        fn chords_stay_within_the_tolerance(
            angle in 0.01..6.2f64, radius in 0.01..200.0f64, clockwise: bool,
        ) {
            let center = Point2::new(3.0, -5.0);
            let from = center + Point2::new(radius, 0.0);
            let signed = if clockwise { -angle } else { angle };
            let to = center + Point2::from_angle(signed) * radius;
            let offset = Center::Offset(center - from);
            let mut at = from;
            for p in chords(from.extend(0.0), to.extend(0.0), offset, clockwise, 0.01).unwrap() {
                let middle = 0.5 * (at + p.truncate());
                prop_assert!((middle.distance(center) - radius).abs() < 0.0101);
                at = p.truncate();
            }
        }
    }
}
