use fgm_core::{Point3, Role};

use crate::{Fan, Machine, MotionLimits, Retraction, Speeds, Temperatures};

/// How a print is written: a machine's usual settings, and what only this print knows.
#[derive(Clone, Debug, PartialEq)]
pub struct WriterOptions {
    /// Bed position = design position + this, mm; z of the beads' tops.
    pub offset: Point3,
    /// Speeds.
    pub speeds: Speeds,
    /// Temperatures.
    pub temperatures: Temperatures,
    /// Pulling back for travels.
    pub retraction: Retraction,
    /// The part's cooling.
    pub fan: Fan,
    /// Accelerations, for the estimate of the time.
    pub limits: MotionLimits,
    /// Greatest extruded volume per second, mm³/s.
    pub max_flow: Option<f64>,
    /// Factor on the extrusion of each role, in the order of [`Role::ALL`].
    pub flow: [f64; Role::ALL.len()],
    /// Lines of the head: version, command line, settings.
    pub comments: Vec<String>,
    /// The palette as red, green and blue, for viewers; may be empty.
    pub colors: Vec<[u8; 3]>,
    /// Whether there are lines that tell the progress by `M73`, to be
    /// [filled in](crate::ProgressLines::fill) after the print.
    pub progress: bool,
}

impl WriterOptions {
    /// A machine's own settings; the design stands at the bed's origin.
    pub fn of(machine: &Machine) -> Self {
        Self {
            offset: Point3::ZERO,
            speeds: machine.speed.clone(),
            temperatures: machine.temperature.clone(),
            retraction: machine.retraction.clone(),
            fan: machine.fan.clone(),
            limits: machine.motion.clone(),
            max_flow: machine.max_flow,
            flow: [1.0; Role::ALL.len()],
            comments: Vec::new(),
            colors: Vec::new(),
            progress: machine.dialect.progress,
        }
    }
}

impl Default for WriterOptions {
    fn default() -> Self {
        Self::of(&Machine::default())
    }
}
