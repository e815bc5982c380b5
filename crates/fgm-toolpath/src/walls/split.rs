//! Cutting a polygon into what is thick and what is thin, across its necks.
//!
//! Every edge is moved inward by half the thickness in question. An edge that keeps its distance
//! from the whole border borders something thick. Where a run of such edges ends, its moved line
//! crosses that of the run on the other side, at the centre of a disc that touches both sides:
//! there a straight cut joins the two points of touch. Cuts do not cross the border, since the
//! disc is empty, nor each other, since they are Delaunay edges of the points of touch.

use fgm_core::{Point2, Polygon, Ring};

use crate::inset::{
    clipper::nest,
    near::{NO_EDGE, NearBorder},
};

/// How much nearer than its distance a moved edge may come to the border, mm: rounding.
const SLACK: f64 = 1e-5;
/// Edges are looked at in parts this long, in radii.
const LONGEST: f64 = 3.0;
/// The same where something thick may hide between the ends of such parts. What hides between
/// these is so little thicker than thin that it is filled as thin.
const SHORT: f64 = 0.75;
/// A bay that stays this near the centre of its disc, in radii, is a corner and no thin part.
const CORNER: f64 = 2.1;
/// A reflex corner is sharp where the cosine of its turn is less than this times the sine: from
/// 11 degrees on.
const SHARP: f64 = 5.0;
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
#[derive(Default)]
struct Side {
    points: Vec<Point2>,
    /// The edge of the polygon, counted through its rings, that each one is part of.
    sources: Vec<u32>,
    moved: Vec<Point2>,
    /// Whether moving the vertex was cut short at a sharp corner.
    blunt: Vec<bool>,
    fits: Vec<bool>,
    /// Edges that fit in their middle only, in order.
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
    let border = NearBorder::new(std::slice::from_ref(polygon), radius);
    let mut sides = sides(polygon, &border, radius)?;
    let mut runs = all_runs(&sides);
    let hidden = hidden(&sides, &runs);
    if !hidden.is_empty() {
        look_closer(&mut sides, &hidden, &border, radius)?;
        runs = all_runs(&sides);
    }
    if sides.iter().any(|side| side.corner_hides(&border, radius)) {
        return None;
    }
    cut_up(polygon, radius, &sides, &runs)
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

/// The rings, their edges cut into parts of at most [`LONGEST`] radii.
fn sides(polygon: &Polygon, border: &NearBorder, radius: f64) -> Option<Vec<Side>> {
    let mut sides = Vec::with_capacity(1 + polygon.holes.len());
    let mut first = 0;
    for ring in polygon.rings() {
        let mut side = Side::default();
        side.points.reserve(2 * ring.points.len());
        side.sources.reserve(2 * ring.points.len());
        for ((a, b), edge) in ring.edges().zip(first..) {
            side.push_parts(a, b, edge, LONGEST * radius);
        }
        first += ring.points.len() as u32;
        side.move_by(radius)?;
        for edge in 0..side.points.len() {
            side.look_at(edge, border, radius);
        }
        sides.push(side);
    }
    Some(sides)
}

/// Cuts edges up into parts of at most [`SHORT`] radii and looks at these.
fn look_closer(
    sides: &mut [Side],
    hidden: &[(usize, usize)],
    border: &NearBorder,
    radius: f64,
) -> Option<()> {
    let mut hidden = hidden.iter().peekable();
    for (index, side) in sides.iter_mut().enumerate() {
        if hidden.peek().is_none_or(|h| h.0 != index) {
            continue;
        }
        let old = std::mem::take(side);
        let mut new = Vec::new();
        for edge in 0..old.points.len() {
            let (a, b) = (old.points[edge], old.points[(edge + 1) % old.points.len()]);
            if hidden.next_if(|h| **h == (index, edge)).is_some() {
                side.push_parts(a, b, old.sources[edge], SHORT * radius);
                new.resize(side.points.len(), true);
                side.fits.resize(side.points.len(), false);
            } else {
                side.points.push(a);
                side.sources.push(old.sources[edge]);
                side.fits.push(old.fits[edge]);
                new.push(false);
            }
        }
        side.move_by(radius)?;
        (0..new.len()).filter(|&e| new[e]).for_each(|edge| side.look_at(edge, border, radius));
    }
    Some(())
}

impl Side {
    /// Appends an edge in parts no longer than `longest`.
    fn push_parts(&mut self, a: Point2, b: Point2, edge: u32, longest: f64) {
        self.points.push(a);
        self.sources.push(edge);
        let squared = a.distance_squared(b);
        if squared <= longest * longest {
            return;
        }
        let parts = (squared.sqrt() / longest).ceil().clamp(1.0, 1e4) as usize;
        for i in 1..parts {
            self.points.push(a + (b - a) * (i as f64 / parts as f64));
            self.sources.push(edge);
        }
    }

