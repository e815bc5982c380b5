use fgm_core::{Role, bead};

/// Which firmware's language is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum DialectName {
    /// Marlin, `M163` for each motor and `M164`: works on every Marlin with mixing.
    #[default]
    MarlinMixing,
    /// Marlin, one `M165`: needs a firmware built with `DIRECT_MIXING_IN_G1`.
    MarlinDirect,
    /// RepRapFirmware, `M567`.
    RepRap,
    /// `T<n>`, as Marlin and Klipper's macros take it.
    ToolChange,
    /// Prusa XL, park and pick.
    PrusaXl,
    /// Kalico, `SET_MIXING_EXTRUDER` after `M400`.
    Kalico,
    /// Repetier, whole `M163` weights and `M164`.
    Repetier,
    /// `M104` for the temperature, flow folded into E or as `M221`.
    Foaming,
}

impl DialectName {
    /// Decimals of a ratio that the firmware can tell apart.
    pub fn ratio_decimals(self) -> u32 {
        if self == Self::Repetier { 3 } else { 4 }
    }
}

macro_rules! part {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty = $default:expr,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }
    };
}

part!(
    /// The firmware's language and what it can be told.
    DialectOptions {
        /// Which language.
        name: DialectName = DialectName::MarlinMixing,
        /// The virtual tool (Marlin, Repetier) or tool (RepRapFirmware) that is rewritten at each
        /// change.
        virtual_tool: u32 = 0,
        /// Weights of the motors before the filaments'. An auger that turns with every flow is
        /// motor 0 of weight 1, and the filaments start at motor 1: `[1.0]`.
        leading_weights: Vec<f64> = Vec::new(),
        /// Whether the firmware scales all weights to a sum of 1, as a stock Marlin does. Leading
        /// motors would take their share from the filaments: every E is then written that much
        /// larger.
        normalises: bool = false,
        /// Virtual tools that keep the palette's mixtures (Marlin, at most 16): written once, then
        /// called by `T<n>`. 0 for rewriting `virtual_tool` at each change.
        virtual_tools: u32 = 0,
        /// Whether the firmware is told the progress by `M73 P<percent> R<minutes left>`.
        progress: bool = false,
    }
);

part!(
    /// An auger whose speed the firmware has to be told; one that turns as a leading motor follows
    /// the flow by itself.
    Auger {
        /// Flow at one turn a second, mm³/s: Q0 of the active-mixing paper, eq. 2.
        flow: Option<f64> = None,
        /// What sets the speed: `{rpm}` is turns a minute. Written before a bead of another flow;
        /// empty for never.
        command: String = String::new(),
        /// What stops it after the print.
        stop: String = String::new(),
    }
);

impl Auger {
    /// Turns a minute for a flow in mm³/s, whole ones: `60 Q / Q0`; none where nothing is told.
    pub fn turns(&self, flow: f64) -> Option<u32> {
        let unit = self.flow.filter(|_| !self.command.is_empty())?;
        Some((60.0 * flow / unit).round() as u32)
    }
}

part!(
    /// Extrusion between a command and its arrival at the nozzle's tip: a volume, or the length of
    /// a bead of a given section.
    LeadOptions {
        /// The volume, mm³; goes before `length`.
        volume: Option<f64> = None,
        /// The length of the bead that was measured, mm.
        length: Option<f64> = None,
        /// That bead's height, mm.
        layer_height: f64 = 0.2,
        /// That bead's width, mm.
        bead_width: f64 = 0.4,
    }
);

impl LeadOptions {
    /// The volume, mm³: `length * A` with the section of [`bead::area`] where only a length is
    /// given; none where nothing is.
    pub fn volume(&self) -> Option<f64> {
        let measured = || self.length.map(|l| l * bead::area(self.bead_width, self.layer_height));
        self.volume.or_else(measured)
    }
}

part!(
    /// How the deposit follows a command: nothing for a delay, then a linear change over a length.
    /// Each a volume, or the length of a bead of a given section.
    TransitionOptions {
        /// Volume before the change begins, mm³; goes before `delay_length`.
        delay: Option<f64> = None,
        /// Volume that the change takes, mm³; goes before `change_length`.
        change: Option<f64> = None,
        /// Bead laid down before the change begins, mm: L1 of the active-mixing paper.
        delay_length: Option<f64> = None,
        /// Bead laid down during the change, mm: L2 of the active-mixing paper.
        change_length: Option<f64> = None,
        /// The measured bead's height, mm.
        layer_height: f64 = 0.2,
        /// The measured bead's width, mm.
        bead_width: f64 = 0.4,
    }
);

