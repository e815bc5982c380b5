//! Calibration prints as G-code.

use std::{
    io::{self, Write},
    path::Path,
};

use fgm::{
    Settings,
    core::{Bounds3, Mixture, Motion},
    gcode::{GcodeError, Lead, Machine, MachineKind, State, Writer, WriterOptions},
};

use super::pattern::{self, Section};
use crate::{
    args::{FoamingPrint, Inputs, LeadPrint, PrintArguments, TransitionPrint},
    commands::slice::{command_line, machine},
    failure::Failure,
    output::Output,
};

/// The section that is printed where none is given: the nozzle wide, half as high.
pub(super) fn section(machine: &Machine, width: Option<f64>, height: Option<f64>) -> Section {
    let width = width.unwrap_or(machine.nozzle);
    Section { width, height: height.unwrap_or(0.5 * machine.nozzle) }
}

/// A plate hatched along y with one change in the middle.
pub(crate) fn lead(arguments: &LeadPrint) -> Result<(), Failure> {
    let (machine, section) = begin(&arguments.print)?;
    let states = two_states(&machine, &arguments.inputs)?;
    let (motions, _) = pattern::plate(section, arguments.size);
    write(&arguments.print, &machine, &states, &motions, arguments.lead_volume)?;
    let late = arguments.lead_volume;
    tell(
        &arguments.print.output,
        &format!(
            "the change is commanded {late} mm3 before the middle of the plate, the longest mark in \
             the middle of the ruler; marks are {} mm apart.\n\
             Read where the colour changes, and go on with\n  \
             fgm calibrate solve lead --late MM --line {} --lead-volume {late}{}",
            if section.width < 0.7 { 1.0 } else { (2.0 * section.width).ceil() },
            arguments.size[1],
            solve_options(&arguments.print, section),
        ),
    );
    Ok(())
}

/// Lines with changes at marks.
pub(crate) fn transition(arguments: &TransitionPrint) -> Result<(), Failure> {
    let (machine, section) = begin(&arguments.print)?;
    let states = two_states(&machine, &arguments.inputs)?;
    let least = 10.0 * arguments.line * section.area();
    let room = arguments.room.unwrap_or_else(|| least.max(3.0 * machine.dead_volume()));
    let apart = 3.0 * section.width;
    let (motions, changed) =
        pattern::lines(section, arguments.line, apart, room, arguments.changes.clamp(1, 100));
    write(&arguments.print, &machine, &states, &motions, 0.0)?;
    tell(
        &arguments.print.output,
        &format!(
            "changes are commanded in the middle of lines {}, counted from the ruler, whose marks \
             are 10 mm apart; a line and its turn are {} mm of bead.\n\
             From each change measure along the bead to where the new colour begins to show and to \
             where the old one is gone, and go on with\n  \
             fgm calibrate solve transition --begins MM --ends MM{}",
            changed.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
            arguments.line + apart,
            solve_options(&arguments.print, section),
        ),
    );
    Ok(())
}

/// A wall that gets hotter rung by rung, with a flow of 1.
pub(crate) fn foaming(arguments: &FoamingPrint) -> Result<(), Failure> {
    let (machine, section) = begin(&arguments.print)?;
    if machine.kind != MachineKind::Foaming {
        return Err(Failure::usage(format!(
            "{} is no printer with a foaming filament; prusa-mk4s-lw-pla is one",
            machine.name
        )));
    }
    let foaming = &machine.foaming;
    let span = foaming.high - foaming.low;
    let rungs = (span.abs() / arguments.step + 1e-9) as u16 + 1;
    let states: Vec<State> = (0..rungs)
        .map(|i| {
            let share = (f64::from(i) * arguments.step / span.abs()).min(1.0);
            let celsius = (foaming.low + share * span).round();
            let mixture = Mixture::from_weights(&[1.0 - share, share]);
            let mixture = mixture.map_err(|e| Failure::usage(e.to_string()))?;
            Ok(State { temperature: Some(celsius), ..State::plain(mixture) })
        })
        .collect::<Result<_, Failure>>()?;
    let motions = pattern::ladder(section, arguments.side, arguments.rung, rungs);
    write(&arguments.print, &machine, &states, &motions, 0.0)?;
    let celsius: Vec<String> =
        states.iter().filter_map(|s| s.temperature).map(|t| t.to_string()).collect();
    tell(
        &arguments.print.output,
        &format!(
            "a nose at one corner begins each rung; from the bottom: {} °C.\n\
             Measure the wall in the upper half of each, and go on with\n  \
             fgm calibrate solve foaming --wall {}=MM ...{}",
            celsius.join(", "),
            celsius.first().map_or("190", String::as_str),
            solve_options(&arguments.print, section),
        ),
    );
    Ok(())
}

