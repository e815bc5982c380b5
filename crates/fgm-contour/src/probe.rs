use crate::ContourOptions;
use crate::root::Bracket;
use fgm_core::{PlanarField, Point2};

/// How far, in cells, a corner may lie from the vertices on either side of it.
const REACH: f64 = 4.0;
/// Tangents nearer to parallel than this (sine of the angle) meet in no corner.
const LEAST_TURN: f64 = 0.05;
/// A corner is right when the curve passes this close to it, mm, along the bisector.
const CORNER_TOLERANCE: f64 = 0.002;
/// Steps towards a corner between curved sides.
const CORNER_STEPS: usize = 4;
/// Halvings of a segment.
const MOST_HALVINGS: u32 = 5;

/// Looks at one level of a field between the vertices of its contour.
#[derive(Clone, Copy)]
pub(crate) struct Probe<'a> {
    pub(crate) field: &'a dyn PlanarField,
    pub(crate) level: f64,
    pub(crate) options: &'a ContourOptions,
}

impl Probe<'_> {
    fn value(&self, p: Point2) -> f64 {
        self.field.eval(p) - self.level
    }

    fn is_low(&self, p: Point2) -> bool {
        self.value(p) < 0.0
    }

    /// The gradient by central differences; none where that is no direction.
    fn gradient(&self, p: Point2) -> Option<Point2> {
        let h = 1e-4 * self.options.cell;
        let (x, y) = (Point2::new(h, 0.0), Point2::new(0.0, h));
        let g = Point2::new(
            self.value(p + x) - self.value(p - x),
            self.value(p + y) - self.value(p - y),
        );
        g.try_normalize()
    }

    /// Where the curve crosses the segment from `p` to `q`, on both sides of which its ends lie.
    fn root(&self, p: Point2, q: Point2) -> Option<Point2> {
        let (at_p, at_q) = (self.value(p), self.value(q));
        let straddles = (at_p < 0.0 && at_q >= 0.0) || (at_p >= 0.0 && at_q < 0.0);
        let length = p.distance(q);
        if !straddles || length == 0.0 {
            return None;
        }
        let mut bracket = Bracket::new(at_p, at_q);
        loop {
            let value = self.value(p + (q - p) * bracket.guess());
            if value.is_nan() {
                return None;
            }
            if bracket.update(value, self.options.root_tolerance / length) {
                return Some(p + (q - p) * bracket.guess());
            }
        }
    }

    /// The point of the curve nearest across the segment from `p`, which may lie on either side
    /// of it. `left` points to the low side.
    fn across(&self, p: Point2, left: Point2, reach: f64) -> Option<Point2> {
        let step = if self.is_low(p) { -left } else { left };
        [0.25, 1.0].into_iter().find_map(|share| self.root(p, p + step * (reach * share)))
    }

    /// Appends the vertices that the chord from `a` to `b` lacks: a corner, or points on the
    /// curve such that no chord is off by more than the sag.
    pub(crate) fn refine(&self, a: Point2, b: Point2, out: &mut Vec<Point2>) {
        if !(self.options.sharp && self.corner(a, b, out)) {
            self.halve(a, b, 0, self.options.sharp, out);
        }
    }

    fn halve(&self, a: Point2, b: Point2, depth: u32, sharp: bool, out: &mut Vec<Point2>) {
        let length = a.distance(b);
        if depth == MOST_HALVINGS || length < 8.0 * self.options.sag {
            return;
        }
        let middle = a.midpoint(b);
        let left = (b - a).perp() / length;
        let Some(on_curve) = self.across(middle, left, length) else { return };
        if on_curve.distance(middle) <= self.options.sag {
            return;
        }
        if depth > 0 && sharp && self.corner(a, b, out) {
            return;
        }
        self.halve(a, on_curve, depth + 1, sharp, out);
        out.push(on_curve);
        self.halve(on_curve, b, depth + 1, sharp, out);
    }

    /// Appends the corner in which the curve's tangents at `a` and `b` meet, if there is one.
    ///
    /// Between curved sides the tangents of points on the curve ever nearer to the corner are
    /// taken. The curve is then shown to pass where the corner and its sides are.
    fn corner(&self, a: Point2, b: Point2, out: &mut Vec<Point2>) -> bool {
        let reach = REACH * self.options.cell;
        let (mut near_a, mut near_b) = (a, b);
        for _ in 0..CORNER_STEPS {
            let (Some(normal_a), Some(normal_b)) = (self.gradient(near_a), self.gradient(near_b))
            else {
                return false;
            };
            // The gradient points to the right of travel.
            let (along_a, along_b) = (normal_a.perp(), normal_b.perp());
            let turn = along_a.perp_dot(along_b);
            let chord = near_b - near_a;
            let (s, t) = (chord.perp_dot(along_b) / turn, along_a.perp_dot(chord) / turn);
            let ahead = 0.0 < s && s <= reach && 0.0 < t && t <= reach;
            if !(turn.abs() > LEAST_TURN && ahead) {
                return false;
            }
            let corner = near_a + along_a * s;
            if let Some(corner) = self.proven_corner(near_a, corner, near_b, turn > 0.0) {
                let mut from = a;
                for to in [near_a, corner, near_b, b] {
                    if from != to {
                        self.halve(from, to, 1, false, out);
                        out.push(to);
                        from = to;
                    }
                }
                out.pop();
                return true;
            }
            let closer = |p: Point2, step: Point2, left: Point2| {
                self.across(p + 0.75 * step, left, 0.5 * step.length())
            };
            let (Some(p), Some(q)) = (
                closer(near_a, s * along_a, along_a.perp()),
                closer(near_b, -t * along_b, along_b.perp()),
            ) else {
                return false;
            };
            (near_a, near_b) = (p, q);
        }
        false
    }

    /// The corner, put on the curve, if the curve runs along both sides as far as there.
    fn proven_corner(
        &self,
        a: Point2,
        corner: Point2,
        b: Point2,
        turns_left: bool,
    ) -> Option<Point2> {
        let outwards = (corner - a.midpoint(b)).try_normalize()?;
        let shortest = corner.distance(a).min(corner.distance(b));
        let step = outwards * CORNER_TOLERANCE.min(0.25 * shortest);
        let turns = self.is_low(corner - step) == turns_left;
        let proven = turns && self.runs_along(a, corner) && self.runs_along(corner, b);
        if !proven {
            return None;
        }
        // Where two regions meet in a point, what lies beyond the corner is the other one.
        let meets = || self.value(corner).abs() <= 1e-3 * self.value(corner - step).abs();
        self.root(corner - step, corner + step).or_else(|| meets().then_some(corner))
    }

    fn runs_along(&self, p: Point2, q: Point2) -> bool {
        let Some(along) = (q - p).try_normalize() else { return true };
        // Less on a short side, which would otherwise be left across an acute corner.
        let off = (2.0 * self.options.sag).max(CORNER_TOLERANCE).min(0.04 * p.distance(q));
        let left = along.perp() * off;
        [0.25, 0.5, 0.75].into_iter().all(|t| {
            let on = p.lerp(q, t);
            self.is_low(on + left) && !self.is_low(on - left)
        })
    }
}
