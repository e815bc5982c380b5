use fgm_core::{Bounds2, Point2};

/// Why a contour, a grid or a mesh cannot be worked on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContourError {
    /// The window is empty, flat or not finite.
    #[error(
        "the window from ({}, {}) to ({}, {}) has no finite, positive size",
        window.min.x, window.min.y, window.max.x, window.max.y
    )]
    Window {
        /// The window asked for.
        window: Bounds2,
    },
    /// An option is out of its range.
    #[error("{option} is {value}, where {limit} is asked for")]
    Option {
        /// The field of [`crate::ContourOptions`] or of the grid.
        option: &'static str,
        /// What it was.
        value: f64,
        /// The range it must be in.
        limit: &'static str,
    },
    /// A level is NaN or infinite.
    #[error("level {index} is {value}")]
    Level {
        /// Which, from 0.
        index: usize,
        /// What it was.
        value: f64,
    },
    /// More levels than one sweep takes.
    #[error("{count} levels, where at most {limit} are possible at a time")]
    TooManyLevels {
        /// How many were asked for.
        count: usize,
        /// [`crate::MAX_LEVELS`].
        limit: usize,
    },
    /// The window has more cells than the limit.
    #[error("{columns} x {rows} cells, where at most {limit} a side are possible")]
    TooManyCells {
        /// Cells along x.
        columns: f64,
        /// Cells along y.
        rows: f64,
        /// [`crate::MAX_CELLS_A_SIDE`].
        limit: u32,
    },
    /// The contour crosses the lattice more often than the limit.
    #[error("more than {limit} crossings of the lattice")]
    TooManyCrossings {
        /// [`crate::MAX_CROSSINGS`].
        limit: usize,
    },
    /// The field has no value at a point.
    #[error("the field is not a number at ({}, {})", at.x, at.y)]
    NotANumber {
        /// Where, mm.
        at: Point2,
    },
    /// The field's bounds exclude a value that it takes: a region's border ends in the open.
    #[error("the field's bounds around ({}, {}) exclude values that it takes", at.x, at.y)]
    FalseBounds {
        /// Where the border ends, mm.
        at: Point2,
    },
    /// A grid's values do not fill its rows and columns.
    #[error("{values} values for {columns} columns and {rows} rows of two or more each")]
    GridSize {
        /// How many values there are.
        values: usize,
        /// Samples along x.
        columns: usize,
        /// Samples along y.
        rows: usize,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error("triangle {triangle} names vertex {vertex} of {count}")]
    VertexOutOfRange {
        /// Which triangle, from 0.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A vertex that a triangle uses is NaN or infinite.
    #[error("vertex {vertex} of triangle {triangle} is not finite")]
    VertexNotFinite {
        /// Which triangle, from 0.
        triangle: usize,
        /// Which vertex.
        vertex: u32,
    },
    /// More triangles than the limit.
    #[error("{count} triangles, where at most {limit} are possible")]
    TooManyTriangles {
        /// How many there are.
        count: usize,
        /// [`crate::MAX_TRIANGLES`].
        limit: usize,
    },
}
