//! Arranging: outline and isolines of a slab layer into faces, at growing numbers of segments, and
//! cutting infill lines by the faces.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fgm::arrange::{ArrangeOptions, Arrangement, Chain};
use fgm::core::Point2;
use fgm_benches::{builtin, lines, middle};

fn chains(lines: &[(Vec<Point2>, bool)]) -> Vec<Chain<'_, u8>> {
    lines.iter().map(|(points, closed)| Chain { points, closed: *closed, label: 0 }).collect()
}

fn faces(c: &mut Criterion) {
    let slab = builtin("slab");
    let mut group = c.benchmark_group("arrange/slab layer of 16 colors");
    for cell in [0.5, 0.1, 0.02] {
        let lines = lines(&slab, middle(&slab), 16, cell);
        let chains = chains(&lines);
        let segments: usize = chains.iter().map(|c| c.points.len()).sum();
        group.throughput(Throughput::Elements(segments as u64));
        group.bench_with_input(BenchmarkId::new("segments", segments), &chains, |b, chains| {
            b.iter(|| Arrangement::new(black_box(chains), &ArrangeOptions::default()))
        });
    }
    group.finish();
}

fn cutting(c: &mut Criterion) {
    let slab = builtin("slab");
    let lines = lines(&slab, middle(&slab), 16, 0.5);
    let arrangement =
        Arrangement::new(&chains(&lines), &ArrangeOptions::default()).expect("in range");
    let infill: Vec<[Point2; 2]> = (0..500)
        .map(|i| f64::from(i) * 0.35 - 87.0)
        .map(|y| [Point2::new(-70.0, y), Point2::new(70.0, y)])
        .collect();
    let mut spans = Vec::new();
    c.bench_function("arrange/cut 500 lines by 16 colors", |b| {
        b.iter(|| {
            let mut count = 0;
            for line in &infill {
                spans.clear();
                arrangement.cut(black_box(line), &mut spans);
                count += spans.len();
            }
            count
        })
    });
}

criterion_group!(benches, faces, cutting);
criterion_main!(benches);
