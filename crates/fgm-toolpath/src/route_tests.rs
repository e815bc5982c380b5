use super::*;
use crate::{AgainstOptions, ClipperInset, against, region_shapes::*};
use fgm_core::{Point2, Polygon, Role};
use proptest::prelude::*;

fn filled(face: &Polygon) -> Vec<Path> {
    let options = AgainstOptions::new(WIDTH, HEIGHT);
    against(std::slice::from_ref(face), &options, &ClipperInset::default())
}

fn path(points: &[(f64, f64)], closed: bool, width: f64) -> Path {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Path { points, closed, role: Role::GapFill, width, turn: 0, turns: Vec::new() }
}

fn length(paths: &[Path]) -> f64 {
    paths.iter().map(Path::length).sum()
}

/// The travels of a round, the one that closes it too.
fn travel(paths: &[Path]) -> f64 {
    let end = |p: &Path| if p.closed { p.points[0] } else { p.points[p.points.len() - 1] };
    let next = paths.iter().skip(1).chain(paths.first());
    paths.iter().zip(next).map(|(a, b)| end(a).distance(b.points[0])).sum()
}

/// As full as before, and with little travel.
fn check(name: &str, face: &Polygon, most_travel: f64) {
    let before = filled(face);
    let paths = route(before.clone(), WIDTH, HEIGHT);
    let (was, is) = (volume(&before), volume(&paths));
    assert!((is / was - 1.0).abs() < 0.01, "{name}: volume {was} to {is}");
    let region = std::slice::from_ref(face);
    let (was, is) = (cover(region, &before, 0.07), cover(region, &paths, 0.07));
    assert!(is.covered > was.covered - 0.01, "{name}: {was:?} {is:?}");
    assert!(is.doubled < was.doubled + 0.01, "{name}: {was:?} {is:?}");
    assert!(is.outside < was.outside + 0.01, "{name}: {was:?} {is:?}");
    let share = travel(&paths) / length(&paths);
    assert!(
        share <= most_travel,
        "{name}: travel {share} of {}",
        travel(&before) / length(&before)
    );
}

#[test]
fn faces_stay_full_and_need_little_travel() {
    for tenths in [10, 13, 16, 19, 25, 31, 40, 60] {
        let w = f64::from(tenths) * 0.1;
        let low = |x: f64| (x * 0.3).sin();
        check(&format!("wavy {w}"), &band(60.0, low, |x| low(x) + w), 0.5);
        let high = |x: f64| low(x) + w + 0.4 * (x * 0.17).sin();
        check(&format!("uneven {w}"), &band(60.0, low, high), 0.5);
    }
    check("disc", &Polygon::simple(radial(Point2::ZERO, 200, |_| 6.0)), 0.005);
    check("rectangle", &rectangle(0.0, 0.0, 20.0, 15.0), 0.005);
    check("ring", &tube(6.0, 4.3), 0.02);
    check("l", &l_shape(), 0.02);
    check("star", &star(5, 12.0, 6.0), 0.05);
    check("wedge", &band(60.0, |_| 0.0, |x| 0.2 + 0.02 * x), 0.3);
}

#[test]
fn a_nest_of_loops_becomes_one_line() {
    let disc = Polygon::simple(radial(Point2::ZERO, 200, |_| 6.0));
    let loops = filled(&disc).into_iter().filter(|p| p.role == Role::SolidInfill).collect();
    let paths = route(loops, WIDTH, HEIGHT);
    assert_eq!(paths.len(), 1);
    assert!(paths[0].closed);
}

#[test]
fn two_beads_side_by_side_become_a_loop() {
    let beads = vec![
        path(&[(0.0, 0.0), (9.0, 0.0)], false, 0.4),
        path(&[(0.0, 0.4), (9.0, 0.4)], false, 0.4),
    ];
    let paths = route(beads, WIDTH, HEIGHT);
    assert_eq!(paths.len(), 1);
    assert!(paths[0].closed);
    assert!((paths[0].length() - 18.0).abs() < 1e-9, "{paths:?}");
    assert!((paths[0].points.iter().map(|p| p.x).fold(0.0, f64::max) - 8.8).abs() < 1e-9);
}

