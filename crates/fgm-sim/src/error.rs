/// Why a simulation cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    /// The G-code could not be read.
    #[error("could not read the G-code: {0}")]
    Io(#[from] std::io::Error),
    /// A number of the options outside its range.
    #[error("{name} is {value}, where {expected} is needed")]
    Option {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A layer too large for its raster.
    #[error(
        "layer {layer}: {width} x {height} cells of {cell} mm, more than the {limit} that a raster may have"
    )]
    Raster {
        /// From 1.
        layer: u32,
        /// Cells along x.
        width: u64,
        /// Cells along y.
        height: u64,
        /// Side of a cell, mm.
        cell: f64,
        /// The most cells.
        limit: u64,
    },
    /// A picture could not be made or written.
    #[error("layer {layer}: no picture: {message}")]
    Picture {
        /// From 1.
        layer: u32,
        /// Why.
        message: String,
    },
    /// The design has no mixture, or no outline, where it is compared.
    #[error("layer {layer}: {message}")]
    Design {
        /// From 1.
        layer: u32,
        /// What is wrong.
        message: String,
    },
}
