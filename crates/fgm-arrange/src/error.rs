use crate::{EdgeId, FaceId, VertexId};

/// Why chains could not be arranged.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ArrangeError {
    /// The lattice step is of no use.
    #[error("lattice step {step} mm: must be a normal number from {least:e} to {greatest:e} mm")]
    Lattice {
        /// The step asked for, mm.
        step: f64,
        /// The least step allowed, mm.
        least: f64,
        /// The greatest step allowed, mm.
        greatest: f64,
    },
    /// A coordinate is NaN or infinite.
    #[error("chain {chain}, point {point}: ({x}, {y}) is not finite")]
    NotFinite {
        /// Index of the chain in the input.
        chain: usize,
        /// Index of the point in the chain.
        point: usize,
        /// The coordinate, mm.
        x: f64,
        /// The coordinate, mm.
        y: f64,
    },
    /// A coordinate is too far from the origin for exact arithmetic on this lattice.
    #[error(
        "chain {chain}, point {point}: ({x}, {y}) lies outside +-{limit} mm, the range of a lattice of {step} mm"
    )]
    OutOfRange {
        /// Index of the chain in the input.
        chain: usize,
        /// Index of the point in the chain.
        point: usize,
        /// The coordinate, mm.
        x: f64,
        /// The coordinate, mm.
        y: f64,
        /// The greatest coordinate allowed, mm.
        limit: f64,
        /// The lattice step, mm.
        step: f64,
    },
    /// More points or crossings than 32-bit handles can name.
    #[error("{count} {what}: at most {limit}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many there are, at least.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
}

/// An invariant that an arrangement breaks: always a defect of this crate.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Invalid {
    /// Two edges share a point that is not an end of both.
    #[error("edges {a:?} and {b:?} meet away from their ends, near ({x}, {y}) mm")]
    EdgesMeet {
        /// One edge.
        a: EdgeId,
        /// The other, or the same.
        b: EdgeId,
        /// Where, mm.
        x: f64,
        /// Where, mm.
        y: f64,
    },
    /// An edge's line does not run between its vertices, or repeats a point.
    #[error("edge {edge:?} is not a line between its vertices")]
    BrokenEdge {
        /// The edge.
        edge: EdgeId,
    },
    /// The half-edges around a vertex are not in order, or two of them have one direction.
    #[error("half-edges around vertex {vertex:?} are out of order")]
    Rotation {
        /// The vertex.
        vertex: VertexId,
    },
    /// A half-edge does not lie in exactly one cycle of one face.
    #[error("half-edge {half_edge} is not in one cycle of one face")]
    Cycle {
        /// Index of the half-edge.
        half_edge: u32,
    },
    /// Euler's formula `V - E + F = 1 + C` fails.
    #[error(
        "{vertices} vertices - {edges} edges + {faces} faces is not 1 + {components} components"
    )]
    Euler {
        /// Number of vertices.
        vertices: usize,
        /// Number of edges.
        edges: usize,
        /// Number of faces, the unbounded one included.
        faces: usize,
        /// Number of connected components.
        components: usize,
    },
    /// The faces' areas do not sum to the area enclosed.
    #[error("faces sum to {faces} mm², the outer borders enclose {enclosed} mm²")]
    Area {
        /// Sum of the faces' areas, mm².
        faces: f64,
        /// Area inside the outer borders, mm².
        enclosed: f64,
    },
    /// A face's polygon has another area than the face.
    #[error("face {face:?} has {area} mm², its polygon {polygon} mm²")]
    Polygon {
        /// The face.
        face: FaceId,
        /// Area of the face, mm².
        area: f64,
        /// Area of its polygon, mm².
        polygon: f64,
    },
    /// A face's inside point lies elsewhere.
    #[error("the inside point ({x}, {y}) of face {face:?} is not inside")]
    InsidePoint {
        /// The face.
        face: FaceId,
        /// The point, mm.
        x: f64,
        /// The point, mm.
        y: f64,
    },
}
