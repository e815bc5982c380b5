//! From the whole part to the design.

use std::path::Path;
use std::sync::Arc;

use fgm_core::{MAX_MATERIALS, TriangleMesh};
use fgm_field::{
    Design, Expr, FractionMode, Material, SharedField, SharedMaterial, VolumeFractions,
};
use glam::{DAffine3, DVec3};

use super::density::Density;
use super::lower::{Lowering, union};
use super::number;
use super::paint::Paint;
use super::parser;
use super::part::{Part, Shape};
use crate::extent::{self, REACH};
use crate::palette::Palette;
use crate::problem::MAX_REACH;
use crate::source::Source;
use crate::{DesignError, Loaded, Problem, Warning};

/// What a single material is joined by.
const UNUSED: &str = "(unused)";
/// The file that errors in the options' expressions name.
const FRACTION: &str = "--fraction";

impl Lowering<'_> {
    /// The design of the source's text. `path` is its file, if it has one.
    pub(crate) fn text_design(mut self, path: Option<&Path>) -> Result<Loaded, DesignError> {
        let nodes = parser::parse(self.source)?;
        let graded = !self.options.fractions.is_empty();
        if graded {
            self.name_fractions()?;
        }
        self.name_materials(&nodes, graded)?;
        let mut parts = Vec::with_capacity(nodes.len());
        for node in &nodes {
            parts.push(self.part(node, graded)?);
        }
        let top = nodes[0].name_span.clone();
        let at = |error| self.source.error(top.clone(), Problem::Field { error });
        let mut part = union(parts).map_err(at)?;
        if graded {
            part = self.with_fractions(part)?;
        }
        if part.void || part.is_empty() {
            return Err(self.source.error(top, Problem::EmptyShape));
        }
        if let (Some(span), false) = (&self.endless, part.bounds.is_finite()) {
            return Err(self.source.error(span.clone(), Problem::Unbounded { limit: REACH }));
        }
        if is_far(&part) {
            return Err(self.source.error(top, Problem::TooFar));
        }
        if let (Shape::Field(field), false) = (&part.shape, part.tight) {
            let Some(bounds) = extent::tighten(&**field, &part.bounds) else {
                return Err(self.source.error(top, Problem::EmptyShape));
            };
            part.bounds = bounds;
        }
        if let Some(by) = self.fit(&part)? {
            part = part.transformed(&by).map_err(at)?;
        }
        let name = path.map_or("design".into(), stem);
        self.design(part, name, path)
            .map_err(|problem| self.source.error(top, problem))
            .map(|design| Loaded { design, warnings: std::mem::take(&mut self.warnings) })
    }

    /// The design of a mesh and the options' fractions.
    pub(crate) fn mesh_design(
        mut self,
        mesh: TriangleMesh,
        path: &Path,
    ) -> Result<Loaded, DesignError> {
        if self.options.fractions.is_empty() {
            return Err(DesignError::file(path, Problem::NoFractions));
        }
        let bounds = mesh.bounds();
        let shape = Shape::Mesh(Arc::new(mesh));
        let (paint, density) = (Paint::Inherit, Density::Inherit);
        let mut part = Part { shape, bounds, tight: true, paint, density, void: false };
        let file = |error| DesignError::file(path, Problem::Field { error });
        if let Some(by) = self.fit(&part)? {
            part = part.transformed(&by).map_err(file)?;
        }
        if is_far(&part) {
            return Err(DesignError::file(path, Problem::TooFar));
        }
        self.name_fractions()?;
        let part = self.with_fractions(part)?;
        let design = self.design(part, stem(path), Some(path));
        let design = design.map_err(|problem| DesignError::file(path, problem))?;
        Ok(Loaded { design, warnings: self.warnings })
    }

    /// The scaling that makes a part fit the wanted size, proportions kept.
    fn fit(&self, part: &Part) -> Result<Option<DAffine3>, DesignError> {
        let Some(size) = self.options.size else { return Ok(None) };
        let wrong = size.to_array().into_iter().find(|v| !(*v > 0.0 && v.is_finite()));
        if let Some(value) = wrong {
            let problem = Problem::NotPositive { value };
            return Err(DesignError::file(Path::new("--size"), problem));
        }
        let sides = part.bounds.size().to_array().into_iter().zip(size.to_array());
        // A flat mesh has a side of length 0, which fits always.
        let factor = sides.filter(|(is, _)| *is > 0.0).map(|(is, may)| may / is);
        let factor = factor.fold(f64::INFINITY, f64::min);
        let factor = if factor.is_finite() { factor } else { 1.0 };
        Ok(Some(DAffine3::from_scale(DVec3::splat(factor))))
    }

    /// Names the materials of the options' fractions.
    fn name_fractions(&mut self) -> Result<(), DesignError> {
        let (expressions, names) = (self.options.fractions.len(), &self.options.names);
        let count = match names.len() {
            0 => expressions.max(2),
            given if given == expressions || given == expressions + 1 => given,
            materials => {
                let problem = Problem::FractionCount { expressions, materials };
                return Err(DesignError::file(Path::new(FRACTION), problem));
            }
        };
        if !(2..=MAX_MATERIALS).contains(&count) {
            let problem = Problem::FractionCount { expressions, materials: count };
            return Err(DesignError::file(Path::new(FRACTION), problem));
        }
        let letter = |i: usize| char::from(b'A' + i as u8).to_string();
        for i in 0..count {
            let name = names.get(i).cloned().unwrap_or_else(|| letter(i));
            if self.materials.contains(&name) {
                let problem = Problem::RepeatedName { name };
                return Err(DesignError::file(Path::new(FRACTION), problem));
            }
            self.materials.push(name);
        }
        Ok(())
    }

    /// Gives a part the options' fractions.
    fn with_fractions(&self, mut part: Part) -> Result<Part, DesignError> {
        let named = if self.options.names.is_empty() {
            self.options.fractions.len().max(2)
        } else {
            self.options.names.len()
        };
        let mut weights = Vec::with_capacity(self.material_count());
        for text in &self.options.fractions {
            let source = Source::new(Path::new(FRACTION), text);
            weights.push(number::expression(&source, 0..text.len(), &Arc::default())?);
        }
        let file = |error| DesignError::file(Path::new(FRACTION), Problem::Field { error });
        let distance: Option<SharedField> = match weights.iter().any(Expr::uses_distance) {
            true => Some(part.shape.field().map_err(file)?),
            false => None,
        };
        let fractions = if weights.len() < named {
            // What remains of 1 comes last; materials of the design's own have no part in it.
            if self.material_count() > named {
                let problem = Problem::RestAmongOthers;
                return Err(DesignError::file(Path::new(FRACTION), problem));
            }
            VolumeFractions::from_exprs_with_rest(&weights, distance)
        } else {
            weights.resize(self.material_count(), Expr::constant(0.0));
            VolumeFractions::from_exprs(&weights, distance, FractionMode::Probability)
        };
        let fractions: SharedMaterial = Arc::new(fractions.map_err(file)?);
        part.paint = part.paint.filled(&fractions);
        Ok(part)
    }

    fn design(&mut self, part: Part, name: String, path: Option<&Path>) -> Result<Design, Problem> {
        let palette = Palette::find(path, self.folder, &mut self.warnings);
        let named = self.materials.iter();
        let mut materials: Vec<Material> = named
            .map(|name| Material {
                name: name.clone(),
                color: palette.color(name, &mut self.warnings),
            })
            .collect();
        if let [only] = materials.as_slice() {
            self.warnings.push(Warning::OneMaterial { name: only.name.clone() });
            materials.push(Material { name: UNUSED.to_string(), color: None });
        }
        let fractions =
            part.paint.fractions(materials.len()).map_err(|error| Problem::Field { error })?;
        Ok(Design {
            name,
            geometry: part.shape.geometry(),
            materials,
            fractions,
            density: part.density.field(),
            bounds: part.bounds,
        })
    }
}

/// Whether a part reaches, or may reach, beyond what a design may.
fn is_far(part: &Part) -> bool {
    let reach = part.bounds.min.abs().max(part.bounds.max.abs());
    !reach.cmple(DVec3::splat(MAX_REACH)).all()
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
