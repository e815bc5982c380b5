use crate::{Bounds2, Point2};

/// A closed line: the last point joins the first, which is not repeated.
///
/// Anticlockwise rings (positive area) enclose, clockwise rings are holes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ring {
    /// The vertices in order.
    pub points: Vec<Point2>,
}

/// An open line of two or more points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyline {
    /// The vertices in order.
    pub points: Vec<Point2>,
}

/// A region: an anticlockwise outer ring, less clockwise holes inside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The outer border.
    pub outer: Ring,
    /// The holes, in no particular order.
    pub holes: Vec<Ring>,
}

impl Ring {
    /// A ring through these points.
    pub fn new(points: Vec<Point2>) -> Self {
        Self { points }
    }

    /// The edges, the closing one included.
    pub fn edges(&self) -> impl Iterator<Item = (Point2, Point2)> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().copied().zip(next.copied())
    }

    /// Enclosed area, mm²: positive anticlockwise.
    ///
    /// Taken relative to the first vertex, so that a small ring far from the origin keeps its
    /// digits.
    pub fn area(&self) -> f64 {
        let Some(&origin) = self.points.first() else { return 0.0 };
        self.edges().map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>() * 0.5
    }

    /// Length all the way round, mm.
    pub fn length(&self) -> f64 {
        self.edges().map(|(a, b)| a.distance(b)).sum()
    }

    /// The least rectangle around it.
    pub fn bounds(&self) -> Bounds2 {
        Bounds2::of(self.points.iter().copied())
    }

    /// Whether `p` lies inside by the even-odd rule. On the border either answer is possible.
    pub fn contains(&self, p: Point2) -> bool {
        self.edges().fold(false, |inside, (a, b)| {
            let crosses =
                (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            inside != crosses
        })
    }

    /// Runs the other way round.
    pub fn reverse(&mut self) {
        self.points.reverse();
    }
}

impl Polyline {
    /// A line through these points.
    pub fn new(points: Vec<Point2>) -> Self {
        Self { points }
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// The least rectangle around it.
    pub fn bounds(&self) -> Bounds2 {
        Bounds2::of(self.points.iter().copied())
    }
}

impl Polygon {
    /// A region without holes.
    pub fn simple(outer: Ring) -> Self {
        Self { outer, holes: Vec::new() }
    }

    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Area less the holes', mm².
    pub fn area(&self) -> f64 {
        self.rings().map(Ring::area).sum()
    }

    /// The least rectangle around it.
    pub fn bounds(&self) -> Bounds2 {
        self.outer.bounds()
    }

    /// Whether `p` lies inside the outer ring and in no hole.
    pub fn contains(&self, p: Point2) -> bool {
        self.outer.contains(p) && !self.holes.iter().any(|h| h.contains(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Ring {
        Ring::new(
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| Point2::new(x * half, y * half))
                .into(),
        )
    }

    #[test]
    fn areas_lengths_and_insides() {
        let mut hole = square(1.0);
        hole.reverse();
        let region = Polygon { outer: square(2.0), holes: vec![hole] };
        assert_eq!(region.area(), 12.0);
        assert_eq!(region.outer.length(), 16.0);
        assert!(region.contains(Point2::new(1.5, 0.0)));
        assert!(!region.contains(Point2::new(0.5, 0.0)));
        assert_eq!(Ring::default().area(), 0.0);
    }
}
