//! What the report says of the deposit, with and without commands chosen for it, and the purge
//! that a transition asks for.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{parse, settings, slice};
use fgm::{Aim, Report, Strategy};

/// A plate with a gradient along x, wide enough that every band takes several transitions.
const PLATE: &str =
    r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["white", "blue"]) { rectprism(60, 40, 1.6); }"#;

fn sliced(strategy: Strategy, changes: &str) -> Report {
    let mut settings = settings(strategy, 4);
    settings.infill.density = 100.0.into();
    let table: toml::Table = changes.parse().unwrap();
    let wanted: fgm::Settings = table.try_into().unwrap();
    settings.compensation = wanted.compensation.clone();
    settings.purge = wanted.purge.clone();
    settings.skins = wanted.skins.clone();
    let mut machine = fgm::gcode::Machine::builtin("generic-mixing").unwrap();
    machine.transition.delay = Some(5.0);
    machine.transition.change = Some(10.0);
    let design = parse(PLATE);
    let mut out = Vec::new();
    fgm::Slicer::new(&design, &machine, &settings).slice(&mut out, &fgm::Quiet).unwrap()
}

#[test]
fn a_printer_with_a_transition_is_compensated() {
    for (strategy, aim, most) in [
        (Strategy::Sectioned, Aim::Colors, 0.75),
        (Strategy::Against, Aim::Colors, 0.75),
        // Its lines run through a band in less than the transition.
        (Strategy::Sectioned, Aim::Design, 0.95),
        (Strategy::Against, Aim::Design, 0.75),
    ] {
        // On a tower nothing is left to be done for the paths' colours.
        let aimed = format!("[purge]\nenabled = false\n[compensation]\naim = \"{aim}\"\n");
        let deposit = sliced(strategy, &aimed).deposit.unwrap();
        assert!(deposit.compensated && deposit.aim == aim);
        assert!(deposit.fit.rms < most * deposit.fit.rms_plain, "{strategy}: {deposit:?}");
        assert_eq!(deposit.off.len(), 4);
        assert!(
            deposit.off.iter().all(|fit| fit.rms <= fit.rms_plain * (1.0 + 1e-9)),
            "{deposit:?}"
        );

        let plain = sliced(strategy, &format!("{aimed}enabled = false")).deposit.unwrap();
        assert!(!plain.compensated);
        assert_eq!(plain.fit.rms, plain.fit.rms_plain);
        assert!((plain.fit.rms - deposit.fit.rms_plain).abs() < 1e-9, "{plain:?} {deposit:?}");
    }
}

#[test]
fn a_printer_without_one_is_not() {
    let (report, _) = slice(&parse(PLATE), "generic-mixing", &settings(Strategy::Against, 4));
    assert_eq!(report.deposit, None);
}

#[test]
fn a_tower_takes_the_whole_of_a_change() {
    let aimed = "[purge]\ntolerance = 0.0\n[compensation]\naim = \"colors\"\nenabled = false";
    let fit = sliced(Strategy::Sectioned, aimed).deposit.unwrap().fit;
    assert!(fit.rms < 1e-6, "{fit:?}");
}

#[test]
fn infill_that_takes_the_old_colour_is_told_apart() {
    let deposit = |into: &str| {
        let skins = "[skins]\ntop = 1\nbottom = 1\n";
        let aimed = format!("{skins}[purge]\ninto = \"{into}\"\ntolerance = 0.0\n");
        sliced(Strategy::Sectioned, &(aimed + "[compensation]\naim = \"colors\"")).deposit.unwrap()
    };
    let (tower, infill) = (deposit("tower"), deposit("infill"));
    assert_eq!((tower.hidden_mm3, tower.hidden_rms), (None, None));
    assert!(infill.fit.rms < 1e-6 && infill.hidden_mm3 > Some(0.0), "{infill:?}");
    // The old colour, then half way to the new one, where a band on either side is a quarter.
    assert!(infill.hidden_rms > Some(0.08) && infill.hidden_rms < Some(0.25), "{infill:?}");
}

#[test]
fn the_purge_follows_the_tolerance() {
    let purge = |tolerance: f64| {
        sliced(Strategy::Sectioned, &format!("[purge]\ntolerance = {tolerance}")).purge_mm3
    };
    // A change is a quarter: at 0.125 half of its length is left out, at 0.25 all of it.
    let (whole, half, none) = (purge(0.0), purge(0.125), purge(0.25));
    assert!(half < 0.8 * whole && half > 0.3 * whole, "{half} {whole}");
    assert!(none < 0.5 * half, "{none} {half}");
}
