//! Every setting of a slice, with its default, unit and meaning in one table.
//!
//! The [`settings!`] table below is the only place a setting is written: the structs, their
//! defaults, and the list that `fgm settings` prints all come from it. What belongs to a machine
//! (speeds, retraction, temperatures) is in its profile, not here.

mod check;
mod options;
mod table;

use serde::{Deserialize, Serialize};

use crate::choice::{Aim, ColorCount, SectionBy, Strategy, Zipper};
use crate::density::Density;
use crate::purge::{PurgeInto, PurgeLayout};
use fgm_toolpath::{FaceFill, Monotonic, Pattern, RoleOrder, Seam};

pub use check::SettingError;
pub use table::SettingInfo;
use table::settings;

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
    #[doc = "Cutting of paths by colour: all with strategy sectioned, those of bridges with strategy against."]
    section: SectionSettings {
        #[doc = "What paths are cut by: the field itself, or the faces its traced boundaries make."]
        by: SectionBy = SectionBy::Field, "\"field\"", "field | faces";
        #[doc = "Shorter pieces are shared out between their neighbours on the path, where no place is then off by more than a band; 0 for none."]
        shortest: f64 = 3.0, "3", "mm";
        #[doc = "The same for walls, whose pieces do not lie beside others that they have to match; not for spirals."]
        shortest_wall: f64 = 4.5, "4.5", "mm";
        #[doc = "Steepest boundary between colours along which the lines of a filling turn round, by the angle between them and its normal: the steeper, the longer the turns and the more is left bare beside them. Where it is steeper, two lines that end one after the other are both ended half-way and turn straight. At 0 no line turns at a boundary."]
        turns: f64 = 30.0, "30", "degrees";
    }
    #[doc = "Walls, strategy sectioned."]
    walls: WallSettings {
        #[doc = "How many walls."]
        count: usize = 3, "3", "count";
        #[doc = "One wall that rises evenly instead of layer by layer, without travels or a seam, on the solid bottom layers (skins.bottom): above them the outer wall of a single outline, and nothing in it. It stands for walls.count = 1, infill.density = 0 and skins.top = 0, whatever these say; no tower is purged on along the spiral."]
        spiral: bool = false, "false", "true | false";
        #[doc = "Share of a bead's width over air from which a wall hangs over, and is printed slower (the printer's speed.overhang, fan.overhang), with strategy against every bead outside bridges; 0 for never."]
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
    #[doc = "What lies over air between places that hold it; its speed and fan are the printer's speed.bridge and fan.bridge."]
    bridges: BridgeSettings {
        #[doc = "Whether to look for bridges: they are solid, and their lines go the shortest way across, with strategy against to the border of the part and only over twelve bead widths and more."]
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
    #[doc = "The order of printing."]
    order: OrderSettings {
        #[doc = "Which walls come first; any takes what is nearest."]
        walls: RoleOrder = RoleOrder::Any, "\"any\"", "any | outer-first | inner-first";
        #[doc = "Where loops of the outer wall, or with strategy against all loops, that are of one colour start; walls of several colours start at a boundary. Aligned is the vertex nearest to seam_point on every layer, hidden the sharpest corner that goes into the part."]
        seam: Seam = Seam::Nearest, "\"nearest\"", "nearest | rear | aligned | random | sharpest | hidden";
        #[doc = "The point of the aligned seam, x and y in the design's coordinates."]
        seam_point: Option<[f64; 2]> = None, "the design's corner of greatest x and y", "[mm, mm]";
        #[doc = "What a change from one pure material to another is worth, in travel, where a machine mixes and nothing is purged: it then comes back to a colour for a part that lies near, and a change by a tenth has to save a tenth of this. 1000000 prints each colour once a layer, and so do order.walls other than any and skins.monotonic."]
        change: f64 = 400.0, "400", "mm";
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
}
