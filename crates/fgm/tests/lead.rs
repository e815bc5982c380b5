//! The look-ahead on the plate of the paper's figure 14: a sharp change in the middle, hatched
//! along y, with the dead volume of the Geeetech Mizar M.

mod common;

use common::{deposit, parse, settings, slice};
use fgm::Strategy;

const DEAD_VOLUME: f64 = 68.6;
const PLATE: &str = r#"fgrade(["x < 0", "x >= 0"], ["white", "blue"]) { rectprism(60, 40, 0.2); }"#;

fn plate(dead_volume: f64, purge: bool) -> common::Deposit {
    let mut settings = settings(Strategy::Sectioned, 2);
    settings.infill.density = 100.0.into();
    settings.infill.angle = 90.0;
    settings.walls.count = 0;
    settings.purge.enabled = Some(purge);
    settings.lead.volume = Some(dead_volume);
    deposit(&slice(&parse(PLATE), "geeetech-mizar-m", &settings).1)
}

/// Extruded before the first bead beyond the middle on the second colour's side.
fn boundary(deposit: &common::Deposit, second: usize) -> f64 {
    let side = if second == 0 { 1.0 } else { -1.0 };
    let mut extruded = 0.0;
    for bead in &deposit.beads {
        // Colour 0 has the least of the first material: it belongs on the side of positive x.
        if !bead.is_tower() && 0.5 * (bead.from.x + bead.to.x) * side > 0.0 {
            return extruded;
        }
        extruded += bead.volume;
    }
    extruded
}

#[test]
fn the_command_stands_the_dead_volume_before_the_boundary() {
    let deposit = plate(DEAD_VOLUME, false);
    let [_, (second, commanded)] = deposit.commands[..] else {
        panic!("one change: {:?}", deposit.commands);
    };
    let lead = boundary(&deposit, second) - commanded;
    assert!((lead - DEAD_VOLUME).abs() < 0.01, "{lead}");
}

#[test]
fn with_a_tower_the_new_colour_comes_out_where_the_tower_ends() {
    let deposit = plate(DEAD_VOLUME, true);
    let (second, commanded) = *deposit.commands.last().unwrap();
    let lead = boundary(&deposit, second) - commanded;
    assert!((lead - DEAD_VOLUME).abs() < 0.01, "{lead}");
}

#[test]
fn without_a_dead_volume_the_command_stands_at_the_boundary() {
    let deposit = plate(0.0, false);
    let (second, commanded) = *deposit.commands.last().unwrap();
    assert!((boundary(&deposit, second) - commanded).abs() < 1e-3);
}
