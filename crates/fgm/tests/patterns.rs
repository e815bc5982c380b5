//! Patterns and directions of the filling, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Pattern, Quiet, Settings, Slicer, Strategy, core::bead, gcode::Machine};

const BOX: &str = r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["a", "b"]) { rectprism(60, 60, 2); }"#;

/// The sparse filling of three layers between the skins.
fn filling(change: impl Fn(&mut Settings)) -> Vec<Bead> {
    let mut settings = settings(Strategy::Sectioned, 3);
    settings.purge.enabled = Some(false);
    (settings.skins.top, settings.skins.bottom, settings.infill.density) = (3, 3, 30.0.into());
    settings.slice.last_layer = Some(7);
    change(&mut settings);
    let beads = deposit(&slice(&parse(BOX), "generic-mixing", &settings).1).beads;
    beads.into_iter().filter(|b| b.role == "Internal infill").collect()
}

/// Inside three walls.
fn inside() -> f64 {
    let spacing = bead::spacing(0.4, 0.2);
    let side = 60.0 - 2.0 * (0.2 + 2.5 * spacing);
    side * side
}

#[test]
fn every_pattern_fills_its_share() {
    for pattern in Pattern::ALL {
        let beads = filling(|s| s.infill.pattern = pattern);
        let layers = 4.0;
        assert!(beads.iter().all(|b| (3..7).contains(&b.layer)), "{pattern}");
        let volume: f64 = beads.iter().map(|b| b.volume).sum();
        let share = volume / (layers * inside() * 0.2 * 0.3);
        // A border's joining pieces on top, at most.
        assert!(share > 0.95 && share < 1.09, "{pattern}: {share}");
    }
}

/// Thin at one end and at the bottom, dense at the other and higher up; near the walls where asked.
#[test]
fn the_density_follows_a_formula() {
    let volume = |beads: &[Bead], low: f64, layers: std::ops::Range<usize>| -> f64 {
        let inside = |b: &&Bead| {
            let middle = b.from.midpoint(b.to);
            // Lines run all the way; what joins them lies at their ends.
            layers.contains(&b.layer)
                && (low..low + 20.0).contains(&middle.x)
                && middle.y.abs() < 20.0
        };
        beads.iter().filter(inside).map(|b| b.volume).sum()
    };
    // Lines across the gradient, so that a bead lies at one density.
    let graded = |text: &str| {
        filling(|s| {
            s.infill.density = text.parse().unwrap();
            s.infill.pattern = Pattern::Aligned;
            s.infill.angle = 90.0;
        })
    };
    let solid = 20.0 * inside().sqrt() * 0.2;
    let beads = graded("30 + x");
    for (low, wanted) in [(-25.0, 0.15), (-10.0, 0.3), (5.0, 0.45)] {
        let share = volume(&beads, low, 3..7) / (4.0 * solid);
        assert!((share - wanted).abs() < 0.036, "{low}: {share}");
    }
    // The box's middle is at 0: the layers cut at -0.3, -0.1, 0.1 and 0.3 mm.
    let beads = graded("40 + 100 z");
    for (layer, wanted) in (3..7).zip([0.1, 0.3, 0.5, 0.7]) {
        let share = volume(&beads, -10.0, layer..layer + 1) / solid;
        assert!((share - wanted).abs() < 0.036, "{layer}: {share}");
    }
    let beads = graded("hypot(x, y) > 15 ? 40 : 0");
    assert!(beads.iter().all(|b| b.from.length().max(b.to.length()) > 14.9));
    assert!(beads.iter().map(Bead::length).sum::<f64>() > 100.0);
    // The sides are far, top and bottom 1 mm away.
    let beads = graded("d > -0.8 ? 50 : 10");
    let at = |layer: usize| volume(&beads, -10.0, layer..layer + 1) / solid;
    assert!((at(3) - 0.5).abs() < 0.036 && (at(4) - 0.1).abs() < 0.036, "{} {}", at(3), at(4));
}

#[test]
fn a_density_that_cannot_be_followed_is_an_error() {
    let error = |text: &str, pattern| {
        let mut settings = settings(Strategy::Sectioned, 3);
        (settings.infill.density, settings.infill.pattern) = (text.parse().unwrap(), pattern);
        let machine = Machine::builtin("generic-mixing").unwrap();
        let design = parse(BOX);
        let error = Slicer::new(&design, &machine, &settings).slice(&mut Vec::new(), &Quiet);
        error.unwrap_err().to_string()
    };
    assert!(
        error("10 + x", Pattern::Gyroid).starts_with("infill.density varies, and gyroid lines")
    );
    let nan = error("20 + sqrt(x)", Pattern::Grid);
    assert!(nan.starts_with("the density of the infill is not a number at (-"), "{nan}");
}

#[test]
fn lines_run_as_their_layer_says() {
    let angles = [10.0, 70.0, -50.0];
    let beads = filling(|s| s.infill.angles = angles.to_vec());
    for layer in beads.chunk_by(|a, b| a.layer == b.layer) {
        let wanted = angles[layer[0].layer % 3].to_radians();
        let along: f64 = layer
            .iter()
            .filter(|b| {
                let way = b.to - b.from;
                way.normalize().perp_dot(fgm::core::Point2::from_angle(wanted)).abs() < 1e-2
            })
            .map(Bead::length)
            .sum();
        let all: f64 = layer.iter().map(Bead::length).sum();
        assert!(along > 0.9 * all, "{along} of {all} mm");
    }
}
