//! One case for each defect that was found, by the name of what went wrong.

#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.

use fgm_arrange::{ArrangeOptions, Arrangement, Chain};
use fgm_core::Point2;

/// Open lines in lattice steps.
fn steps(lines: &[&[(i64, i64)]]) -> Vec<Vec<Point2>> {
    let point = |&(x, y): &(i64, i64)| Point2::new(x as f64 * 1e-6, y as f64 * 1e-6);
    lines.iter().map(|line| line.iter().map(point).collect()).collect()
}

fn arrange(lines: &[Vec<Point2>], keep: bool) -> Arrangement<u32> {
    let chains: Vec<_> = lines.iter().map(|line| Chain::open(line, 0)).collect();
    let options = ArrangeOptions::default().with_dangling(keep);
    let arrangement = Arrangement::new(&chains, &options).unwrap();
    arrangement.validate().unwrap();
    arrangement
}

fn rings(arrangement: &Arrangement<u32>) -> String {
    format!("{:?}", arrangement.faces().map(|f| f.polygon()).collect::<Vec<_>>())
}

/// Both segments at an untouched corner were led through one pixel: the edge from there was there
/// twice.
#[test]
fn a_corner_that_snapping_folds() {
    let lines = steps(&[&[(1, -4), (-6, 1)], &[(-1, 5), (-3, -2), (0, 2)]]);
    for keep in [false, true] {
        arrange(&lines, keep);
    }
}

/// A ring began at different points when its chain was drawn once or twice.
#[test]
fn a_ring_begins_at_its_least_point() {
    let once = steps(&[&[(0, -1), (0, 0), (-2, -2), (2, 0)]]);
    let twice: Vec<_> = once.iter().chain(&once).cloned().collect();
    assert_eq!(rings(&arrange(&once, false)), rings(&arrange(&twice, false)));
}

/// The least point of an edge lies inside a piece that begins upright.
#[test]
fn faces_are_named_by_their_least_point() {
    let there =
        steps(&[&[(-2, 2), (0, 0), (-2, 0)], &[(0, 0), (-2, 2), (-1, -2)], &[(1, 0), (-2, 1)]]);
    let back: Vec<Vec<_>> = there.iter().map(|l| l.iter().rev().copied().collect()).collect();
    let both: Vec<_> = back.into_iter().chain(there.clone()).collect();
    assert_eq!(rings(&arrange(&there, false)), rings(&arrange(&both, false)));
}

/// With dangling edges kept, the point inside came to lie on one.
#[test]
fn an_inside_point_on_a_dangling_edge() {
    arrange(
        &steps(&[
            &[(0, 5), (-5, 5), (-2, -5)],
            &[(-2, 0), (-2, 6), (-6, 2), (-3, 4)],
            &[(0, 1), (-4, 1)],
        ]),
        true,
    );
}

/// Where a path 3 m long crosses an edge of a few steps, the crossing was off by 16 steps.
#[test]
fn a_long_path_over_a_tiny_face() {
    let p = |x, y| Point2::new(x, y);
    let lines = [
        vec![p(955.0, -1910.0), p(-0.000139, 0.000277)],
        vec![p(-1e-6, 2e-6), p(0.0, 0.0)],
        vec![p(1920.0, 640.000001), p(-1365.0, -455.0)],
    ];
    let arrangement = arrange(&lines, false);
    let mut spans = Vec::new();
    arrangement.cut(&lines[2], &mut spans);
    let labels: Vec<_> = spans.iter().map(|s| s.label.is_some()).collect();
    assert_eq!(labels, [false, true, false]);
    let x = fgm_core::point_at(&lines[2], spans[1].from).x;
    assert!((-1e-6..=1e-6).contains(&x), "{x}");
}
