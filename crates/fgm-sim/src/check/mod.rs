//! The whole check of a file.

mod layers;
mod options;
mod report;

use std::io::BufRead;

use fgm_core::Polygon;
use fgm_gcode::{Machine, Reader};

use crate::{
    Deposit, Event, FaultKind, Fidelity, Model, Picture, Replay, Shades, SimError, Totals,
};
use layers::Layers;

pub use options::{CheckDesign, CheckOptions, OutlineAt};
pub use report::{CheckReport, CoverageFigures};

/// Checks G-code: faults, totals, what is laid down and, with a design, how far from it.
/// `show` is given the pictures asked for, layer by layer.
///
/// # Errors
/// [`SimError`], those of `show` among them; faults of the G-code are no error.
///
/// ```
/// use fgm_gcode::{Machine, Reader};
/// use fgm_sim::{CheckOptions, check};
///
/// let gcode = b"M109 S210\nM83\nG1 X10 Y10 Z0.2\nG1 X20 E0.5\nG1 X300\n";
/// let options = CheckOptions::of(Some(&Machine::default()));
/// let report = check(Reader::new(&gcode[..]), &options, None, &mut |_| Ok(()))?;
/// assert_eq!((report.fault_count, report.faults[0].line), (1, 5));
/// assert_eq!(report.totals.extrude_mm, 10.0);
/// # Ok::<(), fgm_sim::SimError>(())
/// ```
pub fn check<R: BufRead>(
    reader: Reader<R>,
    options: &CheckOptions,
    design: Option<&CheckDesign<'_>>,
    show: &mut dyn FnMut(&Picture) -> Result<(), SimError>,
) -> Result<CheckReport, SimError> {
    let machine = options.replay.machine.as_ref();
    let mut replay = Replay::new(reader, &options.replay);
    let mut deposit = Deposit::new(&options.model);
    let mut totals = Totals::new(machine);
    let shades = Shades::new(&options.colors);
    let mut fidelity = design.map(|d| Fidelity::new(d.reference, shades.clone(), options.spacing));
    let mut layers = Layers::new(options, shades, design)?;
    while let Some(event) = replay.next_event()? {
        totals.event(&event);
        if let Event::Layer(_) = event {
            layers.finish(show)?;
        }
        deposit.push(&event, &mut |piece| {
            totals.piece(piece);
            if piece.layer.is_some_and(|layer| options.layers.contains(&layer)) {
                if let Some(fidelity) = &mut fidelity {
                    fidelity.piece(piece);
                }
                layers.piece(piece);
            }
        });
    }
    layers.finish(show)?;
    let mut report = basics(&replay, &totals, &options.model, machine);
    report.fidelity = fidelity.map(|mut fidelity| fidelity.figures());
    (report.coverage, report.layers) = layers.figures();
    Ok(report)
}

/// What needs no design.
fn basics<R: BufRead>(
    replay: &Replay<R>,
    totals: &Totals,
    model: &Model,
    machine: Option<&Machine>,
) -> CheckReport {
    let (faults, totals) = (replay.faults(), totals.figures());
    let usual = Machine::default();
    let density = machine.unwrap_or(&usual).filament_density;
    let grams = |mm3: f64| mm3 * density / 1000.0;
    let kinds = FaultKind::ALL.into_iter().map(|kind| (kind, faults.count(kind)));
    CheckReport {
        lines: replay.lines(),
        bytes: replay.bytes(),
        model: model.to_string(),
        fault_count: faults.total(),
        fault_kinds: kinds.filter(|(_, count)| *count > 0).collect(),
        faults: faults.kept().to_vec(),
        state_changes: replay.changes(),
        mass_g: grams(totals.fed_mm3 + totals.start_mm3),
        purge_g: grams(totals.purge_mm3 + totals.start_mm3),
        totals,
        fidelity: None,
        coverage: None,
        layers: Vec::new(),
    }
}

/// The region of the design under a layer's beads, on the bed.
fn region(
    design: &CheckDesign<'_>,
    layer: u32,
    (z, height): (f64, f64),
) -> Result<Vec<Polygon>, SimError> {
    let offset = design.reference.offset;
    let outline = (design.outline)(z - 0.5 * height - offset.z);
    let mut region =
        outline.map_err(|message| SimError::Design { layer: layer.saturating_add(1), message })?;
    for polygon in &mut region {
        let rings = std::iter::once(&mut polygon.outer).chain(&mut polygon.holes);
        rings.for_each(|ring| ring.points.iter_mut().for_each(|p| *p += offset.truncate()));
    }
    Ok(region)
}
