//! The solids that need no formula. Signed distances, exact everywhere, mm.

use fgm_core::{Bounds3, Field, Interval, Point2, Point3};

use crate::math;
use crate::tape::interval::{abs, widened};

/// A ball around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its radius, mm.
    pub radius: f64,
}

/// A box around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The full lengths of its sides, mm.
    pub size: Point3,
}

/// A cylinder around the z axis that stands on z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Its radius, mm.
    pub radius: f64,
    /// Its height, mm.
    pub height: f64,
}

/// A cone around the z axis that stands on z = 0, or a frustum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Its radius at z = 0, mm.
    pub bottom: f64,
    /// Its radius at the top, mm; 0 for a point.
    pub top: f64,
    /// Its height, mm.
    pub height: f64,
}

/// A ring around the z axis, its middle in the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// From the axis to the middle of the tube, mm.
    pub major: f64,
    /// The radius of the tube, mm.
    pub minor: f64,
}

/// A cylinder around the z axis with hemispheres at both ends, that stands on z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Its radius, mm.
    pub radius: f64,
    /// Its height with the hemispheres, mm. Below twice the radius the whole is a sphere.
    pub height: f64,
}

/// All that lies behind a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Out of the solid; of length 1.
    pub normal: Point3,
    /// Of the plane along the normal, mm: the solid is where `normal . p <= offset`.
    pub offset: f64,
}

/// The distance of a point from the corner of a convex solid, by its distances beyond the faces.
fn beyond(faces: [f64; 2]) -> f64 {
    let [a, b] = faces;
    math::hypot(a.max(0.0), b.max(0.0)) + a.max(b).min(0.0)
}

/// The range of distances from the z axis in a box.
fn radii(cell: &Bounds3) -> Interval {
    let (x, y) = (abs(cell.x()), abs(cell.y()));
    Interval::new(math::hypot(x.lo, y.lo), math::hypot(x.hi, y.hi))
}

/// The range of a function that grows with both of its arguments, with room for rounding.
fn growing(a: Interval, b: Interval, f: impl Fn(f64, f64) -> f64) -> Interval {
    roomy(Interval::new(f(a.lo, b.lo), f(a.hi, b.hi)), a.hi.abs() + b.hi.abs())
}

/// A range with room for the rounding of numbers up to `size`; everything for an empty box.
fn roomy(range: Interval, size: f64) -> Interval {
    let room = size * 1e-15;
    let range = widened(Interval::new(range.lo - room, range.hi + room));
    if range.lo <= range.hi { range } else { Interval::EVERYTHING }
}

impl Field for Sphere {
    fn eval(&self, p: Point3) -> f64 {
        p.length() - self.radius
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        growing(radii(cell), abs(cell.z()), |rho, z| math::hypot(rho, z) - self.radius)
    }
}

impl Cuboid {
    /// By the distances from the middle along the axes.
    fn distance(&self, sizes: Point3) -> f64 {
        let q = sizes - self.size * 0.5;
        q.max(Point3::ZERO).length() + q.max_element().min(0.0)
    }
}

impl Field for Cuboid {
    fn eval(&self, p: Point3) -> f64 {
        self.distance(p.abs())
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let (x, y, z) = (abs(cell.x()), abs(cell.y()), abs(cell.z()));
        let (lo, hi) = (Point3::new(x.lo, y.lo, z.lo), Point3::new(x.hi, y.hi, z.hi));
        roomy(Interval::new(self.distance(lo), self.distance(hi)), hi.max_element())
    }
}

impl Cylinder {
    fn distance(&self, rho: f64, off_middle: f64) -> f64 {
        beyond([rho - self.radius, off_middle - 0.5 * self.height])
    }
}

impl Field for Cylinder {
    fn eval(&self, p: Point3) -> f64 {
        self.distance(math::hypot(p.x, p.y), (p.z - 0.5 * self.height).abs())
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let half = 0.5 * self.height;
        let off_middle = abs(Interval::new(cell.min.z - half, cell.max.z - half));
        growing(radii(cell), off_middle, |rho, off| self.distance(rho, off))
    }
}

impl Cone {
    fn distance(&self, rho: f64, z: f64) -> f64 {
        let (bottom, top) = (Point2::new(self.bottom, 0.0), Point2::new(self.top, self.height));
        let p = Point2::new(rho, z);
        let slope = top - bottom;
        let along = ((p - bottom).dot(slope) / slope.length_squared()).clamp(0.0, 1.0);
        let side = p.distance(bottom + slope * along);
        let cap = |radius: f64, height: f64| math::hypot((rho - radius).max(0.0), z - height);
        let distance = side.min(cap(self.bottom, 0.0)).min(cap(self.top, self.height));
        let inside = z > 0.0 && z < self.height && slope.perp_dot(p - bottom) > 0.0;
        if inside { -distance } else { distance }
    }
}

impl Field for Cone {
    fn eval(&self, p: Point3) -> f64 {
        self.distance(math::hypot(p.x, p.y), p.z)
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let (rho, z) = (radii(cell), cell.z());
        // Convex, hence growing with rho, and greatest at an end of z; the least by its slope,
        // which is at most 1.
        let greatest = self.distance(rho.hi, z.lo).max(self.distance(rho.hi, z.hi));
        let ends = self.distance(rho.lo, z.lo) + self.distance(rho.lo, z.hi);
        let least = 0.5 * (ends - z.width());
        roomy(Interval::new(least, greatest), rho.hi + z.lo.abs().max(z.hi.abs()) + self.height)
    }
}

impl Field for Torus {
    fn eval(&self, p: Point3) -> f64 {
        math::hypot(math::hypot(p.x, p.y) - self.major, p.z) - self.minor
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let rho = radii(cell);
        let off_middle = abs(Interval::new(rho.lo - self.major, rho.hi - self.major));
        growing(off_middle, abs(cell.z()), |off, z| math::hypot(off, z) - self.minor)
    }
}

impl Capsule {
    fn distance(&self, rho: f64, off_middle: f64) -> f64 {
        let straight = (0.5 * self.height - self.radius).max(0.0);
        math::hypot(rho, (off_middle - straight).max(0.0)) - self.radius
    }

    /// The height of its middle.
    fn middle(&self) -> f64 {
        self.radius.max(0.5 * self.height)
    }
}

impl Field for Capsule {
    fn eval(&self, p: Point3) -> f64 {
        self.distance(math::hypot(p.x, p.y), (p.z - self.middle()).abs())
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let middle = self.middle();
        let off_middle = abs(Interval::new(cell.min.z - middle, cell.max.z - middle));
        growing(radii(cell), off_middle, |rho, off| self.distance(rho, off))
    }
}

impl Field for HalfSpace {
    fn eval(&self, p: Point3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        let (a, b) = (self.normal * cell.min, self.normal * cell.max);
        let (lo, hi) = (a.min(b).element_sum(), a.max(b).element_sum());
        let size = a.abs().max(b.abs()).element_sum() + self.offset.abs();
        roomy(Interval::new(lo - self.offset, hi - self.offset), size)
    }
}
