//! Offsets that change no shape: every vertex moves along its bisector.

use fgm_core::{Point2, Polygon, Ring};

use super::near::{NO_EDGE, NearBorder};

/// How much nearer than the distance a moved border may come to the old one, mm: rounding.
const SLACK: f64 = 1e-5;
/// `1 + cos` of the turn at which a mitre is twice the distance.
const SHARPEST_REFLEX: f64 = 0.5;
/// The same where the moved corner lies inside the old one: only to keep the division tame.
const SHARPEST_CONVEX: f64 = 0.02;

/// How far a mitre reaches beyond a round corner to count as a tip, mm.
const BLUNT: f64 = 1e-3;

/// How often turned edges are looked for before a ring is left to the sweep.
const MOST_PASSES: usize = 12;

/// The region with its border moved inward by `distance` (outward where negative); `None` where
/// that would make borders meet, or an edge vanish.
pub(super) fn offset(region: &[Polygon], distance: f64) -> Option<Vec<Polygon>> {
    let out: Vec<Polygon> = region.iter().map(|p| moved(p, distance)).collect::<Option<_>>()?;
    let reach = distance.abs();
    let border = NearBorder::new(region, reach);
    let rings = region.iter().zip(&out).flat_map(|(old, new)| old.rings().zip(new.rings()));
    let mut first = 0;
    let meets = rings.into_iter().any(|(old, new)| {
        let n = old.points.len();
        let base = first;
        first += n;
        // An edge is the distance away from the one it comes from and from that one's neighbours
        // by its making. Where edges vanished, which comes from which is not known.
        let whole = new.points.len() == n;
        new.edges().enumerate().any(|(i, (a, b))| {
            let own = [if i > 0 { i - 1 } else { n - 1 }, i, if i + 1 < n { i + 1 } else { 0 }];
            let own = own.map(|edge| if whole { (base + edge) as u32 } else { NO_EDGE });
            border.any_within(a, b, reach - SLACK, own)
        })
    });
    (!meets && !tips_meet(&out, distance)).then_some(out)
}

/// Whether mitres of reflex corners cross each other: further than the distance from every border,
/// they may meet where no edge comes too near to one.
fn tips_meet(region: &[Polygon], distance: f64) -> bool {
    let mut sides = Vec::new();
    // For each side of a tip the one that lies on the same edge, if the next corner is a tip, too.
    let mut opposite: Vec<u32> = Vec::new();
    for ring in region.iter().flat_map(Polygon::rings) {
        let (n, first) = (ring.points.len(), sides.len());
        let at = |i: usize| ring.points[i % n];
        let mut last_tip = None;
        for i in 0..n {
            let (p, u, v) = (at(i), at(i) - at(i + n - 1), at(i + 1) - at(i));
            let (before, after) = (u.length(), v.length());
            let open = 1.0 + u.dot(v) / (before * after);
            let reflex = u.perp_dot(v) * distance < 0.0;
            if !reflex || distance.abs() * ((2.0 / open).sqrt() - 1.0) <= BLUNT {
                continue;
            }
            // As far as a round corner would not reach; two sides of one edge do not touch.
            let reach = distance.abs() * ((2.0 - open).max(0.0) / open).sqrt();
            let share = |length: f64| (reach / length).min(0.49);
            let side = sides.len() as u32;
            sides.extend([(p - u * share(before), p), (p, p + v * share(after))]);
            opposite.extend([NO_EDGE; 2]);
            if last_tip == Some(i.wrapping_sub(1)) {
                opposite[side as usize] = side - 1;
                opposite[side as usize - 1] = side;
            }
            last_tip = Some(i);
            if i + 1 == n && reflex_at_start(&sides[first..], at(0)) {
                opposite[first] = side + 1;
                opposite[side as usize + 1] = first as u32;
            }
        }
    }
    let near = NearBorder::of_edges(&sides, BLUNT);
    (0..)
        .zip(&sides)
        .zip(&opposite)
        .any(|((side, &(a, b)), &other)| near.any_within(a, b, SLACK, [side, side ^ 1, other]))
}

/// Whether the first of a ring's tips is at its first corner.
fn reflex_at_start(sides: &[(Point2, Point2)], corner: Point2) -> bool {
    sides.first().is_some_and(|side| side.1 == corner)
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
    if kept { Some(out) } else { collapsed(ring, distance) }
}

/// An edge moved: a point of it and its direction.
#[derive(Clone, Copy)]
struct Line {
    from: Point2,
    along: Point2,
}

/// The moved ring without the edges that vanish on the way: their neighbours meet instead.
fn collapsed(ring: &Ring, distance: f64) -> Option<Ring> {
    let mut lines = Vec::with_capacity(ring.points.len());
    for (a, b) in ring.edges() {
        let along = direction(a, b)?;
        lines.push(Line { from: a + along.perp() * distance, along });
    }
    let mut points = Vec::with_capacity(lines.len());
    let mut lengths: Vec<f64> = Vec::with_capacity(lines.len());
    for _ in 0..MOST_PASSES {
        let n = lines.len();
        if n < 3 {
            return None;
        }
        points.clear();
        for i in 0..n {
            points.push(meeting(&lines[(i + n - 1) % n], &lines[i], distance)?);
        }
        lengths.clear();
        lengths.extend((0..n).map(|i| (points[(i + 1) % n] - points[i]).dot(lines[i].along)));
        if lengths.iter().all(|&l| l > 0.0) {
            return Some(Ring::new(points));
        }
        // Of turned edges side by side only the one turned furthest goes: the others may be whole
        // without it.
        let mut i = 0;
        lines.retain(|_| {
            let own = lengths[i];
            let (before, after) = (lengths[(i + n - 1) % n], lengths[(i + 1) % n]);
            i += 1;
            own > 0.0 || own > before || own >= after
        });
        if lines.len() == n {
            return None;
        }
    }
    None
}

/// Where two moved lines meet, the second after the first; `None` where that is far away.
fn meeting(first: &Line, second: &Line, distance: f64) -> Option<Point2> {
    let (turn, cos) = (first.along.perp_dot(second.along), first.along.dot(second.along));
    let reflex = turn * distance < 0.0;
    if 1.0 + cos < if reflex { SHARPEST_REFLEX } else { SHARPEST_CONVEX } {
        return None;
    }
    let gap = second.from - first.from;
    if turn.abs() < 0.02 {
        // As good as parallel: only lines that are one line meet, at the second's beginning.
        let apart = first.along.perp_dot(gap);
        return (apart.abs() < 0.03 * distance.abs())
            .then(|| second.from - first.along.perp() * apart);
    }
    Some(first.from + first.along * (gap.perp_dot(second.along) / turn))
}

fn direction(a: Point2, b: Point2) -> Option<Point2> {
    (b - a).try_normalize()
}
