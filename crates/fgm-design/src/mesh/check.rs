use std::path::Path;

use fgm_core::TriangleMesh;

use crate::Warning;

/// Looks a mesh over: warns of edges without a partner, and turns a closed mesh that faces
/// inwards.
pub(crate) fn check(mesh: &mut TriangleMesh, file: &Path, warnings: &mut Vec<Warning>) {
    let edges = open_edges(mesh);
    if edges > 0 {
        warnings.push(Warning::OpenMesh { file: file.to_path_buf(), edges });
    } else if mesh.volume() < 0.0 {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        warnings.push(Warning::InsideOut { file: file.to_path_buf() });
    }
}

/// How many edges have not as many triangles on one side as on the other. None in a closed mesh
/// whose triangles all face the same way, however many triangles share an edge.
pub(crate) fn open_edges(mesh: &TriangleMesh) -> usize {
    // A counting sort by the lesser vertex; then the few edges of each vertex are sorted.
    let mut starts = vec![0_u32; mesh.vertices.len() + 1];
    let edges = || mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    for [a, b] in edges() {
        starts[a.min(b) as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut others = vec![(0_u32, 0_i32); mesh.triangles.len() * 3];
    for [a, b] in edges() {
        let slot = &mut next[a.min(b) as usize];
        others[*slot as usize] = (a.max(b), if a < b { 1 } else { -1 });
        *slot += 1;
    }
    let mut open = 0;
    for range in starts.windows(2) {
        let group = &mut others[range[0] as usize..range[1] as usize];
        group.sort_unstable();
        open += group
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|same| same.iter().map(|(_, turn)| turn).sum::<i32>() != 0)
            .count();
    }
    open
}

#[cfg(test)]
mod tests {
    use fgm_core::Point3;

    use super::*;

    fn tetrahedron() -> TriangleMesh {
        TriangleMesh {
            vertices: vec![Point3::ZERO, Point3::X, Point3::Y, Point3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        }
    }

    #[test]
    fn open_and_turned_meshes_are_told() {
        let name = Path::new("t.stl");
        let mut warnings = Vec::new();
        let mut mesh = tetrahedron();
        check(&mut mesh, name, &mut warnings);
        assert!(warnings.is_empty());

        mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        check(&mut mesh, name, &mut warnings);
        assert_eq!(warnings, [Warning::InsideOut { file: name.into() }]);
        assert!(mesh.volume() > 0.0);

        mesh.triangles[3].swap(0, 1);
        assert_eq!(open_edges(&mesh), 3, "one triangle faces the other way");
        mesh.triangles.pop();
        assert_eq!(open_edges(&mesh), 3, "one triangle is missing");
    }
}
