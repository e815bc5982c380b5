use super::*;
use crate::region_shapes::*;
use fgm_core::Ring;

fn options() -> GapOptions {
    GapOptions { width: WIDTH, height: HEIGHT, min_width: 0.24, max_width: 0.64, loops: false }
}

#[test]
fn a_tapered_wedge_is_covered() {
    let wedge = [band(40.0, |_| 0.0, |x| 0.25 + 0.015 * x)];
    let paths = gap_fill(&wedge, &options());
    let cover = cover(&wedge, &paths, 0.02);
    assert!(cover.covered > 0.97, "{cover:?}");
    assert!(cover.doubled < 0.02, "{cover:?}");
    let share = volume(&paths) / (wedge[0].area() * HEIGHT);
    assert!((share - 1.0).abs() < 0.03, "{share}");
    assert!(paths.iter().all(|p| p.width >= 0.24 && p.width < 0.68), "{paths:?}");
}

#[test]
fn a_thin_ring_takes_one_closed_bead() {
    let paths = gap_fill(&[tube(10.0, 9.6)], &options());
    assert_eq!(paths.len(), 1);
    assert!(paths[0].closed);
    assert!(paths[0].points.iter().all(|p| (p.length() - 9.8).abs() < 0.02));
    let fills = bead::spacing(paths[0].width, HEIGHT);
    assert!((fills - 0.4).abs() < 0.01, "{fills}");
}

#[test]
fn a_gap_takes_two_beads_where_two_fit_and_loops_are_asked_for() {
    let gap = [rectangle(0.0, 0.0, 20.0, 0.5)];
    for (loops, count) in [(false, 1), (true, 2)] {
        let paths = gap_fill(&gap, &GapOptions { loops, ..options() });
        assert_eq!(paths.len(), count);
        let share = volume(&paths) / (gap[0].area() * HEIGHT);
        assert!((share - 1.0).abs() < 0.04, "{share}");
    }
}

#[test]
fn a_cross_is_filled_in_all_its_arms() {
    let cross = [simple(&[
        (0.0, 5.0),
        (5.0, 5.0),
        (5.0, 0.0),
        (5.4, 0.0),
        (5.4, 5.0),
        (10.4, 5.0),
        (10.4, 5.4),
        (5.4, 5.4),
        (5.4, 10.4),
        (5.0, 10.4),
        (5.0, 5.4),
        (0.0, 5.4),
    ])];
    let paths = gap_fill(&cross, &options());
    let cover = cover(&cross, &paths, 0.02);
    assert!(cover.covered > 0.93, "{cover:?} {paths:?}");
    assert!(cover.doubled < 0.05, "{cover:?}");
}

#[test]
fn too_thin_is_left_open() {
    assert!(gap_fill(&[rectangle(0.0, 0.0, 20.0, 0.1)], &options()).is_empty());
    assert!(gap_fill(&[], &options()).is_empty());
}

#[test]
fn pins_are_printed() {
    for tenths in 4..=9 {
        let radius = 0.05 * f64::from(tenths);
        let pin = [Polygon::simple(radial(Point2::ZERO, 40, |_| radius))];
        let paths = gap_fill(&pin, &options());
        let share = volume(&paths) / (pin[0].area() * HEIGHT);
        assert!(share > 0.5 && share < 1.1, "{radius}: {share} {paths:?}");
    }
}

