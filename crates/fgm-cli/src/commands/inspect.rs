use std::{
    fmt::Write as _,
    io::{self, Write as _},
};

use crate::{
    args::InspectArguments,
    commands::slice::{load, slice_failure},
    failure::Failure,
};

/// Tells what a design holds.
pub(crate) fn run(arguments: &InspectArguments) -> Result<(), Failure> {
    let loaded = load(&arguments.design)?;
    let mut settings = fgm::Settings::default();
    settings.layer.height = arguments.layer_height;
    settings.check().map_err(|e| Failure::usage(e.to_string()))?;
    let found = fgm::inspect(&loaded.design, &settings).map_err(|e| slice_failure(&e))?;
    let warnings: Vec<_> =
        loaded.warnings.iter().map(ToString::to_string).chain(found.warnings.clone()).collect();
    let text = if arguments.json {
        let found = fgm::Inspection { warnings, ..found };
        let json = serde_json::to_string_pretty(&found);
        json.map_err(|e| Failure::could_not(format!("could not print: {e}")))? + "\n"
    } else {
        describe(&found, &warnings)
    };
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::could_not(format!("could not print: {e}")))
        }
        _ => Ok(()),
    }
}

fn describe(found: &fgm::Inspection, warnings: &[String]) -> String {
    let mut text = String::new();
    let [x, y, z] = found.size_mm;
    let [x0, y0, z0] = found.min_mm;
    // Writing to a String cannot fail.
    let _ = writeln!(text, "design    {} ({})", found.design, found.geometry);
    let _ =
        writeln!(text, "size      {x:.3} x {y:.3} x {z:.3} mm, from ({x0:.3}, {y0:.3}, {z0:.3})");
    let _ = writeln!(text, "layers    {} of {} mm", found.layers, found.layer_height_mm);
    let _ = writeln!(
        text,
        "volume    {:.1} mm3 in {} sampled layers",
        found.volume_mm3, found.sampled_layers
    );
    for material in &found.materials {
        let _ = writeln!(
            text,
            "material  {}: fraction {:.4} to {:.4}, mean {:.4}, changes by up to {:.4} a mm",
            material.name,
            material.least,
            material.greatest,
            material.mean,
            material.steepest_per_mm
        );
    }
    for warning in warnings {
        let _ = writeln!(text, "warning   {warning}");
    }
    text
}
