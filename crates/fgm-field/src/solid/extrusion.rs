//! Polygons drawn up along z.

use fgm_core::{Bounds2, Bounds3, Field, Interval, PlanarField, Point2, Point3, Polygon};

use crate::math;

/// A polygon, with holes if it has some, that stands on z = 0. A signed distance, exact everywhere;
/// inside and outside by the even-odd rule, so that the rings may run either way.
#[derive(Clone, Debug)]
pub struct Extrusion {
    edges: Vec<(Point2, Point2)>,
    bounds: Bounds2,
    height: f64,
}

impl Extrusion {
    /// The polygon between z = 0 and `height`, mm.
    ///
    /// A polygon without area is an empty solid.
    pub fn new(polygon: &Polygon, height: f64) -> Self {
        let edges: Vec<_> = polygon.rings().flat_map(fgm_core::Ring::edges).collect();
        Self { edges, bounds: polygon.bounds(), height }
    }

    /// The signed distance from the border in the plane.
    ///
    /// Both the distance and the side go by one pass over the edges (I. Quilez, "2D distance
    /// functions").
    fn planar(&self, p: Point2) -> f64 {
        let mut least = f64::INFINITY;
        let mut inside = false;
        for &(a, b) in &self.edges {
            let (edge, to_p) = (b - a, p - a);
            let length = edge.length_squared();
            let along = if length > 0.0 { (to_p.dot(edge) / length).clamp(0.0, 1.0) } else { 0.0 };
            least = least.min((to_p - edge * along).length_squared());
            if (a.y > p.y) != (b.y > p.y) {
                let left = edge.perp_dot(to_p) > 0.0;
                inside ^= left == (b.y > a.y);
            }
        }
        let distance = if p.is_nan() { f64::NAN } else { least.sqrt() };
        if inside { -distance } else { distance }
    }

    /// The distance in space, from that in the plane.
    fn raised(&self, planar: f64, off_middle: f64) -> f64 {
        let above = off_middle - 0.5 * self.height;
        math::hypot(planar.max(0.0), above.max(0.0)) + planar.max(above).min(0.0)
    }

    /// The range of distances in the plane: a distance changes by no more than the way.
    fn planar_bounds(&self, cell: &Bounds2) -> Interval {
        let middle = self.planar(cell.center());
        let reach = cell.size().length() * 0.5;
        let room = 1e-14 * (cell.max.abs().max(cell.min.abs()).element_sum() + self.reach());
        let range = Interval::new(middle - reach - room, middle + reach + room);
        if range.lo <= range.hi && !self.edges.is_empty() { range } else { Interval::EVERYTHING }
    }

    fn reach(&self) -> f64 {
        self.bounds.min.abs().max(self.bounds.max.abs()).element_sum()
    }

    fn raised_bounds(&self, planar: Interval, off_middle: Interval) -> Interval {
        if planar == Interval::EVERYTHING {
            return planar;
        }
        let lo = self.raised(planar.lo, off_middle.lo);
        let hi = self.raised(planar.hi, off_middle.hi);
        let room = 1e-14 * (planar.hi.abs() + off_middle.hi + self.height.abs());
        Interval::new(lo - room, hi + room)
    }

    fn off_middle(&self, z: f64) -> f64 {
        (z - 0.5 * self.height).abs()
    }
}

impl Field for Extrusion {
    fn eval(&self, p: Point3) -> f64 {
        self.raised(self.planar(p.truncate()), self.off_middle(p.z))
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let half = 0.5 * self.height;
        let off_middle = Interval::new(cell.min.z - half, cell.max.z - half);
        let off_middle = crate::tape::interval::abs(off_middle);
        self.raised_bounds(self.planar_bounds(&cell.xy()), off_middle)
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        Box::new(Layer { solid: self, off_middle: self.off_middle(z) })
    }
}

struct Layer<'a> {
    solid: &'a Extrusion,
    off_middle: f64,
}

impl PlanarField for Layer<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.solid.raised(self.solid.planar(p), self.off_middle)
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        let planar = self.solid.planar_bounds(cell);
        self.solid.raised_bounds(planar, Interval::point(self.off_middle))
    }
}