impl TransitionOptions {
    /// Volumes before and during the change, mm³; none where neither is given. A length counts by
    /// the section of [`bead::area`].
    pub fn volumes(&self) -> Option<(f64, f64)> {
        let area = bead::area(self.bead_width, self.layer_height);
        let delay = self.delay.or(self.delay_length.map(|length| length * area));
        let change = self.change.or(self.change_length.map(|length| length * area));
        (delay.is_some() || change.is_some())
            .then_some((delay.unwrap_or(0.0), change.unwrap_or(0.0)))
    }

    /// Volume from a command to the middle of its change, mm³; none where no transition is given.
    pub fn middle(&self) -> Option<f64> {
        self.volumes().map(|(delay, change)| delay + 0.5 * change)
    }
}

part!(
    /// Temperatures, °C.
    Temperatures {
        /// The nozzle's.
        nozzle: f64 = 210.0,
        /// The nozzle's on the first layer.
        first_layer: f64 = 215.0,
        /// The bed's; 0 for none.
        bed: f64 = 60.0,
        /// The bed's on the first layer.
        first_layer_bed: f64 = 60.0,
        /// A head's while another one prints; left hot where not given.
        standby: Option<f64> = None,
        /// Nothing is extruded below this.
        min_extrusion: f64 = 170.0,
    }
);

part!(
    /// A filament that foams with temperature.
    Foaming {
        /// Temperature for all of the first material (not foamed), °C.
        low: f64 = 190.0,
        /// Temperature for all of the second (foamed most), °C.
        high: f64 = 225.0,
        /// Flow as a polynomial of the temperature in °C: coefficients from the constant up, whose
        /// value is a factor (1 = 100 %).
        flow: Vec<f64> = vec![1.0],
        /// Temperatures are whole multiples of this, °C: firmwares keep whole degrees.
        step: f64 = 1.0,
        /// Whether the flow is told by `M221` in place of being folded into E.
        flow_command: bool = false,
        /// How fast the nozzle heats, °C/s. With this or `cooling` the temperatures go out early by
        /// the time they take, and the flow follows what is predicted; the lead is then the volume
        /// between the melting and the tip alone.
        heating: Option<f64> = None,
        /// How fast it cools, °C/s.
        cooling: Option<f64> = None,
    }
);

impl Foaming {
    /// The temperature for a share of the second material, °C: linear, rounded to the step.
    pub fn temperature(&self, share: f64) -> f64 {
        let exact = self.low + (self.high - self.low) * share.clamp(0.0, 1.0);
        if self.step > 0.0 { (exact / self.step).round_ties_even() * self.step } else { exact }
    }

    /// The factor on the fed filament at a temperature.
    pub fn flow_at(&self, celsius: f64) -> f64 {
        self.flow.iter().rev().fold(0.0, |sum, c| sum * celsius + c)
    }
}

part!(
    /// Speeds, mm/s.
    Speeds {
        /// The wall that is seen.
        outer_wall: f64 = 30.0,
        /// The walls behind it.
        inner_wall: f64 = 45.0,
        /// Sparse filling.
        infill: f64 = 60.0,
        /// Full filling inside.
        solid_infill: f64 = 50.0,
        /// Full filling with nothing above.
        top_skin: f64 = 40.0,
        /// Full filling with nothing below.
        bottom_skin: f64 = 40.0,
        /// Walls that hang over, as shares of the outer wall's speed: up to half of their width
        /// over air, more than half, all of it.
        overhang: [f64; 3] = [0.8, 0.6, 0.5],
        /// Filling over air.
        bridge: f64 = 25.0,
        /// Thin beads.
        gap_fill: f64 = 25.0,
        /// Lines around the part.
        skirt: f64 = 40.0,
        /// Supports.
        support: f64 = 50.0,
        /// The purge tower.
        purge_tower: f64 = 50.0,
        /// Beads of the first layer go no faster than this.
        first_layer: f64 = 20.0,
        /// Moves without extrusion.
        travel: f64 = 150.0,
        /// Moves of z alone.
        z: f64 = 10.0,
    }
);

impl Speeds {
    /// The speed of beads, mm/s.
    pub fn of(&self, role: Role) -> f64 {
        match role {
            Role::OuterWall => self.outer_wall,
            Role::InnerWall => self.inner_wall,
            Role::SlightOverhang => self.outer_wall * self.overhang[0],
            Role::HalfOverhang => self.outer_wall * self.overhang[1],
            Role::FullOverhang => self.outer_wall * self.overhang[2],
            Role::Infill | Role::PurgeInfill => self.infill,
            Role::SolidInfill => self.solid_infill,
            Role::TopSkin => self.top_skin,
            Role::BottomSkin => self.bottom_skin,
            Role::Bridge => self.bridge,
            Role::GapFill => self.gap_fill,
            Role::Skirt => self.skirt,
            Role::Support => self.support,
            Role::PurgeTower => self.purge_tower,
        }
    }
}

