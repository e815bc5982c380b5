use std::path::PathBuf;

use clap::Args;
use fgm::sim::{Thermal, Transition};

use super::{layer_range, size};

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArguments {
    /// The G-code, of fgm or of another slicer; `-` for standard input.
    #[arg(value_name = "OUT.gcode")]
    pub(crate) gcode: PathBuf,

    /// The design it was made from: .vcad, or a mesh with --fraction.
    #[arg(long, value_name = "DESIGN")]
    pub(crate) design: Option<PathBuf>,

    /// Volume fraction of a mesh's material, as for `fgm slice`; once for each material.
    #[arg(long = "fraction", value_name = "EXPR", allow_hyphen_values = true, requires = "design")]
    pub(crate) fractions: Vec<String>,

    /// Scale the design to fit this box.
    #[arg(long, value_name = "X,Y,Z", value_parser = size, requires = "design")]
    pub(crate) size: Option<[f64; 3]>,

    /// Where the design stands: bed position = design position + this [default: design_offset in
    /// the head of the file].
    #[arg(long, value_name = "X,Y,Z", value_parser = offset, requires = "design")]
    #[arg(allow_hyphen_values = true)]
    pub(crate) offset: Option<[f64; 3]>,

    /// The printer: a built-in one or a profile of your own [default: the one in the head of the
    /// file].
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(crate) printer: Option<String>,

    /// How the deposit follows the commands: ideal, delay:MM3, or linear:DELAY,LENGTH in mm3
    /// [default: by the printer's profile].
    #[arg(long, value_name = "MODEL", value_parser = transition)]
    pub(crate) transition: Option<Transition>,

    /// How the nozzle's temperature follows its command, for foaming filament: rates in degrees a
    /// second, time constant in seconds [default: at once].
    #[arg(long, value_name = "HEATING,COOLING,CONSTANT", value_parser = thermal)]
    pub(crate) thermal: Option<Thermal>,

    /// Compare only these layers with the design, counted from 1, B included.
    #[arg(long, value_name = "A..B", value_parser = layer_range)]
    pub(crate) layers: Option<(usize, usize)>,

    /// Compare places at this distance along the beads, in mm.
    #[arg(long, value_name = "MM", default_value_t = 0.5, value_parser = distance)]
    pub(crate) spacing: f64,

    /// Measure coverage in cells of this side, in mm; 0 for not at all [default: 0.1 with a
    /// design, else not at all].
    #[arg(long, value_name = "MM", value_parser = cell)]
    pub(crate) cell: Option<f64>,

    /// Colours of the materials, in their order [default: the design's].
    #[arg(long, value_name = "RRGGBB,...", value_delimiter = ',', value_parser = color)]
    pub(crate) material_colors: Vec<[u8; 3]>,

    /// Write PNG pictures of layers into this folder: designed, commanded, deposited, error.
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,

    /// Which layers to paint, counted from 1 [default: 1].
    #[arg(long, value_name = "1,5,10", value_delimiter = ',', requires = "pictures")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) picture_layers: Vec<u32>,

    /// Write the figures as JSON, to a file or with `-` to standard output in place of the text.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  Faults and totals of any G-code:
    fgm check part.gcode
    fgm check part.gcode --printer prusa-xl-5t
  What a machine lays down, against the design:
    fgm check vase.gcode --design designs/vase.vcad
    fgm check slab.gcode --design designs/slab.vcad --pictures out --picture-layers 1,5,10
  The same for a nozzle that takes 13 mm3 to answer and 26 mm3 to change:
    fgm check slab.gcode --design designs/slab.vcad --transition linear:13,26
  Figures for a program:
    fgm check vase.gcode --json -

Exit status: 0 without faults, 1 with faults (or where something could not be read or written),
2 bad input or usage.";

/// Reads a model of the way from command to deposit.
fn transition(text: &str) -> Result<Transition, String> {
    let wanted = || {
        format!(
            "`{text}` is not a model such as ideal, delay:68.5 or linear:13,26 (volumes of 0 or more in mm3)"
        )
    };
    let volume = |text: &str| {
        let volume: Option<f64> = text.trim().parse().ok();
        volume.filter(|v| (0.0..=1e6).contains(v)).ok_or_else(wanted)
    };
    match text.split_once(':') {
        None if text == "ideal" => Ok(Transition::IDEAL),
        Some(("delay", delay)) => Ok(Transition { delay: volume(delay)?, length: 0.0 }),
        Some(("linear", volumes)) => {
            let (delay, length) = volumes.split_once(',').ok_or_else(wanted)?;
            Ok(Transition { delay: volume(delay)?, length: volume(length)? })
        }
        _ => Err(wanted()),
    }
}

/// Reads three lengths of any sign.
fn offset(text: &str) -> Result<[f64; 3], String> {
    let wanted = || format!("`{text}` is not three lengths in mm such as 125,125,0");
    let lengths: Vec<f64> = text
        .split(',')
        .map(|t| t.trim().parse().map_err(|_| wanted()))
        .collect::<Result<_, _>>()?;
    let lengths: [f64; 3] = lengths.try_into().map_err(|_| wanted())?;
    if lengths.iter().all(|l| l.abs() <= 1e6) { Ok(lengths) } else { Err(wanted()) }
}

fn distance(text: &str) -> Result<f64, String> {
    let distance: Option<f64> = text.parse().ok();
    distance
        .filter(|d| (0.01..=1000.0).contains(d))
        .ok_or_else(|| format!("`{text}` is not a distance of 0.01 to 1000 mm"))
}

fn cell(text: &str) -> Result<f64, String> {
    let cell: Option<f64> = text.parse().ok();
    cell.filter(|c| *c == 0.0 || (0.005..=10.0).contains(c))
        .ok_or_else(|| format!("`{text}` is neither 0 nor a side of 0.005 to 10 mm"))
}

fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.trim().trim_start_matches('#');
    let value = u32::from_str_radix(digits, 16)
        .ok()
        .filter(|_| digits.len() == 6 && !digits.starts_with('+'));
    let [_, rgb @ ..] =
        value.ok_or_else(|| format!("`{text}` is not a colour such as 1e5ac8"))?.to_be_bytes();
    Ok(rgb)
}

