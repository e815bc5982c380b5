use super::*;
use crate::{region, region_shapes::*};
use fgm_core::Point2;
use proptest::prelude::*;

/// Whatever the inset: areas by hand, mm².
#[test]
fn insets_have_their_area() {
    let inset = ClipperInset::default();
    let square = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let dumbbell = [simple(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.0),
        (20.0, 4.0),
        (20.0, 0.0),
        (30.0, 0.0),
        (30.0, 10.0),
        (20.0, 10.0),
        (20.0, 5.0),
        (10.0, 5.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ])];
    let cases: [(&str, &[Polygon], f64, f64, usize); 8] = [
        ("in", &square, 1.0, 64.0, 1),
        ("out", &square, -1.0, 144.0, 1),
        ("none", &square, 0.0, 100.0, 1),
        ("gone", &square, 5.0, 0.0, 0),
        ("l", &[l_shape()], 1.0, 28.0 * 10.0 + 9.0 * 13.0, 1),
        ("splits", &dumbbell, 1.0, 2.0 * 64.0, 2),
        ("merges", &[square[0].clone(), rectangle(11.0, 0.0, 10.0, 10.0)], -1.0, 12.0 * 23.0, 1),
        ("closes", &[tube(5.0, 0.1)], -1.0, 0.0, 1),
    ];
    for (name, region, distance, area, pieces) in cases {
        let out = inset.inset(region, distance);
        assert_eq!(out.len(), pieces, "{name}");
        if area > 0.0 || pieces == 0 {
            assert!((region::area(&out) - area).abs() < 1e-3, "{name}: {}", region::area(&out));
        } else {
            assert!(out[0].holes.is_empty(), "{name}");
        }
    }
}

/// Two corners face each other across a neck: a disc fits between them, their mitres do not.
#[test]
fn mitres_that_would_cross_are_cut() {
    let neck =
        |w: f64| simple(&[(0.0, -5.0), (5.0, -w), (10.0, -5.0), (10.0, 5.0), (5.0, w), (0.0, 5.0)]);
    let cases = [(1.1, 2), (1.2, 2), (1.3, 1), (0.9, 2)];
    for (half, pieces) in cases {
        let out = ClipperInset::default().inset(&[neck(half)], 1.0);
        assert_eq!(out.len(), pieces, "{half}");
        let united = region::union(&out, &[]);
        assert!((region::area(&united) - region::area(&out)).abs() < 1e-3, "{half}");
    }
}

#[test]
fn holes_move_the_other_way() {
    let out = ClipperInset::default().inset(&[tube(10.0, 4.0)], 1.0);
    assert_eq!((out.len(), out[0].holes.len()), (1, 1));
    assert!(out[0].outer.points.iter().all(|p| (p.length() - 9.0).abs() < 0.01));
    assert!(out[0].holes[0].points.iter().all(|p| (p.length() - 5.0).abs() < 0.01));
    assert!(out[0].holes[0].area() < 0.0);
}

#[test]
fn rings_without_area_or_number_are_absent() {
    let inset = ClipperInset::default();
    let bad = [
        simple(&[(0.0, 0.0), (5.0, 0.0)]),
        simple(&[(1.0, 1.0); 6]),
        simple(&[(0.0, 0.0), (5.0, 0.0), (2.0, 0.0)]),
        simple(&[(0.0, 0.0), (f64::NAN, 0.0), (2.0, 3.0)]),
        simple(&[(0.0, 0.0), (f64::INFINITY, 0.0), (2.0, 3.0)]),
        simple(&[(0.0, 0.0), (1e12, 0.0), (2.0, 3.0)]),
        Polygon::default(),
    ];
    for polygon in bad {
        let polygon = std::slice::from_ref(&polygon);
        for distance in [1.0, -1.0, 0.0, f64::NAN] {
            assert!(inset.inset(polygon, distance).is_empty(), "{polygon:?} {distance}");
        }
        assert!(region::union(polygon, &[]).is_empty(), "{polygon:?}");
    }
}

