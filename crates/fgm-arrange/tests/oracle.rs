//! Faces against an independent library, and against plain sums.

#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.

use fgm_arrange::generators::{self, Drawn, chains};
use fgm_arrange::{ArrangeOptions, Arrangement, Arranger};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use proptest::prelude::*;

type Shape = Vec<[f64; 2]>;

fn area(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() * 0.5
}

/// The area inside any of the rings, by i_overlay.
fn union(rings: &[Drawn]) -> f64 {
    let shape = |ring: &Drawn| {
        let mut points: Shape = ring.points.iter().map(|p| [p.x, p.y]).collect();
        if area(&points) < 0.0 {
            points.reverse();
        }
        points
    };
    let shapes: Vec<Shape> = rings.iter().map(shape).collect();
    let clip: Vec<Shape> = Vec::new();
    let result = shapes.overlay(&clip, OverlayRule::Subject, FillRule::NonZero);
    result.iter().flatten().map(|ring| area(ring)).sum()
}

fn rings() -> impl Strategy<Value = Vec<Drawn>> {
    prop_oneof![
        generators::nested(),
        (1..12usize, 3..30usize, any::<u32>()).prop_map(|(rings, n, seed)| {
            let ring = |k: usize| {
                let turn = f64::from(seed % 1000) * 0.01 * (k + 1) as f64;
                let center = fgm_core::Point2::from_angle(turn) * 5.0;
                let at = |i: usize| {
                    let angle = std::f64::consts::TAU * i as f64 / n as f64;
                    center + fgm_core::Point2::from_angle(angle) * (2.0 + (k % 3) as f64)
                };
                Drawn { points: (0..n).map(at).collect(), closed: true }
            };
            (0..rings).map(ring).collect()
        })
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn the_faces_inside_rings_sum_to_their_union(rings in rings()) {
        let arrangement =
            Arrangement::new(&chains(&rings), &ArrangeOptions::default()).unwrap();
        let inside = |p| rings.iter().any(|r| fgm_core::Ring::new(r.points.clone()).contains(p));
        let sum: f64 =
            arrangement.faces().filter(|f| inside(f.inside_point())).map(|f| f.area()).sum();
        let expected = union(&rings);
        prop_assert!((sum - expected).abs() < 1e-6 * expected, "{} not {}", sum, expected);
    }
}

#[test]
fn a_layer_is_divided_without_rest() {
    let lines = generators::layer(2.0, 15);
    let mut arranger = Arranger::new();
    let options = ArrangeOptions::default();
    let arrangement = arranger.arrange(&chains(&lines), &options).unwrap();
    arrangement.validate().unwrap();
    let outline = fgm_core::Ring::new(lines[0].points.clone());
    let inside = |f: &fgm_arrange::Face<'_, u32>| outline.contains(f.inside_point());
    let sum: f64 = arrangement.faces().filter(inside).map(|f| f.area()).sum();
    assert!((sum - outline.area().abs()).abs() < 1e-3, "{sum} of {}", outline.area());
    // The memory of one layer does not show in the next.
    let other = generators::layer(3.0, 4);
    let fresh = Arrangement::new(&chains(&other), &options).unwrap();
    let reused = arranger.arrange(&chains(&other), &options).unwrap();
    let all =
        |a: &Arrangement<u32>| format!("{:?}", a.faces().map(|f| f.polygon()).collect::<Vec<_>>());
    assert_eq!(all(&fresh), all(&reused));
}