/// The quick way and the sure way to triangulate give the same triangles.
#[test]
fn ribbons_flipped_are_delaunay() {
    let fork = simple(&[
        (0.0, 0.0),
        (4.0, 0.3),
        (8.0, -1.5),
        (8.2, -1.0),
        (4.6, 0.6),
        (8.1, 2.4),
        (7.8, 2.9),
        (4.1, 0.9),
        (0.1, 0.6),
    ]);
    let wave = |x: f64| (x * 0.9).sin();
    let shapes = [
        rectangle(0.0, 0.0, 10.0, 0.5),
        band(20.0, wave, |x| wave(x) + 0.4 + 0.2 * (x * 1.3).cos()),
        band(20.0, |_| 0.0, |x| 0.1 + 0.04 * x),
        fork,
    ];
    for (i, shape) in shapes.iter().enumerate() {
        let quick = mesh::Mesh::new(shape, 0.4, 100.0);
        let sure = mesh::Mesh::new(shape, 0.4, 0.0);
        assert_eq!(quick.triangles.len(), sure.triangles.len(), "{i}");
        assert!((quick.area() - shape.area()).abs() < 1e-9, "{i}");
        let key = |m: &mesh::Mesh| -> f64 {
            m.triangles.iter().map(|t| t.center().length_squared() * t.area()).sum()
        };
        assert!((key(&quick) - key(&sure)).abs() < 1e-3 * key(&sure), "{i}");
        for (number, triangle) in (0u32..).zip(&quick.triangles) {
            assert!(triangle.area() > 0.0);
            for neighbour in triangle.across.into_iter().filter(|&n| n != mesh::BORDER) {
                assert!(quick.triangles[neighbour as usize].edge_to(number).is_some(), "{i}");
            }
        }
    }
}

#[test]
fn borders_that_touch_themselves_are_not_filled_across() {
    // Two thin strips that meet in a point, with a spike of no width.
    let bow = [simple(&[
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, 0.4),
        (10.0, 0.4),
        (10.0, 0.8),
        (5.0, 0.8),
        (5.0, 0.4),
        (5.0, 6.0),
        (5.0, 0.4),
        (0.0, 0.4),
    ])];
    let paths = gap_fill(&bow, &options());
    let cover = cover(&bow, &paths, 0.02);
    assert!(cover.covered > 0.9 && cover.outside < 0.02, "{cover:?} {paths:?}");
}

#[test]
fn beads_lead_to_the_very_end_where_another_begins() {
    for (loops, ends) in [(false, 0.25), (true, 0.0)] {
        let gap = [rectangle(0.0, 0.0, 20.0, 0.5)];
        let paths = gap_fill(&gap, &GapOptions { loops, ..options() });
        for path in &paths {
            let (first, last) = (path.points[0].x, path.points[path.points.len() - 1].x);
            assert!((first.min(last) - ends).abs() < 0.01, "{path:?}");
            assert!((first.max(last) - 20.0 + ends).abs() < 0.01, "{path:?}");
        }
    }
}

#[test]
fn what_ends_in_a_point_has_its_volume() {
    let side = |i: usize| Point2::new(0.05 * i as f64, 0.0025 * i as f64);
    let low: Vec<Point2> = (0..80).map(side).collect();
    let high = low.iter().rev().map(|p| Point2::new(p.x, 0.4 - p.y));
    let spike = [Polygon::simple(Ring::new(low.iter().copied().chain(high).collect()))];
    let paths = gap_fill(&spike, &GapOptions { loops: true, ..options() });
    let share = volume(&paths) / (spike[0].area() * HEIGHT);
    assert!((share - 1.0).abs() < 0.06, "{share}");
}

#[test]
fn spots_take_a_loop_of_their_volume() {
    for hundredths in 16..=58 {
        let radius = 0.01 * f64::from(hundredths);
        let disc = Polygon::simple(radial(Point2::new(3.0, 4.0), 40, |_| radius));
        let square = rectangle(1.0, 2.0, 1.8 * radius, 2.2 * radius);
        for spot in [disc, square] {
            let spot = [spot];
            let paths = gap_fill(&spot, &GapOptions { loops: true, ..options() });
            assert!(paths.len() == 1 && paths[0].closed, "{radius}: {paths:?}");
            let share = volume(&paths) / (spot[0].area() * HEIGHT);
            assert!((share - 1.0).abs() < 0.06, "{radius}: {share}");
        }
    }
}
