//! What chosen commands do for the deposit: the palette slab on a machine with a measured
//! transition, with the look-ahead alone and with commands chosen, and on machines that are off
//! by a fifth from what was measured.
//!
//! Prints the tables, and draws a stretch of a print where told to:
//!
//! ```text
//! cargo run --release -p fgm --example compensation -- docs/compensation.svg
//! ```

#![allow(clippy::print_stdout, reason = "an example")]

mod common;

use common::{Axis, Outcome, Plot};
use fgm::{Aim, Settings, Strategy, field::Design, gcode::Machine, sim::Transition};

/// Beads that the slab is printed in: width, height, mm.
const BEADS: [(f64, f64); 2] = [(2.0, 0.8), (0.4, 0.2)];
/// Factors on delay and length: as measured, and the corners of a fifth.
const OFF: [(f64, f64); 5] = [(1.0, 1.0), (1.2, 1.2), (0.8, 0.8), (1.2, 0.8), (0.8, 1.2)];
/// What is drawn, mm³ of the part.
const DRAWN: (f64, f64) = (900.0, 1500.0);

fn main() -> Outcome<()> {
    let (design, machine) = (common::slab()?, measured()?);
    from_design(&design, &machine)?;
    println!();
    from_colors(&design, &machine)?;
    if let Some(path) = std::env::args().nth(1) {
        draw(&design, &machine, &path)?;
    }
    Ok(())
}

/// A mixing printer with L1 = 9 mm and L2 = 18 mm of a bead of 2 x 0.8 mm.
fn measured() -> Outcome<Machine> {
    let mut machine = common::printer("geeetech-mizar-m")?;
    let transition = &mut machine.transition;
    (transition.delay_length, transition.change_length) = (Some(9.0), Some(18.0));
    (transition.bead_width, transition.layer_height) = (2.0, 0.8);
    Ok(machine)
}

/// Strategy 1 with and without towers, strategy 2.
const PRINTS: [(&str, Strategy, bool); 3] = [
    ("sectioned, towers", Strategy::Sectioned, true),
    ("sectioned", Strategy::Sectioned, false),
    ("against", Strategy::Against, false),
];

fn settings(strategy: Strategy, towers: bool, (width, height): (f64, f64)) -> Settings {
    let mut settings = Settings::default();
    settings.slice.strategy = strategy;
    settings.infill.density = 100.0.into();
    settings.purge.enabled = Some(towers);
    (settings.layer.bead_width, settings.layer.height) = (width, height);
    settings
}

/// Error from the design, by following the files.
fn from_design(design: &Design, machine: &Machine) -> Outcome<()> {
    println!(
        "| strategy | bead, mm | rms, look-ahead | rms, compensated | share | shares, off by a fifth \
         | delta E 2000, mean |"
    );
    println!("|---|---|---|---|---|---|---|");
    let transition = Transition::of(machine).ok_or("no transition")?;
    for (name, strategy, towers) in PRINTS {
        for bead in BEADS {
            let figures = |enabled| -> Outcome<Vec<_>> {
                let mut settings = settings(strategy, towers, bead);
                settings.compensation.enabled = Some(enabled);
                let (gcode, _) = common::slice(design, machine, &settings)?;
                let follow = |(delay, length)| {
                    common::fidelity(design, machine, transition.scaled(delay, length), &gcode)
                };
                OFF.into_iter().map(follow).collect()
            };
            let (plain, chosen) = (figures(false)?, figures(true)?);
            let rms = plain.iter().zip(&chosen);
            let shares: Vec<f64> = rms.map(|(p, c)| c.deposited.rms / p.deposited.rms).collect();
            let (plain, chosen) = (plain[0], chosen[0]);
            println!(
                "| {name} | {} x {} | {:.4} | {:.4} | {:.3} | {} | {:.2} to {:.2} |",
                bead.0,
                bead.1,
                plain.deposited.rms,
                chosen.deposited.rms,
                shares[0],
                listed(&shares[1..]),
                plain.deposited_delta_e.mean,
                chosen.deposited_delta_e.mean,
            );
        }
    }
    Ok(())
}

/// Error from the paths' colours, as the slicer reports it.
fn from_colors(design: &Design, machine: &Machine) -> Outcome<()> {
    println!(
        "| strategy | bead, mm | rms, look-ahead | rms, compensated | share | shares, off by a fifth |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, strategy, towers) in PRINTS {
        for bead in BEADS {
            let mut settings = settings(strategy, towers, bead);
            settings.compensation.aim = Some(Aim::Colors);
            let (_, report) = common::slice(design, machine, &settings)?;
            let deposit = report.deposit.ok_or("no transition")?;
            let share = |fit: &fgm::DepositFit| fit.rms / fit.rms_plain;
            let off: Vec<f64> = deposit.off.iter().map(share).collect();
            println!(
                "| {name} | {} x {} | {:.4} | {:.4} | {:.3} | {} |",
                bead.0,
                bead.1,
                deposit.fit.rms_plain,
                deposit.fit.rms,
                share(&deposit.fit),
                listed(&off),
            );
        }
    }
    Ok(())
}

fn listed(shares: &[f64]) -> String {
    let shares: Vec<String> = shares.iter().map(|share| format!("{share:.3}")).collect();
    shares.join(", ")
}

/// The first material along a stretch of strategy 2: designed, and laid down either way.
fn draw(design: &Design, machine: &Machine, path: &str) -> Outcome<()> {
    let mut curves = Vec::new();
    for (name, enabled) in [("look-ahead alone", false), ("compensated", true)] {
        let mut settings = settings(Strategy::Against, false, BEADS[0]);
        settings.compensation.enabled = Some(enabled);
        let (gcode, _) = common::slice(design, machine, &settings)?;
        let (mut designed, mut laid) = (Vec::new(), Vec::new());
        let mut volume = 0.0;
        common::lay_down(machine, &gcode, |piece, offset| {
            if !piece.is_part() {
                return;
            }
            volume += piece.volume;
            if (DRAWN.0..DRAWN.1).contains(&volume) {
                laid.push((volume, piece.deposited[1].fractions()[0]));
                let below = offset + 0.5 * piece.height * fgm::core::Point3::Z;
                if let Ok(mixture) = design.fractions.mixture(piece.to - below) {
                    designed.push((volume, mixture.fractions()[0]));
                }
            }
        })?;
        curves.push((name.to_owned(), laid));
        if enabled {
            curves.push(("designed".to_owned(), designed));
        }
    }
    let x = Axis { label: "extruded, mm³", range: DRAWN, steps: 6, decimals: 0 };
    let label = "share of blue, strategy against";
    let y = Axis { label, range: (0.0, 0.25), steps: 5, decimals: 2 };
    std::fs::write(path, Plot { x, y, dots: false, curves }.svg()?)?;
    Ok(())
}
