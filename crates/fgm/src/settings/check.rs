//! What settings may be.

use std::ops::RangeInclusive;

use super::Settings;

/// A setting out of its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key} is {value}, where {wanted} is possible")]
pub struct SettingError {
    /// `section.key`.
    pub key: &'static str,
    /// What it is.
    pub value: f64,
    /// The range.
    pub wanted: &'static str,
}
impl Settings {
    /// Checks what types cannot: that lengths are positive, shares are shares.
    ///
    /// # Errors
    /// The first setting out of its range, with the range.
    pub fn check(&self) -> Result<(), SettingError> {
        let within = |key, value: f64, range: RangeInclusive<f64>, wanted| {
            if range.contains(&value) { Ok(()) } else { Err(SettingError { key, value, wanted }) }
        };
        let length = |key, value| within(key, value, 0.001..=100.0, "0.001 to 100 mm");
        length("layer.height", self.layer.height)?;
        length("layer.first_height", self.first_height())?;
        length("layer.bead_width", self.layer.bead_width)?;
        // A bead is a capsule, wider than high.
        let width = self.layer.bead_width;
        within("layer.height", self.layer.height, 0.0..=width, "at most layer.bead_width")?;
        within("layer.first_height", self.first_height(), 0.0..=width, "at most layer.bead_width")?;
        within("contour.cell", self.contour.cell, 0.01..=100.0, "0.01 to 100 mm")?;
        within("contour.tolerance", self.contour.tolerance, 0.0..=10.0, "0 to 10 mm")?;
        let wall = self.section.shortest_wall;
        within("section.shortest_wall", wall, 0.0..=1000.0, "0 to 1000 mm")?;
        within("section.shortest", self.section.shortest, 0.0..=1000.0, "0 to 1000 mm")?;
        within("section.turns", self.section.turns, 0.0..=90.0, "0 to 90 degrees")?;
        within("contour.resolution", self.contour.resolution, 0.0..=10.0, "0 to 10 mm")?;
        within("contour.root", self.contour.root, 1e-9..=1.0, "1e-9 to 1 mm")?;
        let density = self.infill.density.percent().unwrap_or(0.0);
        within("infill.density", density, 0.0..=100.0, "0 to 100 percent")?;
        within("infill.angle", self.infill.angle, -3600.0..=3600.0, "an angle in degrees")?;
        for angle in &self.infill.angles {
            within("infill.angles", *angle, -3600.0..=3600.0, "an angle in degrees")?;
        }
        within("infill.reach", self.infill.reach, 0.0..=200.0, "0 to 200 mm")?;
        within("order.change", self.order.change, 0.0..=1e6, "0 to 1000000 mm")?;
        let effort = f64::from(self.order.effort);
        within("order.effort", effort, 0.0..=1e6, "0 to 1000000")?;
        for x in self.order.seam_point.into_iter().flatten() {
            within("order.seam_point", x, -1e6..=1e6, "-1000000 to 1000000 mm")?;
        }
        within("palette.auto_short_share", self.palette.auto_short_share, 0.0..=1.0, "0 to 1")?;
        within("palette.short_piece", self.palette.short_piece, 0.0..=1e6, "0 or more")?;
        let (least, most) = self.bead_widths();
        within("against.min_width", least, f64::MIN_POSITIVE..=f64::MAX, "above 0 mm")?;
        within("against.max_width", most, least..=f64::MAX, "at least against.min_width")?;
        within("purge.volume", self.purge.volume.unwrap_or(0.0), 0.0..=1e5, "0 to 100000 mm3")?;
        within("purge.threshold", self.purge.threshold, 0.0..=1e6, "0 to 1000000 mm3")?;
        within("purge.tolerance", self.purge.tolerance, 0.0..=1.0, "0 to 1")?;
        within("purge.clearance", self.purge.clearance, 0.0..=1e3, "0 to 1000 mm")?;
        within("lead.volume", self.lead.volume.unwrap_or(0.0), 0.0..=1e6, "0 to 1000000 mm3")?;
        let compensation = &self.compensation;
        let off = compensation.uncertainty;
        within("compensation.uncertainty", off, 0.0..=0.9, "0 to 0.9")?;
        within("compensation.shortest", compensation.shortest, 1e-3..=1e5, "0.001 to 100000 mm3")?;
        let cooling = &self.cooling;
        within("cooling.min_layer_time", cooling.min_layer_time, 0.0..=3600.0, "0 to 3600 s")?;
        within("cooling.min_speed", cooling.min_speed, 0.1..=1e4, "0.1 to 10000 mm/s")?;
        within("travel.max_detour", self.travel.max_detour, 0.0..=1e6, "0 to 1000000 mm")?;
        within("walls.overhang", self.walls.overhang, 0.0..=0.5, "0 to 0.5")?;
        within("bridges.flow", self.bridges.flow, 0.1..=3.0, "0.1 to 3")?;
        within("bridges.anchor", self.bridges.anchor, 0.0..=100.0, "0 to 100 mm")?;
        let foot = self.layer.elephant_foot;
        within("layer.elephant_foot", foot, 0.0..=5.0, "0 to 5 mm")?;
        within("brim.width", self.brim.width, 0.0..=100.0, "0 to 100 mm")?;
        within("brim.gap", self.brim.gap, 0.0..=100.0, "0 to 100 mm")?;
        within("skirt.gap", self.skirt.gap, 0.0..=1e3, "0 to 1000 mm")?;
        let count = |key, value: usize, most: usize, wanted| {
            within(key, value as f64, 0.0..=most as f64, wanted)
        };
        count("walls.count", self.walls.count, 10_000, "0 to 10000")?;
        count("skins.top", self.skins.top, 10_000, "0 to 10000 layers")?;
        count("skins.bottom", self.skins.bottom, 10_000, "0 to 10000 layers")?;
        count("skirt.loops", self.skirt.loops, 100, "0 to 100")?;
        let first = self.slice.first_layer as f64;
        within("slice.first_layer", first, 1.0..=1e9, "1 or more")?;
        let last = self.slice.last_layer.map_or(1e9, |l| l as f64);
        within("slice.last_layer", last, first..=1e9, "at least slice.first_layer")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_is_named() {
        let mut settings = Settings::default();
        assert_eq!(settings.check(), Ok(()));
        settings.layer.height = f64::NAN;
        assert_eq!(settings.check().unwrap_err().key, "layer.height");
        settings.layer.height = 0.2;
        settings.infill.density = 101.0.into();
        assert_eq!(
            settings.check().unwrap_err().to_string(),
            "infill.density is 101, where 0 to 100 percent is possible"
        );
    }
}
