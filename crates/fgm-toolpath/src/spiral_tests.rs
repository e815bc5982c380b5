use fgm_core::{ColorId, Role};
use proptest::prelude::*;

use super::*;

/// A star of `n` corners about the origin.
fn star(radii: &[f64], scale: f64, turned: f64) -> Vec<Point2> {
    let step = std::f64::consts::TAU / radii.len() as f64;
    let corner = |(i, r): (usize, &f64)| Point2::from_angle(turned + step * i as f64) * (scale * r);
    radii.iter().enumerate().map(corner).collect()
}

fn length(line: &[Point2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn around(ring: &[Point2]) -> f64 {
    length(ring) + ring[0].distance(ring[ring.len() - 1])
}

/// How far a point is from a line.
fn off(line: &[Point2], p: Point2) -> f64 {
    let ends = line.windows(2).map(|w| nearest_of((w[0], w[1]), p).distance(p));
    ends.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_square_that_grows_is_led_along_straight_sides() {
    let square = |half: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Point2::new(x * half, y * half))
    };
    let before = Turn::new(&square(10.0), Point2::new(10.0, 0.0)).unwrap();
    let now = Turn::new(&square(10.2), before.start()).unwrap();
    assert_eq!(now.start(), Point2::new(10.2, 0.0));
    let way = now.led_from(&before, 0.4);
    assert_eq!((way[0], way[way.len() - 1]), (before.start(), now.start()));
    // An eighth of the way round, and three eighths.
    for (at, share) in [(1, 0.125), (2, 0.375), (3, 0.625), (4, 0.875)] {
        let reach = way[at].abs().max_element();
        assert!((reach - (10.0 + 0.2 * share)).abs() < 1e-9, "{at}: {reach}");
    }
    // What is too far away is not followed, but for the way over to it.
    let far = Turn::new(&square(14.0), before.start()).unwrap().led_from(&before, 0.4);
    assert_eq!(far[..2], [Point2::new(10.0, 0.0), Point2::new(14.0, 0.0)]);
    assert!(far[2..].iter().all(|p| p.abs().max_element() == 14.0));
}

/// Both sides of a thin wall are within reach of each other.
#[test]
fn a_thin_part_is_not_led_from_its_other_side() {
    let thin = |by: f64| {
        [(-10.0, -0.1), (10.0, -0.1), (10.0, 0.1), (-10.0, 0.1)]
            .map(|(x, y)| Point2::new(x, y + by))
    };
    let before = Turn::new(&thin(0.0), Point2::new(0.0, -0.1)).unwrap();
    let now = Turn::new(&thin(0.15), before.start()).unwrap();
    let way = now.led_from(&before, 0.4);
    // Halfway round it is on the upper side, halfway between the two.
    let upper = way.windows(2).find(|w| w[0].x > 0.0 && w[1].x < 0.0 && w[0].y > 0.0).unwrap();
    let middle = 0.5 * (upper[0].y + upper[1].y);
    assert!((middle - (0.1 + 0.5 * 0.15)).abs() < 1e-3, "{way:?}");
}

#[test]
fn what_is_no_loop_has_no_turn() {
    let two = [Point2::ZERO, Point2::X];
    for ring in [&two[..], &[], &[Point2::ONE; 5], &[Point2::ZERO, Point2::X, Point2::NAN]] {
        assert!(Turn::new(ring, Point2::ZERO).is_none(), "{ring:?}");
    }
}

proptest! {
    #[test]
    fn a_turned_loop_closes_and_keeps_its_length(
        radii in prop::collection::vec(2.0..20.0f64, 3..40),
        x in -30.0..30.0f64,
        y in -30.0..30.0f64,
    ) {
        let (ring, near) = (star(&radii, 1.0, 0.3), Point2::new(x, y));
        let turn = Turn::new(&ring, near).unwrap();
        let line = turn.line();
        prop_assert_eq!(line[0], line[line.len() - 1]);
        prop_assert!((length(line) - around(&ring)).abs() < 1e-5);
        let closed: Vec<Point2> = ring.iter().chain(&ring[..1]).copied().collect();
        prop_assert!((turn.start().distance(near) - off(&closed, near)).abs() < 1e-9);
    }

    #[test]
    fn turns_follow_each_other(
        radii in prop::collection::vec(5.0..20.0f64, 3..40),
        scales in prop::collection::vec(0.99..1.01f64, 2..6),
    ) {
        let mut before = Turn::new(&star(&radii, 1.0, 0.0), Point2::new(9.0, 1.0)).unwrap();
        for scale in scales {
            let turn = Turn::new(&star(&radii, scale, 0.0), before.start()).unwrap();
            let way = turn.led_from(&before, 0.4);
            prop_assert_eq!(way[0], before.start());
            prop_assert_eq!(way[way.len() - 1], turn.start());
            // Between the two loops, which are nowhere farther apart than the corners.
            prop_assert!(way.iter().all(|&p| off(turn.line(), p) <= 0.4 + 1e-9));
            before = turn;
        }
    }

    #[test]
    fn fading_beads_have_the_volume_exactly(
        cuts in prop::collection::vec(1e-3..30.0f64, 1..12),
        from in 0.0..1.0f64,
        to in 0.0..1.0f64,
    ) {
        let mut x = 0.0;
        let pieces: Vec<Piece> = (0..)
            .zip(&cuts)
            .map(|(color, length)| {
                let points = vec![Point2::new(x, 0.0), Point2::new(x + length, 0.0)];
                x += length;
                Piece::new(points, Role::OuterWall, 0.4, ColorId(color))
            })
            .collect();
        let faded = fade(pieces.clone(), 0.2, from, to);
        let volume = |piece: &Piece| piece.length() * bead::area(piece.width, 0.2);
        let whole: f64 = pieces.iter().map(volume).sum();
        let found: f64 = faded.iter().map(volume).sum();
        prop_assert!((found - 0.5 * (from + to) * whole).abs() < 1e-6 * whole);
        // Nothing is left out, each place keeps its colour, and no step is more than two steps'.
        prop_assert!(faded.windows(2).all(|w| w[0].points.last() == w[1].points.first()));
        for color in 0..cuts.len() as u16 {
            let of = |all: &[Piece]| -> f64 {
                all.iter().filter(|p| p.color == ColorId(color)).map(Piece::length).sum()
            };
            prop_assert!((of(&faded) - of(&pieces)).abs() < 1e-6);
        }
        let area = |piece: &Piece| bead::area(piece.width, 0.2) / bead::area(0.4, 0.2);
        let most = (to - from).abs() * (1.01 / f64::from(STEPS)) + 1e-6;
        prop_assert!(faded.windows(2).all(|w| (area(&w[0]) - area(&w[1])).abs() <= most));
    }
}
