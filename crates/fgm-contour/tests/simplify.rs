//! Simplification and nesting.

mod common;

use common::{assert_apart, assert_valid};
use fgm_contour::{nest, simplify_line, simplify_polygons, simplify_ring};
use fgm_core::{Point2, Polygon, Polyline, Ring};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn distance(p: Point2, points: &[Point2], closed: bool) -> f64 {
    let n = points.len();
    let edges = if closed { n } else { n - 1 };
    (0..edges)
        .map(|k| {
            let (a, b) = (points[k], points[(k + 1) % n]);
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a + (b - a) * if t.is_nan() { 0.0 } else { t })
        })
        .fold(f64::INFINITY, f64::min)
}

/// A star-shaped ring: simple whatever the radii.
fn star(center: Point2, radii: &[f64]) -> Ring {
    let at = |(k, r): (usize, &f64)| {
        center + Point2::from_angle(k as f64 / radii.len() as f64 * TAU) * *r
    };
    Ring::new(radii.iter().enumerate().map(at).collect())
}

#[test]
fn what_may_go_goes_and_ends_stay() {
    let line = |points: &[(f64, f64)]| {
        Polyline::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect())
    };
    let zigzag = line(&[(0.0, 0.0), (1.0, 0.01), (2.0, -0.01), (3.0, 0.0), (3.0, 2.0)]);
    assert_eq!(simplify_line(&zigzag, 0.02), line(&[(0.0, 0.0), (3.0, 0.0), (3.0, 2.0)]));
    assert_eq!(simplify_line(&zigzag, 0.0), zigzag);
    assert_eq!(simplify_line(&zigzag, f64::NAN), zigzag);
    let there_and_back = line(&[(0.0, 0.0), (5.0, 0.0), (0.0, 0.0)]);
    assert_eq!(simplify_line(&there_and_back, 1.0), there_and_back);
    let tiny = star(Point2::ZERO, &[1e-4; 8]);
    assert_eq!(simplify_ring(&tiny, 1.0).points.len(), 3, "a ring does not vanish");
    assert_eq!(simplify_line(&Polyline::default(), 1.0), Polyline::default());
    assert_eq!(simplify_ring(&Ring::default(), 1.0), Ring::default());
}

#[test]
fn a_chord_that_would_cut_a_neighbour_is_taken_back() {
    // A needle pokes into the bay of a shallow curve: each alone could be simplified.
    let bay: Vec<Point2> = (0..=20)
        .map(|k| Point2::new(f64::from(k), 0.09 * (f64::from(k) - 10.0).powi(2) / 100.0))
        .collect();
    let mut outer = bay.clone();
    outer.extend([Point2::new(20.0, -9.0), Point2::new(0.0, -9.0)]);
    outer.reverse();
    let needle =
        Ring::new([(9.9, 5.0), (10.0, 0.01), (10.1, 5.0)].map(|(x, y)| Point2::new(x, y)).into());
    let polygons = [Polygon::simple(Ring::new(outer)), Polygon::simple(needle)];
    let alone = simplify_ring(&polygons[0].outer, 0.1);
    assert_eq!(alone.points.len(), 4);
    let found = simplify_polygons(&polygons, 0.1);
    assert!(found[0].outer.points.len() > 4);
    assert_apart(found.iter().map(|p| (p.outer.points.as_slice(), true)));
}

#[test]
fn rings_nest_to_any_depth_whatever_their_direction() {
    let square = |half: f64, x: f64, turned: bool| {
        let mut ring = star(Point2::new(x, 0.0), &[half; 4]);
        if turned {
            ring.reverse();
        }
        ring
    };
    let rings = vec![
        square(1.0, 0.0, true),
        square(4.0, 0.0, false),
        square(9.0, 0.0, true),
        square(3.0, 0.0, true),
        square(2.0, 0.0, false),
        square(1.0, 6.0, false),
        square(1.0, 20.0, true),
        Ring::default(),
        square(0.0, 3.0, false),
    ];
    let polygons = nest(rings);
    assert_valid(&polygons);
    let holes: Vec<usize> = polygons.iter().map(|p| p.holes.len()).collect();
    // Outer rings in the order given: 1, 9, 3 ... each with its holes.
    assert_eq!(polygons.len(), 4);
    assert_eq!(holes.iter().sum::<usize>(), 3);
}

#[test]
fn rings_that_touch_at_a_vertex_nest() {
    let outer = star(Point2::ZERO, &[4.0; 4]);
    // The hole's leftmost vertex is the outer's leftmost.
    let hole = star(Point2::new(-2.0, 0.0), &[2.0; 4]);
    let polygons = nest(vec![hole, outer]);
    assert_eq!((polygons.len(), polygons[0].holes.len()), (1, 1));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn simplified_rings_stay_near_and_simple(
        radii in prop::collection::vec(0.5..5.0f64, 3..60), tolerance in 0.001..2.0f64
    ) {
        let ring = star(Point2::new(1.0, 2.0), &radii);
        let found = simplify_ring(&ring, tolerance);
        prop_assert!(found.points.len() >= 3);
        assert_apart([(found.points.as_slice(), true)]);
        for &p in &ring.points {
            prop_assert!(distance(p, &found.points, true) <= tolerance * (1.0 + 1e-9));
        }
        for (a, b) in found.edges() {
            for t in [0.0, 0.3, 0.7] {
                prop_assert!(distance(a.lerp(b, t), &ring.points, true) <= tolerance * (1.0 + 1e-9));
            }
        }
    }

    #[test]
    fn any_points_are_simplified_without_a_panic(
        points in prop::collection::vec((-3..3i32, -3..3i32), 0..12), tolerance in 0.0..3.0f64
    ) {
        let points: Vec<Point2> =
            points.into_iter().map(|(x, y)| Point2::new(x.into(), y.into())).collect();
        let line = simplify_line(&Polyline::new(points.clone()), tolerance);
        prop_assert_eq!(line.points.first(), points.first());
        prop_assert_eq!(line.points.last(), points.last());
        let ring = simplify_ring(&Ring::new(points.clone()), tolerance);
        prop_assert!(ring.points.len() >= points.len().min(3));
        let _ = nest(vec![ring, Ring::new(points)]);
    }

    #[test]
    fn nested_rings_agree_with_counting(
        rings in prop::collection::vec((0..12i32, 0..12i32, 1..4usize), 1..14)
    ) {
        // Diamonds around cells of a grid: nested where they share a centre, else apart.
        let mut seen = std::collections::BTreeSet::new();
        let rings: Vec<Ring> = rings.into_iter().filter(|r| seen.insert(*r)).map(|(x, y, size)| {
            star(Point2::new(f64::from(x), f64::from(y)) * 2.0, &[0.3 * size as f64; 4])
        }).collect();
        let count = rings.len();
        let polygons = nest(rings);
        assert_valid(&polygons);
        prop_assert_eq!(polygons.iter().flat_map(Polygon::rings).count(), count);
    }
}
