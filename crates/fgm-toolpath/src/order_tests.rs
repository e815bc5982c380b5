use super::*;
use crate::begin_at_seams;
use fgm_core::ColorId;
use proptest::prelude::*;

fn piece(points: &[(f64, f64)], color: u16, role: Role) -> Piece {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Piece::new(points, role, 0.4, ColorId(color))
}

fn line(points: &[(f64, f64)]) -> Piece {
    piece(points, 0, Role::Infill)
}

/// Pieces as text: `color:x,y x,y`.
fn told(pieces: &[Piece]) -> String {
    let piece = |p: &Piece| {
        let points: Vec<_> = p.points.iter().map(|q| format!("{},{}", q.x, q.y)).collect();
        format!("{}:{}", p.color.0, points.join(" "))
    };
    pieces.iter().map(piece).collect::<Vec<_>>().join(" | ")
}

fn ids(colors: &[u16]) -> Vec<ColorId> {
    colors.iter().copied().map(ColorId).collect()
}

const SQUARE: [(f64, f64); 5] = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0)];

#[test]
fn orders() {
    let (a, b) = ([(0.0, 0.0), (1.0, 0.0)], [(3.0, 0.0), (1.5, 0.0)]);
    for (pieces, colors, want) in [
        (vec![], &[0][..], ""),
        // From either end, the nearest first.
        (vec![line(&b), line(&a)], &[0], "0:0,0 1,0 | 0:1.5,0 3,0"),
        // Colour by colour; colours not asked for come last.
        (
            vec![
                piece(&a, 7, Role::Infill),
                piece(&a, 0, Role::Infill),
                piece(&b, 2, Role::Infill),
            ],
            &[2, 0],
            "2:1.5,0 3,0 | 0:1,0 0,0 | 7:0,0 1,0",
        ),
        // A loop from its nearest vertex, in its own direction.
        (
            vec![line(&[(3.0, 3.0), (4.0, 3.0)]), line(&SQUARE), line(&[(1.4, 0.0), (2.0, 0.5)])],
            &[0],
            "0:1.4,0 2,0.5 | 0:2,1 2,2 1,2 1,1 2,1 | 0:3,3 4,3",
        ),
        // Meeting ends are a chain, entered at its end, not at its nearest joint.
        (
            vec![line(&[(5.0, 0.0), (0.0, 1.0)]), line(&[(0.0, 1.0), (-1.0, 5.0)])],
            &[0],
            "0:5,0 0,1 | 0:0,1 -1,5",
        ),
        // A purge goes before the part, wherever it is.
        (
            vec![line(&a), piece(&[(50.0, 0.0), (60.0, 0.0)], 0, Role::PurgeTower)],
            &[0],
            "0:50,0 60,0 | 0:1,0 0,0",
        ),
    ] {
        assert_eq!(told(&order(pieces, &ids(colors), Point2::ZERO)), want);
    }
}

