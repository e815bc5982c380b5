//! Measures expressions: nanoseconds a point in chunks, one at a time, and a range over a box.
//!
//! `cargo run --release -p fgm-field --example speed -- "expression"`

#![allow(clippy::print_stdout)]

use std::time::Instant;

use fgm_core::{Bounds2, Field, Point2};
use fgm_field::{Expr, ExprField};

const DEFAULT: &str = "(1 + sin(0.02x + 0.03y) cos(0.03x - 0.02y)) / 2";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let source = std::env::args().nth(1).unwrap_or_else(|| DEFAULT.into());
    let field = ExprField::new(&Expr::parse(&source)?);
    let layer = field.at_z(1.0);
    let points: Vec<Point2> = (0..1 << 16)
        .map(|i| Point2::new(f64::from(i % 256) * 0.5, f64::from(i / 256) * 0.5))
        .collect();
    let mut out = vec![0.0; points.len()];

    report("chunks of points", points.len(), || {
        layer.eval_into(&points, &mut out);
        out[17]
    });
    report("one point", points.len(), || points.iter().map(|p| layer.eval(*p)).sum());
    report("range over a cell", points.len(), || {
        let size = Point2::splat(0.5);
        points.iter().map(|p| layer.bounds(&Bounds2::new(*p, *p + size)).lo).sum()
    });
    Ok(())
}

/// Prints the least time of many runs.
fn report(what: &str, count: usize, mut run: impl FnMut() -> f64) {
    let times = (0..30).map(|_| {
        let start = Instant::now();
        std::hint::black_box(run());
        start.elapsed()
    });
    let best = times.min().unwrap_or_default();
    println!("{what:20} {:8.2} ns", best.as_secs_f64() * 1e9 / count as f64);
}
