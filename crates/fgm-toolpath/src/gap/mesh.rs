//! The triangles inside a polygon.

use super::{
    flip::flip,
    ribbon::{annulus, ribbon},
};
use fgm_core::{Point2, Polygon};
use spade::{ConstrainedDelaunayTriangulation, Triangulation};

/// No neighbour: the edge is the border.
pub(super) const BORDER: u32 = u32::MAX;

/// A triangle, anticlockwise; edge `i` runs from corner `i` to corner `i + 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [Point2; 3],
    /// The triangle across each edge, or [`BORDER`].
    pub(super) across: [u32; 3],
}

impl Triangle {
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).perp_dot(c - a)
    }

    pub(super) fn center(&self) -> Point2 {
        (self.corners[0] + self.corners[1] + self.corners[2]) / 3.0
    }

    /// Which edge leads to triangle `to`.
    pub(super) fn edge_to(&self, to: u32) -> Option<usize> {
        self.across.iter().position(|&t| t == to)
    }
}

/// A constrained Delaunay triangulation of a polygon, without what lies outside.
pub(super) struct Mesh {
    pub(super) triangles: Vec<Triangle>,
}

impl Mesh {
    /// Triangulates, after cutting border edges to `longest` mm at most.
    ///
    /// Most polygons that are thin are ribbons, no wider anywhere than `widest`, and need no
    /// search.
    pub(super) fn new(polygon: &Polygon, longest: f64, widest: f64) -> Self {
        let mut vertices = Vec::new();
        let mut starts = Vec::new();
        for ring in polygon.rings() {
            starts.push(vertices.len());
            for (a, b) in ring.edges() {
                let parts = (a.distance(b) / longest).ceil().clamp(1.0, 1e4) as usize;
                let part = |i: usize| a + (b - a) * (i as f64 / parts as f64);
                vertices.extend((0..parts).map(part));
            }
        }
        let quick = match starts[..] {
            [_] => ribbon(&vertices, widest),
            [_, hole] => annulus(&vertices[..hole], &vertices[hole..], widest),
            _ => None,
        };
        let quick = quick.and_then(flip);
        Self { triangles: quick.unwrap_or_else(|| delaunay(&vertices, &starts)) }
    }

    /// Area of all triangles, mm².
    pub(super) fn area(&self) -> f64 {
        self.triangles.iter().map(Triangle::area).sum()
    }
}

/// The triangulation of rings that begin at `starts`.
fn delaunay(vertices: &[Point2], starts: &[usize]) -> Vec<Triangle> {
    let mut edges = Vec::with_capacity(vertices.len());
    for (ring, &first) in starts.iter().enumerate() {
        let end = starts.get(ring + 1).copied().unwrap_or(vertices.len());
        edges.extend((first..end).map(|i| [i, if i + 1 < end { i + 1 } else { first }]));
    }
    let vertices = vertices.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    // Borders that touch may conflict by rounding; a lost border edge costs one gap its filling
    // and no more.
    match ConstrainedDelaunayTriangulation::try_bulk_load_cdt(vertices, edges, |_| {}) {
        Ok(cdt) => inside(&cdt),
        Err(_) => Vec::new(),
    }
}

/// The triangles an odd number of borders away from the outer face.
fn inside(cdt: &ConstrainedDelaunayTriangulation<spade::Point2<f64>>) -> Vec<Triangle> {
    const UNSEEN: u8 = 2;
    let mut state = vec![UNSEEN; cdt.num_all_faces()];
    let outer = cdt.outer_face().fix().index();
    state[outer] = 0;
    let mut stack: Vec<usize> = Vec::new();
    for edge in cdt.convex_hull() {
        let inner = edge.rev().face().fix().index();
        if state[inner] == UNSEEN {
            state[inner] = u8::from(edge.is_constraint_edge());
            stack.push(inner);
        }
    }
    let faces: Vec<_> = cdt.inner_faces().collect();
    // Inner faces are numbered from 1, after the outer one.
    while let Some(index) = stack.pop() {
        let Some(face) = index.checked_sub(1).and_then(|i| faces.get(i)) else { continue };
        for edge in face.adjacent_edges() {
            let next = edge.rev().face().fix().index();
            if state[next] == UNSEEN {
                state[next] = state[index] ^ u8::from(edge.is_constraint_edge());
                stack.push(next);
            }
        }
    }
    let mut number = vec![BORDER; state.len()];
    let mut count = 0;
    for (index, &state) in state.iter().enumerate() {
        if index != outer && state == 1 {
            number[index] = count;
            count += 1;
        }
    }
    let kept = faces.iter().filter(|f| number[f.fix().index()] != BORDER);
    kept.map(|face| {
        let corners = face.positions().map(|p| Point2::new(p.x, p.y));
        let across = face.adjacent_edges().map(|e| {
            let open = !e.is_constraint_edge();
            if open { number[e.rev().face().fix().index()] } else { BORDER }
        });
        Triangle { corners, across }
    })
    .collect()
}
