//! What hangs over and what is bridged, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Quiet, Settings, Slicer, Strategy, gcode::Machine};

/// A beam on two pillars, graded along it: layers 26 to 35 reach over 20 mm of air.
const GATE: &str = r#"fgrade(["x/30 + 0.5", "0.5 - x/30"], ["a", "b"]) {
    difference() { rectprism(30, 10, 7); translate(0, 0, -1) { rectprism(20, 12, 5); } } }"#;

/// A cone that gets wider upwards, by 0.2 mm on every side in each layer.
const FUNNEL: &str = r#"fgrade(["z/4", "1 - z/4"], ["a", "b"]) {
    function((-12, -12, 0), (12, 12, 4), "max(hypot(x, y) - 6 - z, max(-z, z - 4))"); }"#;

fn text(source: &str, strategy: Strategy, change: impl Fn(&mut Settings)) -> String {
    let mut settings = settings(strategy, 4);
    settings.purge.enabled = Some(false);
    settings.cooling.min_layer_time = 0.0;
    change(&mut settings);
    String::from_utf8(slice(&parse(source), "generic-mixing", &settings).1).unwrap()
}

fn beads(text: &str, role: &str) -> Vec<Bead> {
    let beads = deposit(text.as_bytes()).beads;
    beads.into_iter().filter(|b| b.role == role).collect()
}

/// The feedrates of beads of a type, mm/min.
fn feedrates(text: &str, role: &str) -> Vec<u32> {
    let (mut of_role, mut rate, mut found) = (false, 0, Vec::new());
    for line in text.lines() {
        if let Some(tag) = line.strip_prefix(";TYPE:") {
            of_role = tag == role;
        }
        if let Some((_, f)) = line.split_once(" F").filter(|_| line.starts_with("G1")) {
            rate = f.split(" ").next().unwrap().parse().unwrap();
        }
        if of_role && line.starts_with("G1 X") && line.contains(" E") {
            found.push(rate);
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[test]
fn a_gate_is_bridged_across() {
    let gate = text(GATE, Strategy::Sectioned, |_| ());
    let bridge = beads(&gate, "Bridge infill");
    let layers: std::collections::BTreeSet<usize> = bridge.iter().map(|b| b.layer).collect();
    assert_eq!(layers.len(), 1, "{layers:?}");
    assert!((bridge[0].z - bridge[0].height - 1.5).abs() < 1e-6, "{}", bridge[0].z);
    // Along x, and from pillar to pillar with the anchor.
    let length: f64 = bridge.iter().map(Bead::length).sum();
    let along: f64 = bridge.iter().map(|b| (b.to.x - b.from.x).abs()).sum();
    assert!(along > 0.9 * length, "{along} {length}");
    let reach = bridge.iter().map(|b| b.from.x.abs().max(b.to.x.abs())).fold(0.0, f64::max);
    assert!((reach - 11.0).abs() < 0.3, "{reach}");
    assert_eq!(feedrates(&gate, "Bridge infill"), [25 * 60]);
    // The walls beside it hang in the air.
    let over = beads(&gate, "Overhang perimeter");
    assert!(over.iter().all(|b| b.layer == bridge[0].layer));
    assert!(over.iter().all(|b| b.from.x.abs() < 10.2 && b.to.x.abs() < 10.2));
    let hanging: f64 = over.iter().map(Bead::length).sum();
    assert!((hanging - 6.0 * 20.0).abs() < 2.0, "{hanging}");

    let volume = |flow: f64| -> f64 {
        let gate = text(GATE, Strategy::Sectioned, |s| s.bridges.flow = flow);
        beads(&gate, "Bridge infill").iter().map(|b| b.volume).sum()
    };
    assert!((volume(1.5) / volume(1.0) - 1.5).abs() < 1e-3);
    let without = text(GATE, Strategy::Sectioned, |s| {
        (s.bridges.enabled, s.walls.overhang) = (false, 0.0);
    });
    assert!(beads(&without, "Bridge infill").is_empty());
    assert!(beads(&without, "Overhang perimeter").is_empty());
}

#[test]
fn what_hangs_over_is_slower_and_cooled() {
    let mut machine = Machine::builtin("generic-mixing").unwrap();
    (machine.fan.speed, machine.fan.overhang) = (0.2, 0.8);
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mut settings = settings(strategy, 4);
        settings.purge.enabled = Some(false);
        settings.cooling.min_layer_time = 0.0;
        let mut gcode = Vec::new();
        Slicer::new(&parse(FUNNEL), &machine, &settings).slice(&mut gcode, &Quiet).unwrap();
        let funnel = String::from_utf8(gcode).unwrap();
        // Every layer reaches 0.2 mm beyond the one below it: half of a bead's width.
        let over = beads(&funnel, "Overhang perimeter");
        assert!(over.iter().all(|b| b.layer > 0));
        for layer in 1..20 {
            let length: f64 = over.iter().filter(|b| b.layer == layer).map(Bead::length).sum();
            let around = std::f64::consts::TAU * (6.0 + 0.2 * layer as f64 - 0.1);
            assert!((length / around - 1.0).abs() < 0.05, "{strategy} {layer}: {length} {around}");
        }
        let rates = feedrates(&funnel, "Overhang perimeter");
        assert!(rates.iter().all(|r| [24 * 60, 18 * 60].contains(r)), "{strategy}: {rates:?}");
        let told = |line: &str| funnel.lines().filter(|l| *l == line).count();
        assert!(told("M106 S204") >= 19 && told("M106 S51") >= 19, "{strategy}");
    }
}