#[test]
fn what_leads_elsewhere_is_gone_to_and_come_back_from() {
    let square = path(&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)], true, 0.4);
    let spur = path(&[(9.4, 4.0), (14.0, 4.0)], false, 0.3);
    let paths = route(vec![square, spur], WIDTH, HEIGHT);
    // The loop is cut in the middle of its side, the nearest place.
    assert_eq!(paths.len(), 2, "{paths:?}");
    let out = paths.iter().find(|p| p.width == 0.4).map(|p| p.points[0]);
    assert_eq!(out, Some(Point2::new(9.0, 4.0)));
    assert!((travel(&paths) - 5.4).abs() < 1e-9);
    assert!((length(&paths) - 40.6).abs() < 1e-9);
}

#[test]
fn what_lies_apart_is_kept() {
    let square = |x: f64| path(&[(x, 0.0), (x + 9.0, 0.0), (x + 9.0, 9.0), (x, 9.0)], true, 0.4);
    let paths = route(vec![square(0.0), square(500.0), square(9.36)], WIDTH, HEIGHT);
    assert_eq!(paths.len(), 2, "{paths:?}");
    assert!(paths.iter().all(|p| p.closed));
    assert!((length(&paths) - 108.0).abs() < 0.1);
}

#[test]
fn what_makes_no_sense_is_left() {
    let bad = path(&[(f64::NAN, 0.0), (1.0, 0.0)], false, 0.4);
    let good = path(&[(0.0, 0.0), (1.0, 0.0)], false, 0.4);
    assert_eq!(route(vec![good.clone(), bad], WIDTH, HEIGHT).len(), 2);
    assert_eq!(route(vec![good.clone(), path(&[], true, 0.4)], WIDTH, HEIGHT).len(), 2);
    let two = vec![good.clone(), good];
    assert_eq!(route(two.clone(), f64::NAN, HEIGHT), two);
    assert_eq!(route(two.clone(), WIDTH, 0.0), two);
    assert!(route(Vec::new(), WIDTH, HEIGHT).is_empty());
}

prop_compose! {
    /// Lines on a coarse lattice, so that ends meet and lines overlap.
    fn lines()(
        lines in prop::collection::vec(
            (prop::collection::vec((0..20i32, 0..20i32), 2..9), any::<bool>(), 0..2u8), 0..12),
    ) -> Vec<Path> {
        let line = |(points, closed, width): (Vec<(i32, i32)>, bool, u8)| {
            let points: Vec<_> =
                points.iter().map(|&(x, y)| (0.37 * f64::from(x), 0.37 * f64::from(y))).collect();
            path(&points, closed && points.len() > 2, 0.3 + 0.1 * f64::from(width))
        };
        lines.into_iter().map(line).collect()
    }
}

proptest! {
    #[test]
    fn any_lines_are_kept(lines in lines()) {
        let before = length(&lines);
        let paths = route(lines.clone(), WIDTH, HEIGHT);
        // Every joint and every cap may change the length by what is cut out or put in.
        let most = 4.0 * 0.7 * lines.len() as f64;
        let after = length(&paths);
        prop_assert!((after - before).abs() <= most, "{before} to {after}");
        prop_assert!(paths.iter().flat_map(|p| &p.points).all(|p| p.is_finite()));
        prop_assert_eq!(paths, route(lines, WIDTH, HEIGHT));
    }

    #[test]
    fn lines_that_cannot_be_joined_keep_their_length(lines in lines()) {
        // Loops too short to be cut, lines far apart.
        let apart = |(i, mut path): (usize, Path)| {
            let shift = Point2::new(100.0 * i as f64, 0.0);
            path.points.iter_mut().for_each(|p| *p += shift);
            path
        };
        let lines: Vec<Path> = lines.into_iter().enumerate().map(apart).collect();
        let (before, paths) = (length(&lines), route(lines, WIDTH, HEIGHT));
        prop_assert!((length(&paths) - before).abs() < 1e-6, "{} to {}", before, length(&paths));
    }
}
