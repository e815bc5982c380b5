use fgm_core::{ColorId, Ring, Role};
use proptest::prelude::*;

use super::*;
use crate::ClipperInset;

fn points(points: &[(f64, f64)]) -> Vec<Point2> {
    points.iter().map(|&(x, y)| Point2::new(x, y)).collect()
}

fn polygon(corners: &[(f64, f64)]) -> Polygon {
    Polygon::simple(Ring::new(points(corners)))
}

fn dot(p: (f64, f64)) -> Piece {
    Piece::new(points(&[p, p]), Role::Infill, 0.4, ColorId(0))
}

/// The way between two places, its ends included; two points where it is straight.
fn way(region: &[Polygon], from: (f64, f64), to: (f64, f64), max_detour: f64) -> Vec<Point2> {
    let mut pieces = [dot(from), dot(to)];
    let options = WayOptions { width: 0.4, max_detour };
    let border = Support::new(region);
    find_ways(&mut pieces, None, region, &border, &options, &ClipperInset::default());
    let mut way = pieces[1].way.clone();
    if way.is_empty() {
        way.push(pieces[0].points[0]);
    }
    way.push(pieces[1].points[0]);
    way
}

fn length(way: &[Point2]) -> f64 {
    way.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn horseshoe() -> Vec<Polygon> {
    vec![polygon(&[
        (0.0, 0.0),
        (20.0, 0.0),
        (20.0, 20.0),
        (12.0, 20.0),
        (12.0, 8.0),
        (8.0, 8.0),
        (8.0, 20.0),
        (0.0, 20.0),
    ])]
}

#[test]
fn from_arm_to_arm_round_the_gap() {
    let around = way(&horseshoe(), (4.0, 18.0), (16.0, 18.0), 100.0);
    // Round the gap's two lower corners, a bead off them.
    assert_eq!(around.len(), 4, "{around:?}");
    let shortest = 2.0 * (10.4_f64.hypot(3.6)) + 4.8;
    assert!((length(&around) - shortest).abs() < 0.05, "{} {shortest}", length(&around));
    // From the outer wall to the outer wall, and in arms that have no room behind it.
    let walls = way(&horseshoe(), (7.8, 18.0), (12.2, 18.0), 100.0);
    assert!(walls.len() > 3 && walls[1..walls.len() - 1].iter().all(|p| p.y < 18.0), "{walls:?}");
    let thin = [polygon(&[
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, 9.0),
        (4.5, 9.0),
        (4.5, 0.5),
        (0.5, 0.5),
        (0.5, 9.0),
        (0.0, 9.0),
    ])];
    assert_eq!(way(&thin, (0.25, 8.0), (4.75, 8.0), 100.0).len(), 4);
    // Not where that is too far, and straight where nothing is in the way.
    assert_eq!(way(&horseshoe(), (4.0, 18.0), (16.0, 18.0), 10.0).len(), 2);
    assert_eq!(way(&horseshoe(), (4.0, 4.0), (16.0, 4.0), 100.0).len(), 2);
}

#[test]
fn round_a_hole_the_shorter_way() {
    let mut plate = polygon(&[(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)]);
    let hole = |k: u32| {
        let (y, x) = (-f64::from(k) * std::f64::consts::TAU / 60.0).sin_cos();
        (20.0 + 10.0 * x, 20.0 + 10.0 * y)
    };
    plate.holes.push(polygon(&(0..60).map(hole).collect::<Vec<_>>()).outer);
    let plate = [plate];
    for y in [19.0, 21.0] {
        let around = way(&plate, (5.0, y), (35.0, y), 100.0);
        let side = around.iter().all(|p| (p.y >= y - 1e-9) == (y > 20.0) || (p.y - y).abs() < 1e-9);
        assert!(side, "{around:?}");
        // Tangents and the arc between them, roughly.
        assert!((35.8..36.6).contains(&length(&around)), "{}", length(&around));
    }
}

#[test]
fn no_way_where_there_is_none() {
    let two = [
        polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]),
        polygon(&[(12.0, 0.0), (22.0, 0.0), (22.0, 10.0), (12.0, 10.0)]),
    ];
    assert_eq!(way(&two, (5.0, 5.0), (17.0, 5.0), 1e3).len(), 2);
    // From outside, such as from a tower.
    assert_eq!(way(&two, (-5.0, 5.0), (17.0, 5.0), 1e3).len(), 2);
    let region = horseshoe();
    let mut tower = [dot((4.0, 18.0)), Piece { role: Role::PurgeTower, ..dot((16.0, 18.0)) }];
    let options = WayOptions { width: 0.4, max_detour: 1e3 };
    let (border, inset) = (Support::new(&region), ClipperInset::default());
    find_ways(&mut tower, None, &region, &border, &options, &inset);
    assert!(tower[1].way.is_empty());
    // To the first piece from where the layer before ended.
    let mut first = [dot((16.0, 18.0))];
    find_ways(&mut first, Some(Point2::new(4.0, 18.0)), &region, &border, &options, &inset);
    assert_eq!(first[0].way[0], Point2::new(4.0, 18.0));
}

/// A comb: teeth of 4 mm along a spine, 4 mm apart.
fn comb(teeth: u32, deep: f64) -> Vec<Polygon> {
    let mut corners = vec![(0.0, 0.0), (8.0 * f64::from(teeth) - 4.0, 0.0)];
    for tooth in (0..teeth).rev() {
        let x = 8.0 * f64::from(tooth);
        corners.extend([(x + 4.0, 4.0 + deep), (x, 4.0 + deep)]);
        if tooth > 0 {
            corners.extend([(x, 4.0), (x - 4.0, 4.0)]);
        }
    }
    vec![polygon(&corners)]
}

proptest! {
    #[test]
    fn ways_never_leave_the_part(
        teeth in 2..8u32,
        deep in 2.0..20.0f64,
        turn in 0.0..6.0f64,
        from in (0..8u32, 0.2..3.8f64, 0.0..1.0f64),
        to in (0..8u32, 0.2..3.8f64, 0.0..1.0f64),
    ) {
        let region = comb(teeth, deep);
        let place = |(tooth, x, y): (u32, f64, f64)| {
            (8.0 * f64::from(tooth % teeth) + x, 0.2 + y * (3.6 + deep))
        };
        let turned = |p: Point2| Point2::from_angle(turn).rotate(p);
        let ring = Ring::new(region[0].outer.points.iter().map(|&p| turned(p)).collect());
        let region = [Polygon::simple(ring)];
        let at = |p| { let q = turned(Point2::from(place(p))); (q.x, q.y) };
        let found = way(&region, at(from), at(to), 1e4);
        let border = Support::new(&region);
        let mut crossings = Vec::new();
        for w in found.windows(2) {
            border.crossings(w[0], w[1], &mut crossings);
        }
        prop_assert!(crossings.is_empty(), "{:?}", found);
        // Along the spine is never much longer.
        let (a, b) = (Point2::from(place(from)), Point2::from(place(to)));
        let least = (a.x - b.x).hypot((a.y - b.y).max(0.0));
        prop_assert!(length(&found) <= least + a.y + b.y + 1.0, "{:?}", found);
    }
}
