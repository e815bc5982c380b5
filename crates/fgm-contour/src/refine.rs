use crate::contact::{Contacts, Segment, side};
use crate::graph::{Chain, Chains, Graph};
use crate::lines::Lines;
use crate::probe::Probe;
use crate::simplify::distance_squared;
use crate::sweep::Task;
use crate::{ContourError, ContourOptions};
use fgm_core::{Bounds2, Point2};

/// A ring of more vertices than this is no scrap of a corner's tip.
const MOST_SCRAP_VERTICES: usize = 64;
const NO_EXTRA: u32 = u32::MAX;
/// Segments shorter than this, in cells, lie across a corner more easily than their curvature tells.
const SHORT: f64 = 0.3;

/// A segment that may lie off the curve by more than the sag.
#[derive(Clone, Copy, Debug)]
struct Suspect {
    chain: u32,
    /// Its first node, as an index into [`Chains::nodes`], and its ends.
    slot: usize,
    a: Point2,
    b: Point2,
    /// How fast the field changes across the lattice edges at the ends, a mm; 0 where nearness to
    /// the curve says nothing.
    slope: f64,
    /// How far from its middle the neighbours, drawn on, pass if they meet in a corner; infinite
    /// where they meet in none.
    tip: f64,
}

/// Vertices added to the segment that starts at `slot`: a range of [`Refiner::points`].
#[derive(Clone, Copy, Debug)]
struct Extra {
    chain: u32,
    slot: usize,
    from: usize,
    to: usize,
    /// Whether it may cross another line: it leaves its cell, or shares it.
    risky: bool,
    dropped: bool,
}

/// Adds vertices on the curve where chords between crossings are off it, and its corners.
#[derive(Debug, Default)]
pub(crate) struct Refiner {
    suspects: Vec<Suspect>,
    middles: Vec<Point2>,
    values: Vec<f64>,
    extras: Vec<Extra>,
    points: Vec<Point2>,
    dead: Vec<bool>,
    segments: Vec<Segment>,
    contacts: Contacts,
    scraps: Vec<Scrap>,
}

/// A ring that may be the scrap of a corner's tip.
#[derive(Clone, Copy, Debug)]
struct Scrap {
    level: u16,
    /// Of its first vertex.
    x: f64,
    chain: usize,
}

impl Refiner {
    /// Fills `lines` with the chains and what they lack.
    pub(crate) fn run(
        &mut self,
        task: &Task<'_>,
        options: &ContourOptions,
        graph: &Graph,
        chains: &Chains,
        positions: &[Point2],
        lines: &mut Lines,
    ) -> Result<(), ContourError> {
        self.extras.clear();
        self.points.clear();
        self.dead.clear();
        self.dead.resize(chains.list.len(), false);
        if options.sag > 0.0 {
            self.find_suspects(task, options, graph, chains, positions);
            self.add_extras(task, options, graph, chains)?;
            self.absorb_scraps(options, chains, positions);
            while self.extras.iter().any(|e| e.risky && !e.dropped)
                && self.drop_touching(chains, positions)
            {}
        }
        self.assemble(chains, positions, lines);
        Ok(())
    }

    /// Finds segments at whose ends the line turns enough for the curve to be off them.
    fn find_suspects(
        &mut self,
        task: &Task<'_>,
        options: &ContourOptions,
        graph: &Graph,
        chains: &Chains,
        positions: &[Point2],
    ) {
        self.suspects.clear();
        for (index, chain) in chains.list.iter().enumerate() {
            let nodes = &chains.nodes[chain.from..chain.to];
            let n = nodes.len();
            let at = |k: usize| positions[nodes[k % n] as usize];
            let segments = if chain.closed { n } else { n - 1 };
            for k in 0..segments {
                let (a, b) = (at(k), at(k + 1));
                let before = (chain.closed || k > 0).then(|| at(k + n - 1));
                let after = (chain.closed || k + 2 < n).then(|| at(k + 2));
                if !may_be_off(before, a, b, after, options) {
                    continue;
                }
                let ends = [nodes[k], nodes[(k + 1) % n]].map(|id| &graph.nodes[id as usize]);
                if ends.iter().any(|node| node.is_pad(task.lattice)) {
                    continue;
                }
                let slope = ends.map(|node| {
                    let (p, q) = node.ends(task.lattice);
                    (node.values[1] - node.values[0]).abs() / (q - p).element_sum()
                });
                // At a narrow corner the middle may be near the curve though the tip is not.
                let returns = before.zip(after).is_some_and(|(p, q)| (a - p).dot(q - b) < 0.0);
                let slope = if options.sharp && returns { 0.0 } else { slope[0].max(slope[1]) };
                self.suspects.push(Suspect {
                    chain: index as u32,
                    slot: chain.from + k,
                    a,
                    b,
                    slope,
                    tip: tip(before, a, b, after),
                });
            }
        }
    }

