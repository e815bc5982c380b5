//! How the colour error of a print falls with the number of colours: the palette slab sliced with
//! more and more of them, and each file followed through a model of the machine.
//!
//! Prints a table, and draws it where told to:
//!
//! ```text
//! cargo run --release -p fgm --example fidelity -- docs/fidelity.svg
//! ```

#![allow(clippy::print_stdout, reason = "an example")]

use std::{error::Error, fmt::Write as _, path::Path};

use fgm::{
    ColorCount, Quiet, Sections, Settings, Slicer, Strategy, design,
    field::Design,
    gcode::{Machine, Reader},
    sim::{CheckDesign, CheckOptions, FidelityFigures, Head, Reference, check},
};

const SECTIONED: [usize; 4] = [4, 8, 12, 16];
const AGAINST: [usize; 4] = [12, 24, 36, 48];

fn main() -> Result<(), Box<dyn Error>> {
    let slab = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/slab.vcad");
    let design = design::load(&slab, &design::LoadOptions::default())?.design;
    println!("| strategy | colours | composition error, mean | delta E 2000, mean | 95 % |");
    println!("|---|---|---|---|---|");
    let mut curves = Vec::new();
    for (strategy, counts) in [(Strategy::Sectioned, SECTIONED), (Strategy::Against, AGAINST)] {
        let mut curve = Vec::new();
        for colors in counts {
            let figures = figures(&design, strategy, colors)?;
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
        std::fs::write(path, plot(&curves)?)?;
    }
    Ok(())
}

/// Slices the design and follows the file.
fn figures(
    design: &Design,
    strategy: Strategy,
    colors: usize,
) -> Result<FidelityFigures, Box<dyn Error>> {
    let machine = Machine::builtin("geeetech-mizar-m").ok_or("no such printer")?;
    let mut settings = Settings::default();
    settings.slice.strategy = strategy;
    settings.palette.colors = Some(ColorCount::Count(colors));
    settings.infill.density = 100.0;
    let mut gcode = Vec::new();
    Slicer::new(design, &machine, &settings).slice(&mut gcode, &Quiet)?;

    let mut reader = Reader::new(gcode.as_slice());
    let head = Head::read(&mut reader)?;
    let mut options = CheckOptions::of(Some(&machine));
    options.replay.tagged_layers = head.tagged_layers;
    options.colors = fgm::material_colors(design);
    let sections = Sections::new(design, &settings)?;
    let outline = |z| sections.at(z).map_err(|e| e.to_string());
    let offset = head.offset.ok_or("the file does not say where the design stands")?;
    let reference = Reference { materials: design.fractions.as_ref(), offset };
    let compared = CheckDesign { reference, outline: &outline };
    let report = check(reader, &options, Some(&compared), &mut |_| Ok(()))?;
    Ok(report.fidelity.ok_or("nothing was compared")?)
}

/// The curves as an SVG of 640 by 360.
fn plot(curves: &[(String, Vec<(f64, f64)>)]) -> Result<String, std::fmt::Error> {
    const INKS: [&str; 2] = ["#1f5fa8", "#c0501d"];
    let highest = curves.iter().flat_map(|c| &c.1).map(|p| p.1).fold(1.0, f64::max).ceil();
    let place =
        |(colors, error): (f64, f64)| (60.0 + colors * 11.0, 310.0 - error / highest * 270.0);
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 360\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"640\" height=\"360\" fill=\"white\"/>\n",
    );
    let (left, bottom) = place((0.0, 0.0));
    let (right, top) = place((50.0, highest));
    writeln!(svg, "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"black\"/>")?;
    for colors in (0..=48).step_by(12) {
        let (x, _) = place((f64::from(colors), 0.0));
        writeln!(svg, "<text x=\"{x}\" y=\"328\" text-anchor=\"middle\">{colors}</text>")?;
    }
    for part in 0..=4 {
        let error = highest * f64::from(part) / 4.0;
        let (_, y) = place((0.0, error));
        let base = y + 4.0;
        writeln!(svg, "<text x=\"52\" y=\"{base}\" text-anchor=\"end\">{error:.1}</text>")?;
        writeln!(svg, "<path d=\"M{left} {y}H{right}\" stroke=\"#ddd\"/>")?;
    }
    writeln!(svg, "<text x=\"340\" y=\"350\" text-anchor=\"middle\">colours</text>")?;
    writeln!(svg, "<text x=\"62\" y=\"24\">mean delta E 2000 of the deposit, slab</text>")?;
    for (row, ((name, curve), ink)) in curves.iter().zip(INKS).enumerate() {
        let points: Vec<String> =
            curve.iter().map(|&p| place(p)).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let line = points.join(" ");
        writeln!(
            svg,
            "<polyline points=\"{line}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"2\"/>"
        )?;
        for point in &points {
            let (x, y) = point.split_once(',').unwrap_or_default();
            writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"4\" fill=\"{ink}\"/>")?;
        }
        let y = 60 + 20 * row;
        writeln!(svg, "<text x=\"480\" y=\"{y}\" fill=\"{ink}\">{name}</text>")?;
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}
