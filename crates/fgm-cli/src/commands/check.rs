use std::{
    fmt::Write as _,
    fs::File,
    io::{self, BufRead, BufReader, Write as _},
    path::Path,
};

use fgm::{
    Settings,
    gcode::{Machine, Reader},
    sim::{CheckOptions, CheckReport, Head, SimError},
};

use crate::{args::CheckArguments, commands::slice, failure::Failure, output::Output, show};

/// Checks what a machine lays down from a file of G-code.
pub(crate) fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut reader = Reader::new(open(&arguments.gcode)?);
    let fail = |error: SimError| sim_failure(&arguments.gcode, &error);
    let head = Head::read(&mut reader).map_err(fail)?;
    let machine = machine(arguments, &head)?;
    let options = options(arguments, &head, machine.as_ref());

    let report = fgm::sim::check(reader, &options).map_err(fail)?;
    let json = arguments.json.as_deref();
    if let Some(path) = json {
        let mut file = Output::create(path)?;
        serde_json::to_writer_pretty(&mut file, &report)
            .map_err(io::Error::from)
            .and_then(|()| writeln!(file))
            .map_err(|e| Failure::write(path, &e))?;
        file.finish()?;
    }
    if json.is_none_or(|path| path.as_os_str() != "-") {
        print(&describe(arguments, machine.as_ref(), &report))?;
    }
    match report.fault_count {
        0 => Ok(()),
        1 => Err(Failure::could_not(format!("{}: a fault", arguments.gcode.display()))),
        count => Err(Failure::could_not(format!("{}: {count} faults", arguments.gcode.display()))),
    }
}

/// A block this large is read at a time.
const BLOCK: usize = 1 << 18;

fn open(path: &Path) -> Result<Box<dyn BufRead>, Failure> {
    if path.as_os_str() == "-" {
        return Ok(Box::new(BufReader::with_capacity(BLOCK, io::stdin())));
    }
    let file = File::open(path).map_err(|e| Failure::read(path, &e))?;
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(Failure::usage(format!("{}: is a folder, not G-code", path.display())));
    }
    Ok(Box::new(BufReader::with_capacity(BLOCK, file)))
}

fn sim_failure(path: &Path, error: &SimError) -> Failure {
    match error {
        SimError::Io(error) => Failure::read(path, error),
        error => Failure::usage(error.to_string()),
    }
}

/// The printer asked for, else the one that the file's head describes.
fn machine(arguments: &CheckArguments, head: &Head) -> Result<Option<Machine>, Failure> {
    if let Some(name) = &arguments.printer {
        return slice::machine(name, &Settings::default()).map(Some);
    }
    match &head.machine {
        Some(Ok(machine)) => Ok(Some(machine.clone())),
        Some(Err(error)) => Err(Failure::usage(format!(
            "{}: the profile in its head cannot be read ({}); name the printer with --printer",
            arguments.gcode.display(),
            error.message
        ))),
        None => {
            show::warning("no printer is known: the bed is not checked (--printer names one)");
            Ok(None)
        }
    }
}

fn options(arguments: &CheckArguments, head: &Head, machine: Option<&Machine>) -> CheckOptions {
    let mut options = CheckOptions::of(machine);
    options.replay.tagged_layers = head.tagged_layers;
    if let Some(transition) = arguments.transition {
        options.model.transition = transition;
    }
    options.model.thermal = arguments.thermal;
    if let Some((first, last)) = arguments.layers {
        let index = |layer: usize| u32::try_from(layer - 1).unwrap_or(u32::MAX);
        options.layers = index(first)..=index(last);
    }
    options
}

fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::could_not(format!("could not print: {e}")))
        }
        _ => Ok(()),
    }
}

/// The figures as text.
fn describe(arguments: &CheckArguments, machine: Option<&Machine>, report: &CheckReport) -> String {
    let mut text = String::new();
    let totals = &report.totals;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "file      {}: {} lines, {:.1} MB",
        arguments.gcode.display(),
        report.lines,
        report.bytes as f64 / 1e6
    );
    if let Some(machine) = machine {
        let _ = writeln!(text, "printer   {}; deposit {}", machine.name, report.model);
    }
    let _ = writeln!(
        text,
        "print     {} layers, {} beads, {} state changes, {}",
        totals.layers,
        totals.beads,
        report.state_changes,
        slice::duration(totals.print_time_s)
    );
    if let (Some(min), Some(max)) = (totals.min_mm, totals.max_mm) {
        let range = |axis: usize| format!("{:.2} to {:.2}", min[axis], max[axis]);
        let _ = writeln!(text, "extents   x {}, y {}, z {} mm", range(0), range(1), range(2));
    }
    let _ = writeln!(
        text,
        "volume    {:.2} mm3: part {:.2}, purge {:.2}; before the print {:.2}",
        totals.extruded_mm3, totals.part_mm3, totals.purge_mm3, totals.start_mm3
    );
    let _ = writeln!(
        text,
        "way       {:.1} mm extruding, {:.1} mm travelling",
        totals.extrude_mm, totals.travel_mm
    );
    let area = machine.map_or_else(|| Machine::default().filament_area(), Machine::filament_area);
    let lengths = totals.filament_mm3.iter().map(|mm3| format!("{:.1}", mm3 / area));
    let _ = writeln!(
        text,
        "filament  {} mm; {:.2} g in all, {:.2} g of it purge",
        lengths.collect::<Vec<_>>().join(" + "),
        report.mass_g,
        report.purge_g
    );
    if report.fault_count == 0 {
        let _ = writeln!(text, "faults    none");
    }
    for (kind, count) in &report.fault_kinds {
        let _ = writeln!(text, "fault     {kind}: {count}");
        for fault in report.faults.iter().filter(|f| f.kind == *kind) {
            let _ = writeln!(text, "  line {}: {}", fault.line, fault.message);
        }
    }
    text
}
