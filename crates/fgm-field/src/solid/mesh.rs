//! Signed distance to a triangle mesh.

use fgm_core::{Bounds3, Field, Interval, Point3, TriangleMesh};
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

use crate::FieldError;

/// The signed distance to the surface of a mesh, mm, by a tree of boxes.
///
/// Exact for a closed mesh whose triangles all face the same way; outwards or inwards does not
/// matter. Where a mesh has holes the distance's size is right, and its sign is that of the nearest
/// triangle's side.
///
/// A value costs a search of the tree. A mesh that is not combined with anything is better cut as
/// it is.
pub struct MeshDistance {
    mesh: TriMesh,
    closed: bool,
    /// -1 for a mesh that is inside out.
    sign: f64,
    /// The greatest coordinate, mm: the scale of rounding errors.
    reach: f64,
}

impl MeshDistance {
    /// Builds the search tree. Vertices at the same place are joined; triangles without an area are
    /// left out.
    ///
    /// # Errors
    /// [`FieldError::Mesh`] for a mesh without triangles, with a coordinate that is not finite, or
    /// with an index out of range.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, FieldError> {
        let fault = |reason| FieldError::Mesh { reason };
        if mesh.triangles.iter().flatten().any(|i| *i as usize >= mesh.vertices.len()) {
            return Err(fault("a triangle names a vertex that is not there"));
        }
        if !mesh.vertices.iter().all(|v| v.is_finite()) {
            return Err(fault("a vertex is not finite"));
        }
        let has_area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
            (b - a).cross(c - a) != Point3::ZERO
        };
        let triangles: Vec<_> = mesh.triangles.iter().copied().filter(has_area).collect();
        if triangles.is_empty() {
            return Err(fault("it has no triangle with an area"));
        }
        let flags = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
        let built = TriMesh::with_flags(mesh.vertices.clone(), triangles, flags)
            .map_err(|_| fault("its triangles are not usable"))?;
        let bounds = mesh.bounds();
        Ok(Self {
            closed: is_closed(built.indices()),
            sign: if mesh.volume() < 0.0 { -1.0 } else { 1.0 },
            reach: bounds.min.abs().max(bounds.max.abs()).element_sum(),
            mesh: built,
        })
    }

    /// Whether every edge is shared by as many triangles one way as the other, so that there is an
    /// inside.
    pub fn is_closed(&self) -> bool {
        self.closed
    }
}

fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let edges = || triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let mut forth: Vec<_> = edges().collect();
    let mut back: Vec<_> = edges().map(|(a, b)| (b, a)).collect();
    forth.sort_unstable();
    back.sort_unstable();
    forth == back
}

impl Field for MeshDistance {
    fn eval(&self, p: Point3) -> f64 {
        if !p.is_finite() {
            return f64::NAN;
        }
        let nearest = self.mesh.project_local_point(p, false);
        let distance = nearest.point.distance(p);
        if nearest.is_inside { -self.sign * distance } else { self.sign * distance }
    }

    /// A distance changes by no more than the way: the value in the middle, give or take half of
    /// the diagonal.
    fn bounds(&self, cell: &Bounds3) -> Interval {
        if !cell.is_finite() {
            return Interval::EVERYTHING;
        }
        let middle = self.eval(cell.center());
        let reach = cell.size().length() * 0.5;
        let room = (self.reach + cell.max.abs().max(cell.min.abs()).element_sum()) * 1e-13;
        let reach = reach + room;
        if self.closed {
            return Interval::new(middle - reach, middle + reach);
        }
        // Beside a hole the sign may change anywhere.
        let farthest = middle.abs() + reach;
        Interval::new(-farthest, farthest)
    }
}
