//! Slices a design from text in both strategies and prints the figures.

#![allow(clippy::print_stdout, reason = "an example shows what it does")]

use fgm::{Quiet, Settings, Slicer, Strategy, design, gcode::Machine};

const DESIGN: &str = r#"
    fgrade(["rho/12", "1 - rho/12"], ["blue", "yellow"]) {
        difference() { cylinder(12, 4); cylinder(4, 4); }
    }"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let loaded = design::parse_vcad(DESIGN, ".".as_ref(), &design::LoadOptions::default())?;
    let machine = Machine::builtin("generic-mixing").ok_or("no such printer")?;
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mut settings = Settings::default();
        settings.slice.strategy = strategy;
        settings.infill.density = 100.0.into();
        let mut gcode = Vec::new();
        let report = Slicer::new(&loaded.design, &machine, &settings).slice(&mut gcode, &Quiet)?;
        println!(
            "{strategy}: {} layers, {} faces, {:.1} of {:.1} mm3, {} kB of G-code",
            report.layers,
            report.faces,
            report.extruded_mm3 - report.purge_mm3,
            report.model_mm3,
            gcode.len() / 1000
        );
    }
    Ok(())
}
