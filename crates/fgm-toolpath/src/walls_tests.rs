use super::*;
use crate::{ClipperInset, InfillOptions, infill, region, region_shapes::*};

/// The region, its walls and a solid filling.
fn build(region: &[Polygon], count: usize, angle: f64) -> (Walls, Vec<Path>) {
    let inset = ClipperInset::default();
    let walls = walls(region, &WallOptions::new(count, WIDTH, HEIGHT), &inset);
    let options = InfillOptions { angle, ..InfillOptions::new(WIDTH, HEIGHT) };
    let mut all = walls.paths.clone();
    all.extend(infill(&walls.inside, &options, &inset));
    (walls, all)
}

/// The volume of walls and solid filling is that of the region, less the bead's round outside.
#[test]
fn walls_and_filling_have_the_volume_of_the_part() {
    let islands: Vec<Polygon> = (0..12)
        .map(|i| rectangle(f64::from(i % 4) * 12.0, f64::from(i / 4) * 9.0, 10.0, 7.0))
        .collect();
    let cases: [(&str, Vec<Polygon>); 6] = [
        ("square", vec![rectangle(0.0, 0.0, 40.0, 40.0)]),
        ("tube", vec![tube(20.0, 8.0)]),
        ("plate", vec![rectangle(0.0, 0.0, 60.0, 2.5)]),
        ("l", vec![l_shape()]),
        ("star", vec![star(7, 30.0, 18.0)]),
        ("islands", islands),
    ];
    for (name, region) in cases {
        for (count, angle) in [(1, 0.0), (2, 0.7), (3, 0.0)] {
            let (_, all) = build(&region, count, angle);
            let round = 0.5 * (WIDTH - bead::spacing(WIDTH, HEIGHT));
            let body = ClipperInset::default().inset(&region, round);
            let share = volume(&all) / (region::area(&body) * HEIGHT);
            assert!((share - 1.0).abs() < 0.01, "{name}, {count} walls, {angle}: {share}");
            let cover = cover(&region, &all, 0.15);
            assert!(cover.outside < 0.005, "{name}: {cover:?}");
            assert!(cover.covered > 0.97, "{name}: {cover:?}");
        }
    }
}

#[test]
fn holes_get_walls_and_walls_their_places() {
    let (walls, _) = build(&[tube(10.0, 4.0)], 3, 0.0);
    let spacing = bead::spacing(WIDTH, HEIGHT);
    let radii = |p: &Path| {
        let all = p.points.iter().map(|q| q.length());
        all.fold((f64::MAX, 0.0_f64), |(a, b), r| (a.min(r), b.max(r)))
    };
    assert_eq!(walls.paths.len(), 6);
    for path in &walls.paths {
        let (low, high) = radii(path);
        let deep = 0.5 * WIDTH + f64::from(path.turn) * spacing;
        let bore = (low - (4.0 + deep)).abs() < 0.02 && (high - (4.0 + deep)).abs() < 0.02;
        let outside = (low - (10.0 - deep)).abs() < 0.02 && (high - (10.0 - deep)).abs() < 0.02;
        assert!(bore || outside, "turn {}: {low} {high}", path.turn);
        let role = if path.turn == 0 { Role::OuterWall } else { Role::InnerWall };
        assert!(path.closed && path.role == role && path.width == WIDTH);
    }
    let turns: Vec<u32> = walls.paths.iter().map(|p| p.turn).collect();
    assert_eq!(turns, [0, 0, 1, 1, 2, 2]);
    let expected = std::f64::consts::PI * 6.0 * 14.0;
    let left = region::area(&walls.inside);
    assert!(left < expected && left > 0.5 * expected, "{left}");
}

#[test]
fn thin_parts_are_printed() {
    let inset = ClipperInset::default();
    for tenths in 3..=20 {
        let w = f64::from(tenths) * 0.1;
        let plate = [rectangle(0.0, 0.0, 30.0, w)];
        let walls = walls(&plate, &WallOptions::new(3, WIDTH, HEIGHT), &inset);
        let cover = cover(&plate, &walls.paths, 0.05);
        assert!(cover.covered > 0.9, "{w}: {cover:?}");
        assert!(cover.doubled < 0.01, "{w}: {cover:?}");
    }
}

#[test]
fn rounded_corners_keep_their_walls_inside() {
    // Grown back from its core, a small rounding once became a sharp corner outside the part.
    let corner = |x: f64, y: f64, from: f64| {
        (0..=8).map(move |i| {
            let a = from + f64::from(i) / 8.0 * std::f64::consts::FRAC_PI_2;
            fgm_core::Point2::new(x, y) + fgm_core::Point2::from_angle(a) * 0.3
        })
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let points = corner(9.7, 0.3, -quarter)
        .chain(corner(9.7, 0.6, 0.0))
        .chain(corner(0.3, 4.7, quarter))
        .chain(corner(0.3, 0.3, 2.0 * quarter));
    let part = [Polygon::simple(fgm_core::Ring::new(points.collect()))];
    let walls = walls(&part, &WallOptions::new(3, WIDTH, HEIGHT), &inset_default());
    let cover = cover(&part, &walls.paths, 0.02);
    assert!(cover.outside < 0.002, "{cover:?}");
}

fn inset_default() -> ClipperInset {
    ClipperInset::default()
}

#[test]
fn no_walls_leave_the_whole_region() {
    let region = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let (walls, _) = build(&region, 0, 0.0);
    assert!(walls.paths.is_empty());
    let spacing = bead::spacing(WIDTH, HEIGHT);
    let side = 10.0 - (WIDTH - spacing);
    assert!((region::area(&walls.inside) - side * side).abs() < 1e-3);
    assert_eq!(
        super::walls(&region, &WallOptions::new(2, f64::NAN, 0.2), &inset_default()),
        Walls::default()
    );
}
