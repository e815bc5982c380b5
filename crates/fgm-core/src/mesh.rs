use crate::{Bounds3, Point3};

/// A surface of triangles, as read from a file: indexed, and not promised to be closed.
///
/// Seen from outside the vertices of a triangle run anticlockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// The points, mm.
    pub vertices: Vec<Point3>,
    /// Three indices into `vertices` each; every index is in range.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The least box around the vertices that triangles use.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::of(self.triangles.iter().flatten().map(|&i| self.vertices[i as usize]))
    }

    /// The corners of every triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Point3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.vertices[i as usize]))
    }

    /// Enclosed volume, mm³: positive for a closed mesh whose triangles face outwards.
    pub fn volume(&self) -> f64 {
        let origin = self.bounds().center();
        self.corners()
            .map(|[a, b, c]| (a - origin).dot((b - origin).cross(c - origin)))
            .sum::<f64>()
            / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_has_a_sixth_of_its_box() {
        let mesh = TriangleMesh {
            vertices: vec![
                Point3::new(5.0, 0.0, 0.0),
                Point3::new(6.0, 0.0, 0.0),
                Point3::new(5.0, 1.0, 0.0),
                Point3::new(5.0, 0.0, 1.0),
            ],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        };
        assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(mesh.bounds().max, Point3::new(6.0, 1.0, 1.0));
    }
}
