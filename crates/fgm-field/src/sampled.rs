//! One view of fields in space and fields of a layer, so that combinations are written once.

use fgm_core::{Bounds2, Bounds3, Interval, PlanarField, Point2, Point3};

use crate::SharedField;

/// Points evaluated at a time where a combination needs a buffer.
pub(crate) const CHUNK: usize = 128;

/// A field of points of some kind.
pub(crate) trait Sampled: Sync {
    /// A point, in space or in the plane.
    type Point: Copy + Sync;
    /// A box or a rectangle.
    type Cell: Copy;

    fn value(&self, p: Self::Point) -> f64;
    fn values(&self, points: &[Self::Point], out: &mut [f64]);
    fn range(&self, cell: &Self::Cell) -> Interval;
}

/// One layer of a shared field.
pub(crate) type Layer<'a> = Box<dyn PlanarField + 'a>;

macro_rules! sampled {
    ($type:ty, $point:ty, $cell:ty) => {
        impl Sampled for $type {
            type Point = $point;
            type Cell = $cell;

            fn value(&self, p: $point) -> f64 {
                (**self).eval(p)
            }

            fn values(&self, points: &[$point], out: &mut [f64]) {
                (**self).eval_into(points, out);
            }

            fn range(&self, cell: &$cell) -> Interval {
                (**self).bounds(cell)
            }
        }
    };
}
sampled!(SharedField, Point3, Bounds3);
sampled!(Layer<'_>, Point2, Bounds2);

/// Implements [`PlanarField`] by [`Sampled`].
macro_rules! planar_by_sampled {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> fgm_core::PlanarField for $type {
            fn eval(&self, p: fgm_core::Point2) -> f64 {
                $crate::sampled::Sampled::value(self, p)
            }

            fn eval_into(&self, points: &[fgm_core::Point2], out: &mut [f64]) {
                $crate::sampled::Sampled::values(self, points, out);
            }

            fn bounds(&self, cell: &fgm_core::Bounds2) -> fgm_core::Interval {
                $crate::sampled::Sampled::range(self, cell)
            }
        }
    };
}
pub(crate) use planar_by_sampled;

/// The layers of several fields at one height.
pub(crate) fn layers<'a>(
    fields: impl IntoIterator<Item = &'a SharedField>,
    z: f64,
) -> Vec<Layer<'a>> {
    fields.into_iter().map(|f| f.at_z(z)).collect()
}

/// How values are joined, one after the other.
pub(crate) trait Fold: Copy + Sync {
    /// The value of no field at all.
    fn nothing(self) -> f64;
    /// One more value.
    fn join(self, sum: f64, next: f64) -> f64;
    /// One more range.
    fn join_range(self, sum: Interval, next: Interval) -> Interval;
}

/// Fields joined by a [`Fold`], in order.
pub(crate) struct Folded<'a, C, J> {
    pub(crate) first: Option<&'a C>,
    pub(crate) rest: &'a [C],
    pub(crate) join: J,
}

impl<'a, C, J> Folded<'a, C, J> {
    pub(crate) fn of(children: &'a [C], join: J) -> Self {
        let (first, rest) = match children {
            [first, rest @ ..] => (Some(first), rest),
            [] => (None, children),
        };
        Self { first, rest, join }
    }
}

impl<C: Sampled, J: Fold> Sampled for Folded<'_, C, J> {
    type Point = C::Point;
    type Cell = C::Cell;

    fn value(&self, p: C::Point) -> f64 {
        let Some(first) = self.first else { return self.join.nothing() };
        self.rest.iter().fold(first.value(p), |sum, next| self.join.join(sum, next.value(p)))
    }

    fn values(&self, points: &[C::Point], out: &mut [f64]) {
        let Some(first) = self.first else { return out.fill(self.join.nothing()) };
        first.values(points, out);
        let mut buffer = [0.0; CHUNK];
        for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
            let values = &mut buffer[..points.len()];
            for next in self.rest {
                next.values(points, values);
                out.iter_mut().zip(&*values).for_each(|(o, v)| *o = self.join.join(*o, *v));
            }
        }
    }

    fn range(&self, cell: &C::Cell) -> Interval {
        let Some(first) = self.first else { return Interval::point(self.join.nothing()) };
        let join = |sum, next: &C| self.join.join_range(sum, next.range(cell));
        self.rest.iter().fold(first.range(cell), join)
    }
}

/// The layers of fields joined by a [`Fold`].
pub(crate) struct FoldedLayer<'a, J> {
    pub(crate) children: Vec<Layer<'a>>,
    pub(crate) join: J,
}

impl<'a, J: Fold> Sampled for FoldedLayer<'a, J> {
    type Point = Point2;
    type Cell = Bounds2;

    fn value(&self, p: Point2) -> f64 {
        Folded::of(&self.children, self.join).value(p)
    }

    fn values(&self, points: &[Point2], out: &mut [f64]) {
        Folded::of(&self.children, self.join).values(points, out);
    }

    fn range(&self, cell: &Bounds2) -> Interval {
        Folded::of(&self.children, self.join).range(cell)
    }
}

planar_by_sampled!(['a, J: Fold] FoldedLayer<'a, J>);

/// A function of a field's value.
pub(crate) trait Map: Copy + Sync {
    /// The new value.
    fn apply(self, value: f64) -> f64;
    /// The new range.
    fn apply_range(self, range: Interval) -> Interval;
}

/// A layer's values under a [`Map`].
pub(crate) struct MappedLayer<'a, M> {
    pub(crate) field: Layer<'a>,
    pub(crate) map: M,
}

impl<M: Map> PlanarField for MappedLayer<'_, M> {
    fn eval(&self, p: Point2) -> f64 {
        self.map.apply(self.field.eval(p))
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        self.field.eval_into(points, out);
        out.iter_mut().for_each(|v| *v = self.map.apply(*v));
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        self.map.apply_range(self.field.bounds(cell))
    }
}
