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
    /// The places of the single segments where they differ, as in infill lines joined along the
    /// border; empty where every segment has `turn`. A segment past the end has `turn`.
    pub turns: Vec<u32>,
}

impl Path {
    /// The place of segment `index` among its neighbours.
    pub fn turn_of(&self, index: usize) -> u32 {
        self.turns.get(index).copied().unwrap_or(self.turn)
    }

    /// The whole path in one colour; a closed one becomes a piece that ends where it begins.
    pub fn in_color(self, color: ColorId) -> Piece {
        let Self { mut points, closed, role, width, .. } = self;
        if closed {
            points.extend(points.first().copied());
        }
        Piece { points, role, width, color }
    }

    /// Length, mm, all the way round where closed.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        match (self.points.first(), self.points.last()) {
            (Some(a), Some(b)) if self.closed => open + a.distance(*b),
            _ => open,
        }
    }
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

impl Piece {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Whether it ends where it begins.
    pub fn is_loop(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }
}
