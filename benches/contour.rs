//! Tracing: the outline of a vase layer at resolutions each twice the one before, which is to cost
//! twice as much; the isolines between colours; a box's sharp corners; arrays and masks; the
//! section of a mesh. `peers/` compares with other programs.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use fgm::contour::{ContourOptions, Grid, GridContourer, MeshSlicer, isolines, outline};
use fgm::core::{Field, Point2, Point3};
use fgm::field::{Cuboid, Geometry};
use fgm_benches::{builtin, levels, middle, model, window};

fn outlines(c: &mut Criterion) {
    let vase = builtin("vase");
    let Geometry::Field(field) = &vase.geometry else { return };
    let layer = field.at_z(middle(&vase));
    let window = window(&vase);
    let mut group = c.benchmark_group("contour/vase outline");
    for cell in [1.0, 0.5, 0.25, 0.125] {
        let options = ContourOptions { cell, sharp: true, ..ContourOptions::default() };
        group.bench_with_input(BenchmarkId::new("cell", cell), &options, |b, options| {
            b.iter(|| outline(black_box(layer.as_ref()), &window, options))
        });
    }
    group.finish();

    let cuboid = Cuboid { size: Point3::splat(100.0) };
    let options = ContourOptions { sharp: true, ..ContourOptions::default() };
    let around =
        fgm::core::Bounds2::new(fgm::core::Point2::splat(-51.0), fgm::core::Point2::splat(51.0));
    c.bench_function("contour/box outline", |b| {
        let layer = cuboid.at_z(0.0);
        b.iter(|| outline(black_box(layer.as_ref()), &around, &options))
    });
}

fn material(c: &mut Criterion) {
    let slab = builtin("slab");
    let fraction = slab.fractions.fraction(0).at_z(middle(&slab));
    let window = window(&slab);
    let mut group = c.benchmark_group("contour/slab isolines");
    for colors in [2, 16, 48] {
        let levels = levels(colors);
        let options = ContourOptions::default();
        group.bench_with_input(BenchmarkId::new("colors", colors), &levels, |b, levels| {
            b.iter(|| isolines(black_box(fraction.as_ref()), &window, levels, &options))
        });
    }
    group.finish();
}

fn arrays(c: &mut Criterion) {
    const SIDE: usize = 1024;
    let wave = |k: usize| {
        let (x, y) = ((k % SIDE) as f64 / 100.0, (k / SIDE) as f64 / 100.0);
        (x * 3.0).sin() * (y * 2.0).cos() + (x * y * 0.3).sin()
    };
    let values: Vec<f64> = (0..SIDE * SIDE).map(wave).collect();
    let singles: Vec<f32> = values.iter().map(|&v| v as f32).collect();
    let mask: Vec<bool> = values.iter().map(|&v| v > 0.0).collect();
    let (origin, step) = (Point2::ZERO, Point2::ONE);
    let grid = Grid { origin, step, columns: SIDE, rows: SIDE, values: &values[..] };
    let single = Grid { origin, step, columns: SIDE, rows: SIDE, values: &singles[..] };
    let mask = Grid { origin, step, columns: SIDE, rows: SIDE, values: &mask[..] };
    let mut contourer = GridContourer::default();
    let mut group = c.benchmark_group("contour/1024x1024 array");
    for count in [1, 15] {
        let levels: Vec<f64> =
            (0..count).map(|k| 3.0 * (f64::from(k) + 0.5) / f64::from(count) - 1.5).collect();
        group.bench_with_input(BenchmarkId::new("isolines", count), &levels, |b, levels| {
            b.iter(|| contourer.isolines(black_box(&grid), levels))
        });
        group.bench_with_input(BenchmarkId::new("isolines of f32", count), &levels, |b, levels| {
            b.iter(|| contourer.isolines(black_box(&single), levels))
        });
        group.bench_with_input(BenchmarkId::new("isobands", count + 1), &levels, |b, levels| {
            b.iter(|| contourer.isobands(black_box(&grid), levels))
        });
    }
    group.bench_function("mask", |b| b.iter(|| black_box(&mask).outline()));
    group.finish();
}

fn meshes(c: &mut Criterion) {
    let Some(design) = model("vase.stl", "x/200 + 0.5") else { return };
    let Geometry::Mesh(mesh) = &design.geometry else { return };
    let slicer = MeshSlicer::new(mesh).expect("a good mesh");
    c.bench_function("contour/section of vase.stl", |b| b.iter(|| slicer.section(black_box(50.1))));
    c.bench_function("contour/reading vase.stl in", |b| {
        b.iter(|| MeshSlicer::new(black_box(mesh)))
    });
}

criterion_group!(benches, outlines, material, arrays, meshes);
criterion_main!(benches);
