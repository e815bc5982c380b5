//! The whole check of a file.

mod options;
mod report;

use std::io::BufRead;

use fgm_gcode::{Machine, Reader};

use crate::{Deposit, FaultKind, Figures, Model, Replay, SimError, Totals};

pub use options::CheckOptions;
pub use report::CheckReport;

/// Checks G-code: faults, totals and what is laid down.
///
/// # Errors
/// [`SimError`]; faults of the G-code are no error.
///
/// ```
/// use fgm_gcode::{Machine, Reader};
/// use fgm_sim::{CheckOptions, check};
///
/// let gcode = b"M109 S210\nM83\nG1 X10 Y10 Z0.2\nG1 X20 E0.5\nG1 X300\n";
/// let options = CheckOptions::of(Some(&Machine::default()));
/// let report = check(Reader::new(&gcode[..]), &options)?;
/// assert_eq!((report.fault_count, report.faults[0].line), (1, 5));
/// assert_eq!(report.totals.extrude_mm, 10.0);
/// # Ok::<(), fgm_sim::SimError>(())
/// ```
pub fn check<R: BufRead>(
    reader: Reader<R>,
    options: &CheckOptions,
) -> Result<CheckReport, SimError> {
    let machine = options.replay.machine.as_ref();
    let mut replay = Replay::new(reader, &options.replay);
    let mut deposit = Deposit::new(&options.model);
    let mut totals = Totals::new(machine);
    while let Some(event) = replay.next_event()? {
        totals.event(&event);
        deposit.push(&event, &mut |piece| totals.piece(piece));
    }
    Ok(report(&replay, totals.figures(), &options.model, machine))
}

fn report<R: BufRead>(
    replay: &Replay<R>,
    totals: Figures,
    model: &Model,
    machine: Option<&Machine>,
) -> CheckReport {
    let faults = replay.faults();
    let density =
        machine.map_or_else(|| Machine::default().filament_density, |m| m.filament_density);
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
    }
}