#[test]
fn seams_and_roles() {
    let outer = || piece(&SQUARE, 0, Role::OuterWall);
    let spike = [(0.0, 0.0), (2.0, 0.0), (5.0, 0.5), (2.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
    for (seam, pieces, want) in [
        (Seam::Nearest, vec![outer()], "0:1,1 2,1 2,2 1,2 1,1"),
        (Seam::Rear, vec![outer()], "0:2,2 1,2 1,1 2,1 2,2"),
        (Seam::Sharpest, vec![piece(&spike, 0, Role::OuterWall)], "0:5,0.5 2,1 0,1 0,0 2,0 5,0.5"),
        (Seam::Aligned, vec![outer()], "0:2,1 2,2 1,2 1,1 2,1"),
        (Seam::Rear, vec![piece(&SQUARE, 0, Role::InnerWall)], "0:1,1 2,1 2,2 1,2 1,1"),
        (Seam::Random, vec![piece(&SQUARE, 0, Role::InnerWall)], "0:1,1 2,1 2,2 1,2 1,1"),
    ] {
        let seam_point = Point2::new(9.0, 1.0);
        let options = OrderOptions { seam, seam_point, ..OrderOptions::default() };
        assert_eq!(told(&order_with(pieces, &[], Point2::ZERO, &options)), want);
    }
    let all = [Role::Infill, Role::OuterWall, Role::InnerWall];
    for (roles, want) in [
        (RoleOrder::OuterFirst, [Role::OuterWall, Role::InnerWall, Role::Infill]),
        (RoleOrder::InnerFirst, [Role::InnerWall, Role::OuterWall, Role::Infill]),
    ] {
        let pieces = all.iter().map(|&r| piece(&[(0.0, 0.0), (1.0, 0.0)], 0, r)).collect();
        let options = OrderOptions { roles, ..OrderOptions::default() };
        let got = order_with(pieces, &[], Point2::ZERO, &options);
        assert_eq!(got.iter().map(|p| p.role).collect::<Vec<_>>(), want);
    }
}

/// Along a square of length 4, by the quarter that the seam falls into.
#[test]
fn random_seams_are_spread_and_repeat() {
    let mut quarters = [0; 4];
    for layer in 0..400 {
        let options = OrderOptions { seam: Seam::Random, layer, ..OrderOptions::default() };
        let run =
            || order_with(vec![piece(&SQUARE, 0, Role::OuterWall)], &[], Point2::ZERO, &options);
        let got = run();
        assert_eq!(got, run());
        assert!(got[0].is_loop() && (got[0].length() - 4.0).abs() < 1e-9, "{}", told(&got));
        let start = got[0].points[0];
        let side = [start.y == 1.0, start.x == 2.0, start.y == 2.0, start.x == 1.0];
        quarters[side.iter().position(|on| *on).unwrap()] += 1;
        let corners = SQUARE.iter().all(|&(x, y)| got[0].points.contains(&Point2::new(x, y)));
        assert!(corners, "{}", told(&got));
    }
    assert!(quarters.iter().all(|n| (70..130).contains(n)), "{quarters:?}");
}

#[test]
fn odd_pieces_are_kept() {
    let pieces = vec![
        line(&[]),
        line(&[(1.0, 1.0)]),
        line(&[(f64::NAN, 0.0), (1.0, f64::INFINITY)]),
        line(&[(2.0, 2.0), (2.0, 2.0)]),
        line(&[(2.0, 2.0), (2.0, 2.0), (2.0, 2.0)]),
        line(&[(f64::INFINITY, 0.0), (1.0, 0.0)]),
        line(&[(0.0, 0.0), (1.0, 0.0)]),
    ];
    let got = order(pieces, &ids(&[0]), Point2::new(f64::NAN, 0.0));
    let mut counts: Vec<_> = got.iter().map(|p| p.points.len()).collect();
    counts.sort_unstable();
    assert_eq!(counts, [0, 1, 2, 2, 2, 2, 3]);
}

/// A piece without its direction or start.
fn bare(piece: &Piece) -> (u16, u8, Vec<(u64, u64)>) {
    let mut points = piece.points.clone();
    if piece.is_loop() {
        points.pop();
    }
    let mut points: Vec<_> = points.iter().map(|p| (p.x.to_bits(), p.y.to_bits())).collect();
    points.sort_unstable();
    (piece.color.0, piece.role as u8, points)
}

fn any_pieces() -> impl Strategy<Value = Vec<Piece>> {
    let along = prop_oneof![(0..6i32).prop_map(f64::from), 0.0..6.0f64];
    let one = (prop::collection::vec((along.clone(), along), 0..6), 0..4u16, any::<bool>());
    let role = prop::sample::select(&Role::ALL[..]);
    prop::collection::vec((one, role), 0..40).prop_map(|pieces| {
        pieces
            .into_iter()
            .map(|((mut points, color, closed), role)| {
                if closed {
                    points.extend(points.first().copied());
                }
                piece(&points, color, role)
            })
            .collect()
    })
}

proptest! {
    #[test]
    fn every_piece_is_kept_once(
        pieces in any_pieces(),
        colors in prop::collection::vec(0..5u16, 0..5),
        improve in 0..100u32,
        seam in prop::sample::select(&[Seam::Nearest, Seam::Aligned, Seam::Rear, Seam::Sharpest][..]),
    ) {
        let options = OrderOptions { improve, seam, ..OrderOptions::default() };
        let run = || order_with(pieces.clone(), &ids(&colors), Point2::ZERO, &options);
        let got = run();
        prop_assert_eq!(&got, &run());
        let sorted = |pieces: &[Piece]| {
            let mut all: Vec<_> = pieces.iter().map(bare).collect();
            all.sort();
            all
        };
        prop_assert_eq!(sorted(&got), sorted(&pieces));
        let lengths = |pieces: &[Piece]| pieces.iter().map(Piece::length).sum::<f64>();
        prop_assert!((lengths(&got) - lengths(&pieces)).abs() < 1e-9);
        // Colours in one block each, in the order asked for.
        let mut blocks: Vec<_> = got.iter().map(|p| p.color).collect();
        blocks.dedup();
        let rank = |c: &ColorId| colors.iter().position(|&k| k == c.0).unwrap_or(usize::MAX);
        prop_assert!(blocks.windows(2).all(|w| (rank(&w[0]), w[0]) < (rank(&w[1]), w[1])));
    }

    #[test]
    fn improving_never_lengthens_the_travels_of_one_colour(pieces in any_pieces()) {
        let one: Vec<_> =
            pieces.into_iter().map(|p| Piece { color: ColorId(0), role: Role::Infill, ..p }).collect();
        let travel = |improve| {
            let options = OrderOptions { improve, ..OrderOptions::default() };
            let got = order_with(one.clone(), &[], Point2::ZERO, &options);
            let mut at = Point2::ZERO;
            let mut sum = 0.0;
            for p in got.iter().filter(|p| p.points.len() > 1) {
                sum += at.distance(p.points[0]);
                at = p.points[p.points.len() - 1];
            }
            sum
        };
        prop_assert!(travel(64) <= travel(0) + 1e-6);
    }
}

#[test]
fn a_hidden_seam_lies_in_a_corner_that_goes_into_the_part() {
    // A square with a notch in its lower side; then without.
    let notched =
        [(0.0, 0.0), (4.0, 0.0), (5.0, 3.0), (6.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
    let closed = |corners: &[(f64, f64)]| {
        let mut corners = corners.to_vec();
        corners.push(corners[0]);
        piece(&corners, 0, Role::OuterWall)
    };
    let options = OrderOptions { seam: Seam::Hidden, ..OrderOptions::default() };
    let start =
        |wall: Piece| order_with(vec![wall], &[], Point2::new(10.0, 10.0), &options)[0].points[0];
    assert_eq!(start(closed(&notched)), Point2::new(5.0, 3.0));
    let square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
    assert_eq!(start(closed(&square)), Point2::new(9.0, 9.0));
    // A hole runs the other way round: every corner of it goes into the part.
    let hole: Vec<(f64, f64)> = square.iter().rev().copied().collect();
    let corners: Vec<Point2> = square.iter().map(|&p| p.into()).collect();
    assert!(corners.contains(&start(closed(&hole))));
    // Loops that are in order already, of any role.
    let mut loops = vec![Piece { role: Role::SolidInfill, ..closed(&notched) }];
    begin_at_seams(&mut loops, &options);
    assert_eq!(loops[0].points[0], Point2::new(5.0, 3.0));
    assert!(loops[0].is_loop() && loops[0].points.len() == 8);
    let open = vec![piece(&notched, 0, Role::SolidInfill)];
    let mut kept = open.clone();
    begin_at_seams(&mut kept, &options);
    assert_eq!(kept, open);
}

#[test]
fn a_colour_is_begun_and_ended_near_the_place_between_colours() {
    // Scattered, as multiples of the golden ratio are.
    let at =
        |i: u16| (97.0 * f64::from(i) * 0.618_034 % 97.0, 61.0 * f64::from(i) * 0.414_214 % 61.0);
    let line = |i: u16| {
        let (x, y) = at(i);
        piece(&[(x, y), (x + 3.0, y)], i % 2, Role::Infill)
    };
    let pieces: Vec<Piece> = (0..60).map(line).collect();
    let colors = ids(&[0, 1]);
    let via = Point2::new(-30.0, 30.0);
    let order = ColorOrder { via: Some(via), ..ColorOrder::from(&colors) };
    let way = |order: ColorOrder<'_>| {
        let out = order_with(pieces.clone(), order, Point2::ZERO, &OrderOptions::default());
        let end = |p: &Piece| (p.points[0], p.points[p.points.len() - 1]);
        assert_eq!(out.len(), 60);
        // From the place to each colour and back.
        let colors = out.chunk_by(|a, b| a.color == b.color);
        let trips = colors.map(|run| {
            let inside = run.windows(2).map(|w| end(&w[0]).1.distance(end(&w[1]).0));
            let (first, last) = (end(&run[0]).0, end(&run[run.len() - 1]).1);
            via.distance(first) + inside.sum::<f64>() + last.distance(via)
        });
        trips.sum::<f64>()
    };
    let (plain, near) = (way(ColorOrder::from(&colors)), way(order));
    assert!(near < plain - 20.0, "{near}, {plain}");
}
