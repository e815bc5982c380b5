//! What the examples about fidelity share: slicing, following the file, drawing.

#![allow(dead_code, reason = "each example takes what it needs")]

mod plot;

use std::{error::Error, path::Path};

use fgm::{
    Quiet, Report, Sections, Settings, Slicer,
    core::Point3,
    design::{self, LoadOptions},
    field::Design,
    gcode::{Machine, Reader},
    sim::{
        CheckDesign, CheckOptions, Deposit, FidelityFigures, Head, Model, Piece, Reference, Replay,
        ReplayOptions, Transition, check,
    },
};

pub(crate) use plot::{Axis, Plot};

/// What may go wrong in an example.
pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// The palette slab.
pub(crate) fn slab() -> Outcome<Design> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/slab.vcad");
    Ok(design::load(&path, &LoadOptions::default())?.design)
}

/// A built-in printer.
pub(crate) fn printer(name: &str) -> Outcome<Machine> {
    Ok(Machine::builtin(name).ok_or("no such printer")?)
}

/// The G-code of a design, and the slicer's report.
pub(crate) fn slice(
    design: &Design,
    machine: &Machine,
    settings: &Settings,
) -> Outcome<(Vec<u8>, Report)> {
    let mut gcode = Vec::new();
    let report = Slicer::new(design, machine, settings).slice(&mut gcode, &Quiet)?;
    Ok((gcode, report))
}

/// How far a file is from its design, on a machine that follows its commands by a transition.
pub(crate) fn fidelity(
    design: &Design,
    machine: &Machine,
    transition: Transition,
    gcode: &[u8],
) -> Outcome<FidelityFigures> {
    let mut reader = Reader::new(gcode);
    let head = Head::read(&mut reader)?;
    let mut options = CheckOptions::of(Some(machine));
    options.replay.tagged_layers = head.tagged_layers;
    options.model.transition = transition;
    options.colors = fgm::material_colors(design);
    let settings = Settings::default();
    let sections = Sections::new(design, &settings)?;
    let outline = |z| sections.at(z).map_err(|e| e.to_string());
    let reference = Reference { materials: design.fractions.as_ref(), offset: offset(&head)? };
    let compared = CheckDesign { reference, outline: &outline };
    let report = check(reader, &options, Some(&compared), &mut |_| Ok(()))?;
    Ok(report.fidelity.ok_or("nothing was compared")?)
}

/// Hands over what is laid down, piece by piece, and where the design stands.
pub(crate) fn lay_down(
    machine: &Machine,
    gcode: &[u8],
    mut each: impl FnMut(&Piece, Point3),
) -> Outcome<()> {
    let mut reader = Reader::new(gcode);
    let head = Head::read(&mut reader)?;
    let offset = offset(&head)?;
    let options = ReplayOptions {
        machine: Some(machine.clone()),
        tagged_layers: head.tagged_layers,
        ..ReplayOptions::default()
    };
    let (mut replay, mut deposit) =
        (Replay::new(reader, &options), Deposit::new(&Model::of(machine)));
    while let Some(event) = replay.next_event()? {
        deposit.push(&event, &mut |piece| each(piece, offset));
    }
    Ok(())
}

fn offset(head: &Head) -> Outcome<Point3> {
    Ok(head.offset.ok_or("the file does not say where the design stands")?)
}
