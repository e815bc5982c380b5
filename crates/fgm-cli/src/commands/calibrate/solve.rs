//! From measured numbers to a profile.

use std::io::{self, Write};

use fgm::{core::bead, gcode::MachineKind};

use super::{fit, pattern::Section, prints, profile::Profile};
use crate::{
    args::{Bead, ProfileArguments, Solve},
    failure::Failure,
};

/// Solves, tells the result, and writes the profile.
pub(crate) fn run(solve: &Solve) -> Result<(), Failure> {
    match solve {
        Solve::Lead { late, line, lead_volume, bead, profile } => {
            lead(profile, bead, (*late, *line), *lead_volume)
        }
        Solve::Transition { begins, ends, bead, profile } => {
            transition(profile, bead, begins, ends)
        }
        Solve::Foaming { walls, flows, degree, bead, profile } => {
            foaming(profile, bead, walls, flows, usize::from(*degree))
        }
        Solve::Volume { mm3, bead, profile } => {
            let mut found = Profile::read(profile)?;
            let section = section(&found, bead);
            let told = format!("{mm3} mm3 are {} of bead", lengths(*mm3, section));
            set_lead(&mut found, *mm3)?;
            finish(profile, &found, &told)
        }
    }
}

fn section(profile: &Profile, bead: &Bead) -> Section {
    prints::section(&profile.machine, bead.bead_width, bead.layer_height)
}

/// Appendix A.2: lines of the wrong colour, each as long as the plate is deep. Lines are a
/// spacing apart, and a part of a line counts as that part.
fn lead(
    arguments: &ProfileArguments,
    bead: &Bead,
    (late, line): (f64, f64),
    printed: f64,
) -> Result<(), Failure> {
    let mut profile = Profile::read(arguments)?;
    let section = section(&profile, bead);
    let lines = late / section.spacing();
    let volume = printed + (lines * line + late) * section.area();
    if volume < 0.0 {
        return Err(Failure::usage(format!(
            "--late {late}: that is {:.1} lines early, more than the lead of {printed} mm3 that the \
             plate was printed with; give --lead-volume",
            -lines
        )));
    }
    set_lead(&mut profile, volume)?;
    let told = format!(
        "{lines:.1} lines late: the lead is {volume:.3} mm3, {} of bead",
        lengths(volume, section)
    );
    finish(arguments, &profile, &told)
}

/// What a lead by length is given by.
const BEAD_KEYS: [&str; 3] = ["length", "layer_height", "bead_width"];

/// The lead; a transition, which goes before it, keeps its change and gets its middle there.
fn set_lead(profile: &mut Profile, volume: f64) -> Result<(), Failure> {
    profile.set("lead", "volume", volume, &BEAD_KEYS)?;
    if let Some((delay, change)) = profile.machine.transition.volumes() {
        let delay_now = (volume - 0.5 * change).max(0.0);
        if delay_now != delay {
            profile.set("transition", "delay", delay_now, &["delay_length"])?;
        }
    }
    Ok(())
}

fn transition(
    arguments: &ProfileArguments,
    bead: &Bead,
    begins: &[f64],
    ends: &[f64],
) -> Result<(), Failure> {
    let mut profile = Profile::read(arguments)?;
    let section = section(&profile, bead);
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64;
    let (begin, end) = (mean(begins), mean(ends));
    if end < begin {
        return Err(Failure::usage(format!(
            "the old colour is gone at {end} mm (--ends), before the new one begins at {begin} mm \
             (--begins)"
        )));
    }
    let (delay, change) = (begin * section.area(), (end - begin) * section.area());
    profile.set("transition", "delay", delay, &["delay_length"])?;
    profile.set("transition", "change", change, &["change_length"])?;
    profile.set("lead", "volume", delay + 0.5 * change, &BEAD_KEYS)?;
    let told = format!(
        "L1 = {begin:.2} mm, L2 = {:.2} mm of bead: a delay of {delay:.3} mm3, a change over \
         {change:.3} mm3, the lead to its middle {:.3} mm3",
        end - begin,
        delay + 0.5 * change
    );
    finish(arguments, &profile, &told)
}

fn foaming(
    arguments: &ProfileArguments,
    bead: &Bead,
    walls: &[(f64, f64)],
    flows: &[(f64, f64)],
    degree: usize,
) -> Result<(), Failure> {
    let mut profile = Profile::read(arguments)?;
    if profile.machine.kind != MachineKind::Foaming {
        return Err(Failure::usage(format!(
            "{} is no printer with a foaming filament",
            profile.machine.name
        )));
    }
    let section = section(&profile, bead);
    // What is so much wider needs so much less filament.
    let flow = |(celsius, wall): &(f64, f64)| {
        (*celsius, section.area() / bead::area(*wall, section.height))
    };
    let points: Vec<(f64, f64)> = walls.iter().map(flow).chain(flows.iter().copied()).collect();
    let Some(found) = fit::polynomial(&points, degree) else {
        return Err(Failure::usage(format!(
            "a polynomial of degree {degree} needs measurements (--wall, --flow) at {} temperatures \
             at least",
            degree + 1
        )));
    };
    let at = |celsius: f64| found.iter().rev().fold(0.0, |sum, c| sum * celsius + c);
    let miss = points.iter().map(|(t, flow)| (at(*t) - flow).powi(2)).sum::<f64>();
    let miss = (miss / points.len() as f64).sqrt();
    profile.set_list("foaming", "flow", &found)?;
    let (low, high) = (profile.machine.foaming.low, profile.machine.foaming.high);
    let told = format!(
        "flow = {found:?}: {:.1} % at {low} °C, {:.1} % at {high} °C; {:.2} % from the \
         measurements (rms)",
        100.0 * at(low),
        100.0 * at(high),
        100.0 * miss
    );
    finish(arguments, &profile, &told)
}

/// A volume as the length of the measured bead, and of a usual one.
fn lengths(volume: f64, section: Section) -> String {
    let Section { width, height } = section;
    format!("{:.1} mm of {width} x {height} mm", volume / section.area())
}

fn finish(arguments: &ProfileArguments, profile: &Profile, told: &str) -> Result<(), Failure> {
    profile.write(arguments)?;
    match writeln!(io::stdout().lock(), "{told}") {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::could_not(format!("could not print: {e}")))
        }
        _ => Ok(()),
    }
}
