use super::weld::Welded;

/// Entries of all slabs together, a triangle.
const ENTRIES: f64 = 3.0;
const MOST_SLABS: f64 = 65536.0;

/// The triangles by the level slabs of space that they reach, so that a plane asks only those
/// near it.
#[derive(Debug, Default)]
pub(crate) struct Slabs {
    bottom: f64,
    top: f64,
    height: f64,
    offsets: Vec<u32>,
    triangles: Vec<u32>,
}

impl Slabs {
    pub(crate) fn new(mesh: &Welded) -> Self {
        let spans: Vec<(f64, f64)> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| mesh.vertices[v as usize].z);
                (a.min(b).min(c), a.max(b).max(c))
            })
            .collect();
        let whole = (f64::INFINITY, f64::NEG_INFINITY);
        let (bottom, top) = spans.iter().fold(whole, |w, s| (w.0.min(s.0), w.1.max(s.1)));
        let total: f64 = spans.iter().map(|s| s.1 - s.0).sum();
        let n = spans.len() as f64;
        // As many slabs as keep the entries near a few a triangle, however tall those are.
        let count = (ENTRIES * n * (top - bottom) / total).clamp(1.0, MOST_SLABS.min(n.max(1.0)));
        let count = if count.is_nan() { 1 } else { count as usize };
        let height = (top - bottom) / count as f64;
        let mut slabs =
            Self { bottom, top, height, offsets: vec![0; count + 1], triangles: Vec::new() };
        for &(lo, hi) in &spans {
            for s in slabs.index(lo)..=slabs.index(hi) {
                slabs.offsets[s + 1] += 1;
            }
        }
        for s in 0..count {
            slabs.offsets[s + 1] += slabs.offsets[s];
        }
        let mut next = slabs.offsets.clone();
        slabs.triangles.resize(slabs.offsets[count] as usize, 0);
        for (t, &(lo, hi)) in spans.iter().enumerate() {
            for slot in &mut next[slabs.index(lo)..=slabs.index(hi)] {
                slabs.triangles[*slot as usize] = t as u32;
                *slot += 1;
            }
        }
        slabs
    }

    fn index(&self, z: f64) -> usize {
        (((z - self.bottom) / self.height) as usize).min(self.offsets.len() - 2)
    }

    /// The triangles that a plane may cut, in order.
    pub(crate) fn at(&self, z: f64) -> &[u32] {
        if !(self.bottom <= z && z <= self.top) {
            return &[];
        }
        let s = self.index(z);
        &self.triangles[self.offsets[s] as usize..self.offsets[s + 1] as usize]
    }
}
