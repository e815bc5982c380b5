//! Triangle meshes from files.

pub(crate) mod check;
pub(crate) mod obj;
pub(crate) mod stl;
pub(crate) mod threemf;
mod weld;

use std::path::Path;

use fgm_core::TriangleMesh;
use glam::DAffine3;

use crate::load::{extension, read_file};
use crate::problem::MAX_MESH_BYTES;
use crate::{DesignError, Warning};

/// Reads and checks a mesh file by the ending of its name.
pub(crate) fn load(path: &Path, warnings: &mut Vec<Warning>) -> Result<TriangleMesh, DesignError> {
    let extension = extension(path);
    if !matches!(extension.as_str(), "stl" | "obj" | "3mf") {
        return Err(DesignError::UnknownFormat { path: path.to_path_buf(), extension });
    }
    let bytes = read_file(path, MAX_MESH_BYTES)?;
    let mut mesh = match extension.as_str() {
        "stl" => stl::read(&bytes, path)?,
        "obj" => obj::read(&bytes, path)?,
        _ => threemf::read(&bytes, path, warnings)?,
    };
    check::check(&mut mesh, path, warnings);
    Ok(mesh)
}

/// The mesh moved; its triangles still face outwards where the move mirrors.
pub(crate) fn transformed(mesh: &TriangleMesh, by: &DAffine3) -> TriangleMesh {
    let mut moved = mesh.clone();
    moved.vertices.iter_mut().for_each(|p| *p = by.transform_point3(*p));
    if by.matrix3.determinant() < 0.0 {
        moved.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    moved
}
