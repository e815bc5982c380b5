//! Layers get the time to cool that the settings ask for, judged by the written G-code.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{parse, settings, slice};
use fgm::{
    Report, Strategy,
    core::Point3,
    design,
    gcode::{Machine, Reader, TimeEstimate},
};

const COLUMN: &str = "fgrade([\"z/3\", \"1 - z/3\"], [\"a\", \"b\"]) { rectprism(7, 7, 3); }";

/// A layer as it was written.
#[derive(Debug, Default)]
struct Layer {
    seconds: f64,
    /// Feedrates, mm/min, by what they are for.
    outer: Vec<f64>,
    inner: Vec<f64>,
    travel: Vec<f64>,
}

/// Each layer's time by its moves, and its feedrates.
fn layers(gcode: &[u8], machine: &Machine) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    let (mut at, mut feedrate, mut outer) = (Point3::ZERO, 0.0, false);
    let mut time = TimeEstimate::new(&machine.motion);
    let mut reader = Reader::new(gcode);
    while let Some(line) = reader.next_line().unwrap() {
        if let Some(comment) = line.comment {
            if let Some(last) = layers.last_mut().filter(|_| comment == b"LAYER_CHANGE") {
                last.seconds =
                    std::mem::replace(&mut time, TimeEstimate::new(&machine.motion)).seconds();
            }
            if comment == b"LAYER_CHANGE" {
                layers.push(Layer::default());
            } else if comment.starts_with(b"TYPE:") {
                outer = comment == b"TYPE:External perimeter";
            }
        }
        let Some(command) = line.command.filter(|c| c.is(b'G', 1)) else { continue };
        let mut to = at;
        for (axis, letter) in b"XYZ".iter().enumerate() {
            to[axis] = command.value(*letter).unwrap_or(to[axis]);
        }
        feedrate = command.value(b'F').unwrap_or(feedrate);
        let extrudes = command.value(b'E').is_some();
        let (delta, limits) = (to - at, &machine.motion);
        at = to;
        let Some(layer) = layers.last_mut() else { continue };
        if delta == Point3::ZERO {
            time.push_filament(command.value(b'E').unwrap_or(0.0), feedrate / 60.0);
            continue;
        }
        let acceleration = if extrudes { limits.acceleration } else { limits.travel_acceleration };
        time.push(delta, feedrate / 60.0, acceleration);
        match (extrudes, outer) {
            (true, true) => layer.outer.push(feedrate),
            (true, false) => layer.inner.push(feedrate),
            (false, _) if delta.z == 0.0 => layer.travel.push(feedrate),
            _ => {}
        }
    }
    layers
}

fn column(least_time: f64, least_speed: f64) -> (Report, Vec<Layer>) {
    let mut settings = settings(Strategy::Sectioned, 3);
    settings.purge.enabled = Some(false);
    settings.cooling.min_layer_time = least_time;
    settings.cooling.min_speed = least_speed;
    let (report, gcode) = slice(&parse(COLUMN), "generic-mixing", &settings);
    (report, layers(&gcode, &Machine::builtin("generic-mixing").unwrap()))
}

#[test]
fn short_layers_are_slowed_to_the_time_asked_for() {
    let (usual, before) = column(0.0, 5.0);
    assert_eq!((usual.cooling.slowed_layers, usual.cooling.added_s), (0, 0.0));
    let inside = &before[5..before.len() - 1];
    assert!(inside.iter().all(|l| (2.0..6.0).contains(&l.seconds)), "{before:?}");

    let (report, after) = column(8.0, 5.0);
    assert_eq!(report.cooling.short_layers, 0);
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    assert!(report.cooling.slowed_layers >= inside.len());
    let added = report.print_time_s - usual.print_time_s;
    assert!((added - report.cooling.added_s).abs() < 0.03 * added, "{added} {:?}", report.cooling);
    for (i, (layer, usual)) in after[5..after.len() - 1].iter().zip(inside).enumerate() {
        assert!((7.8..8.3).contains(&layer.seconds), "{i}: {}", layer.seconds);
        assert!(layer.travel.iter().all(|f| *f == 9000.0), "{i}: {:?}", layer.travel);
        // The walls that are seen keep their 30 mm/s.
        assert!(layer.outer.iter().all(|f| *f == 1800.0), "{i}: {:?}", layer.outer);
        assert_eq!(layer.inner.len(), usual.inner.len());
        let slower = layer.inner.iter().zip(&usual.inner).all(|(now, was)| now < was);
        assert!(slower, "{i}: {:?}", layer.inner);
    }
}

#[test]
fn what_cannot_be_slowed_enough_is_told() {
    let (report, layers) = column(60.0, 10.0);
    assert_eq!(report.cooling.short_layers, report.layers);
    assert!(report.warnings.iter().any(|w| w.contains("cooling.min_layer_time")));
    let beads = |layer: &Layer| [&layer.outer[..], &layer.inner[..]].concat();
    assert!(layers[5..].iter().flat_map(beads).all(|f| f == 600.0));
}

#[test]
fn a_foaming_filament_is_heated_by_the_slowed_time() {
    // The flow follows the temperature by the time that the beads really take: with the nozzle's
    // rates named, slow layers have their commands nearer to the boundary, in mm.
    let profile = "[foaming]\nheating = 2.0\ncooling = 1.0".parse().unwrap();
    let text = Machine::builtin_toml("prusa-mk4s-lw-pla").unwrap();
    let machine = fgm::machine(text, &profile).unwrap();
    let source = "fgrade([\"x/7 + 0.5\", \"0.5 - x/7\"], [\"a\", \"b\"]) { rectprism(7, 7, 3); }";
    let design = design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap().design;
    let count = |least_time: f64| {
        let mut settings = settings(Strategy::Sectioned, 3);
        settings.purge.enabled = Some(false);
        settings.cooling.min_layer_time = least_time;
        let mut gcode = Vec::new();
        let slicer = fgm::Slicer::new(&design, &machine, &settings);
        let report = slicer.slice(&mut gcode, &fgm::Quiet).unwrap();
        (report, String::from_utf8(gcode).unwrap())
    };
    let ((usual, fast), (report, slow)) = (count(0.0), count(8.0));
    assert!(report.cooling.slowed_layers > 10 && report.print_time_s > usual.print_time_s);
    let filament = |r: &Report| r.materials.iter().map(|m| m.volume_mm3).sum::<f64>();
    assert_ne!(filament(&usual), filament(&report));
    let temperatures = |text: &str| text.lines().filter(|l| l.starts_with("M104 S")).count();
    assert!(temperatures(&fast) > 20 && temperatures(&slow) > 20);
}
