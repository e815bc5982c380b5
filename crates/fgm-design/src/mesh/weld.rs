use fgm_core::{Point3, TriangleMesh};

/// Makes an indexed mesh of loose triangles: corners that are equal become one vertex.
///
/// Vertices stand in the order of their first use, so that the result does not depend on the hash.
/// Triangles with two equal corners are left out; they have no area and no neighbours.
#[derive(Debug)]
pub(crate) struct Welder {
    mesh: TriangleMesh,
    /// Open addressing: the index of a vertex plus one, 0 where free. A power of two long and at
    /// most half full.
    slots: Vec<u32>,
}

impl Welder {
    pub(crate) fn with_triangles(count: usize) -> Self {
        // A closed mesh has half as many vertices as triangles.
        let slots = (count.max(16)).next_power_of_two() * 2;
        let mesh = TriangleMesh {
            vertices: Vec::with_capacity(count / 2 + 3),
            triangles: Vec::with_capacity(count),
        };
        Self { mesh, slots: vec![0; slots] }
    }

    /// The vertex at `p`, an old one where there is one.
    pub(crate) fn vertex(&mut self, p: Point3) -> u32 {
        // Adding zero makes -0 and 0 the same bits.
        let p = p + Point3::ZERO;
        let mask = self.slots.len() - 1;
        let mut at = hash(p) & mask;
        while self.slots[at] != 0 {
            let vertex = self.slots[at] - 1;
            if self.mesh.vertices[vertex as usize] == p {
                return vertex;
            }
            at = (at + 1) & mask;
        }
        self.mesh.vertices.push(p);
        let count = self.mesh.vertices.len();
        self.slots[at] = count as u32;
        if count * 2 > self.slots.len() {
            self.grow();
        }
        (count - 1) as u32
    }

    pub(crate) fn triangle(&mut self, corners: [Point3; 3]) {
        let [a, b, c] = corners.map(|p| self.vertex(p));
        if a != b && b != c && c != a {
            self.mesh.triangles.push([a, b, c]);
        }
    }

    pub(crate) fn finish(self) -> TriangleMesh {
        self.mesh
    }

    fn grow(&mut self) {
        let mask = self.slots.len() * 2 - 1;
        self.slots = vec![0; mask + 1];
        for (i, p) in self.mesh.vertices.iter().enumerate() {
            let mut at = hash(*p) & mask;
            while self.slots[at] != 0 {
                at = (at + 1) & mask;
            }
            self.slots[at] = i as u32 + 1;
        }
    }
}

fn hash(p: Point3) -> usize {
    // Multiplying by odd constants of many bits, then folding the high half down: coordinates
    // that were f32 have only zeros in their low bits.
    let mut h = p.x.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15);
    h = (h ^ (h >> 32) ^ p.y.to_bits()).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    h = (h ^ (h >> 32) ^ p.z.to_bits()).wrapping_mul(0xA076_1D64_78BD_642F);
    (h ^ (h >> 32)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_corners_become_one_vertex_in_order_of_first_use() {
        let mut welder = Welder::with_triangles(0);
        for i in 0..100 {
            let x = f64::from(i);
            let p = |dx: f64, y: f64| Point3::new(x + dx, y, -0.0);
            welder.triangle([p(0.0, 0.0), p(1.0, 0.0), p(0.0, 1.0)]);
            welder.triangle([p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]);
            welder.triangle([p(1.0, 0.0), Point3::new(x + 1.0, -0.0, 0.0), p(0.0, 1.0)]);
        }
        let mesh = welder.finish();
        assert_eq!(mesh.vertices.len(), 202);
        assert_eq!(mesh.triangles.len(), 200, "those without area are left out");
        assert_eq!(mesh.triangles[..3], [[0, 1, 2], [1, 3, 2], [1, 4, 3]]);
    }
}
