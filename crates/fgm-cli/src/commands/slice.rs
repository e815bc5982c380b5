use std::{
    fs,
    io::{self, IsTerminal, Write},
    path::{Path, PathBuf},
    time::Instant,
};

use fgm::{
    Aim, DepositReport, PurgeLayout, PurgeReport, Report, Settings, Slicer, ZipperReport,
    design::{self, LoadOptions},
    gcode::Machine,
};
use toml::{Table, Value};

use crate::{
    args::{DesignArguments, SettingSources, SliceArguments, Switch},
    failure::Failure,
    output::{Output, folder_of},
    overrides,
    progress::Terminal,
};

/// Slices a design into a file of G-code.
pub(crate) fn run(arguments: &SliceArguments) -> Result<(), Failure> {
    let start = Instant::now();
    check_places(arguments)?;
    let settings = settings(arguments)?;
    let machine = machine(&arguments.printer, &settings)?;
    let settings = with_lead_length(settings, arguments);
    let progress = Terminal::new(arguments.quiet)?;

    let loaded = load(&arguments.design)?;
    for warning in &loaded.warnings {
        fgm::Progress::warn(&progress, &warning.to_string());
    }
    let read_seconds = start.elapsed().as_secs_f64();

    let open = if machine.dialect.progress { Output::to_fill } else { Output::create };
    let mut output = open(&arguments.output)?;
    // The report's place is tried before the work, too, not found wanting after it.
    let report_file = arguments.report.as_deref().map(Output::create).transpose()?;
    let slicer = Slicer::new(&loaded.design, &machine, &settings)
        .threads(arguments.threads.unwrap_or(0))
        .head(vec![command_line()]);
    let sliced = slicer.slice(&mut output, &progress);
    progress.clear();
    let mut report = sliced.map_err(|error| match error {
        fgm::SliceError::Gcode(fgm::gcode::GcodeError::Io(error)) => {
            Failure::write(&arguments.output, &error)
        }
        error => slice_failure(&error),
    })?;
    report.seconds.read += read_seconds;
    report.seconds.total += read_seconds;
    report.warnings.splice(0..0, loaded.warnings.iter().map(ToString::to_string));

    output.fill(&report.progress)?;
    output.finish()?;
    if let (Some(mut file), Some(path)) = (report_file, &arguments.report) {
        write_report(&report, &mut file).map_err(|e| Failure::write(path, &e))?;
        file.finish()?;
    }
    if !arguments.quiet {
        summary(&report, &arguments.output);
    }
    Ok(())
}

/// That nothing which is read, and no other output, is written over.
fn check_places(arguments: &SliceArguments) -> Result<(), Failure> {
    let real = |path: &Path| -> Option<PathBuf> {
        if path.as_os_str() == "-" {
            return None;
        }
        let named = || Some(fs::canonicalize(folder_of(path)).ok()?.join(path.file_name()?));
        fs::canonicalize(path).ok().or_else(named)
    };
    let read = [
        ("the design", Some(arguments.design.design.as_path())),
        ("the settings", arguments.settings.file.as_deref()),
        ("the printer's profile", Some(Path::new(&arguments.printer))),
    ];
    let report = arguments.report.as_deref();
    let outputs = [("-o", Some(arguments.output.as_path())), ("--report", report)];
    for (option, output) in outputs {
        let Some(output) = output.filter(|path| path.is_file()) else { continue };
        for (what, input) in read {
            if input.is_some_and(|input| input.is_file() && real(input) == real(output)) {
                let place = output.display();
                return Err(Failure::usage(format!("{option} {place} would overwrite {what}")));
            }
        }
    }
    match report {
        Some(report) if real(report).is_some() && real(report) == real(&arguments.output) => {
            Err(Failure::usage(format!("-o and --report both name {}", report.display())))
        }
        _ => Ok(()),
    }
}

/// Reads a design with the options of the command line.
pub(crate) fn load(arguments: &DesignArguments) -> Result<design::Loaded, Failure> {
    let options = LoadOptions {
        fractions: arguments.fractions.clone(),
        size: arguments.size.map(Into::into),
        ..LoadOptions::default()
    };
    design::load(&arguments.design, &options).map_err(|e| slice_failure(&e.into()))
}

/// What a slice's error is to the user: its status, and the line it speaks of.
pub(crate) fn slice_failure(error: &fgm::SliceError) -> Failure {
    let failure = match error {
        fgm::SliceError::Cancelled => Failure::interrupted(),
        error if error.is_bad_input() => Failure::usage(error.to_string()),
        error => Failure::could_not(error.to_string()),
    };
    let fgm::SliceError::Design(error) = error else { return failure };
    match (error.location(), error.source_text(), error.problem()) {
        (Some(at), Some(text), Some(problem)) => {
            failure.with_place(&at.file, text, at.span, &problem.to_string())
        }
        _ => failure,
    }
}

