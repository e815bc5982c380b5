use crate::contact::side;
use fgm_core::{Point2, Polygon, Ring};

/// Edges a strip holds on average before more strips are made.
const EDGES_A_STRIP: usize = 8;
const MOST_STRIPS: usize = 1 << 16;

/// Puts closed rings that do not cross into polygons by how many others hold them: even depths
/// are outer rings, odd ones holes of the ring around them. Their direction is set to match:
/// outer rings anticlockwise, holes clockwise.
///
/// Rings of fewer than three points or no area are dropped. Polygons come in the order of their
/// outer rings. About O(n log n) for rings as contours give.
pub fn nest(rings: Vec<Ring>) -> Vec<Polygon> {
    let rings: Vec<Ring> =
        rings.into_iter().filter(|r| r.points.len() > 2 && r.area() != 0.0).collect();
    let around = containing(&rings);
    let kept: Vec<_> = around.iter().map(|a| Some(a.len() % 2 == 1)).collect();
    assemble(rings, &around, &kept)
}

/// Makes polygons: `hole` says for each ring whether it is one, or none that it is no border.
pub(crate) fn assemble(
    rings: Vec<Ring>,
    around: &[Vec<u32>],
    hole: &[Option<bool>],
) -> Vec<Polygon> {
    let areas: Vec<f64> = rings.iter().map(|r| r.area().abs()).collect();
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut place: Vec<Option<usize>> = vec![None; rings.len()];
    let mut holes = Vec::new();
    for (k, mut ring) in rings.into_iter().enumerate() {
        let Some(is_hole) = hole[k] else { continue };
        if (ring.area() > 0.0) == is_hole {
            ring.reverse();
        }
        if is_hole {
            holes.push((k, ring));
        } else {
            place[k] = Some(polygons.len());
            polygons.push(Polygon::simple(ring));
        }
    }
    for (k, ring) in holes {
        let outers = around[k].iter().filter(|&&o| hole[o as usize] == Some(false));
        let parent = outers.min_by(|&&a, &&b| areas[a as usize].total_cmp(&areas[b as usize]));
        if let Some(slot) = parent.and_then(|&p| place[p as usize]) {
            polygons[slot].holes.push(ring);
        }
    }
    polygons
}

/// For each ring, the others that hold it.
pub(crate) fn containing(rings: &[Ring]) -> Vec<Vec<u32>> {
    if rings.len() < 2 {
        return vec![Vec::new(); rings.len()];
    }
    let strips = Strips::new(rings);
    let mut parity = vec![false; rings.len()];
    let mut touched = Vec::new();
    let mut held_by = |k: usize, ring: &Ring| {
        let mut answer = Vec::new();
        for &p in &ring.points {
            touched.clear();
            let clear = strips.parities(rings, k, p, &mut parity, &mut touched);
            answer.clear();
            for &t in &touched {
                if std::mem::take(&mut parity[t as usize]) {
                    answer.push(t);
                }
            }
            // A vertex on another ring's border tells nothing; the next one may.
            if clear {
                break;
            }
        }
        answer.sort_unstable();
        answer.dedup();
        answer
    };
    rings.iter().enumerate().map(|(k, ring)| held_by(k, ring)).collect()
}

/// The edges of rings by the upright strips of the plane that they pass through.
struct Strips {
    start: f64,
    width: f64,
    /// For each strip, where its edges begin in `edges`.
    offsets: Vec<u32>,
    /// Ring and first vertex.
    edges: Vec<(u32, u32)>,
}

impl Strips {
    fn new(rings: &[Ring]) -> Self {
        let total: usize = rings.iter().map(|r| r.points.len()).sum();
        let xs = || rings.iter().flat_map(|r| &r.points).map(|p| p.x);
        let (lo, hi) =
            xs().fold((f64::INFINITY, f64::NEG_INFINITY), |b, x| (b.0.min(x), b.1.max(x)));
        let count = (total / EDGES_A_STRIP).clamp(1, MOST_STRIPS);
        let mut strips = Self {
            start: lo,
            width: (hi - lo) / count as f64,
            offsets: vec![0; count + 1],
            edges: Vec::new(),
        };
        let all = || {
            rings.iter().enumerate().flat_map(|(k, r)| {
                r.edges().enumerate().map(move |(e, (a, b))| (k as u32, e as u32, a.x, b.x))
            })
        };
        for (_, _, a, b) in all() {
            for s in strips.index(a.min(b))..=strips.index(a.max(b)) {
                strips.offsets[s + 1] += 1;
            }
        }
        for s in 0..count {
            strips.offsets[s + 1] += strips.offsets[s];
        }
        let mut next = strips.offsets.clone();
        strips.edges.resize(strips.offsets[count] as usize, (0, 0));
        for (ring, edge, a, b) in all() {
            for slot in &mut next[strips.index(a.min(b))..=strips.index(a.max(b))] {
                strips.edges[*slot as usize] = (ring, edge);
                *slot += 1;
            }
        }
        strips
    }

    fn index(&self, x: f64) -> usize {
        (((x - self.start) / self.width) as usize).min(self.offsets.len() - 2)
    }

    /// Flips the parity of each ring but `own` for every edge of it below `p`; answers whether
    /// `p` lies on none of them.
    fn parities(
        &self,
        rings: &[Ring],
        own: usize,
        p: Point2,
        parity: &mut [bool],
        touched: &mut Vec<u32>,
    ) -> bool {
        let strip = self.index(p.x);
        let range = self.offsets[strip] as usize..self.offsets[strip + 1] as usize;
        for &(ring, edge) in &self.edges[range] {
            if ring as usize == own {
                continue;
            }
            let points = &rings[ring as usize].points;
            let (a, b) = (points[edge as usize], points[(edge as usize + 1) % points.len()]);
            let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
            if p.x < a.x || p.x > b.x || p.y < a.y.min(b.y) {
                continue;
            }
            let above = side(a, b, p);
            if above == 0.0 && p.y <= a.y.max(b.y) {
                return false;
            }
            // Half open, so that a vertex shared by two edges counts once.
            if above > 0.0 && p.x < b.x {
                parity[ring as usize] = !parity[ring as usize];
                touched.push(ring);
            }
        }
        true
    }
}