fn begin(print: &PrintArguments) -> Result<(Machine, Section), Failure> {
    let machine = machine(&print.printer, &Settings::default())?;
    let section = section(&machine, print.bead_width, print.layer_height);
    if section.height > section.width {
        return Err(Failure::usage(format!(
            "--layer-height {}: a bead is at most as high as wide, {} mm",
            section.height, section.width
        )));
    }
    Ok((machine, section))
}

/// One input alone, then another.
fn two_states(machine: &Machine, inputs: &Inputs) -> Result<[State; 2], Failure> {
    let count = machine.inputs();
    let state = |input: usize, option: &str| {
        let wrong = |_| {
            Failure::usage(format!(
                "{option} {input}: {} has the inputs 0 to {}",
                machine.name,
                count - 1
            ))
        };
        let mixture = Mixture::pure(input, count).map_err(wrong)?;
        match machine.kind {
            MachineKind::ToolChanger => {
                Ok(State { tool: Some(input as u32), ..State::plain(mixture) })
            }
            MachineKind::Mixing | MachineKind::Foaming => {
                let states = machine.states(&[mixture]).map_err(|e| gcode_failure(&e))?;
                Ok(states[0])
            }
        }
    };
    Ok([state(inputs.from, "--from")?, state(inputs.to, "--to")?])
}

/// Writes motions in the middle of the bed.
fn write(
    print: &PrintArguments,
    machine: &Machine,
    states: &[State],
    motions: &[Motion],
    lead: f64,
) -> Result<(), Failure> {
    let mut bounds = Bounds3::EMPTY;
    let mut top = 0.0;
    for motion in motions {
        match *motion {
            Motion::Layer { z, .. } => top = z,
            Motion::Travel { to } | Motion::Extrude { to, .. } => {
                bounds.min = bounds.min.min(to.extend(0.0));
                bounds.max = bounds.max.max(to.extend(top));
            }
            Motion::Rise { .. } | Motion::Color(_) | Motion::Command(_) => {}
        }
    }
    let mut options = WriterOptions::of(machine);
    options.offset = machine.bed.centering(&bounds);
    options.comments = vec![format!("fgm {}", env!("CARGO_PKG_VERSION")), command_line()];
    options.comments.extend(fgm::machine_comments(machine));
    let open = if machine.dialect.progress { Output::to_fill } else { Output::create };
    let mut output = open(&print.output)?;
    let fail = |e: GcodeError| match e {
        GcodeError::Io(e) => Failure::write(&print.output, &e),
        e => gcode_failure(&e),
    };
    let mut writer = Writer::new(&mut output, machine, states, &options).map_err(fail)?;
    for step in Lead::with_volume(machine, lead).over(motions.iter().copied()) {
        writer.push(step).map_err(fail)?;
    }
    let summary = writer.finish().map_err(fail)?;
    output.fill(&summary.progress)?;
    output.finish()
}

fn gcode_failure(error: &GcodeError) -> Failure {
    match error {
        GcodeError::OutsideBed { .. } => Failure::could_not(error.to_string()),
        error => Failure::usage(error.to_string()),
    }
}

/// What `fgm calibrate solve` has to be told of the print.
fn solve_options(print: &PrintArguments, section: Section) -> String {
    format!(
        " --bead-width {} --layer-height {} --printer {} -o mine.toml",
        section.width, section.height, print.printer
    )
}

/// What to do with the print, on standard error: standard output may be the G-code.
fn tell(output: &Path, text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}: {text}", output.display());
}
