use std::path::PathBuf;

use clap::{Args, Subcommand};

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CalibrateArguments {
    #[command(subcommand)]
    pub(crate) what: Calibration,
}

const EXAMPLES: &str = "\
Examples:
  How far a change comes late: print the plate, read the ruler where the colour changes.
    fgm calibrate lead --printer generic-mixing -o plate.gcode
    fgm calibrate solve lead --late 12.5 --line 40 --printer generic-mixing -o mine.toml
  How long a change takes: print the lines, measure along the bead from the mark.
    fgm calibrate transition --printer mine.toml -o lines.gcode
    fgm calibrate solve transition --begins 95 --ends 290 --printer mine.toml -o mine2.toml
  How a filament foams: print the ladder, measure the wall at each temperature.
    fgm calibrate foaming --printer prusa-mk4s-lw-pla -o ladder.gcode
    fgm calibrate solve foaming --wall 190=0.40 --wall 205=0.52 --wall 220=0.71 --degree 2 \\
        --printer prusa-mk4s-lw-pla -o mine.toml
  A dead volume that is known:
    fgm calibrate solve volume --mm3 68.6 --printer generic-mixing -o mine.toml";

#[derive(Debug, Subcommand)]
pub(crate) enum Calibration {
    /// Write a plate hatched back and forth with one change in its middle and a ruler at its edge
    /// (appendix A.2 of the gradient-slicing paper).
    Lead(LeadPrint),
    /// Write long lines with changes at marks, to measure where each begins and where it ends.
    Transition(TransitionPrint),
    /// Write a ladder of temperatures: a thin wall that gets hotter step by step.
    Foaming(FoamingPrint),
    /// Turn what was measured into a printer's profile.
    #[command(subcommand)]
    Solve(Solve),
}

/// What every calibration print takes.
#[derive(Args, Debug)]
pub(crate) struct PrintArguments {
    /// A built-in printer or a profile of your own.
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "generic-mixing")]
    pub(crate) printer: String,

    /// Where to write the G-code; `-` for standard output.
    #[arg(short, long, value_name = "OUT.gcode")]
    pub(crate) output: PathBuf,

    /// Width of the beads in mm [default: the nozzle's].
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) bead_width: Option<f64>,

    /// Thickness of the layers in mm [default: half the nozzle's].
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) layer_height: Option<f64>,
}

/// Which filaments, or heads, a change is between.
#[derive(Args, Debug)]
pub(crate) struct Inputs {
    /// The input that comes out first, from 0.
    #[arg(long, value_name = "INPUT", default_value_t = 0)]
    pub(crate) from: usize,

    /// The input that comes out after the change.
    #[arg(long, value_name = "INPUT", default_value_t = 1)]
    pub(crate) to: usize,
}

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm calibrate lead --printer geeetech-a20m -o plate.gcode\n  fgm calibrate lead --printer mine.toml --lead-volume 60 --size 80,30 -o again.gcode"
)]
pub(crate) struct LeadPrint {
    #[command(flatten)]
    pub(crate) print: PrintArguments,

    #[command(flatten)]
    pub(crate) inputs: Inputs,

    /// Size of the plate in mm; the lines run along y.
    #[arg(long, value_name = "X,Y", value_parser = pair, default_value = "60,40")]
    pub(crate) size: [f64; 2],

    /// Command the change this much extrusion early, to see whether it is right.
    #[arg(long, value_name = "MM3", value_parser = not_negative, default_value_t = 0.0)]
    pub(crate) lead_volume: f64,
}

#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  fgm calibrate transition --printer snmf-4 --bead-width 2 --layer-height 0.8 -o lines.gcode\n  fgm calibrate transition --printer mine.toml --changes 4 --room 150 -o lines.gcode"
)]
pub(crate) struct TransitionPrint {
    #[command(flatten)]
    pub(crate) print: PrintArguments,

    #[command(flatten)]
    pub(crate) inputs: Inputs,

    /// Length of a line in mm.
    #[arg(long, value_name = "MM", value_parser = positive, default_value_t = 150.0)]
    pub(crate) line: f64,

    /// How many changes, there and back.
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub(crate) changes: usize,

    /// Extrusion after each change in mm3 [default: three of the printer's dead volumes, and 10
    /// lines at least].
    #[arg(long, value_name = "MM3", value_parser = positive)]
    pub(crate) room: Option<f64>,
}

#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  fgm calibrate foaming --printer prusa-mk4s-lw-pla --step 5 -o ladder.gcode"
)]
pub(crate) struct FoamingPrint {
    #[command(flatten)]
    pub(crate) print: PrintArguments,

    /// Degrees from rung to rung.
    #[arg(long, value_name = "C", value_parser = positive, default_value_t = 5.0)]
    pub(crate) step: f64,

    /// Height of a rung in mm.
    #[arg(long, value_name = "MM", value_parser = positive, default_value_t = 6.0)]
    pub(crate) rung: f64,

    /// Side of the wall's square in mm.
    #[arg(long, value_name = "MM", value_parser = positive, default_value_t = 25.0)]
    pub(crate) side: f64,
}

