use std::io::ErrorKind;

use fgm_core::{Bounds3, MaterialError};

use crate::settings::SettingError;

/// Why a design could not be sliced.
#[derive(Debug, thiserror::Error)]
pub enum SliceError {
    /// The design could not be read.
    #[error(transparent)]
    Design(#[from] fgm_design::DesignError),
    /// A setting is out of its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The settings' changes to the machine's profile do not fit it.
    #[error("machine: {message}")]
    MachineSetting {
        /// What is wrong.
        message: String,
    },
    /// The design has more materials than the machine has inputs.
    #[error(
        "the design has {materials} materials, but {printer} takes {inputs}: choose a printer with \
         more inputs"
    )]
    Inputs {
        /// The design's.
        materials: usize,
        /// The machine's.
        inputs: usize,
        /// Its name.
        printer: String,
    },
    /// The palette asked for does not exist.
    #[error(transparent)]
    Palette(#[from] fgm_palette::PaletteError),
    /// A zipper in mm, where the material does not change.
    #[error(
        "zipper of {length} mm: the material does not change anywhere in the part, so a length along the gradient means nothing; give a share of the gradient"
    )]
    FlatZipper {
        /// The length asked for, mm.
        length: f64,
    },
    /// The design has no valid mixture somewhere.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A layer could not be traced.
    #[error("layer {layer}: {source}")]
    Contour {
        /// From 1.
        layer: usize,
        /// Why.
        source: fgm_contour::ContourError,
    },
    /// A density that varies, where the pattern's lines cannot follow.
    #[error(
        "the density of the infill varies, by infill.density or by the design, and {pattern} lines \
         cannot follow it: choose rectilinear, aligned, grid or triangles as infill.pattern, or a \
         number as infill.density"
    )]
    GradedPattern {
        /// The pattern asked for.
        pattern: fgm_toolpath::Pattern,
    },
    /// A spiral wall in strategy against.
    #[error(
        "walls.spiral is for strategy sectioned: printed against the gradient there are no walls. \
         Choose --strategy sectioned, or leave the spiral out"
    )]
    SpiralStrategy,
    /// A spiral wall around more than one outline.
    #[error(
        "layer {layer}, at z = {z:.3} mm of the design, has {outlines} outlines, and a spiral \
         (walls.spiral) goes round one: print the layers below it only (--layers 1..{}), or print \
         without the spiral", layer - 1
    )]
    SpiralOutlines {
        /// From 1.
        layer: usize,
        /// Height of its middle in the design's coordinates, mm.
        z: f64,
        /// How many loops it would take.
        outlines: usize,
    },
    /// A spiral wall around an outline beside the one below.
    #[error(
        "the outline of layer {layer}, at z = {z:.3} mm of the design, lies beside that of the layer \
         below, and a spiral (walls.spiral) would lead its bead there through the air: print the \
         layers below it only (--layers 1..{}), or print without the spiral", layer - 1
    )]
    SpiralIsland {
        /// From 1.
        layer: usize,
        /// Height of its middle in the design's coordinates, mm.
        z: f64,
    },
    /// A spiral wall would have to go on above a layer without a loop.
    #[error(
        "the part goes on in layer {layer}, at z = {z:.3} mm of the design, above layers that are \
         narrower than a loop of the wall, where the spiral (walls.spiral) ends: print the layers \
         below only (--layers 1..{}), or print without the spiral", layer - 1
    )]
    SpiralGap {
        /// From 1: where it goes on.
        layer: usize,
        /// Height of its middle in the design's coordinates, mm.
        z: f64,
    },
    /// A spiral wall of several colours on a printer with a head for each.
    #[error(
        "layer {layer}, at z = {z:.3} mm of the design: the spiral (walls.spiral) changes from \
         colour {from} to {to}, which {printer} prints with another head, and it cannot leave the \
         wall for that: choose a printer that mixes, or print without the spiral"
    )]
    SpiralHeads {
        /// From 1.
        layer: usize,
        /// Height of its middle in the design's coordinates, mm.
        z: f64,
        /// The palette's colour before, from 0.
        from: usize,
        /// The one after it.
        to: usize,
        /// The printer's name.
        printer: String,
    },
    /// The design's distance, which the density asks for, could not be made.
    #[error("infill.density: {0}")]
    Distance(#[from] fgm_field::FieldError),
    /// The design's surface could not be traced.
    #[error(transparent)]
    Surface(#[from] fgm_contour::ContourError),
    /// A layer's lines could not be arranged.
    #[error(transparent)]
    Arrange(#[from] fgm_arrange::ArrangeError),
    /// Toolpaths could not be made.
    #[error(transparent)]
    Toolpath(#[from] fgm_toolpath::ToolpathError),
    /// G-code could not be written.
    #[error(transparent)]
    Gcode(#[from] fgm_gcode::GcodeError),
    /// The part does not fit the machine.
    #[error(
        "the part is {:.2} x {:.2} x {:.2} mm and does not fit the {:.2} x {:.2} x {:.2} mm of {printer}: \
         too large by {:.2} mm in {axis}; scale it with --size or choose another printer",
        part.size().x, part.size().y, part.size().z, bed.size().x, bed.size().y, bed.size().z, over
    )]
    TooLarge {
        /// The part's bounds.
        part: Box<Bounds3>,
        /// What the machine reaches.
        bed: Box<Bounds3>,
        /// Its name.
        printer: String,
        /// The axis it is too large in by most.
        axis: char,
        /// By how much, mm.
        over: f64,
    },
    /// There is no layer to print.
    #[error("nothing to print: {reason}")]
    NothingToPrint {
        /// Why.
        reason: String,
    },
    /// More threads than make sense.
    #[error(
        "{asked} threads, where at most {} are possible; 0 takes all cores",
        crate::MAX_THREADS
    )]
    TooManyThreads {
        /// How many were asked for.
        asked: usize,
    },
    /// The pool of threads could not be started.
    #[error("could not start the threads: {message}")]
    Threads {
        /// Why.
        message: String,
    },
    /// Stopped through [`crate::Progress::cancelled`].
    #[error("stopped")]
    Cancelled,
}

impl SliceError {
    /// Whether the input or the settings are at fault, rather than the circumstances (I/O, the
    /// bed's size, nothing to print, a stop).
    pub fn is_bad_input(&self) -> bool {
        match self {
            Self::Design(fgm_design::DesignError::Read { error, .. }) => {
                // A file that is not there was named wrongly; one that cannot be read is not the
                // design's fault.
                matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidData)
            }
            Self::Gcode(
                fgm_gcode::GcodeError::Io(_) | fgm_gcode::GcodeError::OutsideBed { .. },
            )
            | Self::Toolpath(fgm_toolpath::ToolpathError::NoRoomForTowers { .. })
            | Self::TooLarge { .. }
            | Self::NothingToPrint { .. }
            | Self::Threads { .. }
            | Self::Cancelled => false,
            _ => true,
        }
    }

    /// Names the layer (from 0) that a contour could not be traced in.
    pub(crate) fn in_layer(self, index: usize) -> Self {
        match self {
            Self::Surface(source) => Self::Contour { layer: index + 1, source },
            other => other,
        }
    }
}
