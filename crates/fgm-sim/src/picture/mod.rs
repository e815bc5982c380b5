//! Pictures of layers.

mod painter;

use serde::Serialize;

use crate::SimError;

pub(crate) use painter::Painter;

/// What a picture of a layer shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PictureKind {
    /// The design.
    Designed,
    /// The mixtures that were commanded while each place was laid down.
    Commanded,
    /// The mixtures laid down.
    Deposited,
    /// How far what was laid down is from the design: white for nothing, over yellow (0.05) and
    /// red (0.15) to black (0.5 and more). Grey where nothing was laid down.
    Error,
}

impl PictureKind {
    /// Its name in file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Designed => "designed",
            Self::Commanded => "commanded",
            Self::Deposited => "deposited",
            Self::Error => "error",
        }
    }
}

/// A picture of a layer seen from above, y upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// What it shows.
    pub kind: PictureKind,
    /// The layer, from 1.
    pub layer: u32,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of every pixel, from the upper left row by row.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// The bytes of a PNG file.
    ///
    /// # Errors
    /// [`SimError::Picture`] for a picture without pixels.
    pub fn png(&self) -> Result<Vec<u8>, SimError> {
        let fail =
            |e: png::EncodingError| SimError::Picture { layer: self.layer, message: e.to_string() };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(fail)?;
        writer.write_image_data(&self.rgb).map_err(fail)?;
        writer.finish().map_err(fail)?;
        Ok(bytes)
    }
}
