//! Offsets that change no shape: every vertex moves along its bisector.

use fgm_core::{Point2, Polygon, Ring};

use super::grid::EdgeGrid;

/// How much nearer than the distance a moved border may come to the old one, mm: rounding.
const SLACK: f64 = 1e-5;
/// `1 + cos` of the turn at which a mitre is twice the distance.
const SHARPEST_REFLEX: f64 = 0.5;
/// The same where the moved corner lies inside the old one: only to keep the division tame.
const SHARPEST_CONVEX: f64 = 0.02;

/// The region with its border moved inward by `distance` (outward where negative); `None` where
/// that would make borders meet, or an edge vanish.
pub(super) fn offset(region: &[Polygon], distance: f64) -> Option<Vec<Polygon>> {
    let out: Vec<Polygon> = region.iter().map(|p| moved(p, distance)).collect::<Option<_>>()?;
    let edges: Vec<_> = region.iter().flat_map(Polygon::rings).flat_map(Ring::edges).collect();
    let length: f64 = edges.iter().map(|(a, b)| a.distance(*b)).sum();
    let reach = distance.abs();
    let mean = length / edges.len().max(1) as f64;
    let grid = EdgeGrid::new(edges, reach.max(mean));
    let near = |(a, b): (Point2, Point2)| grid.any_within(a, b, reach - SLACK);
    let meets = out.iter().flat_map(Polygon::rings).flat_map(Ring::edges).any(near);
    (!meets).then_some(out)
}

/// Every ring's vertices moved, with no look at other borders; `None` where an edge turns round.
pub(super) fn moved(polygon: &Polygon, distance: f64) -> Option<Polygon> {
    let outer = ring(&polygon.outer, distance)?;
    let holes = polygon.holes.iter().map(|h| ring(h, distance)).collect::<Option<_>>()?;
    Some(Polygon { outer, holes })
}

fn ring(ring: &Ring, distance: f64) -> Option<Ring> {
    let n = ring.points.len();
    let &last = ring.points.last()?;
    let mut before = direction(last, ring.points[0])?;
    let mut points = Vec::with_capacity(n);
    for (i, &p) in ring.points.iter().enumerate() {
        let after = direction(p, ring.points[if i + 1 < n { i + 1 } else { 0 }])?;
        let open = 1.0 + before.dot(after);
        // The side that opens towards the move is the one whose mitre can run away.
        let reflex = before.perp_dot(after) * distance < 0.0;
        if open < if reflex { SHARPEST_REFLEX } else { SHARPEST_CONVEX } {
            return None;
        }
        points.push(p + (before + after).perp() * (distance / open));
        before = after;
    }
    let out = Ring::new(points);
    let kept = ring.edges().zip(out.edges()).all(|((a, b), (c, d))| (b - a).dot(d - c) > 0.0);
    kept.then_some(out)
}

fn direction(a: Point2, b: Point2) -> Option<Point2> {
    (b - a).try_normalize()
}
