use fgm_core::{ColorId, Point2, Polygon, Ring};
use proptest::prelude::*;

use super::*;

fn points(points: &[(f64, f64)]) -> Vec<Point2> {
    points.iter().map(|&(x, y)| Point2::new(x, y)).collect()
}

fn square(half: f64) -> Vec<Polygon> {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    vec![Polygon::simple(Ring::new(points(&corners)))]
}

fn wall(line: &[(f64, f64)]) -> Piece {
    Piece::new(points(line), Role::OuterWall, 0.4, ColorId(0))
}

/// The stretches of a wall over a square of 20 mm, as `role:length`.
fn marked(line: &[(f64, f64)], share: f64) -> String {
    let below = Support::new(&square(10.0));
    let pieces = mark_overhangs(vec![wall(line)], &below, share, |_| true);
    let told = |p: &Piece| format!("{}:{:.2}", p.role.overhang(), p.length());
    pieces.iter().map(told).collect::<Vec<_>>().join(" ")
}

#[test]
fn walls_hang_over_by_their_distance_from_the_border() {
    for (x, want) in [(9.8, 0), (9.89, 0), (9.91, 1), (10.05, 2), (10.12, 3), (30.0, 3)] {
        let line = [(x, -5.0), (x, 5.0)];
        assert_eq!(marked(&line, 0.25), format!("{want}:10.00"), "{x}");
    }
    // A quarter and a half are no more than a half; then nothing is slight.
    for (x, want) in [(9.9, 0), (10.1, 3)] {
        assert_eq!(marked(&[(x, -5.0), (x, 5.0)], 0.5), format!("{want}:10.00"), "{x}");
    }
}

#[test]
fn a_wall_out_over_air_is_cut_at_the_border() {
    // At a right angle to it: what is slight and half is too short to tell.
    assert_eq!(marked(&[(5.0, 0.0), (15.0, 0.0)], 0.25), "0:4.90 3:5.10");
    // At a slant the degrees come one after the other.
    assert_eq!(marked(&[(-10.0, 9.0), (10.0, 11.0)], 0.25), "0:9.04 1:1.00 2:1.00 3:9.04");
    // Over a corner's tip and back.
    assert_eq!(marked(&[(9.0, 9.5), (9.0, 11.0), (0.0, 11.0)], 0.25), "0:0.40 3:10.10");
    assert_eq!(marked(&[(-20.0, 0.0), (20.0, 0.0)], 0.25), "3:10.10 0:19.80 3:10.10");
}

#[test]
fn a_wall_at_a_degrees_limit_hangs_over_all_the_same() {
    // To and fro over the border, every stretch shorter than a bead is wide, after one that is held.
    let zigzag =
        |i: u32| (f64::from(i) * 0.2 - 9.0, if i.is_multiple_of(2) { 9.95 } else { 10.05 });
    let line: Vec<(f64, f64)> =
        [(-9.0, 5.0), (-9.0, 9.0)].into_iter().chain((1..90).map(zigzag)).collect();
    let told = marked(&line, 0.25);
    assert!(told == "0:4.92 1:19.83", "{told}");
}

#[test]
fn nothing_below_and_nothing_to_mark() {
    let none = Support::new(&[]);
    let marked = mark_overhangs(vec![wall(&[(0.0, 0.0), (5.0, 0.0)])], &none, 0.25, |_| true);
    assert_eq!(marked[0].role, Role::FullOverhang);
    let skin = Piece { role: Role::TopSkin, ..wall(&[(0.0, 0.0), (5.0, 0.0)]) };
    let walls = |role| role == Role::OuterWall;
    assert_eq!(mark_overhangs(vec![skin.clone()], &none, 0.25, walls), [skin]);
    let empty = wall(&[]);
    assert_eq!(mark_overhangs(vec![empty.clone()], &none, 0.25, |_| true), [empty]);
}

proptest! {
    #[test]
    fn no_length_is_lost_and_pieces_meet(
        line in prop::collection::vec((-14.0..14.0f64, -14.0..14.0f64), 2..12),
        share in 0.0..0.5f64,
        half in 1.0..12.0f64,
    ) {
        let mut region = square(half);
        region[0].holes.push(Ring::new(points(&[(-0.5, -0.5), (0.0, 0.7), (0.5, -0.5)])));
        let below = Support::new(&region);
        let piece = wall(&line);
        let marked = mark_overhangs(vec![piece.clone()], &below, share, |_| true);
        let length: f64 = marked.iter().map(Piece::length).sum();
        prop_assert!((length - piece.length()).abs() < 1e-9);
        for pair in marked.windows(2) {
            prop_assert_eq!(pair[0].points.last(), pair[1].points.first());
            prop_assert_ne!(pair[0].role, pair[1].role);
        }
    }
}
