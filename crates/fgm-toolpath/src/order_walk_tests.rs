use super::*;
use proptest::prelude::*;

fn by(costs: f64) -> impl Fn(ColorId, ColorId) -> f64 {
    move |a, b| costs * (f64::from(a.0) - f64::from(b.0)).abs()
}

fn open(color: u16, enter: (f64, f64), exit: (f64, f64)) -> Part {
    let (enter, exit) = (Point2::from(enter), Point2::from(exit));
    let door = |enter, exit, back| Door { enter, exit, cost: 0.0, back };
    Part { color: ColorId(color), doors: vec![door(enter, exit, 1), door(exit, enter, 0)] }
}

fn round(color: u16, places: &[(f64, f64)]) -> Part {
    let door = |(&p, back): (&(f64, f64), u32)| Door {
        enter: Point2::from(p),
        exit: Point2::from(p),
        cost: 0.0,
        back,
    };
    Part { color: ColorId(color), doors: places.iter().zip(0..).map(door).collect() }
}

/// Travels and changes from `start` through the tour and back.
fn cost(parts: &[Part], tour: &[Stop], ends: (u16, u16), start: Point2, change: Change<'_>) -> f64 {
    let (mut at, mut color, mut sum) = (start, ColorId(ends.0), 0.0);
    for &(part, door) in tour {
        let door = parts[part].doors[door as usize];
        sum += at.distance(door.enter) + door.cost + change(color, parts[part].color);
        (at, color) = (door.exit, parts[part].color);
    }
    sum + at.distance(start) + change(color, ColorId(ends.1))
}

fn ends(parts: &[Part], tour: &[Stop]) -> (u16, u16) {
    let color = |stop: Option<&Stop>| stop.map_or(0, |&(part, _)| parts[part].color.0);
    (color(tour.first()), color(tour.last()))
}

#[test]
fn parts_near_each_other_follow_where_changes_are_cheap() {
    // Two heaps of three colours each, 100 mm apart.
    let parts: Vec<Part> = (0..6)
        .map(|i| {
            let (color, x) = (i / 2, f64::from(i % 2) * 100.0);
            open(color as u16, (x, f64::from(color)), (x + 0.5, f64::from(color)))
        })
        .collect();
    let walked = |costs: f64| {
        let mut tour: Vec<Stop> = (0..6).map(|part| (part, 0)).collect();
        walk(&parts, &mut tour, Point2::ZERO, &by(costs));
        tour
    };
    // One way there and one back, changes up and down.
    let best = [0, 1, 3, 5, 4, 2].map(|part| (part, 0));
    let total = |tour: &[Stop]| cost(&parts, tour, (0, 2), Point2::ZERO, &by(1.0));
    assert!(total(&walked(1.0)) <= total(&best), "{:?}", walked(1.0));
    // Where they are dear no colour is come back to.
    let colors: Vec<usize> = walked(1e4).iter().map(|stop| stop.0 / 2).collect();
    assert_eq!(colors, [0, 0, 1, 1, 2, 2]);
}

#[test]
fn a_row_that_is_turned_is_entered_at_its_other_end() {
    let parts = [
        open(0, (0.0, 0.0), (1.0, 0.0)),
        open(0, (5.0, 0.0), (4.0, 0.0)),
        open(0, (3.0, 0.0), (2.0, 0.0)),
    ];
    let mut tour = vec![(0, 0), (1, 0), (2, 0)];
    walk(&parts, &mut tour, Point2::ZERO, &by(0.0));
    let total = cost(&parts, &tour, (0, 0), Point2::ZERO, &by(0.0));
    assert!((total - 7.0).abs() < 1e-9, "{total}: {tour:?}");
}

#[test]
fn nothing_and_one_part() {
    walk(&[], &mut [], Point2::ZERO, &by(1.0));
    let parts = [round(3, &[(9.0, 0.0), (2.0, 0.0), (5.0, 0.0)])];
    let mut tour = [(0, 0)];
    walk(&parts, &mut tour, Point2::ZERO, &by(1.0));
    assert_eq!(tour, [(0, 1)]);
}

fn part() -> impl Strategy<Value = Part> {
    let place = || (0.0..20.0f64, 0.0..20.0f64);
    prop_oneof![
        (0..5u16, place(), place()).prop_map(|(color, a, b)| open(color, a, b)),
        (0..5u16, prop::collection::vec(place(), 1..5)).prop_map(|(color, p)| round(color, &p)),
    ]
}

proptest! {
    #[test]
    fn every_part_stays_and_the_cost_never_rises(
        parts in prop::collection::vec(part(), 1..40),
        costs in 0.0..20.0f64,
    ) {
        let was: Vec<Stop> = (0..parts.len()).map(|part| (part, 0)).collect();
        let ends = ends(&parts, &was);
        let mut tour = was.clone();
        walk(&parts, &mut tour, Point2::ZERO, &by(costs));
        let cost = |tour: &[Stop]| cost(&parts, tour, ends, Point2::ZERO, &by(costs));
        prop_assert!(cost(&tour) <= cost(&was) + 1e-6, "{} to {}", cost(&was), cost(&tour));
        tour.sort_unstable();
        prop_assert!(tour.iter().map(|stop| stop.0).eq(0..parts.len()));
        prop_assert!(tour.iter().all(|stop| (stop.1 as usize) < parts[stop.0].doors.len()));
    }

    #[test]
    fn no_choice_of_doors_is_better(parts in prop::collection::vec(part(), 1..5)) {
        let mut tour: Vec<Stop> = (0..parts.len()).map(|part| (part, 0)).collect();
        walk(&parts, &mut tour, Point2::ZERO, &by(1.0));
        let ends = ends(&parts, &tour);
        let found = cost(&parts, &tour, ends, Point2::ZERO, &by(1.0));
        let counts: Vec<usize> = tour.iter().map(|stop| parts[stop.0].doors.len()).collect();
        for mut choice in 0..counts.iter().product::<usize>() {
            let mut other = tour.clone();
            for (stop, count) in other.iter_mut().zip(&counts) {
                stop.1 = (choice % count) as u32;
                choice /= count;
            }
            let other = cost(&parts, &other, ends, Point2::ZERO, &by(1.0));
            prop_assert!(found <= other + 1e-6, "{found}, but {other}");
        }
    }
}
