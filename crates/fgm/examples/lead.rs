//! Where a sharp change lies on a plate, with the right look-ahead and without: figure 14 of the
//! gradient-slicing paper, simulated.
//!
//! Prints a table, and draws it where told to:
//!
//! ```text
//! cargo run --release -p fgm --example lead -- docs/lead.svg
//! ```

#![allow(clippy::print_stdout, reason = "an example")]

mod common;

use common::{Axis, Outcome, Plot};
use fgm::{ColorCount, Settings, design, field::Design, gcode::Machine};

/// White on the left, blue on the right.
const PLATE: &str = r#"fgrade(["x < 0", "x >= 0"], ["white", "blue"]) { rectprism(60, 40, 0.2); }"#;

fn main() -> Outcome<()> {
    let design = design::parse_vcad(PLATE, ".".as_ref(), &design::LoadOptions::default())?.design;
    let machine = common::printer("geeetech-mizar-m")?;
    println!("| look-ahead, mm³ | the change lies beyond the middle, mm |");
    println!("|---|---|");
    let mut curves = Vec::new();
    for (name, lead) in [("with the lead", machine.dead_volume()), ("without", 0.0)] {
        let course = course(&design, &machine, lead)?;
        println!("| {lead:.2} | {:.2} |", change(&course).ok_or("nothing changes")?);
        curves.push((name.to_owned(), course));
    }
    if let Some(path) = std::env::args().nth(1) {
        let x = Axis {
            label: "beyond the middle, towards the half printed last, mm",
            range: (-30.0, 30.0),
            steps: 6,
            decimals: 0,
        };
        let label = "share of the second colour in what is laid down";
        let y = Axis { label, range: (0.0, 1.0), steps: 4, decimals: 2 };
        std::fs::write(path, Plot { x, y, dots: false, curves }.svg()?)?;
    }
    Ok(())
}

/// The plate hatched along y with a look-ahead; gives what is laid down line by line from the
/// half printed first on: mm beyond the middle, and the share of what is printed last.
fn course(design: &Design, machine: &Machine, lead: f64) -> Outcome<Vec<(f64, f64)>> {
    let mut settings = Settings::default();
    settings.palette.colors = Some(ColorCount::Count(2));
    settings.infill.density = 100.0.into();
    settings.infill.angle = 90.0;
    settings.walls.count = 0;
    settings.purge.enabled = Some(false);
    settings.lead.volume = Some(lead);
    let (gcode, _) = common::slice(design, machine, &settings)?;
    // For every line its x, its volume and that of the second material in it.
    let mut lines: Vec<(f64, f64, f64)> = Vec::new();
    common::lay_down(machine, &gcode, |piece, offset| {
        let x = piece.to.x - offset.x;
        // The hatch's turns run across.
        if !piece.is_part() || (piece.to.x - piece.from.x).abs() > 1e-3 {
            return;
        }
        if lines.last().is_none_or(|line| (line.0 - x).abs() > 1e-3) {
            lines.push((x, 0.0, 0.0));
        }
        if let Some(line) = lines.last_mut() {
            line.1 += piece.volume;
            line.2 += piece.volume * piece.mixture_at(0.5).fractions()[1];
        }
    })?;
    // Either half may come first, each from the middle outwards.
    let forward = lines.first().is_some_and(|line| line.0 < 0.0);
    let course = lines.into_iter().map(|(x, volume, second)| match forward {
        true => (x, second / volume),
        false => (-x, 1.0 - second / volume),
    });
    let mut course: Vec<(f64, f64)> = course.collect();
    course.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(course)
}

/// Between the last line before the change and the first after it.
fn change(course: &[(f64, f64)]) -> Option<f64> {
    let next = course.iter().position(|(_, share)| *share > 0.5).filter(|next| *next > 0)?;
    Some(0.5 * (course[next - 1].0 + course[next].0))
}