/// Where a profile comes from and goes to.
#[derive(Args, Debug)]
pub(crate) struct ProfileArguments {
    /// The profile to change: a built-in one or a file. The rest of it stays as it is.
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "generic-mixing")]
    pub(crate) printer: String,

    /// Where to write the changed profile; without it the result is only told.
    #[arg(short, long, value_name = "OUT.toml")]
    pub(crate) output: Option<PathBuf>,
}

/// The bead that was measured.
#[derive(Args, Debug)]
pub(crate) struct Bead {
    /// Width of the bead measured in mm [default: the nozzle's].
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) bead_width: Option<f64>,

    /// Its height in mm [default: half the nozzle's].
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) layer_height: Option<f64>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Solve {
    /// The lead, from how far beyond the middle of the plate the colour changed.
    #[command(
        after_help = "Example:\n  fgm calibrate solve lead --late 12.5 --line 40 --printer generic-mixing -o mine.toml"
    )]
    Lead {
        /// From the plate's middle to where the colour changes in mm; negative where it came early.
        #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = number)]
        late: f64,
        /// Length of the plate's lines in mm: its y.
        #[arg(long, value_name = "MM", value_parser = positive)]
        line: f64,
        /// The lead that the plate was printed with.
        #[arg(long, value_name = "MM3", value_parser = not_negative, default_value_t = 0.0)]
        lead_volume: f64,
        #[command(flatten)]
        bead: Bead,
        #[command(flatten)]
        profile: ProfileArguments,
    },
    /// Delay and change, from lengths of bead after the mark; several of each are averaged.
    #[command(
        after_help = "Example:\n  fgm calibrate solve transition --begins 9 --ends 27 --bead-width 2 --layer-height 0.8 --printer snmf-4 -o mine.toml"
    )]
    Transition {
        /// From a mark to where the new colour begins to show, mm along the bead.
        #[arg(long, value_name = "MM", value_parser = not_negative, required = true)]
        begins: Vec<f64>,
        /// From a mark to where the old colour is gone, mm along the bead.
        #[arg(long, value_name = "MM", value_parser = not_negative, required = true)]
        ends: Vec<f64>,
        #[command(flatten)]
        bead: Bead,
        #[command(flatten)]
        profile: ProfileArguments,
    },
    /// The flow polynomial, by least squares from walls or flows at temperatures.
    #[command(
        after_help = "Example:\n  fgm calibrate solve foaming --wall 190=0.40 --wall 205=0.52 --wall 220=0.71 --degree 2 --printer prusa-mk4s-lw-pla -o mine.toml"
    )]
    Foaming {
        /// The width of the ladder's wall at a temperature in mm, printed with a flow of 1.
        #[arg(long = "wall", value_name = "C=MM", value_parser = at_temperature)]
        walls: Vec<(f64, f64)>,
        /// A flow at a temperature that was found right, as a factor.
        #[arg(long = "flow", value_name = "C=FACTOR", value_parser = at_temperature)]
        flows: Vec<(f64, f64)>,
        /// Degree of the polynomial.
        #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(0..=6))]
        degree: u8,
        #[command(flatten)]
        bead: Bead,
        #[command(flatten)]
        profile: ProfileArguments,
    },
    /// The lead, from a dead volume that is known (appendix A.1 of the gradient-slicing paper).
    #[command(
        after_help = "Example:\n  fgm calibrate solve volume --mm3 68.6 --printer generic-mixing -o mine.toml"
    )]
    Volume {
        /// The volume between the mixing and the nozzle's tip.
        #[arg(long, value_name = "MM3", value_parser = not_negative)]
        mm3: f64,
        #[command(flatten)]
        bead: Bead,
        #[command(flatten)]
        profile: ProfileArguments,
    },
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|n| n.is_finite() && n.abs() <= 1e6);
    number.ok_or_else(|| format!("`{text}` is not a number such as 12.5"))
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text)?;
    number(text).ok().filter(|n| *n >= 0.0).ok_or_else(|| format!("`{text}` is below 0"))
}

fn positive(text: &str) -> Result<f64, String> {
    number(text)?;
    number(text).ok().filter(|n| *n > 0.0).ok_or_else(|| format!("`{text}` is not above 0"))
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    let (x, y) =
        text.split_once(',').ok_or_else(|| format!("`{text}` is not two lengths: 60,40"))?;
    Ok([positive(x)?, positive(y)?])
}

fn at_temperature(text: &str) -> Result<(f64, f64), String> {
    let wanted = || format!("`{text}` is not a value at a temperature such as 205=0.52");
    let (celsius, value) = text.split_once('=').ok_or_else(wanted)?;
    Ok((positive(celsius)?, positive(value)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_or_refused() {
        assert_eq!(at_temperature("205=0.52"), Ok((205.0, 0.52)));
        assert_eq!(pair("60, 40"), Ok([60.0, 40.0]));
        assert_eq!(number("-3.5"), Ok(-3.5));
        for bad in ["205", "205=", "=1", "205=0", "x=1", "205=nan", "inf=1"] {
            assert!(at_temperature(bad).is_err(), "{bad}");
        }
        assert!(pair("60").is_err() && pair("60,0").is_err() && not_negative("-1").is_err());
    }
}
