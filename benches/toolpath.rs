//! Toolpaths of one layer: walls of the vase, full infill and fills against the gradient of the
//! slab, ordering.

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use fgm::arrange::{ArrangeOptions, Arrangement, Chain};
use fgm::core::{ColorId, Point2, Polygon, Role};
use fgm::toolpath::{
    AgainstOptions, ClipperInset, InfillOptions, Path, Piece, WallOptions, against, infill, order,
    route, walls,
};
use fgm_benches::{HEIGHT, WIDTH, builtin, layer, lines, middle};

fn wall(c: &mut Criterion) {
    let vase = builtin("vase");
    let region = layer(&vase, middle(&vase));
    let inset = ClipperInset::default();
    let mut group = c.benchmark_group("toolpath/vase walls");
    for count in [3, 10] {
        let options = WallOptions::new(count, WIDTH, HEIGHT);
        group.bench_with_input(BenchmarkId::from_parameter(count), &options, |b, options| {
            b.iter(|| walls(black_box(&region), options, &inset))
        });
    }
    group.finish();
}

fn fills(c: &mut Criterion) {
    let slab = builtin("slab");
    let z = middle(&slab);
    let region = layer(&slab, z);
    let inset = ClipperInset::default();
    let options = InfillOptions { density: 1.0, ..InfillOptions::new(WIDTH, HEIGHT) };
    c.bench_function("toolpath/slab full infill", |b| {
        b.iter(|| infill(black_box(&region), &options, &inset))
    });

    let lines = lines(&slab, z, 48, 0.5);
    let chains: Vec<_> = lines
        .iter()
        .map(|(points, closed)| Chain { points, closed: *closed, label: 0_u8 })
        .collect();
    let arrangement = Arrangement::new(&chains, &ArrangeOptions::default()).expect("in range");
    let inside = |p: &Polygon, at: Point2| p.contains(at);
    let faces: Vec<Polygon> = arrangement
        .faces()
        .filter(|face| region.iter().any(|p| inside(p, face.inside_point())))
        .map(|face| face.polygon())
        .collect();
    let options = AgainstOptions::new(WIDTH, HEIGHT);
    c.bench_function("toolpath/slab against the gradient, 48 colors", |b| {
        b.iter(|| {
            let fill = |face| against(std::slice::from_ref(face), &options, &inset).len();
            black_box(&faces).iter().map(fill).sum::<usize>()
        })
    });
    let beads: Vec<Vec<Path>> =
        faces.iter().map(|face| against(std::slice::from_ref(face), &options, &inset)).collect();
    c.bench_function("toolpath/slab against the gradient, beads joined", |b| {
        b.iter_batched(
            || beads.clone(),
            |beads| beads.into_iter().map(|face| route(face, WIDTH, HEIGHT).len()).sum::<usize>(),
            criterion::BatchSize::LargeInput,
        )
    });
}

fn ordering(c: &mut Criterion) {
    let mut group = c.benchmark_group("toolpath/order pieces");
    for count in [5_000_usize, 50_000] {
        // A low-discrepancy spread: even, and the same on every run.
        let at = |i: usize, a: f64| (i as f64 * a).fract() * 150.0;
        let pieces: Vec<Piece> = (0..count)
            .map(|i| Point2::new(at(i, 0.754_877_666), at(i, 0.569_840_29)))
            .map(|p| {
                Piece::new(vec![p, p + Point2::new(1.0, 0.5)], Role::Infill, WIDTH, ColorId(0))
            })
            .collect();
        group.bench_with_input(BenchmarkId::from_parameter(count), &pieces, |b, pieces| {
            b.iter_batched(
                || pieces.clone(),
                |pieces| order(pieces, &[ColorId(0)], Point2::ZERO),
                BatchSize::LargeInput,
            )
        });
    }
    group.finish();
}

criterion_group!(benches, wall, fills, ordering);
criterion_main!(benches);
