use fgm_core::MAX_MATERIALS;

use crate::{DialectName, GcodeError, Machine, MachineKind, template};

/// A range a setting must lie in, and its words.
struct Range(f64, f64, &'static str);

const POSITIVE: Range = Range(1e-6, 1e6, "a number above 0");
const NOT_NEGATIVE: Range = Range(0.0, 1e6, "0 or more");
const SHARE: Range = Range(0.0, 1.0, "0 to 1");
const OVERHANG: Range = Range(0.01, 1.0, "shares of the outer wall's speed, 0.01 to 1");
const CELSIUS: Range = Range(0.0, 1000.0, "0 to 1000 °C");
const ANY: Range = Range(-1e6, 1e6, "a number of at most 1,000,000");

impl Machine {
    /// Whether every number is in its range, and the templates have no unknown variable.
    ///
    /// # Errors
    /// [`GcodeError::Setting`] with the field's path, [`GcodeError::Template`].
    pub fn validate(&self) -> Result<(), GcodeError> {
        let check = |name: &str, value: f64, range: &Range| {
            if (range.0..=range.1).contains(&value) {
                return Ok(());
            }
            Err(GcodeError::Setting { name: name.into(), value, expected: range.2 })
        };
        let option = |name: &str, value: Option<f64>, range: &Range| {
            value.map_or(Ok(()), |v| check(name, v, range))
        };
        check("inputs", self.inputs as f64, &Range(1.0, 16.0, "1 to 16"))?;
        check("nozzle", self.nozzle, &POSITIVE)?;
        check("filament_diameter", self.filament_diameter, &POSITIVE)?;
        check("filament_density", self.filament_density, &POSITIVE)?;
        check("min_fraction", self.min_fraction, &Range(0.0, 0.1, "0 to 0.1"))?;
        option("max_bead_area", self.max_bead_area, &POSITIVE)?;
        option("max_flow", self.max_flow, &POSITIVE)?;
        for &flow in &self.max_input_flow {
            check("max_input_flow", flow, &POSITIVE)?;
        }
        for axis in 0..4 {
            check("motion.max_speed", self.motion.max_speed[axis], &POSITIVE)?;
            check("motion.max_acceleration", self.motion.max_acceleration[axis], &POSITIVE)?;
        }
        for axis in 0..3 {
            check("bed.origin", self.bed.origin[axis], &ANY)?;
            check("bed.size", self.bed.size[axis], &POSITIVE)?;
        }
        for &weight in &self.dialect.leading_weights {
            check("dialect.leading_weights", weight, &NOT_NEGATIVE)?;
        }
        let tools = f64::from(self.dialect.virtual_tools);
        check("dialect.virtual_tools", tools, &Range(0.0, 16.0, "0 to 16"))?;
        let rate = Range(1e-3, 1e6, "0.001 °C/s or more");
        option("foaming.heating", self.foaming.heating, &rate)?;
        option("foaming.cooling", self.foaming.cooling, &rate)?;
        option("auger.flow", self.auger.flow, &POSITIVE)?;
        if self.auger.flow.is_none() && !self.auger.command.is_empty() {
            let expected = "the flow at one turn a second, for a command with a speed";
            return Err(GcodeError::Setting { name: "auger.flow".into(), value: 0.0, expected });
        }
        option("lead.volume", self.lead.volume, &NOT_NEGATIVE)?;
        option("lead.length", self.lead.length, &NOT_NEGATIVE)?;
        check("lead.layer_height", self.lead.layer_height, &POSITIVE)?;
        check("lead.bead_width", self.lead.bead_width, &POSITIVE)?;
        let t = &self.transition;
        option("transition.delay", t.delay, &NOT_NEGATIVE)?;
        option("transition.change", t.change, &NOT_NEGATIVE)?;
        option("transition.delay_length", t.delay_length, &NOT_NEGATIVE)?;
        option("transition.change_length", t.change_length, &NOT_NEGATIVE)?;
        check("transition.layer_height", t.layer_height, &POSITIVE)?;
        check("transition.bead_width", t.bead_width, &POSITIVE)?;
        self.settings(&check)?;
        template::check(&self.template)
    }

    /// Whether the profile's dialect can tell what the machine's kind and motors need.
    ///
    /// # Errors
    /// [`GcodeError::DialectMismatch`]; [`GcodeError::Setting`] for more motors than it has letters
    /// for.
    pub fn validate_dialect(&self) -> Result<(), GcodeError> {
        let (dialect, kind) = (self.dialect.name, self.kind);
        let (fits, expected) = match kind {
            MachineKind::Foaming => (dialect == DialectName::Foaming, "foaming does"),
            MachineKind::ToolChanger => (
                matches!(dialect, DialectName::ToolChange | DialectName::PrusaXl),
                "tool-change and prusa-xl do",
            ),
            MachineKind::Mixing => (
                !matches!(
                    dialect,
                    DialectName::Foaming | DialectName::ToolChange | DialectName::PrusaXl
                ),
                "marlin-mixing, marlin-direct, rep-rap, kalico and repetier do",
            ),
        };
        if !fits {
            return Err(GcodeError::DialectMismatch { dialect, kind, expected });
        }
        if self.dialect.virtual_tools > 0 && dialect != DialectName::MarlinMixing {
            let expected = "a table of virtual tools is for marlin-mixing";
            let value = f64::from(self.dialect.virtual_tools);
            return Err(GcodeError::Setting {
                name: "dialect.virtual_tools".into(),
                value,
                expected,
            });
        }
        let motors = self.inputs + self.dialect.leading_weights.len();
        let (most, expected) = match (kind, dialect) {
            (MachineKind::Mixing, DialectName::MarlinDirect) => (6, "at most 6 motors for M165"),
            (MachineKind::Mixing, _) => {
                (MAX_MATERIALS + self.dialect.leading_weights.len(), "at most 8 filaments to mix")
            }
            _ => (usize::MAX, ""),
        };
        if motors > most {
            return Err(GcodeError::Setting {
                name: "inputs".into(),
                value: self.inputs as f64,
                expected,
            });
        }
        Ok(())
    }

    fn settings(
        &self,
        check: &dyn Fn(&str, f64, &Range) -> Result<(), GcodeError>,
    ) -> Result<(), GcodeError> {
        let (t, f, r) = (&self.temperature, &self.foaming, &self.retraction);
        let (s, m, c) = (&self.speed, &self.motion, &self.tool_change);
        let rows = [
            ("temperature.nozzle", t.nozzle, &CELSIUS),
            ("temperature.first_layer", t.first_layer, &CELSIUS),
            ("temperature.bed", t.bed, &CELSIUS),
            ("temperature.first_layer_bed", t.first_layer_bed, &CELSIUS),
            ("temperature.standby", t.standby.unwrap_or(0.0), &CELSIUS),
            ("temperature.min_extrusion", t.min_extrusion, &CELSIUS),
            ("foaming.low", f.low, &CELSIUS),
            ("foaming.high", f.high, &CELSIUS),
            ("foaming.step", f.step, &NOT_NEGATIVE),
            ("speed.outer_wall", s.outer_wall, &POSITIVE),
            ("speed.inner_wall", s.inner_wall, &POSITIVE),
            ("speed.infill", s.infill, &POSITIVE),
            ("speed.solid_infill", s.solid_infill, &POSITIVE),
            ("speed.top_skin", s.top_skin, &POSITIVE),
            ("speed.bottom_skin", s.bottom_skin, &POSITIVE),
            ("speed.overhang", s.overhang[0], &OVERHANG),
            ("speed.overhang", s.overhang[1], &OVERHANG),
            ("speed.overhang", s.overhang[2], &OVERHANG),
            ("speed.bridge", s.bridge, &POSITIVE),
            ("speed.gap_fill", s.gap_fill, &POSITIVE),
            ("speed.skirt", s.skirt, &POSITIVE),
            ("speed.support", s.support, &POSITIVE),
            ("speed.purge_tower", s.purge_tower, &POSITIVE),
            ("speed.first_layer", s.first_layer, &POSITIVE),
            ("speed.travel", s.travel, &POSITIVE),
            ("speed.z", s.z, &POSITIVE),
            ("motion.acceleration", m.acceleration, &POSITIVE),
            ("motion.travel_acceleration", m.travel_acceleration, &POSITIVE),
            ("motion.junction_deviation", m.junction_deviation, &NOT_NEGATIVE),
            ("motion.retract_acceleration", m.retract_acceleration, &POSITIVE),
            ("retraction.length", r.length, &NOT_NEGATIVE),
            ("retraction.speed", r.speed, &POSITIVE),
            ("retraction.min_travel", r.min_travel, &NOT_NEGATIVE),
            ("retraction.z_hop", r.z_hop, &NOT_NEGATIVE),
            ("template.start_seconds", self.template.start_seconds, &NOT_NEGATIVE),
            ("fan.speed", self.fan.speed, &SHARE),
            ("fan.bridge", self.fan.bridge, &SHARE),
            ("fan.overhang", self.fan.overhang, &SHARE),
            ("tool_change.retraction", c.retraction, &NOT_NEGATIVE),
            ("tool_change.prime", c.prime, &NOT_NEGATIVE),
            ("tool_change.z_hop", c.z_hop, &NOT_NEGATIVE),
            ("tool_change.seconds", c.seconds, &NOT_NEGATIVE),
        ];
        rows.iter().try_for_each(|(name, value, range)| check(name, *value, range))?;
        if self.kind == MachineKind::Foaming {
            for celsius in [f.low, f.high] {
                let positive = Range(0.01, 10.0, "a polynomial that gives a flow of 0.01 to 10");
                check("foaming.flow", f.flow_at(celsius), &positive)?;
            }
        }
        Ok(())
    }
}
