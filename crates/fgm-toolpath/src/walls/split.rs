//! Cutting a polygon into what is thick and what is thin, across its necks.
//!
//! Every edge is moved inward by half the thickness in question. An edge that keeps its distance
//! from the whole border borders something thick. Where a run of such edges ends, its moved line
//! crosses that of the run on the other side, at the centre of a disc that touches both sides:
//! there a straight cut joins the two points of touch. Cuts do not cross the border, since the
//! disc is empty, nor each other, since they are Delaunay edges of the points of touch.

use fgm_core::{Point2, Polygon, Ring};

use crate::inset::{clipper::nest, grid::EdgeGrid};

/// How much nearer than its distance a moved edge may come to the border, mm: rounding.
const SLACK: f64 = 1e-5;
/// Edges are looked at in parts this long, in radii.
const LONGEST: f64 = 3.0;
/// The same where something thick may hide between the ends of such parts. What hides between
/// these is so little thicker than thin that it is filled as thin.
const SHORT: f64 = 0.75;
/// A bay that stays this near the centre of its disc, in radii, is a corner and no thin part.
const CORNER: f64 = 2.1;
/// `1 + cos` of the turn from which on a moved corner would lie too far away.
const SHARPEST: f64 = 0.05;

/// A polygon cut up.
#[derive(Debug, Default)]
pub(super) struct Split {
    pub(super) thick: Vec<Polygon>,
    pub(super) thin: Vec<Polygon>,
    /// Whether all of the polygon is thick, corners included: every moved edge fits.
    pub(super) whole: bool,
}

/// A ring with what is known of its edges; edge `i` runs from vertex `i` to the next.
struct Side {
    points: Vec<Point2>,
    moved: Vec<Point2>,
    fits: Vec<bool>,
    /// Edges that fit in their middle only.
    partial: Vec<usize>,
}

/// A maximal run of edges that fit, `first` to `last` (past the end where it goes round).
#[derive(Clone, Copy, Debug)]
struct Run {
    side: usize,
    first: usize,
    last: usize,
    /// The next run on the same ring.
    next: usize,
}

/// Where the moved line of one run's end meets that of another's start.
#[derive(Clone, Copy, Debug)]
struct Cut {
    start: usize,
    /// Points of touch at the end of the one run and the start of the other.
    from: Point2,
    to: Point2,
    /// Nothing is cut off but a corner.
    corner: bool,
}

/// Cuts a polygon where it is thinner than `2 * radius`; `None` where the cuts do not work out.
pub(super) fn split(polygon: &Polygon, radius: f64) -> Option<Split> {
    let coarse = sides(polygon, radius, LONGEST)?;
    let runs = all_runs(&coarse);
    if hides_more(&coarse, &runs) {
        let fine = sides(polygon, radius, SHORT)?;
        let runs = all_runs(&fine);
        return cut_up(polygon, radius, &fine, &runs);
    }
    cut_up(polygon, radius, &coarse, &runs)
}

/// The runs of the rings that fit in part.
fn all_runs(sides: &[Side]) -> Vec<Run> {
    let mut runs = Vec::new();
    for (index, side) in sides.iter().enumerate() {
        if side.fits.contains(&true) && side.fits.contains(&false) {
            runs_of(side, index, &mut runs);
        }
    }
    runs
}

fn cut_up(polygon: &Polygon, radius: f64, sides: &[Side], runs: &[Run]) -> Option<Split> {
    if sides.iter().all(|s| s.fits.iter().all(|&f| f)) {
        return Some(Split { thick: vec![polygon.clone()], thin: Vec::new(), whole: true });
    }
    let mut thick = Vec::new();
    let mut thin = Vec::new();
    for side in sides {
        if side.fits.iter().all(|&f| f) {
            thick.push(Ring::new(side.points.clone()));
        } else if !side.fits.contains(&true) {
            thin.push(Ring::new(side.points.clone()));
        }
    }
    let cuts = cuts(sides, runs, radius)?;
    thick_rings(sides, runs, &cuts, &mut thick)?;
    thin_rings(sides, runs, &cuts, &mut thin)?;
    let split =
        Split { thick: nest(thick.into_iter()), thin: nest(thin.into_iter()), whole: false };
    let area = |p: &[Polygon]| p.iter().map(Polygon::area).sum::<f64>();
    let whole = polygon.area();
    let sum = area(&split.thick) + area(&split.thin);
    ((sum - whole).abs() < 1e-6 * (1.0 + whole)).then_some(split)
}

