//! G-code: look-ahead and writing of a million moves, and reading them back.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fgm::core::{ColorId, Mixture, Motion, Point2, Role};
use fgm::gcode::{Lead, Machine, Reader, Writer, WriterOptions};
use fgm_benches::{HEIGHT, WIDTH};

const MOVES: u32 = 1_000_000;
const COLORS: u16 = 16;

/// Circles of short moves, a colour a circle, layer after layer.
fn motions() -> Vec<Motion> {
    let mut motions = Vec::new();
    let mut layer = 0;
    for i in 0..MOVES {
        if i % 20_000 == 0 {
            layer += 1;
            motions.push(Motion::Layer {
                index: layer - 1,
                z: f64::from(layer) * HEIGHT,
                height: HEIGHT,
            });
        }
        let (turn, step) = (i / 500, i % 500);
        let radius = 20.0 + f64::from(turn % 40) * WIDTH;
        let angle = f64::from(step) * std::f64::consts::TAU / 500.0;
        let to = Point2::new(100.0, 100.0) + radius * Point2::from_angle(angle);
        if step == 0 {
            motions.push(Motion::Color(ColorId((turn % u32::from(COLORS)) as u16)));
            motions.push(Motion::Travel { to });
        } else {
            motions.push(Motion::Extrude { to, width: WIDTH, role: Role::InnerWall });
        }
    }
    motions
}

fn write(motions: &[Motion], lead: f64) -> Vec<u8> {
    let machine = Machine::builtin("generic-mixing").expect("built in");
    let mixture = |i| Mixture::from_weights(&[f64::from(i) + 0.5, f64::from(COLORS - i) - 0.5]);
    let mixtures: Vec<_> = (0..COLORS).map(|i| mixture(i).expect("positive")).collect();
    let states = machine.states(&mixtures).expect("within the machine");
    let mut text = Vec::with_capacity(64 << 20);
    let options = WriterOptions::of(&machine);
    let mut writer = Writer::new(&mut text, &machine, &states, &options).expect("a good profile");
    let mut lead = Lead::new(lead);
    for motion in motions {
        lead.push(*motion, |step| writer.push(step)).expect("inside the bed");
    }
    lead.finish(|step| writer.push(step)).expect("inside the bed");
    writer.finish().expect("memory to write to");
    text
}

fn writing(c: &mut Criterion) {
    let motions = motions();
    let mut group = c.benchmark_group("gcode/a million moves");
    group.sample_size(10);
    group.throughput(Throughput::Elements(u64::from(MOVES)));
    group.bench_function("write", |b| b.iter(|| write(black_box(&motions), 0.0)));
    group.bench_function("look ahead and write", |b| b.iter(|| write(black_box(&motions), 68.6)));
    let text = write(&motions, 68.6);
    group.throughput(Throughput::Bytes(text.len() as u64));
    group.bench_function("read", |b| {
        b.iter(|| {
            let mut reader = Reader::new(black_box(text.as_slice()));
            let mut extruded = 0.0;
            while let Ok(Some(line)) = reader.next_line() {
                extruded += line.command.and_then(|c| c.value(b'E')).unwrap_or(0.0);
            }
            extruded
        })
    });
    group.finish();
}

criterion_group!(benches, writing);
criterion_main!(benches);
