//! How the colour error of a print falls with the number of colours: the palette slab sliced with
//! more and more of them, and each file followed through a model of the machine.
//!
//! Prints a table, and draws it where told to:
//!
//! ```text
//! cargo run --release -p fgm --example fidelity -- docs/fidelity.svg
//! ```

#![allow(clippy::print_stdout, reason = "an example")]

mod common;

use common::{Axis, Outcome, Plot};
use fgm::{ColorCount, Settings, Strategy, sim::Model};

const SECTIONED: [usize; 4] = [4, 8, 12, 16];
const AGAINST: [usize; 4] = [12, 24, 36, 48];

fn main() -> Outcome<()> {
    let (design, machine) = (common::slab()?, common::printer("geeetech-mizar-m")?);
    let transition = Model::of(&machine).transition;
    println!("| strategy | colours | composition error, mean | delta E 2000, mean | 95 % |");
    println!("|---|---|---|---|---|");
    let mut curves = Vec::new();
    for (strategy, counts) in [(Strategy::Sectioned, SECTIONED), (Strategy::Against, AGAINST)] {
        let mut curve = Vec::new();
        for colors in counts {
            let mut settings = Settings::default();
            settings.slice.strategy = strategy;
            settings.palette.colors = Some(ColorCount::Count(colors));
            settings.infill.density = 100.0.into();
            let (gcode, _) = common::slice(&design, &machine, &settings)?;
            let figures = common::fidelity(&design, &machine, transition, &gcode)?;
            let (error, color) = (&figures.deposited, &figures.deposited_delta_e);
            println!(
                "| {strategy} | {colors} | {:.4} | {:.2} | {:.2} |",
                error.mean, color.mean, color.percentile_95
            );
            curve.push((colors as f64, color.mean));
        }
        curves.push((strategy.to_string(), curve));
    }
    if let Some(path) = std::env::args().nth(1) {
        let x = Axis { label: "colours", range: (0.0, 48.0), steps: 4, decimals: 0 };
        let label = "mean delta E 2000 of the deposit, slab";
        let y = Axis { label, range: (0.0, 6.0), steps: 4, decimals: 1 };
        std::fs::write(path, Plot { x, y, dots: true, curves }.svg()?)?;
    }
    Ok(())
}