    /// Asks the field in the middle of each suspect and refines those that are off.
    fn add_extras(
        &mut self,
        task: &Task<'_>,
        options: &ContourOptions,
        graph: &Graph,
        chains: &Chains,
    ) -> Result<(), ContourError> {
        self.middles.clear();
        self.middles.extend(self.suspects.iter().map(|s| s.a.midpoint(s.b)));
        self.values.resize(self.middles.len(), 0.0);
        task.field.eval_into(&self.middles, &mut self.values);
        for (k, suspect) in self.suspects.iter().enumerate() {
            let chain = chains.list[suspect.chain as usize];
            let level = task.levels[usize::from(chain.level)];
            let value = self.values[k] - level;
            if value.is_nan() && !task.skip_nan {
                return Err(ContourError::NotANumber { at: self.middles[k] });
            }
            let off = value.abs() / suspect.slope;
            // A corner that cuts the chord as the neighbours say; a bend lies at a quarter of that.
            let corner = options.sharp && suspect.tip <= 2.0 * off;
            if off <= if corner { 0.5 * options.sag } else { options.sag } {
                continue;
            }
            let from = self.points.len();
            let probe = Probe { field: task.field, level, options };
            probe.refine(suspect.a, suspect.b, &mut self.points);
            let to = keep_inside(&mut self.points, from, &task.lattice.window());
            if !is_simple(suspect.a, &self.points[from..to], suspect.b) {
                self.points.truncate(from);
                continue;
            }
            if to > from {
                // Off the cell's border, on which another line's addition may lie.
                let cell = task.lattice.cell_around(self.middles[k]);
                let cell = cell.grown(-options.root_tolerance);
                let outside = !self.points[from..].iter().all(|&p| cell.contains(p));
                let risky = outside || graph.is_shared(chains.nodes[suspect.slot]);
                let (chain, slot) = (suspect.chain, suspect.slot);
                self.extras.push(Extra { chain, slot, from, to, risky, dropped: false });
            }
        }
        Ok(())
    }

    /// Drops the rings that the tip of a corner, narrower than a cell, left on its own: the
    /// recovered corner holds them.
    fn absorb_scraps(&mut self, options: &ContourOptions, chains: &Chains, positions: &[Point2]) {
        let limit = (1e-3 * options.cell).max(options.sag);
        if self.extras.iter().any(|e| e.risky) {
            self.find_scraps(chains, positions);
        }
        for extra in self.extras.iter().filter(|e| e.risky) {
            let owner = &chains.list[extra.chain as usize];
            let nodes = &chains.nodes[owner.from..owner.to];
            let k = extra.slot - owner.from;
            let at = |k: usize| positions[nodes[k % nodes.len()] as usize];
            let tip = &self.points[extra.from..extra.to];
            let hull: Vec<Point2> = [at(k)].iter().chain(tip).copied().chain([at(k + 1)]).collect();
            let bounds = Bounds2::of(hull.iter().copied()).grown(limit);
            let turns_left = area(&hull) > 0.0;
            let before = |s: &Scrap| (s.level, s.x) < (owner.level, bounds.min.x);
            let near = &self.scraps[self.scraps.partition_point(before)..];
            let near = near.iter().take_while(|s| (s.level, s.x) <= (owner.level, bounds.max.x));
            for scrap in near.filter(|scrap| scrap.chain as u32 != extra.chain) {
                let chain = &chains.list[scrap.chain];
                let nodes = &chains.nodes[chain.from..chain.to];
                let ring = || nodes.iter().map(|&id| positions[id as usize]);
                if ring().all(|p| bounds.contains(p) && holds(&hull, p, limit)) {
                    let points: Vec<Point2> = ring().collect();
                    self.dead[scrap.chain] |= (area(&points) > 0.0) == turns_left;
                }
            }
        }
    }

