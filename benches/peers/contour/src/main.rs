//! Contours a raw array as `compare.py` asks: `ours FILE COLUMNS KIND LEVEL...`, KIND being `lines`,
//! `view` (lines without a copy) or `bands`. Prints the mean processor time of a run in seconds, with memory kept from the run
//! before, then that of a run with new memory, then the number of points.

use std::time::Instant;
use std::{env, fs, process};

use fgm_contour::{Grid, GridContourer};
use fgm_core::{Point2, Polygon};

/// How long runs are repeated, in seconds: the system tells processor time in steps of a few
/// milliseconds.
const LONG_ENOUGH: f64 = 0.25;

/// The processor time of this thread where the system tells it, which other programs do not
/// lengthen; otherwise what a clock says.
fn seconds(begin: Instant) -> f64 {
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|t| t.split(' ').next().and_then(|n| n.parse::<f64>().ok()));
    nanoseconds.map_or_else(|| begin.elapsed().as_secs_f64(), |n| n * 1e-9)
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [file, columns, kind, levels @ ..] = arguments.as_slice() else {
        eprintln!("usage: ours FILE COLUMNS lines|view|bands LEVEL...");
        process::exit(2);
    };
    let bytes = fs::read(file).expect("a file of numbers");
    let values: Vec<f64> = bytes
        .chunks_exact(8)
        .map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes")))
        .collect();
    let columns: usize = columns.parse().expect("a number of columns");
    let levels: Vec<f64> = levels.iter().map(|l| l.parse().expect("a level")).collect();
    let rows = values.len() / columns;
    let grid = Grid { origin: Point2::ZERO, step: Point2::ONE, columns, rows, values: &values };
    let mut points = 0;
    let mut run = |contourer: &mut GridContourer| {
        points = if kind == "view" {
            let found = contourer.lines(&grid, &levels).expect("good data");
            found.map(|line| line.points.len() + usize::from(line.closed)).sum()
        } else if kind == "lines" {
            let found = contourer.isolines(&grid, &levels).expect("good data");
            found.iter().map(count_lines).sum::<usize>()
        } else {
            let found = contourer.isobands(&grid, &levels).expect("good data");
            found.iter().flat_map(|b| &b.polygons).map(count_polygon).sum()
        };
    };
    let mut contourer = GridContourer::default();
    run(&mut contourer);
    let kept = mean(|| run(&mut contourer));
    let new = mean(|| run(&mut GridContourer::default()));
    println!("{kept} {new} {points}");
}

/// The mean time of a run.
fn mean(mut run: impl FnMut()) -> f64 {
    let clock = Instant::now();
    let begin = seconds(clock);
    let mut runs = 0;
    while clock.elapsed().as_secs_f64() < LONG_ENOUGH {
        run();
        runs += 1;
    }
    (seconds(clock) - begin) / f64::from(runs)
}

fn count_lines(lines: &fgm_contour::LevelLines) -> usize {
    let rings: usize = lines.rings.iter().map(|r| r.points.len() + 1).sum();
    rings + lines.lines.iter().map(|l| l.points.len()).sum::<usize>()
}

fn count_polygon(polygon: &Polygon) -> usize {
    polygon.rings().map(|r| r.points.len() + 1).sum()
}
