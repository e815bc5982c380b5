//! Evaluating fields: the material of eq. 1 point by point and in chunks, the vase's surface, and
//! bounds.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fgm::core::{Bounds3, Field, Point2, Point3};
use fgm::field::{Expr, ExprField, Geometry};
use fgm_benches::builtin;

const EQ1: &str = "(1 + sin(0.02x + 0.03y) cos(0.03x - 0.02y)) / 2";

fn points() -> Vec<Point2> {
    let row = |j: usize| (0..100).map(move |i| Point2::new(i as f64, j as f64 * 1.5 - 70.0));
    (0..100).flat_map(row).collect()
}

fn expressions(c: &mut Criterion) {
    let expr = Expr::parse(EQ1).expect("eq. 1");
    let field = ExprField::new(&expr);
    let points = points();
    let lifted: Vec<Point3> = points.iter().map(|p| p.extend(10.0)).collect();
    let mut out = vec![0.0; points.len()];
    let mut group = c.benchmark_group("field/eq1");
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("one point at a time", |b| {
        b.iter(|| lifted.iter().map(|p| field.eval(black_box(*p))).sum::<f64>())
    });
    group.bench_function("chunks", |b| b.iter(|| field.eval_into(black_box(&lifted), &mut out)));
    let layer = field.at_z(10.0);
    group.bench_function("chunks in a layer", |b| {
        b.iter(|| layer.eval_into(black_box(&points), &mut out))
    });
    group.finish();

    let cell = Bounds3::new(Point3::new(3.0, 4.0, 5.0), Point3::new(11.0, 12.0, 5.0));
    c.bench_function("field/eq1/bounds of a cell", |b| b.iter(|| field.bounds(black_box(&cell))));
    c.bench_function("field/eq1/parse and compile", |b| {
        b.iter(|| ExprField::new(&Expr::parse(black_box(EQ1)).expect("eq. 1")))
    });
}

fn vase(c: &mut Criterion) {
    let design = builtin("vase");
    let Geometry::Field(field) = &design.geometry else { return };
    let points = points();
    let mut out = vec![0.0; points.len()];
    let layer = field.at_z(50.0);
    let mut group = c.benchmark_group("field/vase");
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("surface in a layer", |b| {
        b.iter(|| layer.eval_into(black_box(&points), &mut out))
    });
    let fraction = design.fractions.fraction(0).at_z(50.0);
    group.bench_function("fraction in a layer", |b| {
        b.iter(|| fraction.eval_into(black_box(&points), &mut out))
    });
    group.finish();
}

criterion_group!(benches, expressions, vase);
criterion_main!(benches);
