use crate::{Interval, Point2, Point3};

/// An axis-aligned rectangle, mm. Empty when a `min` is above its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounds2 {
    /// Least corner.
    pub min: Point2,
    /// Greatest corner.
    pub max: Point2,
}

/// An axis-aligned box, mm. Empty when a `min` is above its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounds3 {
    /// Least corner.
    pub min: Point3,
    /// Greatest corner.
    pub max: Point3,
}

macro_rules! bounds {
    ($bounds:ident, $point:ident) => {
        impl $bounds {
            /// Holds nothing; the identity of [`Self::union`].
            pub const EMPTY: Self =
                Self { min: $point::splat(f64::INFINITY), max: $point::splat(f64::NEG_INFINITY) };

            /// The bounds between two corners given in order.
            pub const fn new(min: $point, max: $point) -> Self {
                Self { min, max }
            }

            /// The least bounds around points; [`Self::EMPTY`] for none.
            pub fn of(points: impl IntoIterator<Item = $point>) -> Self {
                points
                    .into_iter()
                    .fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
            }

            /// Whether no point lies inside.
            pub fn is_empty(&self) -> bool {
                self.min.cmpgt(self.max).any()
            }

            /// Whether every corner is finite and the bounds are not empty.
            pub fn is_finite(&self) -> bool {
                self.min.is_finite() && self.max.is_finite() && !self.is_empty()
            }

            /// The lengths of the sides; negative where empty.
            pub fn size(&self) -> $point {
                self.max - self.min
            }

            /// The middle.
            pub fn center(&self) -> $point {
                (self.min + self.max) * 0.5
            }

            /// Whether `p` lies inside or on the border.
            pub fn contains(&self, p: $point) -> bool {
                self.min.cmple(p).all() && p.cmple(self.max).all()
            }

            /// Whether the two share a point.
            pub fn intersects(&self, other: &Self) -> bool {
                self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
            }

            /// The least bounds around both.
            #[must_use]
            pub fn union(&self, other: &Self) -> Self {
                Self { min: self.min.min(other.min), max: self.max.max(other.max) }
            }

            /// What both share; empty where they share nothing.
            #[must_use]
            pub fn intersection(&self, other: &Self) -> Self {
                Self { min: self.min.max(other.min), max: self.max.min(other.max) }
            }

            /// Grown by `margin` on every side (shrunk when negative).
            #[must_use]
            pub fn grown(&self, margin: f64) -> Self {
                Self { min: self.min - margin, max: self.max + margin }
            }
        }
    };
}

bounds!(Bounds2, Point2);
bounds!(Bounds3, Point3);

impl Bounds2 {
    /// The x values inside.
    pub fn x(&self) -> Interval {
        Interval::new(self.min.x, self.max.x)
    }

    /// The y values inside.
    pub fn y(&self) -> Interval {
        Interval::new(self.min.y, self.max.y)
    }

    /// The box over this rectangle between two heights.
    pub fn extrude(&self, z: Interval) -> Bounds3 {
        Bounds3::new(self.min.extend(z.lo), self.max.extend(z.hi))
    }
}

impl Bounds3 {
    /// The x values inside.
    pub fn x(&self) -> Interval {
        Interval::new(self.min.x, self.max.x)
    }

    /// The y values inside.
    pub fn y(&self) -> Interval {
        Interval::new(self.min.y, self.max.y)
    }

    /// The z values inside.
    pub fn z(&self) -> Interval {
        Interval::new(self.min.z, self.max.z)
    }

    /// The shadow on the plane z = 0.
    pub fn xy(&self) -> Bounds2 {
        Bounds2::new(self.min.truncate(), self.max.truncate())
    }

    /// The eight corners.
    pub fn corners(&self) -> [Point3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            Point3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_is_the_identity_of_union_and_contains_nothing() {
        let unit = Bounds2::new(Point2::ZERO, Point2::ONE);
        assert!(Bounds2::EMPTY.is_empty());
        assert_eq!(Bounds2::EMPTY.union(&unit), unit);
        assert!(!Bounds2::EMPTY.contains(Point2::ZERO));
        assert!(
            unit.intersection(&Bounds2::new(Point2::splat(2.0), Point2::splat(3.0))).is_empty()
        );
    }

    #[test]
    fn corners_span_the_box() {
        let b = Bounds3::new(Point3::new(-1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.0));
        assert_eq!(Bounds3::of(b.corners()), b);
    }
}