part!(
    /// How a machine speeds up and takes corners; only the time estimate goes by it.
    MotionLimits {
        /// Acceleration while extruding, mm/s².
        acceleration: f64 = 1000.0,
        /// Acceleration of travels, mm/s².
        travel_acceleration: f64 = 1500.0,
        /// Acceleration of the filament alone, mm/s².
        retract_acceleration: f64 = 3000.0,
        /// How far a corner may be cut, mm: the speed through it follows.
        junction_deviation: f64 = 0.02,
        /// Greatest speed of x, y, z and the filament, mm/s.
        max_speed: [f64; 4] = [500.0, 500.0, 12.0, 120.0],
        /// Greatest acceleration of x, y, z and the filament, mm/s².
        max_acceleration: [f64; 4] = [3000.0, 3000.0, 100.0, 10_000.0],
    }
);

part!(
    /// Pulling back the filament for travels.
    Retraction {
        /// Filament pulled back, mm; 0 for never.
        length: f64 = 1.0,
        /// Its speed, mm/s.
        speed: f64 = 35.0,
        /// Travels shorter than this do without, mm.
        min_travel: f64 = 2.0,
        /// How far the nozzle is lifted for the travel, mm.
        z_hop: f64 = 0.0,
    }
);

part!(
    /// The part's cooling: shares of full speed, 0..=1.
    Fan {
        /// From `from_layer` on.
        speed: f64 = 1.0,
        /// Over bridges.
        bridge: f64 = 1.0,
        /// On walls that hang over.
        overhang: f64 = 1.0,
        /// The first layer with the fan on, from 0.
        from_layer: u32 = 1,
    }
);

impl Fan {
    /// The share for a role's beads, from `from_layer` on.
    pub fn of(&self, role: Role) -> f64 {
        match role {
            Role::Bridge => self.bridge,
            role if role.overhang() > 0 => self.overhang,
            _ => self.speed,
        }
    }
}

part!(
    /// Changing heads.
    ToolChanging {
        /// Filament pulled back before a head is parked, mm.
        retraction: f64 = 10.0,
        /// Filament pushed on top of that at a head's first use, mm.
        prime: f64 = 0.0,
        /// Lift before a change, mm.
        z_hop: f64 = 1.0,
        /// Time of one change, s, for the time estimate.
        seconds: f64 = 10.0,
    }
);

part!(
    /// G-code around the print. `{variables}` are listed in the crate's documentation, `{{` is a
    /// brace.
    Templates {
        /// Before the first layer: homing, heating, a purge line.
        start: String = DEFAULT_START.into(),
        /// After the last layer: heaters off, head away.
        end: String = DEFAULT_END.into(),
        /// Time of the start, heating up included, s, for the time estimate.
        start_seconds: f64 = 0.0,
    }
);

const DEFAULT_START: &str = "\
M140 S{bed_temperature}
M104 S{nozzle_temperature}
G28
M190 S{bed_temperature}
M109 S{nozzle_temperature}
G92 E0
";

const DEFAULT_END: &str = "\
M104 S0
M140 S0
M107
G1 Z{park_z} F600
G28 X
M84
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_volume_goes_before_a_length() {
        let mut lead = LeadOptions::default();
        assert_eq!(lead.volume(), None);
        lead.length = Some(960.0);
        assert!((lead.volume().unwrap() - 68.559).abs() < 1e-3);
        lead.volume = Some(5.0);
        assert_eq!(lead.volume(), Some(5.0));
    }

    #[test]
    fn a_transition_is_two_volumes_or_two_lengths() {
        let mut transition = TransitionOptions::default();
        assert_eq!((transition.volumes(), transition.middle()), (None, None));
        transition.change = Some(4.0);
        assert_eq!((transition.volumes(), transition.middle()), (Some((0.0, 4.0)), Some(2.0)));
        // L1 = 9 mm, L2 = 18 mm of a bead of 2 x 0.8 mm.
        let measured = TransitionOptions {
            delay_length: Some(9.0),
            change_length: Some(18.0),
            layer_height: 0.8,
            bead_width: 2.0,
            ..TransitionOptions::default()
        };
        let (delay, change) = measured.volumes().unwrap();
        assert!((delay - 13.164).abs() < 1e-3 && (change - 2.0 * delay).abs() < 1e-9);
    }

    #[test]
    fn temperatures_are_whole_steps() {
        let foaming = Foaming { low: 190.0, high: 225.0, step: 1.0, ..Foaming::default() };
        for (share, celsius) in [(0.0, 190.0), (0.51, 208.0), (1.0, 225.0), (2.0, 225.0)] {
            assert_eq!(foaming.temperature(share), celsius);
        }
    }
}