#[test]
fn simplifying_keeps_corners_and_drops_what_lies_between() {
    let mut points = Vec::new();
    for (a, b) in rectangle(0.0, 0.0, 10.0, 10.0).outer.edges() {
        points.extend((0..50).map(|i| a + (b - a) * (f64::from(i) / 50.0)));
    }
    let out = simplify::region(&[Polygon::simple(fgm_core::Ring::new(points))], 1e-3);
    assert_eq!(out[0].outer.points.len(), 4);
}

#[test]
fn booleans_have_their_area() {
    let a = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let b = [rectangle(5.0, 5.0, 10.0, 10.0)];
    let hole = [rectangle(4.0, 4.0, 2.0, 2.0)];
    assert!((region::area(&region::union(&a, &b)) - 175.0).abs() < 1e-6);
    assert!((region::area(&region::intersection(&a, &b)) - 25.0).abs() < 1e-6);
    assert!((region::area(&region::difference(&a, &b)) - 75.0).abs() < 1e-6);
    let holed = region::difference(&a, &hole);
    assert_eq!((holed.len(), holed[0].holes.len()), (1, 1));
    assert!(region::intersection(&a, &[]).is_empty());
    assert!(region::difference(&[], &a).is_empty());
}

fn wobbly() -> impl Strategy<Value = Polygon> {
    let waves = prop::collection::vec((1u32..14, 0.0..0.3f64, 0.0..6.0f64), 0..4);
    (1.0..12.0f64, waves, prop::option::of(0.1..0.8f64)).prop_map(|(radius, waves, bore)| {
        let wobble = |a: f64| -> f64 {
            let sum: f64 = waves.iter().map(|&(k, h, p)| h * (f64::from(k) * a + p).sin()).sum();
            radius * (1.0 + sum).max(0.05)
        };
        let holes = bore.map(|b| {
            let mut hole = radial(Point2::new(7.0, 3.0), 90, |a| b * wobble(a));
            hole.reverse();
            hole
        });
        let outer = radial(Point2::new(7.0, 3.0), 130, wobble);
        Polygon { outer, holes: holes.into_iter().collect() }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn what_is_moved_by_bisectors_is_what_the_sweep_finds(
        polygon in wobbly(),
        distance in prop_oneof![0.05..1.5f64, -1.5..-0.05f64],
    ) {
        let region = simplify::region(&[polygon], 1e-3);
        if let Some(quick) = local::offset(&region, distance) {
            let sure = clipper::offset(&region, -distance);
            let (a, b) = (region::area(&quick), region::area(&sure));
            let near = |a: f64, b: f64| (a - b).abs() < 1e-3 * (1.0 + b);
            // Its polygons do not overlap.
            prop_assert!(near(region::area(&region::union(&quick, &[])), a), "{}", a);
            let count = |r: &[Polygon]| -> usize {
                r.iter().flat_map(Polygon::rings).map(|r| r.points.len()).sum()
            };
            // The sweep keeps the mitres of edges that vanished, and so moves the border further.
            if count(&quick) == count(&region) {
                prop_assert!(near(a, b), "{} {}", a, b);
                prop_assert_eq!(quick.len(), sure.len());
            }
            let (most, least) = if distance > 0.0 { (&quick, &sure) } else { (&sure, &quick) };
            let rest = region::area(&region::difference(least, most));
            prop_assert!(rest < 1e-3 * (1.0 + b), "{} outside", rest);
        }
    }

    #[test]
    fn insets_keep_their_distance(polygon in wobbly(), distance in 0.05..1.5f64) {
        let inset = ClipperInset::default();
        let out = inset.inset(std::slice::from_ref(&polygon), distance);
        let border = near::NearBorder::new(std::slice::from_ref(&polygon), distance);
        for (a, b) in out.iter().flat_map(Polygon::rings).flat_map(fgm_core::Ring::edges) {
            prop_assert!(polygon.contains(a));
            prop_assert!(!border.any_within(a, b, distance - 3e-3, [near::NO_EDGE; 3]), "{} {}", a, b);
        }
    }
}
