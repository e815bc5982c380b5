use crate::Point2;

/// A stretch of a path with one label.
///
/// Positions along a path of `n` points are parameters in `0..=n-1`: the whole part is the index
/// of a segment, the rest the share of that segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<L> {
    /// Where it begins.
    pub from: f64,
    /// Where it ends; not before `from`.
    pub to: f64,
    /// What it crosses.
    pub label: L,
}

/// Cuts open paths by the regions of a layer.
///
/// The spans of one path follow each other without gap or overlap from `0` to `n - 1`, so that no
/// length is lost or doubled; neighbouring spans have different labels.
pub trait Sectioner<L>: Sync {
    /// Replaces `spans` by the spans of `path`; none for a path of fewer than two points.
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<L>>);
}

/// The point of a path at a parameter, clamped to the path's ends.
///
/// # Panics
/// Never for a path that has a point.
pub fn point_at(path: &[Point2], at: f64) -> Point2 {
    let last = path.len().saturating_sub(1);
    let segment = (at.max(0.0) as usize).min(last);
    let (a, b) = (path[segment], path[(segment + 1).min(last)]);
    let share = (at - segment as f64).clamp(0.0, 1.0);
    if share == 0.0 { a } else { a + (b - a) * share }
}

/// Appends to `out` the part of a path between two parameters, its end points included.
pub fn slice_path(path: &[Point2], from: f64, to: f64, out: &mut Vec<Point2>) {
    if path.len() < 2 || from.is_nan() || to.is_nan() || from >= to {
        return;
    }
    out.push(point_at(path, from));
    let first = from.floor() as usize + 1;
    let end = (to.ceil() as usize).min(path.len());
    out.extend_from_slice(path.get(first..end).unwrap_or_default());
    out.push(point_at(path, to));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn path(n: usize) -> Vec<Point2> {
        (0..n).map(|i| Point2::new(i as f64, (i * i % 7) as f64)).collect()
    }

    fn length(points: &[Point2]) -> f64 {
        points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    #[test]
    fn whole_parameters_repeat_no_point() {
        let path = path(4);
        let mut out = Vec::new();
        slice_path(&path, 1.0, 3.0, &mut out);
        assert_eq!(out, path[1..]);
        out.clear();
        slice_path(&path, 0.25, 0.75, &mut out);
        assert_eq!(out, [point_at(&path, 0.25), point_at(&path, 0.75)]);
        out.clear();
        slice_path(&path, 2.0, 2.0, &mut out);
        assert!(out.is_empty());
    }

    proptest! {
        #[test]
        fn slices_keep_the_length(n in 2usize..20, cut in 0.0..1.0f64) {
            let path = path(n);
            let at = cut * (n - 1) as f64;
            let (mut a, mut b) = (Vec::new(), Vec::new());
            slice_path(&path, 0.0, at, &mut a);
            slice_path(&path, at, (n - 1) as f64, &mut b);
            prop_assert!((length(&a) + length(&b) - length(&path)).abs() < 1e-9);
        }
    }
}
