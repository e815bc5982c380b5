use fgm_core::Point3;

use crate::{DialectName, MachineKind};

/// Why G-code cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GcodeError {
    /// NaN, an infinity, or a magnitude beyond any machine.
    #[error("{value} cannot be written as a coordinate, length or ratio")]
    NotANumber {
        /// The value.
        value: f64,
    },
    /// A palette that does not fit a tool changer.
    #[error("{colors} colours on {heads} heads of {machine}")]
    TooManyColors {
        /// Colours of the palette.
        colors: usize,
        /// Heads of the machine.
        heads: usize,
        /// Its name.
        machine: String,
    },
    /// A design with more materials than the machine has inputs.
    #[error("colour {color} mixes {materials} materials, but {machine} has {inputs} inputs")]
    TooManyMaterials {
        /// Which colour of the palette, from 0.
        color: usize,
        /// Materials of its mixture.
        materials: usize,
        /// Filaments the machine takes.
        inputs: usize,
        /// Its name.
        machine: String,
    },
    /// A palette with no colour.
    #[error("the palette has no colour")]
    NoColors,
    /// A colour that the palette does not have.
    #[error("colour {color} of a palette of {colors}")]
    UnknownColor {
        /// The colour asked for.
        color: usize,
        /// Colours of the palette.
        colors: usize,
    },
    /// A position outside the bed or above the machine's height.
    #[error(
        "{axis} = {at:.3} mm is {over:.3} mm outside the machine, which ends at {limit:.3} mm \
         (bed position {position:?})"
    )]
    OutsideBed {
        /// `'X'`, `'Y'` or `'Z'`.
        axis: char,
        /// The coordinate.
        at: f64,
        /// How far outside it is, mm.
        over: f64,
        /// The nearest allowed coordinate.
        limit: f64,
        /// The whole position, on the bed.
        position: Point3,
    },
    /// Extrusion by a nozzle that is too cold for it.
    #[error(
        "{what} would extrude at {celsius} °C, below the least temperature for extrusion, \
         {least} °C"
    )]
    Cold {
        /// Which setting or colour.
        what: String,
        /// Its temperature.
        celsius: f64,
        /// The machine's least temperature for extrusion.
        least: f64,
    },
    /// A bead with more section than the firmware allows.
    #[error(
        "a bead of {width:.3} x {height:.3} mm has {area:.4} mm², more than the {limit} mm² that \
         the firmware allows"
    )]
    BeadTooLarge {
        /// Width, mm.
        width: f64,
        /// Height, mm.
        height: f64,
        /// Section, mm².
        area: f64,
        /// The greatest section, mm².
        limit: f64,
    },
    /// A bead with no section.
    #[error("a bead {width} mm wide on a layer {height} mm high has no section")]
    NoBead {
        /// Width, mm.
        width: f64,
        /// Height of the layer, mm; 0 before the first one.
        height: f64,
    },
    /// A bead before any position.
    #[error("the print begins with a bead, before any travel says where from")]
    NoStart,
    /// A setting outside its range.
    #[error("{name} is {value}, where {expected} is needed")]
    Setting {
        /// Which setting, as in a profile: `speed.travel`.
        name: String,
        /// Its value.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A dialect that cannot tell what the machine needs.
    #[error("the dialect {dialect:?} does not fit a machine of kind {kind:?}: {expected}")]
    DialectMismatch {
        /// The dialect.
        dialect: DialectName,
        /// The kind of machine.
        kind: MachineKind,
        /// What would fit.
        expected: &'static str,
    },
    /// A template with a variable that does not exist, or an unclosed brace.
    #[error("{template} template, line {line}, column {column}: {message}")]
    Template {
        /// `start` or `end`.
        template: &'static str,
        /// From 1.
        line: usize,
        /// From 1, in characters.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// Writing failed.
    #[error("could not write the G-code: {0}")]
    Io(#[from] std::io::Error),
}
