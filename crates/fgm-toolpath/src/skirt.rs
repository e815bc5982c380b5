use fgm_core::{ColorId, Point2, Polygon, Role};

use crate::Piece;

/// Most of a round corner that a straight line replaces, radians.
const STEP: f64 = std::f64::consts::PI / 12.0;

/// Lines around the part on the first layer, that get the nozzle going.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SkirtOptions {
    /// How many; 0 is no skirt.
    pub loops: u32,
    /// From the part to the inner side of the first bead, mm.
    pub distance: f64,
    /// Width of the beads, mm.
    pub width: f64,
}

impl Default for SkirtOptions {
    fn default() -> Self {
        Self { loops: 0, distance: 3.0, width: 0.4 }
    }
}

/// Appends loops around the convex hull of everything in `parts`, the inner one first, each
/// anticlockwise, in one colour.
///
/// Nothing for no loops, fewer than three points that span an area, or options that are not
/// finite. Whether the loops fit on the bed is for the caller to check.
pub fn skirt(parts: &[Polygon], color: ColorId, options: &SkirtOptions, out: &mut Vec<Piece>) {
    let SkirtOptions { loops, distance, width } = *options;
    if !(distance.is_finite() && width.is_finite() && distance >= 0.0 && width > 0.0) {
        return;
    }
    let hull = hull(parts.iter().flat_map(|part| part.outer.points.iter().copied()).collect());
    if hull.len() < 3 {
        return;
    }
    out.extend((0..loops).map(|i| {
        let points = around(&hull, distance + (f64::from(i) + 0.5) * width);
        Piece::new(points, Role::Skirt, width, color)
    }));
}

/// The convex hull, anticlockwise, without points on its sides (Andrew's monotone chain).
fn hull(mut points: Vec<Point2>) -> Vec<Point2> {
    points.retain(|p| p.is_finite());
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let mut hull: Vec<Point2> = Vec::new();
    let half = |hull: &mut Vec<Point2>, points: &mut dyn Iterator<Item = Point2>| {
        let base = hull.len();
        for p in points {
            while let [.., a, b] = hull[base..]
                && (b - a).perp_dot(p - a) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    };
    half(&mut hull, &mut points.iter().copied());
    half(&mut hull, &mut points.iter().rev().copied());
    hull
}

/// The loop at a distance around a convex ring, round at its corners; its first point stands at
/// its end again.
fn around(hull: &[Point2], distance: f64) -> Vec<Point2> {
    let n = hull.len();
    let mut points = Vec::with_capacity(2 * n + (std::f64::consts::TAU / STEP) as usize + 2);
    for (i, &corner) in hull.iter().enumerate() {
        let outward = |a: Point2, b: Point2| -(b - a).perp().normalize_or_zero();
        let before = outward(hull[(i + n - 1) % n], corner);
        let after = outward(corner, hull[(i + 1) % n]);
        let turn = before.perp_dot(after).atan2(before.dot(after));
        let steps = (turn / STEP).ceil().max(1.0);
        let directions = (0..=steps as u32)
            .map(|k| Point2::from_angle(turn * f64::from(k) / steps).rotate(before));
        points.extend(directions.map(|direction| corner + direction * distance));
    }
    points.extend(points.first().copied());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Ring;
    use proptest::prelude::*;

    fn part(points: &[(f64, f64)]) -> Polygon {
        Polygon::simple(Ring::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect()))
    }

    fn loops(parts: &[Polygon], loops: u32) -> Vec<Piece> {
        let mut out = Vec::new();
        let options = SkirtOptions { loops, ..SkirtOptions::default() };
        skirt(parts, ColorId(1), &options, &mut out);
        out
    }

    #[test]
    fn around_two_islands() {
        let parts = [
            part(&[(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 2.0)]),
            part(&[(8.0, 0.0), (10.0, 0.0), (10.0, 2.0), (8.0, 2.0)]),
        ];
        let got = loops(&parts, 2);
        assert_eq!(got.len(), 2);
        for (piece, distance) in got.iter().zip([3.2, 3.6]) {
            assert!(piece.is_loop() && piece.role == Role::Skirt);
            // Straight sides, and a circle in chords.
            let round = std::f64::consts::TAU * distance;
            let chords = 24.0 * 2.0 * distance * (STEP / 2.0).sin();
            assert!((piece.length() - 24.0 - chords).abs() < 1e-9, "{} {round}", piece.length());
        }
        assert!(loops(&parts, 0).is_empty());
    }

    #[test]
    fn nothing_around_nothing() {
        assert!(loops(&[], 2).is_empty());
        assert!(loops(&[part(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])], 2).is_empty());
        let mut out = Vec::new();
        let options = SkirtOptions { loops: 1, distance: f64::NAN, ..SkirtOptions::default() };
        skirt(&[part(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], ColorId(0), &options, &mut out);
        assert!(out.is_empty());
    }

    proptest! {
        #[test]
        fn a_skirt_keeps_its_distance(
            points in prop::collection::vec((0..9i32, 0..9i32), 3..20),
        ) {
            let points: Vec<_> =
                points.iter().map(|p| (f64::from(p.0), f64::from(p.1))).collect();
            let part = part(&points);
            for piece in loops(std::slice::from_ref(&part), 1) {
                for w in piece.points.windows(2) {
                    for p in &part.outer.points {
                        let (d, length) = (w[1] - w[0], w[0].distance_squared(w[1]));
                        let t = ((p - w[0]).dot(d) / length.max(1e-300)).clamp(0.0, 1.0);
                        let distance = p.distance(w[0] + d * t);
                        prop_assert!(distance >= 3.2 * (STEP / 2.0).cos() - 1e-9);
                    }
                }
            }
        }
    }
}
