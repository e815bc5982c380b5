//! What is printed around the part on the first layer, and how that layer is drawn in.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Settings, Strategy};

const BOX: &str = r#"fgrade(["x/10 + 0.5", "0.5 - x/10"], ["a", "b"]) { cube(10); }"#;

fn beads(design: &str, strategy: Strategy, change: impl Fn(&mut Settings)) -> Vec<Bead> {
    let mut settings = settings(strategy, 4);
    settings.slice.last_layer = Some(12);
    change(&mut settings);
    deposit(&slice(&parse(design), "generic-mixing", &settings).1).beads
}

fn reach<'a>(beads: impl Iterator<Item = &'a Bead>) -> f64 {
    let ends = beads.flat_map(|b| [b.from, b.to]);
    ends.fold(0.0, |reach: f64, p| reach.max(p.abs().max_element()))
}

#[test]
fn brim_and_skirt_stand_around_the_part() {
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let beads = beads(BOX, strategy, |s| {
            s.brim.width = 2.0;
            (s.skirt.loops, s.skirt.gap) = (1, 3.0);
            s.purge.enabled = Some(false);
        });
        let (around, part): (Vec<_>, Vec<_>) =
            beads.iter().partition(|b| b.role == "Skirt/Brim" || b.role == "Skirt");
        assert!(around.iter().all(|b| b.layer == 0));
        assert!((reach(part.into_iter()) - 4.8).abs() < 0.03);
        // Six loops of 0.357 mm, room, and the skirt.
        let brim = around.iter().filter(|b| b.from.abs().max_element() < 8.0);
        let last = 5.0 + 6.0 * 0.3571 - 0.2;
        assert!((reach(brim.copied()) - last).abs() < 0.01);
        let skirt = last + 0.2 + 3.0 + 0.2;
        assert!((reach(around.iter().copied()) - skirt).abs() < 0.01);
    }
}

#[test]
fn towers_keep_away_from_the_brim() {
    let beads = beads(BOX, Strategy::Sectioned, |s| s.brim.width = 8.0);
    let tower = |b: &&Bead| b.is_tower();
    assert!(beads.iter().any(Bead::is_tower));
    let near = beads.iter().filter(tower).map(|b| b.from.abs().max_element());
    assert!(near.fold(f64::INFINITY, f64::min) > 5.0 + 8.0 + 5.0);
}

#[test]
fn only_the_first_layer_is_drawn_in() {
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let beads = beads(BOX, strategy, |s| {
            s.layer.elephant_foot = 0.3;
            s.purge.enabled = Some(false);
        });
        let of = |layer| reach(beads.iter().filter(move |b| b.layer == layer));
        assert!((of(1) - of(0) - 0.3).abs() < 0.02, "{strategy}: {} {}", of(0), of(1));
    }
}

/// The lowest layers of a ball are narrower than a bead: its first is another one.
#[test]
fn a_ball_has_its_brim_where_it_begins() {
    let ball = r#"fgrade(["x/10 + 0.5", "0.5 - x/10"], ["a", "b"]) { sphere(0.9); }"#;
    let beads = beads(ball, Strategy::Sectioned, |s| {
        s.brim.width = 2.0;
        s.layer.height = 0.02;
        s.layer.bead_width = 0.8;
        s.purge.enabled = Some(false);
    });
    assert!(beads[0].z > -0.85, "{}", beads[0].z);
    assert!(beads[0].role.starts_with("Skirt"), "{}", beads[0].role);
}