/// The rings, their edges cut into parts of at most `longest` radii.
fn sides(polygon: &Polygon, radius: f64, longest: f64) -> Option<Vec<Side>> {
    let edges: Vec<_> = polygon.rings().flat_map(Ring::edges).collect();
    let grid = EdgeGrid::new(edges, 1.5 * radius);
    let mut sides = Vec::new();
    let mut first = 0;
    for ring in polygon.rings() {
        let (points, sources) = subdivided(ring, longest * radius, first);
        first += ring.points.len() as u32;
        let (moved, blunt) = moved(&points, radius)?;
        let n = points.len();
        let mut side = Side { points, moved, fits: Vec::new(), partial: Vec::new() };
        for i in 0..n {
            let next = (i + 1) % n;
            let (a, b) = (side.moved[i], side.moved[next]);
            let forward = (b - a).dot(side.points[next] - side.points[i]) > 0.0;
            // The edge it comes from is the radius away by its making, unless a corner was blunted.
            let own = (!blunt[i] && !blunt[next]).then_some(sources[i]);
            let near = |a, b| grid.any_within(a, b, radius - SLACK, |edge| Some(edge) == own);
            let fits = forward && !near(a, b);
            side.fits.push(fits);
            let middle = (a + b) * 0.5;
            if forward && !fits && !near(middle, middle) {
                side.partial.push(i);
            }
        }
        sides.push(side);
    }
    Some(sides)
}

/// A ring's points with long edges cut up, and the edge that each new one is part of, counted from
/// `first`.
fn subdivided(ring: &Ring, longest: f64, first: u32) -> (Vec<Point2>, Vec<u32>) {
    let (mut out, mut sources) = (Vec::new(), Vec::new());
    for ((a, b), edge) in ring.edges().zip(first..) {
        let parts = (a.distance(b) / longest).ceil().clamp(1.0, 1e4) as usize;
        out.extend((0..parts).map(|i| a + (b - a) * (i as f64 / parts as f64)));
        sources.extend((0..parts).map(|_| edge));
    }
    (out, sources)
}

/// The points moved along their bisectors, and whether that was cut short at a sharp corner.
fn moved(points: &[Point2], radius: f64) -> Option<(Vec<Point2>, Vec<bool>)> {
    let n = points.len();
    let mut before = (points[0] - points[n - 1]).try_normalize()?;
    let (mut out, mut blunt) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for i in 0..n {
        let after = (points[(i + 1) % n] - points[i]).try_normalize()?;
        let open = 1.0 + before.dot(after);
        blunt.push(open < SHARPEST);
        out.push(points[i] + (before + after).perp() * (radius / open.max(SHARPEST)));
        before = after;
    }
    Some((out, blunt))
}

fn runs_of(side: &Side, index: usize, runs: &mut Vec<Run>) {
    let n = side.fits.len();
    let begin = runs.len();
    for first in 0..n {
        if side.fits[first] && !side.fits[(first + n - 1) % n] {
            let length = (1..n).take_while(|k| side.fits[(first + k) % n]).count();
            runs.push(Run { side: index, first, last: first + length, next: runs.len() + 1 });
        }
    }
    if let Some(last) = runs.last_mut() {
        last.next = begin;
    }
}

/// Whether an edge fits in part that is not beside a run: something thick has no whole edge that
/// fits, and would be missed.
fn hides_more(sides: &[Side], runs: &[Run]) -> bool {
    let beside = |side: usize, edge: usize| {
        let n = sides[side].points.len();
        let own = runs.iter().filter(|r| r.side == side);
        own.clone().any(|r| (r.last + 1) % n == edge || (r.first + n - 1) % n == edge)
    };
    sides.iter().enumerate().any(|(i, s)| s.partial.iter().any(|&edge| !beside(i, edge)))
}

