//! Writes a graded spiral for a mixing hotend, reads it back, and tells what came out and how
//! fast: `cargo run --release -p fgm-gcode --example spiral [MOVES]`.
#![allow(clippy::print_stdout, reason = "an example tells what it did")]

use std::{error::Error, time::Instant};

use fgm_core::{ColorId, Mixture, Motion, Point2, Point3, Role};
use fgm_gcode::{Lead, Machine, Reader, Writer, WriterOptions};

const COLORS: u16 = 16;

/// A spiral of `moves` beads, whose colour goes from the first to the last and back.
fn spiral(moves: u32) -> impl Iterator<Item = Motion> {
    let start =
        [Motion::Layer { index: 0, z: 0.2, height: 0.2 }, Motion::Travel { to: Point2::ZERO }];
    let mut last = None;
    let beads = (1..=moves).flat_map(move |i| {
        let share = f64::from(i) / f64::from(moves);
        let angle = 0.01 * f64::from(i);
        let radius = 5.0 + 100.0 * share;
        let to = Point2::from_angle(angle) * radius;
        let wave = (share * 40.0) % 2.0;
        let step = (f64::from(COLORS - 1) * (wave - 1.0).abs()).round() as u16;
        let color = (last.replace(step) != Some(step)).then_some(Motion::Color(ColorId(step)));
        let bead = Motion::Extrude { to, width: 0.4, role: Role::SolidInfill };
        color.into_iter().chain([bead])
    });
    start.into_iter().chain(beads)
}

fn main() -> Result<(), Box<dyn Error>> {
    let moves = std::env::args().nth(1).map_or(Ok(100_000), |n| n.parse())?;
    let machine = Machine { max_flow: Some(8.0), ..Machine::default() };
    let share = |i: u16| (f64::from(i) + 0.5) / f64::from(COLORS);
    let palette: Vec<Mixture> = (0..COLORS)
        .map(|i| Mixture::from_weights(&[1.0 - share(i), share(i)]))
        .collect::<Result<_, _>>()?;
    let options =
        WriterOptions { offset: Point3::new(125.0, 125.0, 0.0), ..WriterOptions::of(&machine) };

    let begun = Instant::now();
    let motions: Vec<Motion> = spiral(moves).collect();
    println!("made    {moves} beads in {:?}", begun.elapsed());

    let begun = Instant::now();
    let led: Vec<_> = Lead::new(68.6).over(motions.iter().copied()).collect();
    println!("led     {} steps in {:?}", led.len(), begun.elapsed());

    let mut gcode = Vec::with_capacity(40 * moves as usize);
    let begun = Instant::now();
    let mut writer = Writer::new(&mut gcode, &machine, &machine.states(&palette)?, &options)?;
    for step in led {
        writer.push(step)?;
    }
    let summary = writer.finish()?;
    println!("wrote   {} bytes in {:?}", summary.bytes, begun.elapsed());

    let begun = Instant::now();
    let (mut reader, mut filament) = (Reader::new(&gcode[..]), 0.0);
    while let Some(line) = reader.next_line()? {
        if let Some(command) = line.command.filter(|c| c.is(b'G', 1)) {
            for word in command.words().filter(|w| w.letter == b'E') {
                filament += word.value.unwrap_or(0.0);
            }
        }
    }
    println!("read    {} lines in {:?}", reader.line(), begun.elapsed());
    println!(
        "printed {:.3} mm³ with {} changes in {:.0} s, {filament:.2} mm of filament",
        summary.extruded_mm3, summary.state_changes, summary.print_time_s
    );
    Ok(())
}