/// The settings: defaults, below the file's, below the named options', below `--set`.
fn settings(arguments: &SliceArguments) -> Result<Settings, Failure> {
    let mut table = base(&arguments.settings)?;
    let mut put = |key: [&str; 2], value: Option<Value>| {
        if let Some(value) = value {
            overrides::put(&mut table, &key, value);
        }
    };
    let text = |value: Option<String>| value.map(Value::String);
    let count =
        |value: Option<usize>| value.map(|v| Value::Integer(v.min(i64::MAX as usize) as i64));
    let a = arguments;
    put(["slice", "strategy"], text(a.strategy.map(|s| s.to_string())));
    put(["slice", "first_layer"], count(a.layers.map(|l| l.0)));
    put(["slice", "last_layer"], count(a.layers.map(|l| l.1).filter(|l| *l != usize::MAX)));
    put(["palette", "colors"], text(a.colors.map(|c| c.to_string())));
    put(["palette", "zipper"], text(a.zipper.map(|z| z.to_string())));
    put(["layer", "height"], a.layer_height.map(Value::Float));
    put(["layer", "bead_width"], a.bead_width.map(Value::Float));
    put(["walls", "count"], count(a.walls));
    put(["walls", "spiral"], a.spiral.then_some(Value::Boolean(true)));
    put(["infill", "density"], text(a.infill.as_ref().map(ToString::to_string)));
    put(["infill", "pattern"], text(a.infill_pattern.map(|p| p.to_string())));
    put(["skins", "top"], count(a.top));
    put(["skins", "bottom"], count(a.bottom));
    put(["against", "fill"], text(a.fill.map(|f| f.to_string())));
    put(["purge", "enabled"], a.purge.map(|p| Value::Boolean(p == Switch::On)));
    put(["lead", "volume"], a.dead_volume.map(Value::Float));
    for text in &arguments.settings.set {
        // Alone first, so that a mistake is told with what was typed.
        let mut alone = Table::new();
        overrides::set(&mut alone, text)?;
        let read = alone.try_into::<Settings>();
        read.map_err(|e| Failure::usage(format!("--set {text}: {}", e.message())))?;
        overrides::set(&mut table, text)?;
    }
    if let Some(lead) = arguments.lead.filter(|lead| !(0.0..=1e6).contains(lead)) {
        return Err(Failure::usage(format!("--lead {lead}: 0 to 1000000 mm is possible")));
    }
    if let Some(threads) = arguments.threads.filter(|threads| *threads > fgm::MAX_THREADS) {
        let most = fgm::MAX_THREADS;
        return Err(Failure::usage(format!("--threads {threads}: at most {most} are possible")));
    }
    let settings: Settings =
        table.try_into().map_err(|e| Failure::usage(format!("settings: {}", e.message())))?;
    settings.check().map_err(|e| Failure::usage(e.to_string()))?;
    Ok(settings)
}

/// What a settings file says, checked where it stands.
fn base(sources: &SettingSources) -> Result<Table, Failure> {
    match &sources.file {
        None => Ok(Table::new()),
        Some(path) => overrides::read(path, |text| {
            toml::from_str::<Settings>(text)?;
            toml::from_str::<Table>(text)
        }),
    }
}

/// `--lead` says the dead volume as a length of bead.
fn with_lead_length(mut settings: Settings, arguments: &SliceArguments) -> Settings {
    if let Some(length) = arguments.lead {
        let layer = &settings.layer;
        settings.lead.volume = Some(length * fgm::core::bead::area(layer.bead_width, layer.height));
    }
    settings
}

/// A built-in printer, or a profile in a file, with the settings' changes.
pub(crate) fn machine(name: &str, settings: &Settings) -> Result<Machine, Failure> {
    let looks_like_file = name.ends_with(".toml") || name.contains(std::path::MAIN_SEPARATOR);
    let text = match Machine::builtin_toml(name) {
        Some(text) => text.to_owned(),
        None if looks_like_file => {
            let path = Path::new(name);
            let text = fs::read_to_string(path).map_err(|e| Failure::read(path, &e))?;
            Machine::from_toml(&text)
                .map_err(|e| Failure::at_line(path, &text, e.line, e.column, &e.message))?;
            text
        }
        None => return Err(unknown_printer(name)),
    };
    fgm::machine(&text, &settings.machine)
        .map_err(|e| Failure::usage(format!("printer {name}: {e}")))
}

/// No built-in printer has this name.
pub(crate) fn unknown_printer(name: &str) -> Failure {
    let known: Vec<_> = Machine::builtin_names().collect();
    Failure::usage(format!(
        "no printer is named `{name}`; built in are {}; or give a profile's file name ending in .toml",
        known.join(", ")
    ))
}

/// The command line as the user would type it again.
pub(crate) fn command_line() -> String {
    let quoted = std::env::args().map(|word| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''").replace(['\n', '\r'], " "))
        }
    });
    format!("command: {}", quoted.collect::<Vec<_>>().join(" "))
}

