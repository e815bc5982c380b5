use fgm_core::{ColorId, Point2, Role};

/// A line to be printed, before it has a colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The vertices; a closed path does not repeat the first.
    pub points: Vec<Point2>,
    /// Whether the last point joins the first.
    pub closed: bool,
    /// What the bead is for.
    pub role: Role,
    /// Width of the bead, mm.
    pub width: f64,
    /// Its place among its neighbours (second wall, third infill line): a zipper alternates by it.
    pub turn: u32,
}

/// A line to be printed in one colour, from its first point to its last.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The vertices; where the piece is a whole loop the last equals the first.
    pub points: Vec<Point2>,
    /// What the bead is for.
    pub role: Role,
    /// Width of the bead, mm.
    pub width: f64,
    /// What it is printed with.
    pub color: ColorId,
}
