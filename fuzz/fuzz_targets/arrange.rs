//! Any lines are arranged into a valid planar subdivision.
#![no_main]

use arbitrary::Arbitrary;
use fgm_arrange::{ArrangeOptions, Arrangement, Chain};
use fgm_core::Point2;
use libfuzzer_sys::fuzz_target;

/// Coordinates on a small lattice, nudged by a few lattice steps of the noding: what is nearly
/// collinear and nearly coincident comes up often.
#[derive(Arbitrary, Debug)]
struct Line {
    points: Vec<(i8, i8, i8, i8)>,
    closed: bool,
}

fuzz_target!(|lines: Vec<Line>| {
    if lines.iter().map(|line| line.points.len()).sum::<usize>() > 200 {
        return;
    }
    let place = |at: i8, nudge: i8| f64::from(at) * 0.125 + f64::from(nudge) * 3e-7;
    let chains: Vec<(Vec<Point2>, bool)> = lines
        .iter()
        .map(|line| {
            let point = |&(x, y, dx, dy): &(i8, i8, i8, i8)| Point2::new(place(x, dx), place(y, dy));
            (line.points.iter().map(point).collect(), line.closed)
        })
        .collect();
    for keep_dangling in [false, true] {
        let chains: Vec<_> = chains
            .iter()
            .enumerate()
            .map(|(label, (points, closed))| Chain { points, closed: *closed, label })
            .collect();
        let options = ArrangeOptions { keep_dangling, ..ArrangeOptions::default() };
        let arrangement = Arrangement::new(&chains, &options).expect("within the limits");
        arrangement.validate().expect("valid");
    }
});