fn write_report(report: &Report, file: &mut Output) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *file, report).map_err(io::Error::from)?;
    writeln!(file)
}

/// The figures in a few lines, on standard error: standard output may be the G-code.
fn summary(report: &Report, output: &Path) {
    let mut err = io::stderr().lock();
    let dash = if io::stderr().is_terminal() { "–" } else { "-" };
    let _ = writeln!(
        err,
        "{}: {} layers, {} colours, {} faces, {:.1} MB in {:.2} s",
        output.display(),
        report.layers,
        report.colors,
        report.faces,
        report.bytes as f64 / 1e6,
        report.seconds.total
    );
    for used in &report.materials {
        let _ = writeln!(
            err,
            "  {dash} {}: {:.1} g, {:.2} m of filament",
            used.name, used.mass_g, used.filament_m
        );
    }
    let _ = writeln!(
        err,
        "  {dash} part {:.1} mm3 of {:.1} mm3, purge {:.1} mm3, {} colour changes, print time {}",
        report.extruded_mm3 - report.purge_mm3,
        report.model_mm3,
        report.purge_mm3,
        report.state_changes,
        duration(report.print_time_s)
    );
    if let Some(ZipperReport { seam_mm, straight_mm, .. }) = report.zipper {
        let _ = writeln!(
            err,
            "  {dash} zipper: colours touch over {:.2} m, {:.2} m without it",
            seam_mm / 1000.0,
            straight_mm / 1000.0
        );
    }
    if let Some(purge) = &report.purge {
        purge_summary(purge).iter().for_each(|line| {
            let _ = writeln!(err, "  {dash} {line}");
        });
    }
    let cooling = &report.cooling;
    if cooling.slowed_layers > 0 {
        let (layers, added) = (cooling.slowed_layers, duration(cooling.added_s));
        let _ = writeln!(err, "  {dash} {layers} layers slowed to cool, {added} in all");
    }
    if let Some(deposit) = &report.deposit {
        let _ = writeln!(err, "  {dash} {}", deposit_summary(deposit));
    }
}

/// Where the old colour went, and what was saved.
fn purge_summary(purge: &PurgeReport) -> Vec<String> {
    let mut lines = Vec::new();
    let tower = match purge.layout {
        Some(PurgeLayout::One) => "one tower",
        Some(PurgeLayout::Spots) => "a spot for each colour",
        None => "no tower",
    };
    if purge.changes > 0 {
        let into = match purge.infill_mm3 {
            0.0 => String::new(),
            volume => format!(", {volume:.1} mm3 into hidden infill"),
        };
        let (purged, changes) = (purge.purged, purge.changes);
        lines.push(format!("{purged} of {changes} changes purged, {tower}{into}"));
    }
    if purge.spiral_changes > 0 {
        let changes = purge.spiral_changes;
        lines.push(format!("{changes} changes along the spiral, where nothing is purged"));
    }
    let saved = &purge.saved;
    if saved.total.mm3 > 0.0 {
        lines.push(format!(
            "saved {:.2} g of purge: {:.2} g by infill, {:.2} g by the threshold, {:.2} g by the \
             order of colours",
            saved.total.g, saved.infill.g, saved.threshold.g, saved.order.g
        ));
    }
    lines
}

/// What is predicted of the deposit.
fn deposit_summary(deposit: &DepositReport) -> String {
    let percent = |share: f64| 100.0 * share;
    let fit = &deposit.fit;
    let from = match deposit.aim {
        Aim::Design => "the design",
        Aim::Colors => "the paths' colours",
    };
    let plain = percent(fit.rms_plain);
    let hidden = match deposit.hidden_rms {
        Some(rms) => format!("; {:.2} % where infill takes the old colour", percent(rms)),
        None => String::new(),
    };
    if deposit.compensated {
        let rms = percent(fit.rms);
        format!(
            "deposit: {rms:.2} % rms from {from}, {plain:.2} % with the look-ahead alone{hidden}"
        )
    } else {
        format!("deposit: {plain:.2} % rms from {from} with the look-ahead alone{hidden}")
    }
}

/// Seconds as a person says them.
pub(crate) fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    match (minutes / 60, minutes % 60) {
        (0, 0) => format!("{seconds:.0} s"),
        (0, minutes) => format!("{minutes} min"),
        (hours, minutes) => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_changes_where_they_are() {
        let lines = |changes, spiral_changes| {
            let counts =
                PurgeReport { changes, purged: changes, spiral_changes, ..Default::default() };
            purge_summary(&counts)
        };
        let along = "172 changes along the spiral, where nothing is purged";
        assert!(lines(0, 0).is_empty());
        assert_eq!(lines(0, 172), [along]);
        assert_eq!(lines(29, 172), ["29 of 29 changes purged, no tower", along]);
    }

    #[test]
    fn durations_are_short() {
        for (seconds, text) in [(12.0, "12 s"), (600.0, "10 min"), (7260.0, "2 h 1 min")] {
            assert_eq!(duration(seconds), text);
        }
    }
}
