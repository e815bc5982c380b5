//! Prints what a design is: `cargo run -p fgm-design --example inspect -- FILE [FRACTION ...]`.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::path::Path;
use std::process::ExitCode;

use fgm_design::{LoadOptions, load};
use fgm_field::Geometry;

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let path = args
        .next()
        .unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/examples/ring.vcad").to_string());
    let options = LoadOptions { fractions: args.collect(), ..LoadOptions::default() };
    let loaded = match load(Path::new(&path), &options) {
        Ok(loaded) => loaded,
        Err(error) => {
            eprintln!("{error}");
            if let (Some(at), Some(text)) = (error.location(), error.source_text()) {
                eprintln!("{}", text.lines().nth(at.line - 1).unwrap_or_default());
                eprintln!("{:>1$}", "^", at.column);
            }
            return ExitCode::FAILURE;
        }
    };
    for warning in &loaded.warnings {
        println!("warning: {warning}");
    }
    let design = loaded.design;
    let kind = match &design.geometry {
        Geometry::Field(_) => "field",
        Geometry::Mesh(_) => "mesh",
    };
    println!("{} ({kind}), {} to {} mm", design.name, design.bounds.min, design.bounds.max);
    let center = design.bounds.center();
    match design.fractions.mixture(center) {
        Ok(mixture) => {
            for (material, fraction) in design.materials.iter().zip(mixture.fractions()) {
                println!("{:>6.1} % {} at the middle", 100.0 * fraction, material.name);
            }
        }
        Err(error) => println!("{error}"),
    }
    ExitCode::SUCCESS
}
