//! What hangs over and what is bridged, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Quiet, Settings, Slicer, Strategy, core::Point2, gcode::Machine};

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

/// The share of the beam's area that the beads of a layer cover, looked at every 0.1 mm.
fn covered(beads: &[Bead]) -> f64 {
    let under = |p: Point2| {
        beads.iter().any(|b| {
            let way = b.to - b.from;
            let along = (p - b.from).dot(way) / way.length_squared();
            p.distance(b.from + way * along.clamp(0.0, 1.0)) <= 0.5 * b.width + 1e-3
        })
    };
    let places = (0..300).flat_map(|i| (0..100).map(move |j| (i, j)));
    let at = |i: i32, j: i32| Point2::new(f64::from(i) * 0.1 - 14.95, f64::from(j) * 0.1 - 4.95);
    places.filter(|&(i, j)| under(at(i, j))).count() as f64 / 30_000.0
}

#[test]
fn against_the_gradient_a_gate_is_bridged_across_too() {
    let beads_of = |text: &str| deposit(text.as_bytes()).beads;
    // On pillars of 5 mm, and of hardly more than two beads: nothing is left beside the bridge.
    for (gap, reach) in [(20, 11.0), (28, 14.8)] {
        let gate = GATE.replace("rectprism(20", &format!("rectprism({gap}"));
        // No look-ahead: what is read back is then the colour of each bead.
        let text = text(&gate, Strategy::Against, |s| s.lead.volume = Some(0.0));
        let all = beads_of(&text);
        let bridge: Vec<Bead> = all.iter().filter(|b| b.role == "Bridge infill").cloned().collect();
        let number = bridge[0].layer;
        assert!(bridge.iter().all(|b| b.layer == number));
        assert!((bridge[0].z - bridge[0].height - 1.5).abs() < 1e-6, "{}", bridge[0].z);

        // Straight along x over the whole width, on to what holds them.
        let length: f64 = bridge.iter().map(Bead::length).sum();
        let along: f64 = bridge.iter().map(|b| (b.to.x - b.from.x).abs()).sum();
        assert!(along > 0.9 * length, "{along} {length}");
        let far = |of: fn(Point2) -> f64| {
            bridge.iter().map(|b| of(b.from).abs().max(of(b.to).abs())).fold(0.0, f64::max)
        };
        assert!((far(|p| p.x) - reach).abs() < 0.3, "{}", far(|p| p.x));
        assert!((far(|p| p.y) - 4.8).abs() < 0.01, "{}", far(|p| p.y));
        assert_eq!(feedrates(&text, "Bridge infill"), [25 * 60]);
        assert!(beads(&text, "Overhang perimeter").is_empty());
        // Each piece in the colour of its place: four bands along the beam.
        for b in &bridge {
            let band = |x: f64| (4.0 * (x / 30.0 + 0.5)).clamp(0.0, 3.999);
            let (low, high) =
                (band(b.from.x.min(b.to.x) + 0.01), band(b.from.x.max(b.to.x) - 0.01));
            assert!(low as usize == b.color && high as usize == b.color, "{b:?}");
        }

        // The layer is as full as with strategy 1.
        let sectioned = beads_of(&self::text(&gate, Strategy::Sectioned, |s| {
            s.infill.density = 100.0.into();
        }));
        for (all, strategy) in [(&all, "against"), (&sectioned, "sectioned")] {
            let layer: Vec<Bead> = all.iter().filter(|b| b.layer == number).cloned().collect();
            let volume: f64 = layer.iter().map(|b| b.volume).sum();
            assert!((volume / 60.0 - 1.0).abs() < 0.01, "{gap} {strategy}: {volume}");
            let covered = covered(&layer);
            assert!(covered > 0.99, "{gap} {strategy}: {covered}");
        }
    }
}

#[test]
fn against_the_gradient_no_bridge_changes_nothing() {
    let body = |text: String| -> Vec<String> {
        text.lines().filter(|l| !l.starts_with("; ")).map(str::to_owned).collect()
    };
    // Layers that reach out by half a bead, by two beads, and not at all; and inwards, round a bore
    // and along a slot.
    let steps = FUNNEL.replace("6 - z", "6 - 4*z").replace("12", "24");
    let inwards = |of: &str| {
        let wall = format!("max(max(abs(x) - 23, abs(y) - 11.5), 10 - 2.3*z - {of})");
        FUNNEL
            .replace("(-12, -12, 0), (12", "(-23, -12, 0), (23")
            .replace("hypot(x, y) - 6 - z", &wall)
    };
    let bores = [inwards("hypot(x, y)"), inwards("max(abs(x) - 12, abs(y))")];
    let straight = FUNNEL.replace("- z,", ",");
    for source in [FUNNEL, &steps, &straight, &bores[0], &bores[1]] {
        let with = body(text(source, Strategy::Against, |_| ()));
        let without = body(text(source, Strategy::Against, |s| s.bridges.enabled = false));
        assert!(with == without, "{source}");
    }
    let gate = |enabled| text(GATE, Strategy::Against, |s| s.bridges.enabled = enabled);
    assert!(body(gate(true)) != body(gate(false)));
    assert!(beads(&gate(false), "Bridge infill").is_empty());
}

#[test]
fn what_hangs_over_is_slower_and_cooled() {
    let mut machine = Machine::builtin("generic-mixing").unwrap();
    (machine.fan.speed, machine.fan.overhang) = (0.2, 0.8);
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mut settings = settings(strategy, 4);
        settings.purge.enabled = Some(false);
        settings.cooling.min_layer_time = 0.0;
        // A layer would else begin with what the one below ended with.
        settings.order.change = 1e6;
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

#[test]
fn bridges_have_a_fan_of_their_own() {
    let mut machine = Machine::builtin("generic-mixing").unwrap();
    (machine.fan.speed, machine.fan.bridge) = (0.2, 0.6);
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mut settings = settings(strategy, 4);
        settings.purge.enabled = Some(false);
        let mut gcode = Vec::new();
        Slicer::new(&parse(GATE), &machine, &settings).slice(&mut gcode, &Quiet).unwrap();
        let gate = String::from_utf8(gcode).unwrap();
        assert!(gate.lines().any(|line| line == "M106 S153"), "{strategy}");
    }
}
