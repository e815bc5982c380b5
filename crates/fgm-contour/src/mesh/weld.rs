use super::issues::MeshIssues;
use crate::{ContourError, MAX_TRIANGLES};
use fgm_core::{Point3, TriangleMesh};

/// A mesh in which a place has one vertex and no triangle is degenerate or there twice.
#[derive(Debug, Default)]
pub(crate) struct Welded {
    pub(crate) vertices: Vec<Point3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Joins vertices in exactly the same place, as the soup of an STL file needs, and drops
/// degenerate and duplicate triangles.
pub(crate) fn weld(mesh: &TriangleMesh, issues: &mut MeshIssues) -> Result<Welded, ContourError> {
    check(mesh)?;
    // Adding 0 turns -0 into 0: two names of one place.
    let vertices: Vec<Point3> = mesh.vertices.iter().map(|&v| v + Point3::ZERO).collect();
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    let at = |k: u32| vertices[k as usize];
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (at(a), at(b));
        let places = p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z));
        places.then(a.cmp(&b))
    });
    let mut first = vec![0; vertices.len()];
    let mut current = None;
    for &k in &order {
        let same = current.filter(|&c| at(c) == at(k));
        let c = same.unwrap_or(k);
        current = Some(c);
        first[k as usize] = c;
    }
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| first[v as usize]);
        if a == b || b == c || c == a {
            issues.degenerate_triangles.add(at(a));
        } else {
            triangles.push([a, b, c]);
        }
    }
    drop_duplicates(&mut triangles, &vertices, issues);
    Ok(Welded { vertices, triangles })
}

fn check(mesh: &TriangleMesh) -> Result<(), ContourError> {
    let count = mesh.vertices.len();
    if mesh.triangles.len() > MAX_TRIANGLES || count > u32::MAX as usize {
        let count = mesh.triangles.len().max(count);
        return Err(ContourError::TooManyTriangles { count, limit: MAX_TRIANGLES });
    }
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        for &vertex in corners {
            let Some(v) = mesh.vertices.get(vertex as usize) else {
                return Err(ContourError::VertexOutOfRange { triangle, vertex, count });
            };
            if !v.is_finite() {
                return Err(ContourError::VertexNotFinite { triangle, vertex });
            }
        }
    }
    Ok(())
}

/// Of triangles on the same three vertices keeps one of those that face the more frequent way,
/// or none where as many face either way: such a sheet has no thickness.
fn drop_duplicates(triangles: &mut Vec<[u32; 3]>, vertices: &[Point3], issues: &mut MeshIssues) {
    let key = |t: &[u32; 3]| {
        let mut k = *t;
        k.sort_unstable();
        k
    };
    let mut order: Vec<([u32; 3], u32)> =
        triangles.iter().enumerate().map(|(k, t)| (key(t), k as u32)).collect();
    order.sort_unstable();
    let mut dropped = vec![false; triangles.len()];
    for group in order.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1) {
        let even = |k: u32| {
            let [a, b, c] = triangles[k as usize];
            (a < b) as u8 + (b < c) as u8 + (c < a) as u8 == 2
        };
        let evens = group.iter().filter(|g| even(g.1)).count();
        let majority = match (2 * evens).cmp(&group.len()) {
            std::cmp::Ordering::Equal => None,
            order => Some(order == std::cmp::Ordering::Greater),
        };
        let keep = group.iter().find(|g| Some(even(g.1)) == majority).map(|g| g.1);
        for &(corners, k) in group.iter().filter(|g| Some(g.1) != keep) {
            dropped[k as usize] = true;
            issues.duplicate_triangles.add(vertices[corners[0] as usize]);
        }
    }
    if issues.duplicate_triangles.any() {
        let mut k = 0;
        triangles.retain(|_| {
            k += 1;
            !dropped[k - 1]
        });
    }
}