    /// The rings small enough to be a scrap, by level and then from left to right.
    fn find_scraps(&mut self, chains: &Chains, positions: &[Point2]) {
        self.scraps.clear();
        let small = |chain: &Chain| chain.closed && chain.to - chain.from <= MOST_SCRAP_VERTICES;
        for (index, chain) in chains.list.iter().enumerate().filter(|(_, chain)| small(chain)) {
            if let Some(&first) = chains.nodes.get(chain.from) {
                let x = positions[first as usize].x;
                self.scraps.push(Scrap { level: chain.level, x, chain: index });
            }
        }
        self.scraps.sort_by(|s, t| s.level.cmp(&t.level).then(s.x.total_cmp(&t.x)));
    }

    /// Drops the risky additions that touch another segment; answers whether there were any.
    fn drop_touching(&mut self, chains: &Chains, positions: &[Point2]) -> bool {
        self.segments.clear();
        let mut extras = self.extras.iter().enumerate().peekable();
        for (index, chain) in chains.list.iter().enumerate() {
            for (slot, a, b) in slots(chain, chains, positions) {
                let mut from = a;
                let mut tag = NO_EXTRA;
                if let Some((id, extra)) = extras.next_if(|(_, e)| e.slot == slot)
                    && !extra.dropped
                    && !self.dead[index]
                {
                    tag = if extra.risky { id as u32 } else { NO_EXTRA };
                    for &to in &self.points[extra.from..extra.to] {
                        self.segments.push(Segment { a: from, b: to, tag });
                        from = to;
                    }
                }
                if !self.dead[index] {
                    self.segments.push(Segment { a: from, b, tag });
                }
            }
        }
        let (segments, extras) = (&self.segments, &mut self.extras);
        let mut dropped = false;
        self.contacts.find(segments, |s, t| {
            for tag in [segments[s].tag, segments[t].tag] {
                if let Some(extra) = extras.get_mut(tag as usize) {
                    dropped |= !extra.dropped;
                    extra.dropped = true;
                }
            }
        });
        dropped
    }

    fn assemble(&self, chains: &Chains, positions: &[Point2], lines: &mut Lines) {
        lines.clear();
        let mut extras = self.extras.iter().peekable();
        for (index, chain) in chains.list.iter().enumerate() {
            if self.dead[index] {
                while extras.next_if(|e| e.slot < chain.to).is_some() {}
                continue;
            }
            for slot in chain.from..chain.to {
                lines.points.push(positions[chains.nodes[slot] as usize]);
                if let Some(extra) = extras.next_if(|e| e.slot == slot)
                    && !extra.dropped
                {
                    lines.points.extend_from_slice(&self.points[extra.from..extra.to]);
                }
            }
            lines.finish(chain.closed, chain.level);
        }
    }
}

/// Takes out the points from `from` on that lie outside the window; answers how many are left.
fn keep_inside(points: &mut Vec<Point2>, from: usize, window: &Bounds2) -> usize {
    let mut to = from;
    for k in from..points.len() {
        if window.contains(points[k]) {
            points[to] = points[k];
            to += 1;
        }
    }
    points.truncate(to);
    to
}

/// Whether the line from `a` through some points to `b` neither crosses nor touches itself.
fn is_simple(a: Point2, points: &[Point2], b: Point2) -> bool {
    let from = || [a].into_iter().chain(points.iter().copied());
    let to = points.iter().copied().chain([b]);
    let segment = |(a, b)| Segment { a, b, tag: 0 };
    let segments: Vec<Segment> =
        if points.len() > 1 { from().zip(to).map(segment).collect() } else { Vec::new() };
    segments.iter().enumerate().all(|(k, s)| !segments[k + 1..].iter().any(|t| s.meets(t)))
}

