use std::{fmt::Write as _, io};

use fgm_core::ColorId;

use super::{Writer, change::Heads};
use crate::{Fixed, GcodeError, State, Text, dialect::Change, lines, template};

impl<W: io::Write> Writer<W> {
    /// Head comments, heating, the start template, modes.
    pub(super) fn head(&mut self, color: ColorId) -> Result<(), GcodeError> {
        let state = self.state(color)?;
        self.comments()?;
        self.mark_progress(0.0);
        let mut setting = Text::new();
        let change = Change {
            color,
            state: &state,
            previous: None,
            temperature: self.temperature_of(&state),
            standby: None,
        };
        self.set_state(&change, &mut setting)?;
        self.heads.begin(color, state);

        let start = std::mem::take(&mut self.machine.template.start);
        self.heat(&start, &state);
        let setting = setting.to_text();
        let rendered = template::render("start", &start, &|name| {
            if name == "initial_state" {
                return Some(setting.trim_end().to_owned());
            }
            self.variable(name, &state)
        })?;
        self.position.follow(rendered.as_bytes())?;
        self.time.dwell(self.machine.template.start_seconds);
        relative_extrusion(&rendered, &mut self.text);
        self.dialect.begin(&mut self.text);
        if !template::uses(&start, &["initial_state"]) {
            self.text.raw(&setting);
            if self.is_tool_changer() {
                self.position.lose();
            }
        }
        if self.machine.fan.from_layer > 0 {
            self.dialect.fan(0.0, &mut self.text);
        }
        self.set_flow(&state)
    }

    /// What the caller says, and what maps positions back to the design.
    fn comments(&mut self) -> Result<(), GcodeError> {
        for comment in self.options.comments.iter().flat_map(|c| c.lines()) {
            // A stray line end would turn a comment into commands.
            let safe: String =
                comment.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            self.dialect.comment(&format!(" {safe}"), &mut self.text);
        }
        let mut line = String::from(" design_offset =");
        for value in self.options.offset.to_array() {
            let mut digits = Vec::new();
            Fixed::<6>::round(value)?.write_trimmed(&mut digits);
            let _ = write!(line, " {}", String::from_utf8_lossy(&digits));
        }
        self.dialect.comment(&line, &mut self.text);
        Ok(())
    }

    /// Heats up where the start template does not.
    fn heat(&mut self, start: &str, state: &State) {
        let bed = self.options.temperatures.first_layer_bed;
        let nozzle = !template::uses(start, &["nozzle_temperature"]);
        let bed_left = bed > 0.0 && !template::uses(start, &["bed_temperature"]);
        let celsius = self.temperature_of(state);
        for wait in [false, true] {
            if bed_left {
                self.dialect.bed_temperature(bed, wait, &mut self.text);
            }
            if nozzle {
                self.dialect.temperature(state.tool, celsius, wait, &mut self.text);
            }
        }
    }

    /// A template variable's value.
    fn variable(&self, name: &str, state: &State) -> Option<String> {
        let number = |value: f64| {
            let mut digits = Vec::new();
            Fixed::<3>::round(value).ok()?.write_trimmed(&mut digits);
            String::from_utf8(digits).ok()
        };
        let degrees = |celsius: f64| number(celsius.round());
        let (temperatures, bed) = (&self.options.temperatures, self.position.bed());
        match name {
            "printer" => Some(self.machine.name.clone()),
            "nozzle_temperature" => degrees(self.temperature_of(state)),
            "bed_temperature" => degrees(temperatures.first_layer_bed),
            "standby_temperature" => degrees(temperatures.standby.unwrap_or(temperatures.nozzle)),
            "initial_tool" => number(f64::from(Heads::tool(state))),
            "nozzle" => number(self.machine.nozzle),
            "bed_min_x" => number(bed.min.x),
            "bed_min_y" => number(bed.min.y),
            "bed_max_x" => number(bed.max.x),
            "bed_max_y" => number(bed.max.y),
            "max_z" => number(self.position.max_z.value()),
            "park_z" => number(self.position.clamp_z(self.position.max_z.value() + 10.0)),
            _ => None,
        }
    }

    /// The end template, and what viewers and hosts read at the end of a file.
    pub(super) fn tail(&mut self) -> Result<(), GcodeError> {
        self.retract(self.options.retraction.length)?;
        self.summary.print_time_s = self.time.seconds();
        self.mark_progress(self.summary.print_time_s);
        self.dialect.end(&mut self.text);
        if !self.machine.auger.stop.is_empty() {
            self.text.line(&self.machine.auger.stop);
        }
        let state = self.heads.state;
        let end = std::mem::take(&mut self.machine.template.end);
        let rendered = template::render("end", &end, &|name| match name {
            "initial_state" => Some(String::new()),
            _ => self.variable(name, &state),
        })?;
        relative_extrusion(&rendered, &mut self.text);

        let mut line = String::from(" filament used [mm] =");
        let area = self.machine.filament_area();
        for (i, volume) in self.summary.filament_mm3.iter().enumerate() {
            let length = Fixed::<2>::round(volume / area)?;
            let _ = write!(line, "{} {length}", if i > 0 { "," } else { "" });
        }
        self.dialect.comment(&line, &mut self.text);
        let mut line = String::from(" extruder_colour = ");
        for (i, [r, g, b]) in self.options.colors.iter().enumerate() {
            let _ = write!(line, "{}#{r:02x}{g:02x}{b:02x}", if i > 0 { ";" } else { "" });
        }
        if !self.options.colors.is_empty() {
            self.dialect.comment(&line, &mut self.text);
        }
        Ok(())
    }
}

/// Appends a template's lines, with relative extrusion stated again after every `G90`.
fn relative_extrusion(template: &str, out: &mut Text) {
    let mut parsed = lines(template.as_bytes()).peekable();
    for line in template.lines() {
        out.line(line);
        let absolute = parsed.next().and_then(|l| l.command).is_some_and(|c| c.is(b'G', 90));
        let stated = parsed.peek().and_then(|l| l.command).is_some_and(|c| c.is(b'M', 83));
        if absolute && !stated {
            out.line("M83");
        }
    }
}
