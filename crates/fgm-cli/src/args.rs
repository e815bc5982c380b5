//! The command line.

mod calibrate;
mod check;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use fgm::{ColorCount, Density, FaceFill, Pattern, Strategy, Zipper};

pub(crate) use calibrate::{
    Bead, CalibrateArguments, Calibration, FoamingPrint, Inputs, LeadPrint, PrintArguments,
    ProfileArguments, Solve, TransitionPrint,
};
pub(crate) use check::CheckArguments;

/// Slices graded designs, whose material changes through the part, into G-code.
#[derive(Debug, Parser)]
#[command(name = "fgm", version, propagate_version = true, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  fgm slice designs/vase.vcad -o vase.gcode
  fgm slice benchy.3mf --fraction 'z/48' --printer prusa-xl-5t --strategy against -o benchy.gcode
  fgm check vase.gcode --design designs/vase.vcad
  fgm inspect designs/vase.vcad
  fgm printers show generic-mixing > mine.toml

Exit status: 0 done, 1 could not (I/O, out of bed, nothing to print), 2 bad input or usage.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Slice a design into G-code.
    Slice(Box<SliceArguments>),
    /// Tell what a machine really lays down from G-code, and what is wrong with it.
    Check(Box<CheckArguments>),
    /// Measure a machine: write prints for it, and turn what was measured into its profile.
    Calibrate(Box<CalibrateArguments>),
    /// Tell what a design holds: size, volume, materials, layers, warnings.
    Inspect(InspectArguments),
    /// List the built-in printers, or print one's profile.
    Printers(PrintersArguments),
    /// List every setting with its default and unit.
    Settings(SettingsArguments),
    /// Print a completion script for a shell.
    Completions(CompletionsArguments),
}

/// A design file and how to read it.
#[derive(Args, Clone, Debug)]
pub(crate) struct DesignArguments {
    /// The design: .vcad, or a mesh (.stl, .obj, .3mf) with --fraction.
    #[arg(value_name = "DESIGN")]
    pub(crate) design: PathBuf,

    /// Volume fraction of a mesh's material, as an expression of x y z in mm; once for each
    /// material. With one material fewer the last is the rest to 1.
    #[arg(long = "fraction", value_name = "EXPR", allow_hyphen_values = true)]
    pub(crate) fractions: Vec<String>,

    /// Scale the design to fit this box.
    #[arg(long, value_name = "X,Y,Z", value_parser = size, allow_hyphen_values = true)]
    pub(crate) size: Option<[f64; 3]>,
}

/// Where settings come from.
#[derive(Args, Clone, Debug)]
pub(crate) struct SettingSources {
    /// Read settings from a file: TOML, as `fgm settings --toml` prints it.
    #[arg(long = "settings", value_name = "FILE.toml")]
    pub(crate) file: Option<PathBuf>,

    /// Set one setting, or with `machine.` one entry of the printer's profile.
    #[arg(long = "set", value_name = "SECTION.KEY=VALUE", allow_hyphen_values = true)]
    pub(crate) set: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Switch {
    On,
    Off,
}

#[derive(Args, Debug)]
#[command(after_help = SLICE_EXAMPLES)]
pub(crate) struct SliceArguments {
    #[command(flatten)]
    pub(crate) design: DesignArguments,

    /// Where to write the G-code; `-` for standard output.
    #[arg(short, long, value_name = "OUT.gcode")]
    pub(crate) output: PathBuf,

    /// A built-in printer (`fgm printers` lists them) or a profile of your own.
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "generic-mixing")]
    pub(crate) printer: String,

    /// sectioned (1): ordinary toolpaths cut by colour; against (2): printed against the gradient.
    #[arg(long, value_name = "STRATEGY")]
    pub(crate) strategy: Option<Strategy>,

    /// How many colours the gradient is printed in, or auto [default: 16; a tool changer: its
    /// heads].
    #[arg(long, value_name = "N|auto")]
    pub(crate) colors: Option<ColorCount>,

    /// Overlap of neighbouring colours: 0.05 of the gradient, or 15mm [default: 0].
    #[arg(long, value_name = "SHARE|LENGTH", allow_hyphen_values = true)]
    pub(crate) zipper: Option<Zipper>,

    /// Thickness of a layer in mm [default: 0.2].
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) layer_height: Option<f64>,

    /// Width of a bead in mm [default: 0.4].
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) bead_width: Option<f64>,

    /// How many walls [default: 3].
    #[arg(long, value_name = "N")]
    pub(crate) walls: Option<usize>,

    /// Above the bottom one wall only that rises evenly, without travels or a seam: a vase.
    /// Strategy sectioned; stands for one wall, no infill and no top.
    #[arg(long)]
    pub(crate) spiral: bool,

    /// How much of the inside is filled, in percent; or a formula such as '10 + 40 z/50' of x, y, z
    /// and the distance d, for straight patterns [default: 15].
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    pub(crate) infill: Option<Density>,

    /// rectilinear, aligned, grid, triangles, honeycomb, concentric or gyroid [default: rectilinear].
    #[arg(long, value_name = "PATTERN")]
    pub(crate) infill_pattern: Option<Pattern>,

    /// Solid layers under a top [default: 4].
    #[arg(long, value_name = "N")]
    pub(crate) top: Option<usize>,

    /// Solid layers over a bottom [default: 4].
    #[arg(long, value_name = "N")]
    pub(crate) bottom: Option<usize>,

    /// How faces are filled, strategy against: concentric or rectilinear [default: concentric].
    #[arg(long, value_name = "FILL")]
    pub(crate) fill: Option<FaceFill>,

    /// Purge towers, strategy sectioned [default: on for mixing and foaming].
    #[arg(long, value_enum)]
    pub(crate) purge: Option<Switch>,

    /// Volume between the mixing and the nozzle's tip, by which commands go out early [default:
    /// the printer's].
    #[arg(long, value_name = "MM3", conflicts_with = "lead", allow_hyphen_values = true)]
    pub(crate) dead_volume: Option<f64>,

    /// The same as a length of bead of this layer height and width.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub(crate) lead: Option<f64>,

    /// Print only these layers, counted from 1, B included; they keep their height above the bed.
    #[arg(long, value_name = "A..B", value_parser = layer_range)]
    pub(crate) layers: Option<(usize, usize)>,

    /// How many threads to use; 0 for all cores [default: 0].
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,

    #[command(flatten)]
    pub(crate) settings: SettingSources,

    /// Write the figures of the slice as JSON.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Show no progress and no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const SLICE_EXAMPLES: &str = "\
