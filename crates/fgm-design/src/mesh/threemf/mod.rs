mod model;
mod package;

use std::collections::BTreeMap;
use std::path::Path;

use fgm_core::{Point3, TriangleMesh};
use glam::{DAffine3, DVec3};

use self::model::{Instance, Model};
use self::package::Package;
use super::weld::Welder;
use crate::problem::MAX_TRIANGLES;
use crate::{DesignError, Problem, Warning};

/// How deep components may hold components.
const MAX_NESTING: usize = 32;
/// The most objects placed, repeated ones included.
const MAX_INSTANCES: usize = 100_000;

/// Reads a 3MF file (core specification): all items of its build as one mesh, in mm.
///
/// Units, components and transforms are applied, those of mirrored items with their triangles
/// turned. Components of other parts (the production extension) are followed. Support objects and
/// items marked as not printable are left out. Materials and colours are not read. A file without
/// a build gives all its meshes as they stand.
///
/// # Errors
/// [`DesignError`] naming the part and the byte.
pub fn read_3mf(bytes: &[u8]) -> Result<TriangleMesh, DesignError> {
    read(bytes, Path::new("<3mf>"), &mut Vec::new())
}

pub(crate) fn read(
    bytes: &[u8],
    file: &Path,
    warnings: &mut Vec<Warning>,
) -> Result<TriangleMesh, DesignError> {
    let mut package = Package::open(bytes, file)?;
    let root = package.root_part()?;
    let mut build = Build {
        package,
        file,
        parts: BTreeMap::new(),
        welder: Welder::with_triangles(0),
        triangles: 0,
        instances: 0,
    };
    build.load(&root)?;
    let model = &build.parts[&root];
    let mut items = model.items.clone();
    if items.is_empty() {
        let whole = |o: &model::Object| Instance {
            object: o.id,
            part: None,
            transform: DAffine3::IDENTITY,
            printable: true,
        };
        items = model.objects.iter().filter(|o| !o.triangles.is_empty()).map(whole).collect();
    }
    let count: usize = model.objects.iter().map(|o| o.triangles.len()).sum();
    build.welder = Welder::with_triangles(count);
    for item in &items {
        if item.printable {
            build.place(item, &root, DAffine3::IDENTITY, 0)?;
        } else {
            let what = format!("object {} is marked as not printable; left out", item.object);
            warnings.push(Warning::LeftOut { file: file.to_path_buf(), what });
        }
    }
    let mesh = build.welder.finish();
    if mesh.triangles.is_empty() {
        return Err(DesignError::file(file, Problem::NoTriangles));
    }
    Ok(mesh)
}

/// The mesh on its way.
struct Build<'a> {
    package: Package<'a>,
    file: &'a Path,
    parts: BTreeMap<String, Model>,
    welder: Welder,
    triangles: usize,
    instances: usize,
}

impl Build<'_> {
    fn load(&mut self, part: &str) -> Result<(), DesignError> {
        if !self.parts.contains_key(part) {
            let text = self.package.read(part)?;
            self.parts.insert(part.to_string(), model::parse(&text, part, self.file)?);
        }
        Ok(())
    }

    /// Adds an object and its components. `outer` maps the frame the instance stands in to the
    /// build's.
    fn place(
        &mut self,
        instance: &Instance,
        part: &str,
        outer: DAffine3,
        depth: usize,
    ) -> Result<(), DesignError> {
        let part = instance.part.as_deref().unwrap_or(part);
        self.instances += 1;
        if depth > MAX_NESTING {
            return Err(self.error(part, format!("components nested more than {MAX_NESTING} deep")));
        }
        if self.instances > MAX_INSTANCES {
            return Err(self.error(part, format!("more than {MAX_INSTANCES} components")));
        }
        self.load(part)?;
        let model = &self.parts[part];
        let Some(object) = model.object(instance.object) else {
            return Err(self.error(part, format!("no object {}", instance.object)));
        };
        if object.support {
            return Ok(());
        }
        let transform = outer * instance.transform;
        // Vertices cost time too, even if no triangle uses them.
        self.triangles += object.triangles.len().max(object.vertices.len());
        if self.triangles > MAX_TRIANGLES {
            return Err(DesignError::file(self.file, Problem::TooManyTriangles));
        }
        let to_mm = DAffine3::from_scale(DVec3::splat(model.unit)) * transform;
        let turned = to_mm.matrix3.determinant() < 0.0;
        let points: Vec<Point3> =
            object.vertices.iter().map(|&v| to_mm.transform_point3(v)).collect();
        if points.iter().any(|p| !p.is_finite()) {
            return Err(self.error(part, format!("object {} is too large", instance.object)));
        }
        for t in &object.triangles {
            let [a, b, c] = t.map(|v| points[v as usize]);
            self.welder.triangle(if turned { [a, c, b] } else { [a, b, c] });
        }
        for component in object.components.clone() {
            self.place(&component, part, transform, depth + 1)?;
        }
        Ok(())
    }

    fn error(&self, part: &str, what: String) -> DesignError {
        DesignError::file(self.file, Problem::Model { part: part.to_string(), offset: 0, what })
    }
}
