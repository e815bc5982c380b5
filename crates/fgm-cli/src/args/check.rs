use std::path::PathBuf;

use clap::Args;
use fgm::sim::{Thermal, Transition};

use super::layer_range;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArguments {
    /// The G-code, of fgm or of another slicer; `-` for standard input.
    #[arg(value_name = "OUT.gcode")]
    pub(crate) gcode: PathBuf,

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

    /// Write the figures as JSON, to a file or with `-` to standard output in place of the text.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  Faults and totals of any G-code:
    fgm check part.gcode
    fgm check part.gcode --printer prusa-xl-5t
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
        let expected = Thermal { heating: 2.0, cooling: 1.0, time_constant: 8.0 };
        assert_eq!(thermal("2, 1,8"), Ok(expected));
        for bad in ["", "1,2", "0,1,1", "1,-1,1", "1,1,-1", "1,1,nan", "1,1,1,1"] {
            assert!(thermal(bad).is_err(), "{bad}");
        }
    }
}
