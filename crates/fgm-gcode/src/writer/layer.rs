use std::io;

use super::Writer;
use crate::{Fixed, GcodeError, Pace};

impl<W: io::Write> Writer<W> {
    /// A new layer: tags, and what changes after the first one.
    pub(super) fn layer(&mut self, index: u32, z: f64, height: f64) -> Result<(), GcodeError> {
        if !(height > 0.0 && height.is_finite()) {
            return Err(GcodeError::Setting {
                name: "layer height".into(),
                value: height,
                expected: "a number above 0",
            });
        }
        let top = self.position.place_z(z)?;
        (self.position.layer_z, self.position.bead_z) = (top, top);
        self.position.climb.layer(z);
        self.position.max_z = self.position.max_z.max(top);
        self.bead.layer(height);
        self.pace = match self.paces.front() {
            Some((layer, _)) if *layer == index => self.paces.pop_front().map(|paced| paced.1),
            _ => None,
        }
        .unwrap_or(Pace::USUAL);
        self.summary.layers += 1;

        self.dialect.comment("LAYER_CHANGE", &mut self.text);
        for (tag, value) in [("Z", top), ("HEIGHT", Fixed::round(height)?)] {
            let mut digits = Vec::new();
            value.write_trimmed(&mut digits);
            let text = format!("{tag}:{}", String::from_utf8_lossy(&digits));
            self.dialect.comment(&text, &mut self.text);
        }
        let begun = self.summary.layers - 1;
        if begun == 1 {
            self.after_first_layer()?;
        }
        if begun == u64::from(self.options.fan.from_layer) {
            self.bead.told_fan = self.options.fan.speed;
            self.dialect.fan(self.options.fan.speed, &mut self.text);
        }
        Ok(())
    }

    /// The beads of the layer rise from a height.
    pub(super) fn rise(&mut self, from: f64, length: f64) -> Result<(), GcodeError> {
        self.position.bead_z = self.position.place_z(from)?;
        self.position.climb.rise(from, length);
        Ok(())
    }

    /// Other temperatures than the first layer's.
    fn after_first_layer(&mut self) -> Result<(), GcodeError> {
        let t = &self.options.temperatures;
        let state = self.heads.state;
        if state.temperature.is_none() && t.nozzle != t.first_layer {
            self.dialect.temperature(state.tool, t.nozzle, false, &mut self.text);
        }
        if t.bed != t.first_layer_bed {
            self.dialect.bed_temperature(t.bed, false, &mut self.text);
        }
        Ok(())
    }
}
