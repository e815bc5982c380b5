use super::*;
use crate::{ClipperInset, Inset, region, region_shapes::*};
use proptest::prelude::*;

fn counts(polygon: &Polygon, radius: f64) -> Option<(usize, usize)> {
    split(polygon, radius).map(|s| (s.thick.len(), s.thin.len()))
}

#[test]
fn necks_are_cut() {
    let dumbbell = simple(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.6),
        (20.0, 4.6),
        (20.0, 0.0),
        (30.0, 0.0),
        (30.0, 10.0),
        (19.5, 10.0),
        (19.5, 5.4),
        (10.5, 5.4),
        (10.5, 10.0),
        (0.0, 10.0),
    ]);
    let bulge = |x: f64| 0.3 + 0.5 * (x * 0.4).sin().powi(2);
    let chain = band(31.4159, |x| -bulge(x), bulge);
    let wedge = band(60.0, |_| 0.0, |x| 0.2 + 0.02 * x);
    let cases = [
        ("square", rectangle(0.0, 0.0, 10.0, 10.0), 1.0, (1, 0)),
        ("strip", rectangle(0.0, 0.0, 10.0, 1.0), 1.0, (0, 1)),
        ("tube", tube(10.0, 5.0), 1.0, (1, 0)),
        ("thin tube", tube(10.0, 9.0), 1.0, (0, 1)),
        ("dumbbell", dumbbell, 1.0, (2, 1)),
        ("chain of four", chain, 0.55, (4, 5)),
        ("wedge", wedge, 0.5, (1, 1)),
    ];
    for (name, polygon, radius, expected) in cases {
        assert_eq!(counts(&polygon, radius), Some(expected), "{name}");
    }
}

#[test]
fn a_small_rounding_is_no_thin_part() {
    let arc = (0..=6).map(|i| {
        let a = f64::from(i) / 6.0 * std::f64::consts::FRAC_PI_2;
        Point2::new(9.7, 9.7) + Point2::from_angle(a) * 0.3
    });
    let rest = [Point2::new(0.0, 10.0), Point2::ZERO, Point2::new(10.0, 0.0)];
    let polygon = Polygon::simple(Ring::new(arc.chain(rest).collect()));
    assert_eq!(counts(&polygon, 1.0), Some((1, 0)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// The parts are the whole; what is thick holds every disc that fits, and what is thin none.
    #[test]
    fn parts_share_out_the_polygon(
        radius in 0.5..5.0f64,
        waves in prop::collection::vec((1u32..12, 0.0..0.3f64, 0.0..6.0f64), 1..4),
        bore in prop::option::of(0.2..0.9f64),
        half in 0.2..0.6f64,
    ) {
        let wobble = |a: f64| -> f64 {
            let sum: f64 = waves.iter().map(|&(k, h, p)| h * (f64::from(k) * a + p).sin()).sum();
            radius * (1.0 + sum).max(0.1)
        };
        let mut polygon = Polygon::simple(radial(Point2::new(40.0, 9.0), 140, wobble));
        if let Some(bore) = bore {
            let mut hole = radial(Point2::new(40.0, 9.0), 110, |a| wobble(a) * bore);
            hole.reverse();
            polygon.holes.push(hole);
        }
        if let Some(parts) = split(&polygon, half) {
            let whole = polygon.area();
            let sum = region::area(&parts.thick) + region::area(&parts.thin);
            prop_assert!((sum - whole).abs() < 1e-5 * whole, "{} {}", sum, whole);
            let inset = ClipperInset { simplify: 1e-6 };
            // Cores no longer than a few edges may be missed, and cuts end beside them.
            let core = inset.inset(&inset.inset(&[polygon], half), 0.25 * half);
            let missed = region::intersection(&core, &parts.thin);
            prop_assert!(region::area(&missed) < 0.5 * half * half, "{}", region::area(&missed));
        }
    }
}

/// Their cores touch the border only at the corners between the arms: no edge fits, or only in its
/// middle, however blunt the corners are.
#[test]
fn a_small_star_is_not_all_thin() {
    let stars = [
        (1.546, 0.271, 3.32, 0.456),
        (1.6296, 0.2653, 0.0, 0.5375),
        (0.7015, 0.0816, 2.868, 0.3505),
    ];
    for (radius, depth, turn, half) in stars {
        let wobble = |a: f64| radius * (1.0 + depth * (10.0 * a + turn).sin());
        let star = Polygon::simple(radial(Point2::new(40.0, 9.0), 140, wobble));
        assert_eq!(counts(&star, half), None, "{radius}");
    }
}