/// Reads rates and the time constant of a nozzle.
fn thermal(text: &str) -> Result<Thermal, String> {
    let wanted =
        || format!("`{text}` is not rates above 0 and a time of 0 or more such as 2.0,1.0,8");
    let numbers: Vec<f64> = text
        .split(',')
        .map(|t| t.trim().parse().map_err(|_| wanted()))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [heating, cooling, time_constant]
            if heating > 0.0 && cooling > 0.0 && (0.0..=1e6).contains(&time_constant) =>
        {
            Ok(Thermal { heating, cooling, time_constant })
        }
        _ => Err(wanted()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models() {
        assert_eq!(transition("ideal"), Ok(Transition::IDEAL));
        assert_eq!(transition("delay:3.5"), Ok(Transition { delay: 3.5, length: 0.0 }));
        assert_eq!(transition("linear:3,4"), Ok(Transition { delay: 3.0, length: 4.0 }));
        for bad in ["", "delay", "delay:-1", "delay:x", "linear:3", "linear:3,4,5", "delay:nan"] {
            assert!(transition(bad).is_err(), "{bad}");
        }
        assert_eq!(color("#1e5ac8"), Ok([0x1e, 0x5a, 0xc8]));
        assert!(color("1e5ac").is_err() && color("+12345").is_err() && color("red").is_err());
        assert_eq!(offset("1,-2,0.5"), Ok([1.0, -2.0, 0.5]));
        assert!(offset("1,2").is_err() && offset("1,2,inf").is_err());
        assert!(cell("0").is_ok() && cell("0.001").is_err() && distance("0").is_err());
        let expected = Thermal { heating: 2.0, cooling: 1.0, time_constant: 8.0 };
        assert_eq!(thermal("2, 1,8"), Ok(expected));
        for bad in ["", "1,2", "0,1,1", "1,-1,1", "1,1,-1", "1,1,nan", "1,1,1,1"] {
            assert!(thermal(bad).is_err(), "{bad}");
        }
    }
}
