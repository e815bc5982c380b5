//! A disc cut by the isolines of a mixture into bands: the faces, what borders on what, and where
//! a straight path changes colour.
//!
//! `cargo run -p fgm-arrange --example isolines`

#![allow(clippy::print_stdout)]

use fgm_arrange::{ArrangeError, ArrangeOptions, Arrangement, Chain};
use fgm_core::{Point2, point_at};
use std::f64::consts::TAU;

/// What a line is: the outline, or the isoline at some percentage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    Outline,
    Iso(u32),
}

fn main() -> Result<(), ArrangeError> {
    let disc: Vec<_> =
        (0..90).map(|i| Point2::from_angle(TAU * f64::from(i) / 90.0) * 20.0).collect();
    // Wavy lines across the disc, a little longer than it.
    let wave = |x: f64| -> Vec<_> {
        let at = |j: i32| f64::from(j) * 0.5;
        (-50..=50).map(|j| Point2::new(x + (0.4 * at(j)).sin(), at(j))).collect()
    };
    let isolines: Vec<_> = [25, 50, 75].map(|p| (p, wave(f64::from(p) * 0.4 - 20.0))).into();

    let mut chains = vec![Chain::closed(&disc, Line::Outline)];
    chains.extend(isolines.iter().map(|(percent, line)| Chain::open(line, Line::Iso(*percent))));
    let arrangement = Arrangement::new(&chains, &ArrangeOptions::default())?;

    for face in arrangement.faces() {
        let p = face.inside_point();
        println!(
            "face {}: {:.3} mm², ({:.3}, {:.3}) is inside",
            face.id().0,
            face.area(),
            p.x,
            p.y
        );
        for border in face.neighbours() {
            let lines: Vec<_> = border.labels().map(|l| l.label).collect();
            match border.neighbour() {
                Some(other) => println!("  beyond {lines:?}: face {}", other.0),
                None => println!("  beyond {lines:?}: nothing"),
            }
        }
    }

    let path = [Point2::new(-25.0, 3.0), Point2::new(25.0, 3.0)];
    let mut spans = Vec::new();
    arrangement.cut(&path, &mut spans);
    println!("along y = 3:");
    for span in &spans {
        let (from, to) = (point_at(&path, span.from).x, point_at(&path, span.to).x);
        println!("  x {from:.3} to {to:.3}: {:?}", span.label);
    }
    Ok(())
}
