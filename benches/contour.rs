//! Tracing: the outline of a vase layer at two resolutions, the 15 isolines between 16 colours,
//! a box's sharp corners, and the section of a mesh.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use fgm::contour::{ContourOptions, MeshSlicer, isolines, outline};
use fgm::core::{Field, Point3};
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

fn meshes(c: &mut Criterion) {
    let Some(design) = model("vase.stl", "x/200 + 0.5") else { return };
    let Geometry::Mesh(mesh) = &design.geometry else { return };
    let slicer = MeshSlicer::new(mesh).expect("a good mesh");
    c.bench_function("contour/section of vase.stl", |b| b.iter(|| slicer.section(black_box(50.1))));
    c.bench_function("contour/reading vase.stl in", |b| {
        b.iter(|| MeshSlicer::new(black_box(mesh)))
    });
}

criterion_group!(benches, outlines, material, meshes);
criterion_main!(benches);
