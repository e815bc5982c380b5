use super::*;
use proptest::prelude::*;

fn piece(points: &[(f64, f64)], color: u16, role: Role) -> Piece {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Piece::new(points, role, 0.4, ColorId(color))
}

fn plan(pieces: Vec<Piece>) -> LayerPlan {
    LayerPlan::new(3, 0.8, 0.2, pieces).unwrap()
}

/// Motions as text.
fn told(plan: &LayerPlan, previous: Option<ColorId>) -> String {
    let motion = |motion| match motion {
        Motion::Layer { index, z, height } => format!("layer {index} {z} {height}"),
        Motion::Rise { from, length } => format!("rise {from} {length}"),
        Motion::Color(color) => format!("color {}", color.0),
        Motion::Command(color) => format!("command {}", color.0),
        Motion::Travel { to } => format!("to {},{}", to.x, to.y),
        Motion::Extrude { to, .. } => format!("{},{}", to.x, to.y),
    };
    plan.motions(previous).map(motion).collect::<Vec<_>>().join("; ")
}

#[test]
fn a_layer_that_rises_says_so_first() {
    let flat = plan(vec![piece(&[(0.0, 0.0), (1.0, 0.0)], 2, Role::OuterWall)]);
    let rising = flat.clone().rising(Rise { from: 0.6, length: 1.0 }).unwrap();
    let told = told(&rising, None);
    assert_eq!(told, "layer 3 0.8 0.2; rise 0.6 1; color 2; to 0,0; 1,0");
    assert!(flat.rising(Rise { from: f64::NAN, length: 1.0 }).is_err());
}

