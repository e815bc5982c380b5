//! `arrange-peers write DIR` makes the inputs; `arrange-peers fgm|i_overlay FILE [RUNS]` times one
//! library on one of them.
//!
//! A file has a line of whole numbers `x y x y ...` for each polyline, in steps of 1e-6 mm; rings
//! repeat their first point.

mod inputs;
mod report;

use fgm_arrange::{ArrangeOptions, Arranger, Chain};
use fgm_core::Point2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::slice::FloatSlice;
use report::{Report, fastest};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match *words {
        ["write", folder] => inputs::write(Path::new(folder)),
        [library, file] => time(library, file, 1),
        [library, file, runs] => time(library, file, runs.parse()?),
        _ => Err("arrange-peers write DIR | fgm FILE [RUNS] | i_overlay FILE [RUNS]".into()),
    }
}

fn time(library: &str, file: &str, runs: usize) -> Result<(), Box<dyn Error>> {
    let lines = inputs::read(Path::new(file))?;
    let mut report = match library {
        "fgm" => fgm(&lines, runs)?,
        "i_overlay" => i_overlay(&lines, runs),
        _ => return Err(format!("no library {library}").into()),
    };
    report.input = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into();
    report.print();
    Ok(())
}

fn fgm(lines: &[Vec<Point2>], runs: usize) -> Result<Report, Box<dyn Error>> {
    let chains: Vec<_> = lines.iter().map(|line| Chain::open(line, 0u8)).collect();
    let options = ArrangeOptions::default().with_dangling(true);
    let mut arranger = Arranger::new();
    let (seconds, arrangement) = fastest(runs, || arranger.arrange(&chains, &options));
    let arrangement = arrangement?;
    // The others count every point of a polyline as a vertex.
    let segments: usize = arrangement.edges().map(|edge| edge.points().len() - 1).sum();
    let vertices = arrangement.vertex_count() + segments - arrangement.edge_count();
    Ok(Report {
        library: "fgm-arrange",
        input: String::new(),
        seconds,
        vertices: Some(vertices),
        edges: Some(segments),
        faces: arrangement.face_count(),
        area: arrangement.faces().map(|face| face.area()).sum(),
    })
}

/// i_overlay cuts shapes by lines, so the lines are laid over a square around them all; the region
/// of the square outside of the lines is one face, or a few, more.
fn i_overlay(lines: &[Vec<Point2>], runs: usize) -> Report {
    let square = [[-80.0, -80.0], [80.0, -80.0], [80.0, 80.0], [-80.0, 80.0]].to_vec();
    let paths: Vec<Vec<[f64; 2]>> =
        lines.iter().map(|line| line.iter().map(|p| [p.x, p.y]).collect()).collect();
    let (seconds, shapes) = fastest(runs, || {
        let rule = FillRule::NonZero;
        square.slice_custom_by(&paths, rule, Default::default(), Solver::AUTO)
    });
    let twice = |ring: &Vec<[f64; 2]>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    };
    Report {
        library: "i_overlay",
        input: String::new(),
        seconds,
        vertices: None,
        edges: None,
        faces: shapes.len(),
        area: shapes.iter().flatten().map(twice).sum::<f64>() * 0.5,
    }
}
