use super::issues::MeshIssues;
use super::weld::Welded;
use fgm_core::Point3;

/// No triangle on the other side.
pub(crate) const OPEN: u32 = u32::MAX;

/// One side of a triangle, sorted by the edge it lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// Lesser and greater vertex.
    edge: (u32, u32),
    /// Three times the triangle and which of its sides.
    id: u32,
    /// Whether the triangle runs from the lesser vertex to the greater.
    forward: bool,
}

/// For each side of each triangle, at three times the triangle and the side, the side that it
/// is joined to, or [`OPEN`].
pub(crate) fn join_sides(mesh: &Welded, issues: &mut MeshIssues) -> Vec<u32> {
    let mut sides: Vec<Side> = Vec::with_capacity(3 * mesh.triangles.len());
    for (t, corners) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let id = (3 * t + k) as u32;
            sides.push(Side { edge: (a.min(b), a.max(b)), id, forward: a < b });
        }
    }
    sides.sort_unstable();
    let mut mates = vec![OPEN; sides.len()];
    let mut join = |a: &Side, b: &Side| {
        mates[a.id as usize] = b.id;
        mates[b.id as usize] = a.id;
    };
    for group in sides.chunk_by(|a, b| a.edge == b.edge) {
        let ends = group[0].edge;
        let at = mesh.vertices[ends.0 as usize].midpoint(mesh.vertices[ends.1 as usize]);
        match group {
            [_] => issues.open_edges.add(at),
            [a, b] => {
                if a.forward == b.forward {
                    issues.flipped_edges.add(at);
                }
                join(a, b);
            }
            _ => {
                issues.non_manifold_edges.add(at);
                if group.len() % 2 == 1 {
                    issues.open_edges.add(at);
                }
                join_fan(mesh, group, &mut join);
            }
        }
    }
    mates
}

/// Joins the triangles around an edge of more than two: each with its neighbour in angle such
/// that the solid lies between them, so that the sections of the solids touch and do not cross.
fn join_fan(mesh: &Welded, group: &[Side], join: &mut impl FnMut(&Side, &Side)) {
    let mut fan: Vec<(f64, Side)> = group.iter().map(|s| (angle(mesh, s), *s)).collect();
    fan.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // Around the edge, seen against its direction, the solid follows a triangle that runs
    // backward and ends at one that runs forward.
    let mut left: Vec<Side> = fan.into_iter().map(|f| f.1).collect();
    while left.len() > 1 {
        let n = left.len();
        let wedge = (0..n).find(|&k| !left[k].forward && left[(k + 1) % n].forward);
        // Where all run one way there is no inside: neighbours are as good as any.
        let k = wedge.unwrap_or(0);
        let next = (k + 1) % n;
        join(&left[k], &left[next]);
        left.remove(k.max(next));
        left.remove(k.min(next));
    }
}

/// The angle of a triangle's third corner around the edge, from lesser to greater vertex.
fn angle(mesh: &Welded, side: &Side) -> f64 {
    let corners = mesh.triangles[side.id as usize / 3];
    let third = mesh.vertices[corners[(side.id as usize + 2) % 3] as usize];
    let (a, b) = (mesh.vertices[side.edge.0 as usize], mesh.vertices[side.edge.1 as usize]);
    let axis = (b - a).normalize_or_zero();
    let across = if axis.x.abs() < 0.5 { Point3::X } else { Point3::Y };
    let u = axis.cross(across);
    let v = axis.cross(u);
    (third - a).dot(v).atan2((third - a).dot(u))
}
