//! Patterns and directions of the filling, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Pattern, Settings, Strategy, core::bead};

const BOX: &str = r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["a", "b"]) { rectprism(60, 60, 2); }"#;

/// The sparse filling of three layers between the skins.
fn filling(change: impl Fn(&mut Settings)) -> Vec<Bead> {
    let mut settings = settings(Strategy::Sectioned, 3);
    settings.purge.enabled = Some(false);
    (settings.skins.top, settings.skins.bottom, settings.infill.density) = (3, 3, 30.0);
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
