//! What the settings mean to the crates below: their options.

use std::borrow::Cow;

use fgm_contour::ContourOptions;
use fgm_core::Point2;
use fgm_toolpath::{
    BrimOptions, Monotonic, OrderOptions, Pattern, SkirtOptions, Turns, WayOptions,
};

use super::{AgainstSettings, BrimSettings, InfillSettings, Settings, TravelSettings};
use crate::{
    choice::{Aim, Strategy, Zipper},
    density::Density,
    error::SliceError,
    layers::Layer,
};

impl Settings {
    /// Thickness of the first layer, mm.
    pub fn first_height(&self) -> f64 {
        self.layer.first_height.unwrap_or(self.layer.height)
    }

    /// How many layers lie flat below a spiral wall, where `first`, from 0, is the one on the bed.
    pub(crate) fn flat_layers(&self, first: usize) -> usize {
        first + self.skins.bottom.max(1)
    }

    /// The settings with what a spiral wall stands for.
    ///
    /// # Errors
    /// [`SliceError::SpiralStrategy`].
    pub(crate) fn implied(&self) -> Result<Cow<'_, Self>, SliceError> {
        if !self.walls.spiral {
            return Ok(Cow::Borrowed(self));
        }
        if self.slice.strategy == Strategy::Against {
            return Err(SliceError::SpiralStrategy);
        }
        let mut settings = self.clone();
        (settings.walls.count, settings.skins.top) = (1, 0);
        settings.infill = InfillSettings {
            density: Density::Percent(0.0),
            pattern: Pattern::Rectilinear,
            ..settings.infill
        };
        Ok(Cow::Owned(settings))
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

    /// How lines turn round at boundaries between colours in a layer of a height, mm.
    pub(crate) fn turns(&self, height: f64) -> Turns {
        Turns { height, steepest: self.section.turns.to_radians() }
    }

    /// How the pieces of a layer are put in order. `corner` is the design's of greatest x and y.
    pub(crate) fn order_options(&self, layer: &Layer, corner: Point2) -> OrderOptions {
        OrderOptions {
            roles: self.order.walls,
            seam: self.order.seam,
            seam_point: self.order.seam_point.map_or(corner, Point2::from),
            layer: layer.index as u32,
            improve: self.order.effort,
            monotonic: match self.infill.pattern {
                // Loops have no direction of advance.
                Pattern::Concentric if self.infill.density == Density::Percent(100.0) => {
                    Monotonic::Off
                }
                _ => self.skins.monotonic,
            },
            direction: 0.0,
            turns: (self.section.turns > 0.0).then(|| self.turns(layer.height)),
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
}
