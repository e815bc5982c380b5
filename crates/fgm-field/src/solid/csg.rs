//! Solids from solids.

use fgm_core::{Bounds3, Field, Interval, PlanarField, Point3};

use crate::SharedField;
use crate::math;
use crate::sampled::{Fold, Folded, FoldedLayer, Map, MappedLayer, Sampled, layers};
use crate::tape::interval;
use crate::tape::op::{Binary, Unary};

/// Inside any of its parts: the least of their distances. Nothing, at an infinite distance, without
/// parts.
///
/// As with every combination here, the value is a distance next to the surface and a lower bound
/// of it elsewhere, if the parts' are.
#[derive(Clone)]
pub struct Union(pub Vec<SharedField>);

/// Inside all of its parts: the greatest of their distances. Everything without parts.
#[derive(Clone)]
pub struct Intersection(pub Vec<SharedField>);

/// Inside the first and in none of the rest.
#[derive(Clone)]
pub struct Difference {
    /// What is cut.
    pub first: SharedField,
    /// What is taken away.
    pub rest: Vec<SharedField>,
}

/// [`Union`] with the concave edges between parts rounded out.
///
/// The polynomial smooth minimum of two values, taken from the first part to the last:
/// `min(a, b) - k/4 h²` with `h = max(1 - |a - b| / k, 0)`.
#[derive(Clone)]
pub struct SmoothUnion {
    /// The parts.
    pub parts: Vec<SharedField>,
    /// How far around the edges the surface changes, mm; 0 for not at all.
    pub radius: f64,
}

/// [`Intersection`] with its convex edges rounded off; see [`SmoothUnion`].
#[derive(Clone)]
pub struct SmoothIntersection {
    /// The parts.
    pub parts: Vec<SharedField>,
    /// How far around the edges the surface changes, mm; 0 for not at all.
    pub radius: f64,
}

/// [`Difference`] with its convex edges rounded off; see [`SmoothUnion`].
#[derive(Clone)]
pub struct SmoothDifference {
    /// What is cut.
    pub first: SharedField,
    /// What is taken away.
    pub rest: Vec<SharedField>,
    /// How far around the edges the surface changes, mm; 0 for not at all.
    pub radius: f64,
}

/// A solid grown by a distance, or shrunk by a negative one.
#[derive(Clone)]
pub struct Offset {
    /// The solid.
    pub field: SharedField,
    /// How far out the surface moves, mm.
    pub distance: f64,
}

/// The skin of a solid: what is inside it and not deeper than the thickness.
#[derive(Clone)]
pub struct Shell {
    /// The solid.
    pub field: SharedField,
    /// Of the wall, mm.
    pub thickness: f64,
}

#[derive(Clone, Copy)]
struct Least;

impl Fold for Least {
    fn nothing(self) -> f64 {
        f64::INFINITY
    }

    fn join(self, sum: f64, next: f64) -> f64 {
        math::min(sum, next)
    }

    fn join_range(self, sum: Interval, next: Interval) -> Interval {
        interval::binary(Binary::Min, sum, next)
    }
}

#[derive(Clone, Copy)]
struct Greatest;

impl Fold for Greatest {
    fn nothing(self) -> f64 {
        f64::NEG_INFINITY
    }

    fn join(self, sum: f64, next: f64) -> f64 {
        math::max(sum, next)
    }

    fn join_range(self, sum: Interval, next: Interval) -> Interval {
        interval::binary(Binary::Max, sum, next)
    }
}

/// The first less the others: the greatest of the first and the others' negatives.
#[derive(Clone, Copy)]
struct Less;

impl Fold for Less {
    fn nothing(self) -> f64 {
        f64::INFINITY
    }

    fn join(self, sum: f64, next: f64) -> f64 {
        math::max(sum, -next)
    }

    fn join_range(self, sum: Interval, next: Interval) -> Interval {
        interval::binary(Binary::Max, sum, interval::unary(Unary::Neg, next))
    }
}

/// The smooth minimum of both times a sign each, times the first sign: with signs of -1 the smooth
/// maximum.
#[derive(Clone, Copy)]
struct Smooth {
    radius: f64,
    sum_sign: f64,
    next_sign: f64,
}

impl Smooth {
    fn least(self, a: f64, b: f64) -> f64 {
        let least = math::min(a, b);
        if self.radius.is_nan() || self.radius <= 0.0 {
            return least;
        }
        let near = math::max(1.0 - (a - b).abs() / self.radius, 0.0);
        // Two infinite distances differ by NaN, and are not near each other.
        if least.is_infinite() { least } else { least - near * near * self.radius * 0.25 }
    }
}

