//! Any lines are arranged into a valid planar subdivision, which stays the same when it is arranged
//! again, and whose faces do not depend on the order, direction or number of copies of the lines.
#![no_main]

use arbitrary::Arbitrary;
use fgm_arrange::{ArrangeOptions, Arrangement, Chain};
use fgm_core::{Point2, Polygon};
use libfuzzer_sys::fuzz_target;

/// Coordinates on a small lattice, nudged by a few lattice steps of the noding: what is nearly
/// collinear and nearly coincident comes up often.
#[derive(Arbitrary, Debug)]
struct Line {
    points: Vec<(i8, i8, i8, i8)>,
    closed: bool,
}

#[derive(Arbitrary, Debug)]
struct Case {
    lines: Vec<Line>,
    size: u8,
}

type Lines = Vec<(Vec<Point2>, bool)>;

fn arrange(lines: &Lines, keep_dangling: bool) -> Arrangement<u8> {
    let chains: Vec<_> =
        lines.iter().map(|(points, closed)| Chain { points, closed: *closed, label: 0 }).collect();
    let options = ArrangeOptions { keep_dangling, ..ArrangeOptions::default() };
    let arrangement = Arrangement::new(&chains, &options).expect("within the limits");
    arrangement.validate().expect("valid");
    arrangement
}

fn faces(arrangement: &Arrangement<u8>) -> Vec<Polygon> {
    arrangement.faces().map(|face| face.polygon()).collect()
}

/// All segments, each from its lesser to its greater end, sorted.
fn segments(arrangement: &Arrangement<u8>) -> Vec<[f64; 4]> {
    let mut list = Vec::new();
    for edge in arrangement.edges() {
        let points: Vec<_> = edge.points().collect();
        list.extend(points.windows(2).map(|w| {
            let (a, b) = ([w[0].x, w[0].y], [w[1].x, w[1].y]);
            let (a, b) = if a < b { (a, b) } else { (b, a) };
            [a[0], a[1], b[0], b[1]]
        }));
    }
    list.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
    list
}

fuzz_target!(|case: Case| {
    if case.lines.iter().map(|line| line.points.len()).sum::<usize>() > 120 {
        return;
    }
    // From a few lattice steps to nearly the greatest coordinates.
    let size = [0.125, 1e-6, 3e-5, 8.5e3][usize::from(case.size % 4)];
    let place = |at: i8, nudge: i8| f64::from(at) * size + f64::from(nudge) * 3e-7;
    let point = |&(x, y, dx, dy): &(i8, i8, i8, i8)| Point2::new(place(x, dx), place(y, dy));
    let line = |line: &Line| (line.points.iter().map(point).collect(), line.closed);
    let lines: Lines = case.lines.iter().map(line).collect();
    let all = arrange(&lines, true);
    let bounded = arrange(&lines, false);

    let again: Lines = all.edges().map(|edge| (edge.points().collect(), false)).collect();
    assert_eq!(segments(&all), segments(&arrange(&again, true)), "arranged again");

    let mut other: Lines = lines.iter().rev().cloned().collect();
    other.iter_mut().for_each(|(points, _)| points.reverse());
    assert_eq!(faces(&bounded), faces(&arrange(&other, false)), "reversed");
    other.extend(lines);
    assert_eq!(faces(&bounded), faces(&arrange(&other, false)), "doubled");
});
