//! Arranging: outline and isolines of a slab layer into faces, at growing numbers of segments, and
//! long random segments with all their crossings; then what is asked of faces: points inside,
//! polygons, places, cuts of infill lines.
//!
//! `peers/arrange` compares with other libraries.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fgm::arrange::{ArrangeOptions, Arrangement, Arranger, Chain};
use fgm::core::Point2;
use fgm_benches::{builtin, lines, middle};

fn chains(lines: &[(Vec<Point2>, bool)]) -> Vec<Chain<'_, u8>> {
    lines.iter().map(|(points, closed)| Chain { points, closed: *closed, label: 0 }).collect()
}

/// The slab's middle layer, its boundaries traced on cells of this size, mm.
fn layer(cell: f64) -> Vec<(Vec<Point2>, bool)> {
    let slab = builtin("slab");
    lines(&slab, middle(&slab), 16, cell)
}

fn faces(c: &mut Criterion) {
    let mut group = c.benchmark_group("arrange/slab layer of 16 colors");
    for cell in [0.5, 0.1, 0.02] {
        let lines = layer(cell);
        let chains = chains(&lines);
        let segments: usize = chains.iter().map(|c| c.points.len()).sum();
        group.throughput(Throughput::Elements(segments as u64));
        let mut arranger = Arranger::new();
        group.bench_with_input(BenchmarkId::new("segments", segments), &chains, |b, chains| {
            b.iter(|| arranger.arrange(black_box(chains), &ArrangeOptions::default()))
        });
    }
    group.finish();
}

/// Chords of a circle, so that about a third of all pairs cross.
fn crossings(c: &mut Criterion) {
    let mut group = c.benchmark_group("arrange/chords of a circle");
    group.sample_size(10);
    for count in [200, 800] {
        let at = |i: usize| Point2::from_angle((i * i) as f64 * 0.618) * 50.0;
        let chords: Vec<_> = (0..count).map(|i| (vec![at(2 * i), at(2 * i + 1)], false)).collect();
        let chains = chains(&chords);
        let mut arranger = Arranger::new();
        group.bench_with_input(BenchmarkId::new("chords", count), &chains, |b, chains| {
            b.iter(|| arranger.arrange(black_box(chains), &ArrangeOptions::default()))
        });
    }
    group.finish();
}

fn asking(c: &mut Criterion) {
    let lines = layer(0.1);
    let arrangement =
        Arrangement::new(&chains(&lines), &ArrangeOptions::default()).expect("in range");
    c.bench_function("arrange/points inside all faces", |b| {
        b.iter(|| arrangement.faces().map(|face| face.inside_point().x).sum::<f64>())
    });
    c.bench_function("arrange/polygons of all faces", |b| {
        b.iter(|| arrangement.faces().map(|face| face.polygon().rings().count()).sum::<usize>())
    });
    let places: Vec<_> =
        (0..1000).map(|i| Point2::from_angle(f64::from(i)) * f64::from(i) * 0.09).collect();
    c.bench_function("arrange/locate 1000 points", |b| {
        let found = |p: &&Point2| arrangement.locate(black_box(**p)).face().is_some();
        b.iter(|| places.iter().filter(found).count())
    });
}

fn cutting(c: &mut Criterion) {
    let lines = layer(0.5);
    let arrangement =
        Arrangement::new(&chains(&lines), &ArrangeOptions::default()).expect("in range");
    let infill: Vec<[Point2; 2]> = (0..500)
        .map(|i| f64::from(i) * 0.35 - 87.0)
        .map(|y| [Point2::new(-70.0, y), Point2::new(70.0, y)])
        .collect();
    let mut spans = Vec::new();
    c.bench_function("arrange/cut 500 lines by 16 colors", |b| {
        let mut cutter = arrangement.cutter();
        b.iter(|| {
            let mut count = 0;
            for line in &infill {
                cutter.cut(black_box(line), &mut spans);
                count += spans.len();
            }
            count
        })
    });
}

criterion_group!(benches, faces, crossings, asking, cutting);
criterion_main!(benches);