impl Fold for Smooth {
    fn nothing(self) -> f64 {
        self.sum_sign * f64::INFINITY
    }

    fn join(self, sum: f64, next: f64) -> f64 {
        self.sum_sign * self.least(self.sum_sign * sum, self.next_sign * next)
    }

    fn join_range(self, sum: Interval, next: Interval) -> Interval {
        if sum == Interval::EVERYTHING || next == Interval::EVERYTHING {
            return Interval::EVERYTHING;
        }
        let signed = |range: Interval, sign: f64| {
            if sign < 0.0 { Interval::new(-range.hi, -range.lo) } else { range }
        };
        let (a, b) = (signed(sum, self.sum_sign), signed(next, self.next_sign));
        // The smooth minimum grows with both.
        let (lo, hi) = (self.least(a.lo, b.lo), self.least(a.hi, b.hi));
        // What rounding may do to the part that is taken off.
        let room = self.radius.abs() * 1e-15;
        signed(interval::widened(Interval::new(lo - room, hi + room)), self.sum_sign)
    }
}

#[derive(Clone, Copy)]
struct Grow(f64);

impl Map for Grow {
    fn apply(self, value: f64) -> f64 {
        value - self.0
    }

    fn apply_range(self, range: Interval) -> Interval {
        interval::binary(Binary::Sub, range, interval::constant(self.0))
    }
}

/// The distance from the middle of a wall, less half of its thickness.
#[derive(Clone, Copy)]
struct Wall {
    half: f64,
}

impl Map for Wall {
    fn apply(self, value: f64) -> f64 {
        (value + self.half).abs() - self.half
    }

    fn apply_range(self, range: Interval) -> Interval {
        let half = interval::constant(self.half);
        let middle = interval::unary(Unary::Abs, interval::binary(Binary::Add, range, half));
        interval::binary(Binary::Sub, middle, half)
    }
}

/// Implements [`Field`] for a combination: its first field if there is one, the others, and how
/// they are joined.
macro_rules! folded_field {
    ($type:ty, |$this:ident| $first:expr, $rest:expr, $join:expr) => {
        impl $type {
            fn folded(&self) -> Folded<'_, SharedField, impl Fold + 'static> {
                let $this = self;
                Folded { first: $first, rest: $rest, join: $join }
            }
        }

        impl Field for $type {
            fn eval(&self, p: Point3) -> f64 {
                self.folded().value(p)
            }

            fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
                self.folded().values(points, out);
            }

            fn bounds(&self, cell: &Bounds3) -> Interval {
                self.folded().range(cell)
            }

            fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
                let Folded { first, rest, join } = self.folded();
                Box::new(FoldedLayer { children: layers(first.into_iter().chain(rest), z), join })
            }
        }
    };
}

const fn smooth(radius: f64, sum_sign: f64, next_sign: f64) -> Smooth {
    Smooth { radius, sum_sign, next_sign }
}

/// All but the first.
fn rest(parts: &[SharedField]) -> &[SharedField] {
    parts.get(1..).unwrap_or_default()
}

folded_field!(Union, |f| f.0.first(), rest(&f.0), Least);
folded_field!(Intersection, |f| f.0.first(), rest(&f.0), Greatest);
folded_field!(Difference, |f| Some(&f.first), &f.rest, Less);
folded_field!(SmoothUnion, |f| f.parts.first(), rest(&f.parts), smooth(f.radius, 1.0, 1.0));
folded_field!(
    SmoothIntersection,
    |f| f.parts.first(),
    rest(&f.parts),
    smooth(f.radius, -1.0, -1.0)
);
folded_field!(SmoothDifference, |f| Some(&f.first), &f.rest, smooth(f.radius, -1.0, 1.0));

/// Implements [`Field`] for a function of the value of `field`.
macro_rules! mapped_field {
    ($type:ty, |$this:ident| $map:expr) => {
        impl $type {
            fn map(&self) -> impl Map + 'static {
                let $this = self;
                $map
            }
        }

        impl Field for $type {
            fn eval(&self, p: Point3) -> f64 {
                self.map().apply(self.field.eval(p))
            }

            fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
                self.field.eval_into(points, out);
                let map = self.map();
                out.iter_mut().for_each(|v| *v = map.apply(*v));
            }

            fn bounds(&self, cell: &Bounds3) -> Interval {
                self.map().apply_range(self.field.bounds(cell))
            }

            fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
                Box::new(MappedLayer { field: self.field.at_z(z), map: self.map() })
            }
        }
    };
}

mapped_field!(Offset, |f| Grow(f.distance));
mapped_field!(Shell, |f| Wall { half: 0.5 * f.thickness });