Examples:
  A design on the default mixing printer:
    fgm slice designs/vase.vcad -o vase.gcode
  Ten walls, no infill, sixteen colours on a named machine:
    fgm slice designs/vase.vcad --printer geeetech-mizar-m --colors 16 --walls 10 --infill 0 -o vase.gcode
  A mesh graded from bottom to top over five heads, against the gradient:
    fgm slice benchy.3mf --fraction 'z/48' --printer prusa-xl-5t --strategy against -o benchy.gcode
  One wall that rises without a step:
    fgm slice designs/vase.vcad --spiral -o vase.gcode
  Colours that overlap by 15 mm, a setting from a file, one from the line, a report:
    fgm slice designs/dogbone.vcad --zipper 15mm --colors 3 --settings my.toml --set infill.angle=0 \\
        --report dogbone.json -o dogbone.gcode";

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm inspect designs/vase.vcad\n  fgm inspect part.stl --fraction 'z/20' --json"
)]
pub(crate) struct InspectArguments {
    #[command(flatten)]
    pub(crate) design: DesignArguments,

    /// Thickness of a layer in mm.
    #[arg(long, value_name = "MM", default_value_t = 0.2)]
    pub(crate) layer_height: f64,

    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm printers\n  fgm printers show geeetech-mizar-m > mine.toml"
)]
pub(crate) struct PrintersArguments {
    #[command(subcommand)]
    pub(crate) command: Option<PrintersCommand>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum PrintersCommand {
    /// Print a built-in profile as TOML, ready to copy and change.
    Show {
        /// Its name.
        name: String,
    },
}

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm settings\n  fgm settings infill\n  fgm settings --toml > my.toml"
)]
pub(crate) struct SettingsArguments {
    /// List only keys that contain this word.
    pub(crate) filter: Option<String>,

    /// Print a settings file with every default.
    #[arg(long)]
    pub(crate) toml: bool,
}

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm completions bash > /etc/bash_completion.d/fgm\n  fgm completions zsh > ~/.zfunc/_fgm"
)]
pub(crate) struct CompletionsArguments {
    /// Which shell.
    pub(crate) shell: clap_complete::Shell,
}

fn size(text: &str) -> Result<[f64; 3], String> {
    let wanted = || format!("`{text}` is not three lengths above 0 in mm such as 60,31,48");
    let lengths: Vec<f64> = text
        .split(',')
        .map(|t| t.trim().parse().map_err(|_| wanted()))
        .collect::<Result<_, _>>()?;
    let lengths: [f64; 3] = lengths.try_into().map_err(|_| wanted())?;
    if lengths.iter().all(|l| l.is_finite() && *l > 0.0) { Ok(lengths) } else { Err(wanted()) }
}

fn layer_range(text: &str) -> Result<(usize, usize), String> {
    let wanted = || format!("`{text}` is not a range of layers such as 1..10, counted from 1");
    let (first, last) = match text.split_once("..") {
        Some((first, last)) => (first.trim(), last.trim().trim_start_matches('=')),
        None => (text.trim(), text.trim()),
    };
    let first: usize = if first.is_empty() { 1 } else { first.parse().map_err(|_| wanted())? };
    let last: usize =
        if last.is_empty() { usize::MAX } else { last.parse().map_err(|_| wanted())? };
    if first >= 1 && last >= first { Ok((first, last)) } else { Err(wanted()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn ranges_and_sizes() {
        assert_eq!(layer_range("3..5"), Ok((3, 5)));
        assert_eq!(layer_range("..5"), Ok((1, 5)));
        assert_eq!(layer_range("7"), Ok((7, 7)));
        assert!(layer_range("0..5").is_err());
        assert!(layer_range("5..4").is_err());
        assert!(layer_range("a..b").is_err());
        assert_eq!(size("1, 2,3"), Ok([1.0, 2.0, 3.0]));
        assert!(size("1,2").is_err());
        assert!(size("1,2,-3").is_err());
    }
}