/// The segments of a chain: slot of the first node, and both ends.
fn slots<'a>(
    chain: &'a Chain,
    chains: &'a Chains,
    positions: &'a [Point2],
) -> impl Iterator<Item = (usize, Point2, Point2)> + 'a {
    let end = if chain.closed { chain.to } else { chain.to - 1 };
    let at = |slot: usize| positions[chains.nodes[slot] as usize];
    (chain.from..end).map(move |slot| {
        let next = if slot + 1 == chain.to { chain.from } else { slot + 1 };
        (slot, at(slot), at(next))
    })
}

/// Whether the turns at the ends of a segment let the curve be off it by more than the sag.
fn may_be_off(
    before: Option<Point2>,
    a: Point2,
    b: Point2,
    after: Option<Point2>,
    options: &ContourOptions,
) -> bool {
    let chord = b - a;
    let length = chord.length();
    let arriving = before.map_or(chord, |p| a - p);
    let leaving = after.map_or(chord, |p| p - b);
    if before.is_none() && after.is_none() {
        return true;
    }
    // The curvature through three vertices, and with it the height of the arc over the chord.
    let curvature = |u: Point2, v: Point2| {
        let (lu, lv) = (u.length(), v.length());
        let sine = if u.dot(v) < 0.0 { 1.0 } else { u.perp_dot(v).abs() / (lu * lv) };
        2.0 * sine / (lu + lv)
    };
    let most = curvature(arriving, chord).max(curvature(chord, leaving));
    if most * length * length > 4.0 * options.sag {
        return true;
    }
    // Where the neighbours, drawn on, would meet: a corner cut off by a short segment.
    let product = arriving.length() * leaving.length();
    let height = 0.5 * length * arriving.perp_dot(leaving).abs();
    let least = if length < SHORT * options.cell { 0.5 } else { 2.0 } * options.sag;
    options.sharp && height > least * (product + arriving.dot(leaving))
}

/// How far from the middle of the segment from `a` to `b` the lines through its neighbours pass, if
/// they meet ahead of both; infinite if they do not.
fn tip(before: Option<Point2>, a: Point2, b: Point2, after: Option<Point2>) -> f64 {
    let (Some(before), Some(after)) = (before, after) else { return f64::INFINITY };
    let (u, v, chord) = (a - before, after - b, b - a);
    let turn = u.perp_dot(v);
    let (s, t) = (chord.perp_dot(v) / turn, u.perp_dot(chord) / turn);
    if !(s > 0.0 && t > 0.0) {
        return f64::INFINITY;
    }
    let corner = u * s;
    let share = (corner.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
    let height = corner.perp_dot(chord).abs() / chord.length();
    height * 0.5 / share.max(1.0 - share)
}

/// Twice the enclosed area, signed.
fn area(points: &[Point2]) -> f64 {
    let Some(&origin) = points.first() else { return 0.0 };
    points.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum()
}

/// Whether `p` lies in a polygon or within `limit` of its border.
fn holds(polygon: &[Point2], p: Point2, limit: f64) -> bool {
    let n = polygon.len();
    let edges = || (0..n).map(|k| (polygon[k], polygon[(k + 1) % n]));
    let inside = edges().fold(false, |inside, (a, b)| {
        let spans = (a.y > p.y) != (b.y > p.y);
        inside != (spans && (side(a, b, p) > 0.0) == (b.y > a.y))
    });
    inside || edges().any(|(a, b)| distance_squared(p, a, b) <= limit * limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field wild enough once gave vertices that turned back through their own first step.
    #[test]
    fn additions_that_cross_themselves_are_known() {
        let point = |p: (f64, f64)| Point2::new(p.0, p.1);
        let check = |points: &[(f64, f64)], simple: bool| {
            let inner: Vec<Point2> = points.iter().copied().map(point).collect();
            assert_eq!(
                is_simple(point((0.0, 0.0)), &inner, point((4.0, 0.0))),
                simple,
                "{points:?}"
            );
        };
        check(&[], true);
        check(&[(2.0, 1.0)], true);
        check(&[(1.0, 1.0), (3.0, 1.0)], true);
        check(&[(3.0, 1.0), (1.0, 1.0)], false);
        check(&[(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], true);
        check(&[(2.0, 0.0), (1.0, 0.0)], false);
    }
}
