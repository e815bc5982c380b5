use fgm_core::Polygon;
use fgm_field::Design;

use crate::{error::SliceError, outlines::Outliner, settings::Settings};

/// A design's outlines as they are sliced.
///
/// ```
/// use fgm::{Sections, Settings, design};
///
/// let source = "fgrade([\"x/10 + 0.5\", \"0.5 - x/10\"], [\"a\", \"b\"]) { cube(10); }";
/// let loaded = design::parse_vcad(source, ".".as_ref(), &Default::default())?;
/// let sections = Sections::new(&loaded.design, &Settings::default())?;
/// assert!((sections.at(0.0)?[0].area() - 100.0).abs() < 1e-3);
/// assert!(sections.at(6.0)?.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sections<'a>(Outliner<'a>);

impl<'a> Sections<'a> {
    /// Outlines with the settings' tolerances.
    ///
    /// # Errors
    /// [`SliceError`] for a mesh that cannot be cut.
    pub fn new(design: &'a Design, settings: &Settings) -> Result<Self, SliceError> {
        Outliner::new(design, settings.outline_options()).map(Self)
    }

    /// The region of the part at a height in the design's coordinates, mm.
    ///
    /// # Errors
    /// [`SliceError`] where the surface cannot be traced.
    pub fn at(&self, z: f64) -> Result<Vec<Polygon>, SliceError> {
        Ok(self.0.at(z)?.region)
    }
}