    /// Moves the points along their bisectors.
    fn move_by(&mut self, radius: f64) -> Option<()> {
        let n = self.points.len();
        let mut before = (self.points[0] - self.points[n - 1]).try_normalize()?;
        self.moved.reserve(n);
        self.blunt.reserve(n);
        for i in 0..n {
            let next = self.points[if i + 1 < n { i + 1 } else { 0 }];
            let after = (next - self.points[i]).try_normalize()?;
            let open = 1.0 + before.dot(after);
            self.blunt.push(open < SHARPEST);
            let far = radius / open.max(SHARPEST);
            self.moved.push(self.points[i] + (before + after).perp() * far);
            before = after;
        }
        Some(())
    }

    /// Whether a disc fits that touches a sharp reflex corner, or the middle of an edge at it, while
    /// neither edge fits: something thick between such corners has no edge that fits.
    fn corner_hides(&self, border: &NearBorder, radius: f64) -> bool {
        let n = self.points.len();
        (0..n).any(|i| {
            let (before, after) =
                (if i > 0 { i - 1 } else { n - 1 }, if i + 1 < n { i + 1 } else { 0 });
            if self.fits[i] || self.fits[before] {
                return false;
            }
            let (u, v) =
                (self.points[i] - self.points[before], self.points[after] - self.points[i]);
            let turn = u.perp_dot(v);
            if turn >= 0.0 || u.dot(v) > SHARP * -turn {
                return false;
            }
            // Unless its thick part is the one beside it.
            let alone = |edge: usize, beside: usize| {
                !self.fits[beside] && self.partial.binary_search(&edge).is_ok()
            };
            let two_before = if before > 0 { before - 1 } else { n - 1 };
            if alone(i, after) || alone(before, two_before) {
                return true;
            }
            let Some(inward) = (self.moved[i] - self.points[i]).try_normalize() else {
                return false;
            };
            let centre = self.points[i] + inward * radius;
            let skip = [self.sources[before], self.sources[i], NO_EDGE];
            !border.any_within(centre, centre, radius - SLACK, skip)
        })
    }

    /// Finds whether an edge fits, in whole or in its middle.
    fn look_at(&mut self, edge: usize, border: &NearBorder, radius: f64) {
        let n = self.points.len();
        let next = if edge + 1 < n { edge + 1 } else { 0 };
        let (a, b) = (self.moved[edge], self.moved[next]);
        // What it comes from is the radius away by its making, and so is what lies beside that,
        // unless a corner was blunted.
        let (start, end) = (!self.blunt[edge], !self.blunt[next]);
        let known = |is: bool, at: usize| if is { self.sources[at] } else { NO_EDGE };
        let before = if edge > 0 { edge - 1 } else { n - 1 };
        let skip = [known(start && end, edge), known(start, before), known(end, next)];
        let near = |a, b| border.any_within(a, b, radius - SLACK, skip);
        let forward = (b - a).dot(self.points[next] - self.points[edge]) > 0.0;
        let fits = forward && !near(a, b);
        if edge < self.fits.len() {
            self.fits[edge] = fits;
        } else {
            self.fits.push(fits);
        }
        let middle = (a + b) * 0.5;
        if forward && !fits && !near(middle, middle) {
            self.partial.push(edge);
        }
    }
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

/// Edges, by side, that fit in their middle and are not beside a run: something thick has no whole
/// edge that fits, and would be missed.
fn hidden(sides: &[Side], runs: &[Run]) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    for (index, side) in sides.iter().enumerate() {
        let n = side.points.len();
        let beside = |&&edge: &&usize| {
            let of = |r: &&Run| (r.last + 1) % n == edge || (r.first + n - 1) % n == edge;
            runs.iter().filter(|r| r.side == index).any(|r| of(&r))
        };
        out.extend(side.partial.iter().filter(|e| !beside(e)).map(|&edge| (index, edge)));
    }
    out
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
