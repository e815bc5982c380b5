use super::*;
use fgm_core::Role;
use proptest::prelude::*;

fn piece(points: &[(f64, f64)], color: u16) -> Piece {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Piece::new(points, Role::SolidInfill, 0.4, ColorId(color))
}

fn square(x: f64, y: f64, color: u16) -> Vec<Piece> {
    let (u, v) = (x + 1.0, y + 1.0);
    vec![piece(&[(x, y), (u, y), (u, v), (x, v), (x, y)], color)]
}

fn travel(pieces: &[Piece], start: Point2) -> f64 {
    let mut at = start;
    let mut sum = 0.0;
    for piece in pieces {
        sum += at.distance(piece.points[0]);
        at = piece.points[piece.points.len() - 1];
    }
    sum
}

fn length(pieces: &[Piece]) -> f64 {
    let step = |p: &Piece| p.points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    pieces.iter().map(step).sum()
}

fn starts(pieces: &[Piece]) -> Vec<(f64, f64)> {
    pieces.iter().map(|p| (p.points[0].x, p.points[0].y)).collect()
}

#[test]
fn colours_follow_as_asked_and_routes_as_they_lie() {
    let routes =
        vec![square(0.0, 0.0, 1), square(9.0, 0.0, 1), square(9.0, 5.0, 0), square(0.0, 5.0, 0)];
    let out = order_routes(routes, &[ColorId(0), ColorId(1)], Point2::new(0.0, 9.0));
    let colors: Vec<_> = out.iter().map(|p| p.color.0).collect();
    assert_eq!(colors, [0, 0, 1, 1]);
    // Down the right side and back, not across twice.
    assert_eq!(starts(&out), [(1.0, 6.0), (9.0, 5.0), (9.0, 1.0), (1.0, 1.0)]);
}

#[test]
fn a_colour_is_come_back_to_where_changes_cost_less_than_the_way() {
    let heap = |x: f64| (0..3).map(move |color| square(x, 2.0 * f64::from(color), color));
    let routes: Vec<_> = heap(0.0).chain(heap(90.0)).collect();
    let sequence = [0, 1, 2].map(ColorId);
    let colors = |costs: f64| {
        let change = move |a: ColorId, b: ColorId| costs * f64::from(a.0.abs_diff(b.0));
        let order = ColorOrder { sequence: &sequence, change: Some(&change), via: None };
        let out = order_routes(routes.clone(), order, Point2::ZERO);
        (out.iter().map(|p| p.color.0).collect::<Vec<_>>(), travel(&out, Point2::ZERO))
    };
    let ((near, way), (one_by_one, long)) = (colors(5.0), colors(1e3));
    assert_eq!(near.windows(2).filter(|w| w[0] == w[1]).count(), 2, "{near:?}");
    assert_eq!(one_by_one, [0, 0, 1, 1, 2, 2]);
    assert!(way < 200.0 && long > 260.0, "{way}, {long}");
}

#[test]
fn a_far_route_does_not_cost_a_way_back() {
    // From the second colour's two places the third is at one only: end there.
    let routes = vec![
        square(0.0, 0.0, 0),
        square(2.0, 0.0, 1),
        square(90.0, 0.0, 1),
        square(2.0, 2.0, 2),
        square(90.0, 2.0, 2),
    ];
    let out = order_routes(routes, &[0, 1, 2].map(ColorId), Point2::ZERO);
    assert!(travel(&out, Point2::ZERO) < 190.0, "{:?}", starts(&out));
}

#[test]
fn a_route_with_a_travel_of_its_own_is_begun_there() {
    let route = vec![piece(&[(0.0, 0.0), (10.0, 0.0)], 0), piece(&[(10.2, 0.0), (20.0, 0.0)], 0)];
    for (start, first) in [((-1.0, 0.0), (0.0, 0.0)), ((21.0, 0.0), (20.0, 0.0))] {
        let start = Point2::new(start.0, start.1);
        // What comes last is to end near the start of the layer: nothing to choose here.
        let routes = vec![route.clone(), square(first.0, 30.0, 1)];
        let out = order_routes(routes, &[ColorId(0), ColorId(1)], start);
        assert_eq!(out[0].points.len(), 2, "{out:?}");
        assert_eq!(starts(&out)[0], first);
    }
}

#[test]
fn empty_pieces_and_nonsense_are_dropped() {
    let nan = piece(&[(f64::NAN, 0.0), (1.0, 1.0)], 0);
    let routes = vec![vec![], vec![piece(&[], 0)], vec![nan], square(0.0, 0.0, 9)];
    assert_eq!(order_routes(routes, &[], Point2::ZERO).len(), 1);
    assert!(order_routes(Vec::new(), &[ColorId(0)], Point2::ZERO).is_empty());
}

prop_compose! {
    fn routes()(
        routes in prop::collection::vec(
            (0..4u16, prop::collection::vec(
                prop::collection::vec((0.0..50.0f64, 0.0..50.0f64), 2..5), 1..4)), 0..15),
    ) -> Vec<Vec<Piece>> {
        let route = |(color, lines): (u16, Vec<Vec<(f64, f64)>>)| {
            lines.iter().map(|line| piece(line, color)).collect()
        };
        routes.into_iter().map(route).collect()
    }
}

proptest! {
    #[test]
    fn everything_is_kept(routes in routes(), x in 0.0..50.0f64) {
        let colors = [2, 0, 1].map(ColorId);
        let start = Point2::new(x, 0.0);
        let before: f64 = routes.iter().map(|route| length(route)).sum();
        let count: usize = routes.iter().map(|route| route.len() + 1).sum();
        let out = order_routes(routes.clone(), &colors, start);
        prop_assert!((length(&out) - before).abs() < 1e-6);
        prop_assert!(out.len() <= count);
        let ranks: Vec<_> = out.iter().map(|p| [1, 2, 0, 3][usize::from(p.color.0)]).collect();
        prop_assert!(ranks.is_sorted());
        prop_assert_eq!(out, order_routes(routes, &colors, start));
    }

    #[test]
    fn a_few_routes_are_in_the_best_sequence(
        places in prop::collection::vec((0..60i32, 0..60i32), 1..6),
    ) {
        // Squares so small that where they are entered does not matter.
        let dot = |&(x, y): &(i32, i32)| {
            let (x, y) = (f64::from(x), f64::from(y));
            vec![piece(&[(x, y), (x + 1e-4, y), (x, y + 1e-4), (x, y)], 0)]
        };
        let out = order_routes(places.iter().map(dot).collect(), &[ColorId(0)], Point2::ZERO);
        let mut best = f64::INFINITY;
        permute(&mut places.clone(), 0, &mut |places| {
            let mut at = Point2::ZERO;
            let mut sum = 0.0;
            for &(x, y) in places {
                let p = Point2::new(f64::from(x), f64::from(y));
                sum += at.distance(p);
                at = p;
            }
            best = best.min(sum);
        });
        let own = travel(&out, Point2::ZERO);
        // The last one may be left towards the start.
        prop_assert!(own <= best + 0.01, "{own} for {best}");
    }
}

type Places = Vec<(i32, i32)>;

fn permute(places: &mut Places, from: usize, visit: &mut dyn FnMut(&Places)) {
    if from == places.len() {
        return visit(places);
    }
    for i in from..places.len() {
        places.swap(from, i);
        permute(places, from + 1, visit);
        places.swap(from, i);
    }
}
