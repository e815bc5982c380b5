//! Every setting of a slice, with its default, unit and meaning in one table.
//!
//! The [`settings!`] table below is the only place a setting is written: the structs, their
//! defaults, and the list that `fgm settings` prints all come from it. What belongs to a machine
//! (speeds, retraction, temperatures) is in its profile, not here.

use serde::{Deserialize, Serialize};

use crate::choice::{Aim, ColorCount, SectionBy, Strategy, Zipper};
use crate::density::Density;
use crate::purge::{PurgeInto, PurgeLayout};
use fgm_contour::ContourOptions;
use fgm_core::Point2;
use fgm_toolpath::{
    BrimOptions, FaceFill, Monotonic, OrderOptions, Pattern, RoleOrder, Seam, SkirtOptions,
    WayOptions,
};

/// One line of the list of settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SettingInfo {
    /// The section of the settings file.
    pub section: &'static str,
    /// The key in its section.
    pub key: &'static str,
    /// The unit, or the kind of value.
    pub unit: &'static str,
    /// The default, as the settings file would say it, or where it comes from.
    pub default: &'static str,
    /// What it does.
    pub help: &'static str,
}

macro_rules! settings {
    ($(
        #[doc = $section_doc:literal]
        $section:ident: $Section:ident {
            $( #[doc = $doc:literal] $key:ident: $type:ty = $default:expr, $shown:literal, $unit:literal; )*
        }
    )*) => {
        /// All settings of a slice. Every key may be left out of a file; unknown keys are errors.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct Settings {
            $( #[doc = $section_doc] pub $section: $Section, )*
            /// Changes to the printer's profile, laid over it.
            #[serde(skip_serializing_if = "toml::Table::is_empty")]
            pub machine: toml::Table,
        }

        $(
            #[doc = $section_doc]
            #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
            #[serde(default, deny_unknown_fields)]
            pub struct $Section {
                $( #[doc = $doc] pub $key: $type, )*
            }

            impl Default for $Section {
                fn default() -> Self {
                    Self { $( $key: $default, )* }
                }
            }
        )*

        /// The settings in the order of the file, for listing.
        pub const SETTINGS: &[SettingInfo] = &[$($(
            SettingInfo {
                section: stringify!($section),
                key: stringify!($key),
                unit: $unit,
                default: $shown,
                help: $doc,
            },
        )*)*];
    };
}

settings! {
    #[doc = "How the part becomes paths."]
    slice: SliceSettings {
        #[doc = "Ordinary toolpaths sectioned by colour, or faces filled against the gradient."]
        strategy: Strategy = Strategy::Sectioned, "\"sectioned\"", "sectioned | against";
        #[doc = "First layer to print, counted from 1."]
        first_layer: usize = 1, "1", "layer";
        #[doc = "Last layer to print; the top one where left out."]
        last_layer: Option<usize> = None, "the top", "layer";
    }
    #[doc = "Layers and beads."]
    layer: LayerSettings {
        #[doc = "Thickness of a layer."]
        height: f64 = 0.2, "0.2", "mm";
        #[doc = "Thickness of the first layer; as the others where left out."]
        first_height: Option<f64> = None, "layer.height", "mm";
        #[doc = "Width of a bead."]
        bead_width: f64 = 0.4, "0.4", "mm";
        #[doc = "How far the first layer's outline is drawn in, as the bed squeezes its beads outwards; what would get narrower than a bead stays."]
        elephant_foot: f64 = 0.0, "0", "mm";
    }
    #[doc = "How the surface and the gradient are traced."]
    contour: ContourSettings {
        #[doc = "Side of the finest cell that a field is sampled in: features below two cells may be lost."]
        cell: f64 = 0.5, "0.5", "mm";
        #[doc = "How far a simplified contour may lie from the true one."]
        tolerance: f64 = 0.01, "0.01", "mm";
        #[doc = "How far a printed path may lie from the exact one."]
        resolution: f64 = 0.01, "0.01", "mm";
        #[doc = "How far a vertex may lie from the true contour before simplification."]
        root: f64 = 1e-6, "1e-6", "mm";
    }
    #[doc = "The colours that the gradient is printed in."]
    palette: PaletteSettings {
        #[doc = "How many colours; auto takes the most that keeps pieces printable."]
        colors: Option<ColorCount> = None, "16, or the heads of a tool changer", "count | \"auto\"";
        #[doc = "Overlap of neighbouring colours, in which their paths alternate: a share of the gradient, or a length along it, measured where it is, up to the width of a band."]
        zipper: Zipper = Zipper::NONE, "0", "share of the gradient | \"15mm\"";
        #[doc = "Share of pieces that may be shorter than short_piece when colors is auto."]
        auto_short_share: f64 = 0.1, "0.1", "share";
        #[doc = "Length below which a piece prints badly."]
        short_piece: f64 = 5.0, "5", "mm";
    }
    #[doc = "Cutting of paths by colour, strategy sectioned."]
    section: SectionSettings {
        #[doc = "What paths are cut by: the field itself, or the faces its traced boundaries make."]
        by: SectionBy = SectionBy::Field, "\"field\"", "field | faces";
        #[doc = "Shorter pieces are shared out between their neighbours on the path, where no place is then off by more than a band; 0 for none."]
        shortest: f64 = 3.0, "3", "mm";
        #[doc = "Steepest boundary between colours at which the lines of a filling turn round instead of travelling, by the angle between them and its normal; at more, turns leave gaps."]
        turns: f64 = 60.0, "60", "degrees";
    }
    #[doc = "Walls, strategy sectioned."]
    walls: WallSettings {
        #[doc = "How many walls."]
        count: usize = 3, "3", "count";
        #[doc = "Share of a bead's width over air from which a wall hangs over, and is printed slower (the printer's speed.overhang, fan.overhang), with strategy against every bead; 0 for never."]
        overhang: f64 = 0.25, "0.25", "share";
    }
    #[doc = "Solid layers below and above, strategy sectioned."]
    skins: SkinSettings {
        #[doc = "Solid layers under a top."]
        top: usize = 4, "4", "layers";
        #[doc = "Solid layers over a bottom."]
        bottom: usize = 4, "4", "layers";
        #[doc = "Which are laid line beside line in one direction of advance, within each colour, so that they shine alike; at the cost of some travel."]
        monotonic: Monotonic = Monotonic::Off, "\"off\"", "off | top | all";
    }
    #[doc = "What lies over air between places that hold it, strategy sectioned; its speed and fan are the printer's speed.bridge and fan.bridge."]
    bridges: BridgeSettings {
        #[doc = "Whether to look for bridges: they are solid, and their lines go the shortest way across."]
        enabled: bool = true, "true", "true | false";
        #[doc = "Factor on the volume of their beads."]
        flow: f64 = 1.0, "1", "factor";
        #[doc = "How far their lines reach on to what holds them."]
        anchor: f64 = 1.0, "1", "mm";
    }
    #[doc = "Filling between the walls, strategy sectioned."]
    infill: InfillSettings {
        #[doc = "How much of the inside is filled: a number; a formula of x, y, z and the distance d in the design's coordinates, such as \"10 + 40 z/50\", for straight patterns; or the design's own density, which is 15 where it has none. Skins stay solid."]
        density: Density = Density::Design, "\"design\"", "percent | \"formula\" | \"design\"";
        #[doc = "How the lines run."]
        pattern: Pattern = Pattern::Rectilinear, "\"rectilinear\"", "rectilinear | aligned | grid | triangles | honeycomb | concentric | gyroid | lightning";
        #[doc = "Direction of the lines; rectilinear lines and skins are turned by a right angle on every other layer."]
        angle: f64 = 45.0, "45", "degrees";
        #[doc = "Directions of the lines, layer by layer and then from the first again, in place of angle and its turn."]
        angles: Vec<f64> = Vec::new(), "[]", "[degrees, ...]";
        #[doc = "How far below a roof lightning infill still gets thinner; what its branches hold up within this height, they hold up alone."]
        reach: f64 = 20.0, "20", "mm";
    }
    #[doc = "Filling of faces, strategy against."]
    against: AgainstSettings {
        #[doc = "How the lines run in a face."]
        fill: FaceFill = FaceFill::Concentric, "\"concentric\"", "concentric | rectilinear";
        #[doc = "Narrowest bead, where the middle of a face needs one."]
        min_width: Option<f64> = None, "0.6 bead widths", "mm";
        #[doc = "Widest bead, where the middle of a face needs one."]
        max_width: Option<f64> = None, "1.6 bead widths", "mm";
    }
    #[doc = "The order of printing inside a colour, strategy sectioned."]
    order: OrderSettings {
        #[doc = "Which walls come first; any takes what is nearest."]
        walls: RoleOrder = RoleOrder::Any, "\"any\"", "any | outer-first | inner-first";
        #[doc = "Where loops of the outer wall, or with strategy against all loops, that are of one colour start; walls of several colours start at a boundary. Aligned is the vertex nearest to seam_point on every layer, hidden the sharpest corner that goes into the part."]
        seam: Seam = Seam::Nearest, "\"nearest\"", "nearest | rear | aligned | random | sharpest | hidden";
        #[doc = "The point of the aligned seam, x and y in the design's coordinates."]
        seam_point: Option<[f64; 2]> = None, "the design's corner of greatest x and y", "[mm, mm]";
        #[doc = "How many changes of the order are tried to shorten the travels, for each piece."]
        effort: u32 = 32, "32", "count";
    }
    #[doc = "The ways between beads."]
    travel: TravelSettings {
        #[doc = "Whether travels that would cross the outer wall go round inside the part, where there is a way."]
        avoid_crossing: bool = true, "true", "true | false";
        #[doc = "What a way round may be longer than the straight one."]
        max_detour: f64 = 30.0, "30", "mm";
    }
    #[doc = "Where the old colour goes, strategy sectioned."]
    purge: PurgeSettings {
        #[doc = "Whether to purge."]
        enabled: Option<bool> = None, "on for mixing and foaming", "true | false";
        #[doc = "Least volume of a purge; where left out and the printer has a transition, what each change needs to come within the tolerance, else the dead volume."]
        volume: Option<f64> = None, "by the transition, or the dead volume", "mm3";
        #[doc = "How far the mixture may be from its goal where a purge by the transition ends."]
        tolerance: f64 = 0.01, "0.01", "share";
        #[doc = "No purge where the step of the mixture times the dead volume, what comes out wrong, is at or below this; no tower where that is so at every change."]
        threshold: f64 = 0.0, "0", "mm3";
        #[doc = "One tower that all colours share, or a spot for each."]
        layout: Option<PurgeLayout> = None, "\"one\", or \"spots\" where that has no room", "one | spots";
        #[doc = "What takes the old colour: the towers, or first the infill behind the walls, which then has the wrong mixture there."]
        into: PurgeInto = PurgeInto::Tower, "\"tower\"", "tower | infill";
        #[doc = "Room between the part and the towers."]
        clearance: f64 = 5.0, "5", "mm";
    }
    #[doc = "Look-ahead: how far commands go out before their boundary."]
    lead: LeadSettings {
        #[doc = "Volume between the mixing and the nozzle's tip."]
        volume: Option<f64> = None, "the printer's", "mm3";
    }
    #[doc = "Commands chosen so that the deposit fits, for mixing printers with a transition."]
    compensation: CompensationSettings {
        #[doc = "Whether to choose them; else the look-ahead alone moves them."]
        enabled: Option<bool> = None, "on where the printer has a transition", "true | false";
        #[doc = "What the deposit is to come near to: the design along every bead, or the palette's colours of the paths."]
        aim: Option<Aim> = None, "\"design\"; \"colors\" with a zipper", "design | colors";
        #[doc = "How far the transition's delay and length may be off without the deposit being worse than with the look-ahead alone."]
        uncertainty: f64 = 0.2, "0.2", "share";
        #[doc = "Least volume that a command lasts."]
        shortest: f64 = 0.2, "0.2", "mm3";
    }
    #[doc = "Time for layers to cool."]
    cooling: CoolingSettings {
        #[doc = "Least time of a layer: a shorter one has its beads slowed, the walls that are seen last, travels not. 0 for never."]
        min_layer_time: f64 = 5.0, "5", "s";
        #[doc = "No bead is slowed below this."]
        min_speed: f64 = 10.0, "10", "mm/s";
    }
    #[doc = "Loops around the part on the first layer."]
    skirt: SkirtSettings {
        #[doc = "How many loops."]
        loops: usize = 0, "0", "count";
        #[doc = "Room between the part, or its brim, and the loops."]
        gap: f64 = 5.0, "5", "mm";
    }
    #[doc = "Loops that hold the part to the bed on the first layer; islands near each other share them, holes have none."]
    brim: BrimSettings {
        #[doc = "How far it reaches out from the outline."]
        width: f64 = 0.0, "0", "mm";
        #[doc = "Room between the part and the brim; at 0 its first bead is the outer wall's neighbour."]
        gap: f64 = 0.0, "0", "mm";
    }
}

impl Settings {
    /// Thickness of the first layer, mm.
    pub fn first_height(&self) -> f64 {
        self.layer.first_height.unwrap_or(self.layer.height)
    }

    /// What the deposit is to come near to: a zipper's colours interlock where the design has one
    /// mixture, so they are kept.
    pub(crate) fn aim(&self) -> Aim {
        let zipper =
            self.slice.strategy == Strategy::Sectioned && self.palette.zipper != Zipper::NONE;
        let usual = if zipper { Aim::Colors } else { Aim::Design };
        self.compensation.aim.unwrap_or(usual)
    }

    /// How the part's outlines are traced.
    pub(crate) fn outline_options(&self) -> ContourOptions {
        ContourOptions { sharp: true, ..self.isoline_options() }
    }

    /// How the palette's boundaries are traced. The material need not be a number outside the
    /// part.
    pub(crate) fn isoline_options(&self) -> ContourOptions {
        ContourOptions {
            cell: self.contour.cell,
            root_tolerance: self.contour.root,
            simplify: self.contour.tolerance,
            sharp: false,
            skip_nan: true,
            ..ContourOptions::default()
        }
    }

    /// The narrowest and widest bead of fills against the gradient, mm.
    pub(crate) fn bead_widths(&self) -> (f64, f64) {
        let width = self.layer.bead_width;
        let AgainstSettings { min_width, max_width, .. } = self.against;
        (min_width.unwrap_or(0.6 * width), max_width.unwrap_or(1.6 * width))
    }

    /// How far an offset may move a border by dropping vertices first, mm: half of what a path may
    /// be off, so that the other half is left for the path itself.
    pub(crate) fn inset_simplification(&self) -> f64 {
        (0.5 * self.contour.resolution).clamp(1e-4, 0.1)
    }

    /// How the pieces of a layer, from 0, are put in order. `corner` is the design's of greatest x
    /// and y.
    pub(crate) fn order_options(&self, layer: usize, corner: Point2) -> OrderOptions {
        OrderOptions {
            roles: self.order.walls,
            seam: self.order.seam,
            seam_point: self.order.seam_point.map_or(corner, Point2::from),
            layer: layer as u32,
            improve: self.order.effort,
            monotonic: match self.infill.pattern {
                // Loops have no direction of advance.
                Pattern::Concentric if self.infill.density == Density::Percent(100.0) => {
                    Monotonic::Off
                }
                _ => self.skins.monotonic,
            },
            direction: 0.0,
        }
    }

    /// The direction of lines on a layer, from 0, in radians, and the number by which patterns turn
    /// them.
    pub(crate) fn infill_direction(&self, layer: usize) -> (f64, usize) {
        let InfillSettings { angle, angles, .. } = &self.infill;
        match angles.len() {
            0 => (angle.to_radians(), layer),
            count => (angles[layer % count].to_radians(), 0),
        }
    }

    /// How travels keep off the outer wall; none where they need not.
    pub(crate) fn way_options(&self) -> Option<WayOptions> {
        let TravelSettings { avoid_crossing, max_detour } = self.travel;
        avoid_crossing.then_some(WayOptions { width: self.layer.bead_width, max_detour })
    }

    /// The brim on a first layer.
    pub(crate) fn brim_options(&self) -> BrimOptions {
        let BrimSettings { width, gap } = self.brim;
        BrimOptions { width, gap, bead_width: self.layer.bead_width, height: self.first_height() }
    }

    /// The loops around the part and its brim.
    pub(crate) fn skirt_options(&self) -> SkirtOptions {
        SkirtOptions {
            loops: u32::try_from(self.skirt.loops).unwrap_or(u32::MAX),
            distance: self.brim_options().reach() + self.skirt.gap,
            width: self.layer.bead_width,
        }
    }

    /// How far brim and skirt reach beyond the part, mm.
    pub(crate) fn reach(&self) -> f64 {
        match self.skirt.loops {
            0 => self.brim_options().reach(),
            loops => self.skirt_options().distance + loops as f64 * self.layer.bead_width,
        }
    }

    /// Checks what types cannot: that lengths are positive, shares are shares.
    ///
    /// # Errors
    /// The first setting out of its range, with the range.
    pub fn check(&self) -> Result<(), SettingError> {
        let within = |key, value: f64, range: std::ops::RangeInclusive<f64>, wanted| {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shown_defaults_are_the_defaults() {
        let defaults = toml::Table::try_from(Settings::default()).unwrap();
        for info in SETTINGS {
            match defaults[info.section].get(info.key) {
                Some(value) => {
                    let shown: toml::Table = format!("v = {}", info.default).parse().unwrap();
                    let same = shown["v"] == *value
                        || shown["v"].as_integer().map(|i| i as f64) == value.as_float();
                    assert!(
                        same,
                        "{}.{}: {} shown, {value} true",
                        info.section, info.key, info.default
                    );
                }
                None => assert!(!info.default.is_empty(), "{}.{}", info.section, info.key),
            }
        }
    }

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