#[test]
fn motions_of_a_layer() {
    let wall = Role::InnerWall;
    let a = piece(&[(0.0, 0.0), (1.0, 0.0)], 2, wall);
    for (pieces, previous, want) in [
        (vec![], None, ""),
        (vec![a.clone()], None, "; color 2; to 0,0; 1,0"),
        (vec![a.clone()], Some(2), "; to 0,0; 1,0"),
        (vec![a.clone()], Some(1), "; color 2; to 0,0; 1,0"),
        // Pieces that meet, and a point that stands twice.
        (
            vec![a.clone(), piece(&[(1.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 2, wall)],
            Some(2),
            "; to 0,0; 1,0; 2,0",
        ),
        (
            vec![a.clone(), piece(&[(1.0, 0.0), (2.0, 0.0)], 0, wall)],
            Some(2),
            "; to 0,0; 1,0; color 0; 2,0",
        ),
        (
            vec![a.clone(), piece(&[(5.0, 0.0), (6.0, 0.0)], 2, wall)],
            Some(2),
            "; to 0,0; 1,0; to 5,0; 6,0",
        ),
        // Nothing to print changes no colour.
        (
            vec![piece(&[], 7, wall), piece(&[(4.0, 4.0), (4.0, 4.0)], 7, wall), a.clone()],
            Some(2),
            "; to 0,0; 1,0",
        ),
    ] {
        let got = told(&plan(pieces), previous.map(ColorId));
        assert_eq!(got, format!("layer 3 0.8 0.2{want}"));
    }
}

#[test]
fn what_is_not_finite_is_refused() {
    let nan = piece(&[(0.0, 0.0), (f64::NAN, 0.0)], 0, Role::Infill);
    let wide = Piece { width: f64::INFINITY, ..piece(&[(0.0, 0.0), (1.0, 0.0)], 0, Role::Infill) };
    for (z, pieces, what, at) in [
        (f64::NAN, vec![], "height", 0),
        (0.2, vec![piece(&[(0.0, 0.0), (1.0, 0.0)], 0, Role::Infill), nan], "point", 1),
        (0.2, vec![wide], "width", 0),
    ] {
        let got = LayerPlan::new(7, z, 0.2, pieces);
        assert_eq!(got, Err(ToolpathError::NotFinite { layer: 7, piece: at, what }));
    }
}

#[test]
fn figures_of_a_layer() {
    let plan = plan(vec![
        piece(&[(0.0, 50.0), (10.0, 50.0)], 1, Role::PurgeTower),
        piece(&[(0.0, 0.0), (4.0, 0.0)], 1, Role::OuterWall),
        piece(&[(4.0, 0.0), (8.0, 0.0)], 1, Role::Infill),
        piece(&[(8.0, 0.0), (9.0, 0.0)], 2, Role::Infill),
        piece(&[(9.0, 3.0), (9.0, 20.0)], 2, Role::Infill),
        piece(&[(1.0, 1.0)], 3, Role::Infill),
    ]);
    let stats = plan.stats();
    let area = bead::area(0.4, 0.2);
    assert_eq!(stats.pieces, 5);
    assert_eq!(stats.color_changes, 1);
    assert_eq!(stats.short_pieces, 1);
    assert_eq!(stats.travels, 2);
    assert!((stats.travel - (2600.0_f64.sqrt() + 3.0)).abs() < 1e-9);
    assert!((stats.extruded - 36.0).abs() < 1e-12);
    assert!((stats.volume[&(ColorId(2), Role::Infill)] - 18.0 * area).abs() < 1e-12);
    assert!((stats.volume_of(Role::is_part) - 26.0 * area).abs() < 1e-12);
    assert_eq!(plan.first_color().zip(plan.last_color()), Some((ColorId(1), ColorId(2))));
    assert_eq!(plan.end(), Some(Point2::new(9.0, 20.0)));
    let mut twice = stats.clone();
    twice.add(&stats);
    assert_eq!((twice.pieces, twice.volume.len()), (10, 4));
}

proptest! {
    #[test]
    fn motions_lay_down_what_the_pieces_hold(
        pieces in prop::collection::vec(
            (prop::collection::vec((0..4i32, 0..4i32), 0..6), 0..3u16), 0..12),
        previous in prop::option::of(0..3u16),
    ) {
        let pieces: Vec<_> = pieces
            .iter()
            .map(|(points, color)| {
                let points: Vec<_> =
                    points.iter().map(|p| (f64::from(p.0), f64::from(p.1))).collect();
                piece(&points, *color, Role::Infill)
            })
            .collect();
        let plan = plan(pieces);
        let stats = plan.stats();
        let (mut at, mut color) = (None, previous.map(ColorId));
        let mut extruded: BTreeMap<ColorId, f64> = BTreeMap::new();
        let (mut travel, mut changes) = (0.0, 0);
        for motion in plan.motions(color) {
            match motion {
                Motion::Color(next) => {
                    prop_assert!(color != Some(next));
                    changes += usize::from(at.is_some());
                    color = Some(next);
                }
                Motion::Travel { to } => {
                    travel += at.map_or(0.0, |at: Point2| at.distance(to));
                    at = Some(to);
                }
                Motion::Extrude { to, .. } => {
                    let length = at.unwrap().distance(to);
                    prop_assert!(length > 0.0);
                    *extruded.entry(color.unwrap()).or_default() += length;
                    at = Some(to);
                }
                _ => {}
            }
        }
        prop_assert!((travel - stats.travel).abs() < 1e-9);
        prop_assert_eq!(changes, stats.color_changes);
        prop_assert!((extruded.values().sum::<f64>() - stats.extruded).abs() < 1e-9);
        for (color, length) in extruded {
            let volume = stats.volume[&(color, Role::Infill)];
            prop_assert!((volume - length * bead::area(0.4, 0.2)).abs() < 1e-9);
        }
        prop_assert_eq!(at, plan.end());
    }
}

#[test]
fn ways_are_travelled_over_from_where_they_begin() {
    let mut second = piece(&[(5.0, 0.0), (6.0, 0.0)], 0, Role::Infill);
    second.way = vec![Point2::new(1.0, 0.0), Point2::new(1.0, 3.0), Point2::new(5.0, 3.0)];
    let first = piece(&[(0.0, 0.0), (1.0, 0.0)], 0, Role::Infill);
    let travels = |pieces: Vec<Piece>| -> (Vec<Point2>, f64) {
        let plan = LayerPlan::new(0, 0.2, 0.2, pieces).unwrap();
        let to = |m| if let Motion::Travel { to } = m { Some(to) } else { None };
        (plan.motions(Some(ColorId(0))).filter_map(to).collect(), plan.stats().travel)
    };
    let ends = [Point2::ZERO, Point2::new(5.0, 0.0)];
    let (way, length) = travels(vec![first.clone(), second.clone()]);
    assert_eq!(way, [ends[0], second.way[1], second.way[2], ends[1]]);
    assert_eq!(length, 10.0);
    // Where something came between, the way is no longer one.
    let between = piece(&[(1.0, 0.0), (2.0, 0.0)], 0, Role::PurgeTower);
    let (way, length) = travels(vec![first, between, second.clone()]);
    assert_eq!((way, length), (ends.to_vec(), 3.0));
    let plan = LayerPlan::new(1, 0.4, 0.2, vec![second.clone()]).unwrap();
    let count = |end| plan.motions_from(end, None).count();
    assert_eq!(count(Some(second.way[0])) - count(None), 2);
}
