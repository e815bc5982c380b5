use fgm_core::Role;

use crate::State;

mod bed;
#[cfg(feature = "serde")]
mod builtin;
mod parts;
#[cfg(feature = "serde")]
mod profile;
mod validate;

pub use bed::Bed;
pub use parts::{
    Auger, DialectName, DialectOptions, Fan, Foaming, LeadOptions, MotionLimits, Retraction,
    Speeds, Temperatures, Templates, ToolChanging, TransitionOptions,
};
#[cfg(feature = "serde")]
pub use profile::MachineError;

/// How a machine changes what comes out of its nozzle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum MachineKind {
    /// Several filaments meet in one nozzle; a colour is a ratio.
    #[default]
    Mixing,
    /// Several heads, one used at a time; a colour is a head.
    ToolChanger,
    /// One filament that foams more the hotter it is; a colour is a temperature.
    Foaming,
}

/// A printer: its size, its firmware's dialect, its dead volume, its usual settings.
///
/// As TOML every field may be left out and then has the value of [`Machine::default`]; an unknown
/// field is an error. Lengths mm, temperatures °C, speeds mm/s.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Machine {
    /// Short name, as on a command line.
    pub name: String,
    /// One line that says what the machine is.
    pub title: String,
    /// What a user should know before printing.
    pub notes: String,
    /// How it changes what comes out.
    pub kind: MachineKind,
    /// Filaments that it mixes, or heads that it changes; a foaming filament counts as 2 (not
    /// foamed, foamed).
    pub inputs: usize,
    /// Diameter of the nozzle's opening, mm.
    pub nozzle: f64,
    /// Diameter of the filament, mm.
    pub filament_diameter: f64,
    /// Density of the filament, g/cm³, for the mass that a print takes.
    pub filament_density: f64,
    /// No ratio lies between 0 and this: firmwares drop what is less than 0.01.
    pub min_fraction: f64,
    /// Greatest section of a bead, mm², above which the firmware stops.
    pub max_bead_area: Option<f64>,
    /// Greatest extruded volume per second, mm³/s; faster moves are slowed to it.
    pub max_flow: Option<f64>,
    /// Greatest volume of each input per second, mm³/s, where the materials differ: filaments in
    /// their order, or heads. Those without an entry have no limit of their own.
    pub max_input_flow: Vec<f64>,
    /// Where the nozzle can go.
    pub bed: Bed,
    /// The firmware's language.
    pub dialect: DialectOptions,
    /// An auger with a speed of its own.
    pub auger: Auger,
    /// Extrusion between a command and its effect.
    pub lead: LeadOptions,
    /// How the deposit follows a command, where it was measured.
    pub transition: TransitionOptions,
    /// Temperatures.
    pub temperature: Temperatures,
    /// The foaming filament, where there is one.
    pub foaming: Foaming,
    /// Speeds.
    pub speed: Speeds,
    /// What the estimate of the printing time goes by.
    pub motion: MotionLimits,
    /// Pulling back the filament for travels.
    pub retraction: Retraction,
    /// The part's cooling.
    pub fan: Fan,
    /// Changing heads, on a tool changer.
    pub tool_change: ToolChanging,
    /// G-code at the start and the end.
    pub template: Templates,
}

impl Default for Machine {
    fn default() -> Self {
        Self {
            name: "custom".into(),
            title: String::new(),
            notes: String::new(),
            kind: MachineKind::Mixing,
            inputs: 2,
            nozzle: 0.4,
            filament_diameter: 1.75,
            filament_density: 1.24,
            min_fraction: 0.01,
            max_bead_area: None,
            max_flow: None,
            max_input_flow: Vec::new(),
            bed: Bed::default(),
            dialect: DialectOptions::default(),
            auger: Auger::default(),
            lead: LeadOptions::default(),
            transition: TransitionOptions::default(),
            temperature: Temperatures::default(),
            foaming: Foaming::default(),
            speed: Speeds::default(),
            motion: MotionLimits::default(),
            retraction: Retraction::default(),
            fan: Fan::default(),
            tool_change: ToolChanging::default(),
            template: Templates::default(),
        }
    }
}

impl Machine {
    /// Volume extruded between a command and its arrival at the nozzle's tip, mm³; on a tool
    /// changer, how far ahead of its use a head is heated.
    ///
    /// Where the profile gives a transition, that is its middle, else its lead.
    ///
    /// ```
    /// use fgm_gcode::{LeadOptions, Machine};
    /// let lead = LeadOptions { length: Some(960.0), ..LeadOptions::default() };
    /// let machine = Machine { lead, ..Machine::default() };
    /// assert!((machine.dead_volume() - 68.56).abs() < 0.01);
    /// ```
    pub fn dead_volume(&self) -> f64 {
        self.transition.middle().or(self.lead.volume()).unwrap_or(0.0)
    }

    /// How many colours a palette may have, where the heads limit it.
    pub fn max_colors(&self) -> Option<usize> {
        (self.kind == MachineKind::ToolChanger).then_some(self.inputs)
    }

    /// Filaments mixed, or heads; 2 for a foaming filament.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// What E is written with for a firmware that scales the weights of all motors to a sum of 1:
    /// their sum, so that each turns by its weight again; else 1.
    pub fn feed_factor(&self) -> f64 {
        let leading = self.dialect.leading_weights.iter().sum::<f64>();
        if self.dialect.normalises && self.kind == MachineKind::Mixing {
            1.0 + leading
        } else {
            1.0
        }
    }

    /// The speed of a role's beads that take so much filament a mm (mm²), mm/s: the profile's, no
    /// more than the first layer's on that layer, slowed to the greatest flow in the state that the
    /// machine is in.
    pub fn bead_speed(
        &self,
        role: Role,
        fed: f64,
        state: Option<&State>,
        first_layer: bool,
    ) -> f64 {
        let usual = self.speed.of(role);
        let speed = if first_layer { usual.min(self.speed.first_layer) } else { usual };
        speed.min(self.flow_limit(state) / fed.max(f64::MIN_POSITIVE))
    }

    /// The greatest flow in a state, mm³/s: the machine's, and no more than each input's for its
    /// share of it; infinite where nothing limits it.
    pub fn flow_limit(&self, state: Option<&State>) -> f64 {
        let most = self.max_flow.unwrap_or(f64::INFINITY);
        let Some(state) = state.filter(|_| !self.max_input_flow.is_empty()) else { return most };
        let input = |i: usize| self.max_input_flow.get(i).copied().unwrap_or(f64::INFINITY);
        let inputs = match self.kind {
            MachineKind::Mixing => {
                let shares = state.mixture.fractions().iter().enumerate();
                shares.filter(|(_, w)| **w > 0.0).map(|(i, w)| input(i) / w).fold(most, f64::min)
            }
            MachineKind::ToolChanger => input(state.tool.unwrap_or(0) as usize),
            MachineKind::Foaming => input(0),
        };
        most.min(inputs)
    }

    /// Section of the filament, mm².
    pub fn filament_area(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.filament_diameter * self.filament_diameter
    }
}
