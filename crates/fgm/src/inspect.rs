use fgm_core::{Point3, Polygon};
use fgm_field::{Design, Geometry};
use serde::Serialize;

use crate::{
    colors, error::SliceError, extent, layers::Layers, outlines::Outliner, samples,
    settings::Settings,
};

/// What a design holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inspection {
    /// The design's name.
    pub design: String,
    /// `function` or `mesh`.
    pub geometry: &'static str,
    /// Least corner of the part, mm.
    pub min_mm: [f64; 3],
    /// Size of the part, mm.
    pub size_mm: [f64; 3],
    /// Layers it has.
    pub layers: usize,
    /// Thickness of a layer, mm.
    pub layer_height_mm: f64,
    /// Volume, from evenly spread layers, mm³.
    pub volume_mm3: f64,
    /// How many layers the volume was taken from.
    pub sampled_layers: usize,
    /// The materials, in the design's order.
    pub materials: Vec<MaterialRange>,
    /// What a slice would warn of.
    pub warnings: Vec<String>,
}

/// How a material is spread in a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialRange {
    /// Its name.
    pub name: String,
    /// Least fraction found.
    pub least: f64,
    /// Greatest fraction found.
    pub greatest: f64,
    /// Mean fraction.
    pub mean: f64,
    /// Greatest change of the fraction in a layer, a mm.
    pub steepest_per_mm: f64,
}

/// Layers that a volume is taken from.
const VOLUME_LAYERS: usize = 64;

/// Looks at a design without slicing it.
///
/// # Errors
/// [`SliceError`] where the design cannot be traced, is empty, or has no valid mixture at a
/// sampled point.
pub fn inspect(design: &Design, settings: &Settings) -> Result<Inspection, SliceError> {
    settings.check()?;
    let outliner = Outliner::new(design, settings.outline_options())?;
    let heights = extent::heights(&outliner, &design.bounds, settings.layer.height)?
        .ok_or_else(|| SliceError::NothingToPrint { reason: "the design is empty".into() })?;
    let mut part = design.bounds;
    (part.min.z, part.max.z) = (heights.lo, heights.hi);
    let layers = Layers::new(heights, settings.first_height(), settings.layer.height);
    let sampled = layers.count().clamp(1, VOLUME_LAYERS);
    let mut volume = 0.0;
    for i in 0..sampled {
        let z = heights.lo + heights.width() * (i as f64 + 0.5) / sampled as f64;
        let area: f64 = outliner.at(z)?.region.iter().map(Polygon::area).sum();
        volume += area * heights.width() / sampled as f64;
    }
    let points = samples::inside(&outliner, &part)?;
    let materials =
        (0..design.materials.len()).map(|m| range(design, m, &points)).collect::<Result<_, _>>()?;
    Ok(Inspection {
        design: design.name.clone(),
        geometry: match design.geometry {
            Geometry::Field(_) => "function",
            Geometry::Mesh(_) => "mesh",
        },
        min_mm: part.min.to_array(),
        size_mm: part.size().to_array(),
        layers: layers.count(),
        layer_height_mm: settings.layer.height,
        volume_mm3: volume,
        sampled_layers: sampled,
        materials,
        warnings: outliner.warnings(),
    })
}

fn range(design: &Design, material: usize, points: &[Point3]) -> Result<MaterialRange, SliceError> {
    let mut range = MaterialRange {
        name: design.materials[material].name.clone(),
        least: f64::INFINITY,
        greatest: f64::NEG_INFINITY,
        mean: 0.0,
        steepest_per_mm: 0.0,
    };
    for &point in points {
        let fraction = design.fractions.mixture(point)?.fractions()[material];
        range.least = range.least.min(fraction);
        range.greatest = range.greatest.max(fraction);
        range.mean += fraction / points.len() as f64;
        let slope = colors::gradient(design.fractions.fraction(material), point);
        range.steepest_per_mm = range.steepest_per_mm.max(slope);
    }
    Ok(range)
}
