use std::{
    fmt::Write as _,
    fs::File,
    io::{self, BufRead, BufReader, Write as _},
    path::Path,
};

use fgm::{
    Sections, Settings,
    core::Point3,
    field::Design,
    gcode::{Machine, Reader},
    sim::{
        CheckDesign, CheckOptions, CheckReport, CoverageFigures, FidelityFigures, Head, Picture,
        Reference, SimError,
    },
};

use crate::{
    args::{CheckArguments, DesignArguments},
    commands::slice::{self, slice_failure},
    failure::Failure,
    output::Output,
    show,
};

/// Checks what a machine lays down from a file of G-code.
pub(crate) fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut reader = Reader::new(open(&arguments.gcode)?);
    let fail = |error: SimError| sim_failure(&arguments.gcode, &error);
    let head = Head::read(&mut reader).map_err(fail)?;
    let machine = machine(arguments, &head)?;
    let loaded = arguments.design.as_deref().map(|path| load(path, arguments)).transpose()?;
    let design = loaded.as_ref().map(|loaded| &loaded.design);
    let options = options(arguments, &head, machine.as_ref(), design);
    if let Some(folder) = &arguments.pictures {
        std::fs::create_dir_all(folder).map_err(|e| Failure::write(folder, &e))?;
    }
    // The places are tried before the work.
    let json = arguments.json.as_deref();
    let json_file = json.map(Output::create).transpose()?;

    let report = match design {
        None => fgm::sim::check(reader, &options, None, &mut |p| paint(arguments, p)),
        Some(design) => {
            let offset = offset(arguments, &head)?;
            let settings = Settings::default();
            let sections = Sections::new(design, &settings).map_err(|e| slice_failure(&e))?;
            let outline = |z| sections.at(z).map_err(|e| e.to_string());
            let reference = Reference { materials: design.fractions.as_ref(), offset };
            let design = CheckDesign { reference, outline: &outline };
            fgm::sim::check(reader, &options, Some(&design), &mut |p| paint(arguments, p))
        }
    };
    let report = report.map_err(fail)?;
    if report.totals.beads == 0 {
        show::warning(&format!("{}: nothing is printed in it", arguments.gcode.display()));
    }
    if let (Some(mut file), Some(path)) = (json_file, json) {
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

fn load(path: &Path, arguments: &CheckArguments) -> Result<fgm::design::Loaded, Failure> {
    let loaded = slice::load(&DesignArguments {
        design: path.to_path_buf(),
        fractions: arguments.fractions.clone(),
        size: arguments.size,
    })?;
    loaded.warnings.iter().for_each(|w| show::warning(&w.to_string()));
    Ok(loaded)
}

/// Where the design stands on the bed.
fn offset(arguments: &CheckArguments, head: &Head) -> Result<Point3, Failure> {
    arguments.offset.map(Point3::from_array).or(head.offset).ok_or_else(|| {
        Failure::usage(format!(
            "{}: its head has no `; design_offset = DX DY DZ`; say where the design stands with \
             --offset",
            arguments.gcode.display()
        ))
    })
}

/// Writes a picture into its folder.
fn paint(arguments: &CheckArguments, picture: &Picture) -> Result<(), SimError> {
    let Some(folder) = &arguments.pictures else { return Ok(()) };
    let name = format!("layer-{:04}-{}.png", picture.layer, picture.kind.name());
    let path = folder.join(name);
    let written = std::fs::write(&path, picture.png()?);
    written.map_err(|e| SimError::Picture {
        layer: picture.layer,
        message: format!("{}: {e}", path.display()),
    })
}

/// Cells for coverage where none are asked for, mm.
const CELL: f64 = 0.1;
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
        error @ SimError::Picture { .. } => Failure::could_not(error.to_string()),
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

fn options(
    arguments: &CheckArguments,
    head: &Head,
    machine: Option<&Machine>,
    design: Option<&Design>,
) -> CheckOptions {
    let mut options = CheckOptions::of(machine);
    options.replay.tagged_layers = head.tagged_layers;
    if let Some(transition) = arguments.transition {
        options.model.transition = transition;
    }
    options.model.thermal = arguments.thermal.or(options.model.thermal);
    let index = |layer: usize| u32::try_from(layer - 1).unwrap_or(u32::MAX);
    if let Some((first, last)) = arguments.layers {
        options.layers = index(first)..=index(last);
    }
    options.spacing = arguments.spacing;
    let cell = arguments.cell.or(design.map(|_| CELL));
    options.cell = cell.filter(|cell| *cell > 0.0);
    options.colors = match design {
        _ if !arguments.material_colors.is_empty() => arguments.material_colors.clone(),
        Some(design) => fgm::material_colors(design),
        None => fgm::usual_colors().to_vec(),
    };
    if arguments.pictures.is_some() {
        options.pictures = arguments.picture_layers.iter().map(|layer| layer - 1).collect();
        if options.pictures.is_empty() {
            options.pictures.insert(0);
        }
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
    let mut lengths: Vec<String> =
        totals.filament_mm3.iter().map(|mm3| format!("{:.1}", mm3 / area)).collect();
    if lengths.is_empty() {
        lengths.push("0.0".into());
    }
    let _ = writeln!(
        text,
        "filament  {} mm; {:.2} g in all, {:.2} g of it purge",
        lengths.join(" + "),
        report.mass_g,
        report.purge_g
    );
    if let Some(fidelity) = &report.fidelity {
        describe_fidelity(fidelity, &mut text);
    }
    if let Some(coverage) = &report.coverage {
        describe_coverage(coverage, &mut text);
    }
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

fn describe_fidelity(fidelity: &FidelityFigures, text: &mut String) {
    let rows = [
        ("commanded", &fidelity.commanded, &fidelity.commanded_delta_e),
        ("deposited", &fidelity.deposited, &fidelity.deposited_delta_e),
    ];
    for (name, error, color) in rows {
        let _ = writeln!(
            text,
            "{name:9} composition off by {:.4} (mean), {:.4} (rms), {:.4} (95 %); \
             delta E 2000 {:.2} (mean), {:.2} (95 %)",
            error.mean, error.rms, error.percentile_95, color.mean, color.percentile_95
        );
        if let Some(worst) = &error.worst {
            let [x, y, z] = worst.at;
            let _ = writeln!(
                text,
                "          worst {:.4} at ({x:.2}, {y:.2}, {z:.2}) of the design, layer {}, line {}",
                worst.error, worst.layer, worst.line
            );
        }
    }
    let seen = &fidelity.deposited_seen;
    if let Some(worst) = &seen.worst {
        let _ = writeln!(
            text,
            "          without infill {:.4} (mean), {:.4} (rms), {:.4} (95 %), worst {:.4}",
            seen.mean, seen.rms, seen.percentile_95, worst.error
        );
    }
    if fidelity.undefined > 0 {
        let _ = writeln!(
            text,
            "          {} places left out, where the design has no mixture",
            fidelity.undefined
        );
    }
}

fn describe_coverage(coverage: &CoverageFigures, text: &mut String) {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let _ = write!(text, "coverage  ");
    if let (Some(covered), Some(outside), Some(filled)) =
        (coverage.coverage, coverage.outside, coverage.filled)
    {
        let _ = write!(
            text,
            "{} of the design's area covered, {} outside it, {} of its volume laid down; ",
            percent(covered),
            percent(outside),
            percent(filled)
        );
    }
    let _ = write!(text, "{} of the beads' area laid twice", percent(coverage.overlap));
    let _ = match coverage.least_covered {
        Some(layer) => writeln!(text, "; least in layer {layer}"),
        None => writeln!(text),
    };
}
