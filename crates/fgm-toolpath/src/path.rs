use fgm_core::{ColorId, Point2, Role};

use crate::inset::simplify;

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
        Piece::new(points, role, width, color)
    }

    /// The path without the vertices that lie within `tolerance` mm of a line past them; as it is
    /// with a tolerance of 0.
    ///
    /// Offsets keep every vertex of the border they come from and add their own; a printer neither
    /// needs nor keeps up with them. Lines joined along a border are left as they are: their
    /// segments have [places](Path::turns) of their own. So is a loop no wider than the tolerance.
    #[must_use]
    pub fn simplified(mut self, tolerance: f64) -> Self {
        if !(tolerance > 0.0 && self.points.len() >= 4 && self.turns.is_empty()) {
            return self;
        }
        let mut points = Vec::with_capacity(self.points.len());
        simplify::line(&self.points, self.closed, tolerance, &mut points);
        if !self.closed || points.len() >= 3 {
            self.points = points;
        }
        self
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
    /// How the nozzle travels to it: from the first of these points, the end of the piece before,
    /// over the others to the piece's first point; straight where it comes from anywhere else, or
    /// this is empty.
    pub way: Vec<Point2>,
}

impl Piece {
    /// A piece that is travelled to straight.
    pub fn new(points: Vec<Point2>, role: Role, width: f64, color: ColorId) -> Self {
        Self { points, role, width, color, way: Vec::new() }
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// The piece up to a length, mm, and the rest of it: one of them without a point where the
    /// length is not inside the piece.
    pub fn split(mut self, length: f64) -> (Self, Self) {
        let mut left = length;
        let mut cut = self.points.len();
        if left <= 0.0 {
            cut = 0;
        } else {
            for i in 1..self.points.len() {
                let (a, b) = (self.points[i - 1], self.points[i]);
                let step = a.distance(b);
                if left < step {
                    self.points.insert(i, a.lerp(b, left / step));
                    cut = i;
                    break;
                }
                if left == step && i + 1 < self.points.len() {
                    cut = i;
                    break;
                }
                left -= step;
            }
        }
        let Self { role, width, color, .. } = self;
        let mut rest = self.points.split_off(cut);
        if cut > 0 && !rest.is_empty() {
            self.points.extend(rest.first());
        }
        rest.shrink_to_fit();
        (self, Self::new(rest, role, width, color))
    }

    /// Whether it ends where it begins.
    pub fn is_loop(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_and_lines_lose_what_is_straight_and_keep_their_length() {
        let points: Vec<Point2> =
            (0..400).map(|i| 20.0 * Point2::from_angle(f64::from(i) * 0.015)).collect();
        for closed in [false, true] {
            let path = Path {
                points: points.clone(),
                closed,
                role: Role::InnerWall,
                width: 0.4,
                turn: 0,
                turns: Vec::new(),
            };
            let simple = path.clone().simplified(0.005);
            assert!(simple.points.len() < 200, "{}", simple.points.len());
            assert!((simple.length() / path.length() - 1.0).abs() < 1e-3);
            let off = |p: &Point2| (p.length() - 20.0).abs();
            assert!(simple.points.iter().all(|p| off(p) < 0.0051));
            assert_eq!(path.clone().simplified(0.0), path);
        }
    }

    #[test]
    fn a_piece_is_cut_in_two() {
        let at = |x: f64| Point2::new(x, 0.0);
        let piece = Piece {
            points: vec![at(0.0), at(4.0), at(6.0)],
            role: Role::Infill,
            width: 0.4,
            way: Vec::new(),
            color: ColorId(3),
        };
        for (length, first, rest) in [
            (-1.0, vec![], vec![0.0, 4.0, 6.0]),
            (0.0, vec![], vec![0.0, 4.0, 6.0]),
            (1.0, vec![0.0, 1.0], vec![1.0, 4.0, 6.0]),
            (4.0, vec![0.0, 4.0], vec![4.0, 6.0]),
            (5.0, vec![0.0, 4.0, 5.0], vec![5.0, 6.0]),
            (6.0, vec![0.0, 4.0, 6.0], vec![]),
            (9.0, vec![0.0, 4.0, 6.0], vec![]),
        ] {
            let (one, other) = piece.clone().split(length);
            let xs = |piece: &Piece| piece.points.iter().map(|p| p.x).collect::<Vec<_>>();
            assert_eq!((xs(&one), xs(&other)), (first, rest), "{length}");
            assert_eq!((one.color, other.role), (piece.color, piece.role));
        }
    }
}