/// The cut after each run.
fn cuts(sides: &[Side], runs: &[Run], radius: f64) -> Option<Vec<Cut>> {
    // The first edge after a run, and the last before it, fit in part.
    let edge = |run: &Run, index: usize| {
        let side = &sides[run.side];
        let n = side.points.len();
        (side.moved[index % n], side.moved[(index + 1) % n])
    };
    let before = |run: &Run| run.first + sides[run.side].points.len() - 1;
    let mut out: Vec<Cut> = Vec::with_capacity(runs.len());
    let mut taken = vec![false; runs.len()];
    for run in runs {
        let (a, b) = edge(run, run.last + 1);
        let mut best: Option<(f64, usize)> = None;
        for (start, other) in runs.iter().enumerate() {
            let (c, d) = edge(other, before(other));
            let Some(at) = crossing(a, b, c, d) else { continue };
            if best.is_none_or(|(least, _)| at < least) {
                best = Some((at, start));
            }
        }
        let (at, start) = best?;
        if std::mem::replace(&mut taken[start], true) {
            return None;
        }
        let centre = a + (b - a) * at;
        let from = touch(&sides[run.side], run.last + 1, centre);
        let to = touch(&sides[runs[start].side], before(&runs[start]), centre);
        let bay = || bay(sides, runs, run);
        let near = |p: Point2| p.distance(centre) < CORNER * radius;
        let corner = run.next == start && bay().all(near);
        out.push(Cut { start, from, to, corner });
    }
    Some(out)
}

/// The vertices between a run and the next on its ring.
fn bay<'a>(sides: &'a [Side], runs: &[Run], run: &Run) -> impl Iterator<Item = Point2> + 'a {
    let points = &sides[run.side].points;
    let n = points.len();
    let next = runs[run.next].first;
    // Past the run's own end, all the way round where it is the only one.
    let end = if next > run.last { next } else { next + n };
    (run.last + 2..end).map(move |i| points[i % n])
}

/// Where along the first segment the second crosses it.
fn crossing(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<f64> {
    let (u, v) = (b - a, d - c);
    let area = u.perp_dot(v);
    if area.abs() < 1e-9 * u.length() * v.length() {
        return None;
    }
    let (s, t) = ((c - a).perp_dot(v) / area, (c - a).perp_dot(u) / area);
    let on = |x: f64| (-1e-9..=1.0 + 1e-9).contains(&x);
    (on(s) && on(t)).then_some(s)
}

/// The point of a border edge nearest to a disc's centre.
fn touch(side: &Side, index: usize, centre: Point2) -> Point2 {
    let n = side.points.len();
    let (a, b) = (side.points[index % n], side.points[(index + 1) % n]);
    let v = b - a;
    // Beside a reflex corner the moved line is longer than the edge: the corner is touched.
    a + v * ((centre - a).dot(v) / v.length_squared()).clamp(0.0, 1.0)
}

fn thick_rings(sides: &[Side], runs: &[Run], cuts: &[Cut], out: &mut Vec<Ring>) -> Option<()> {
    let mut seen = vec![false; runs.len()];
    for begin in 0..runs.len() {
        if seen[begin] {
            continue;
        }
        let mut points = Vec::new();
        let mut at = begin;
        loop {
            if std::mem::replace(&mut seen[at], true) {
                return None;
            }
            let (run, cut) = (&runs[at], &cuts[at]);
            let side = &sides[run.side];
            let n = side.points.len();
            points.extend((run.first..=run.last + 1).map(|i| side.points[i % n]));
            if cut.corner {
                points.extend(bay(sides, runs, run));
            } else {
                points.extend([cut.from, cut.to]);
            }
            at = cut.start;
            if at == begin {
                break;
            }
        }
        points.dedup();
        out.push(Ring::new(points));
    }
    Some(())
}

fn thin_rings(sides: &[Side], runs: &[Run], cuts: &[Cut], out: &mut Vec<Ring>) -> Option<()> {
    let mut into = vec![0; runs.len()];
    for (run, cut) in cuts.iter().enumerate() {
        into[cut.start] = run;
    }
    let mut seen: Vec<bool> = cuts.iter().map(|c| c.corner).collect();
    for begin in 0..cuts.len() {
        if seen[begin] {
            continue;
        }
        let mut points = Vec::new();
        let mut at = begin;
        loop {
            if std::mem::replace(&mut seen[at], true) {
                return None;
            }
            points.push(cuts[at].from);
            points.extend(bay(sides, runs, &runs[at]));
            // Along the border to the next run, and back over the cut that leads into it.
            let over = into[runs[at].next];
            points.push(cuts[over].to);
            at = over;
            if at == begin {
                break;
            }
        }
        points.dedup();
        out.push(Ring::new(points));
    }
    Some(())
}

#[cfg(test)]
#[path = "split_tests.rs"]
mod tests;
