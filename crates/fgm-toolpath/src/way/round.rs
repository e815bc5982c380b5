//! The way round inside one part of a region.

use fgm_core::{Point2, Polygon};

use crate::inset::grid::EdgeGrid;

/// Side of a cell, mm; sparse borders get larger ones.
const CELL: f64 = 1.0;
/// Passes in which a way is pulled taut; each shortens less than the one before.
const PASSES: usize = 4;

/// How far inside a border, in bead widths, ways begin that come from outside of it.
const HAIR: f64 = 0.02;

/// Where travels may go: polygons to walk along the borders of, and a little larger ones that the
/// ways stay in.
pub(super) struct Rooms {
    polygons: Vec<Polygon>,
    /// The borders to walk along, ring after ring, and the first edge of each ring and of none.
    corners: Vec<Point2>,
    rings: Vec<usize>,
    borders: EdgeGrid,
    /// What no way crosses.
    limits: EdgeGrid,
    /// Width of a bead, mm.
    width: f64,
}

/// Where the straight line crosses a border.
struct Crossing {
    at: Point2,
    edge: u32,
    ring: usize,
}

impl Rooms {
    /// `walk` lies inside `limits`.
    pub(super) fn new(walk: Vec<Polygon>, limits: &[Polygon], width: f64) -> Self {
        let edges = |region: &[Polygon]| -> Vec<(Point2, Point2)> {
            region.iter().flat_map(Polygon::rings).flat_map(fgm_core::Ring::edges).collect()
        };
        let (mut corners, mut rings) = (Vec::new(), vec![0]);
        for ring in walk.iter().flat_map(Polygon::rings) {
            corners.extend_from_slice(&ring.points);
            rings.push(corners.len());
        }
        let borders = EdgeGrid::new(edges(&walk), CELL);
        let limits = EdgeGrid::new(edges(limits), CELL);
        Self { polygons: walk, corners, rings, borders, limits, width }
    }

    /// The points of a way from one place to another, the first but not the last included, no
    /// longer than `most` mm; none where there is no such way.
    pub(super) fn way(&self, from: Point2, to: Point2, most: f64) -> Option<Vec<Point2>> {
        let (start, end) = (self.enter(from)?, self.enter(to)?);
        let room = |p: Point2| self.polygons.iter().position(|polygon| polygon.contains(p));
        if room(start)? != room(end)? {
            return None;
        }
        let mut crossed = Vec::new();
        self.borders.crossed(start, end, &mut crossed);
        let ring = |edge: u32| self.rings.partition_point(|first| *first <= edge as usize) - 1;
        let crossed: Vec<Crossing> = crossed
            .into_iter()
            .map(|(share, edge)| Crossing { at: start.lerp(end, share), edge, ring: ring(edge) })
            .collect();
        // Round each ring once, or back to the straight line as soon as it is inside again: for a
        // hole with bays the one, for a comb the other.
        let mut best: Option<(f64, Vec<Point2>)> = None;
        for at_once in [true, false] {
            let Some(mut way) = self.walk(start, end, &crossed, at_once) else { continue };
            way.insert(0, from);
            way.push(to);
            self.tighten(&mut way);
            let length: f64 = way.windows(2).map(|w| w[0].distance(w[1])).sum();
            if best.as_ref().is_none_or(|best| length < best.0) {
                best = Some((length, way));
            }
            if crossed.len() == 2 {
                break;
            }
        }
        let (length, mut way) = best?;
        let stays = way.windows(2).all(|w| self.sees(w[0], w[1]));
        way.pop();
        (length <= most && stays).then_some(way)
    }

    /// The place where a way from or to a place comes to where it may go: the place itself, or one
    /// just inside of the nearest border, if that is no farther than a wall is wide.
    fn enter(&self, p: Point2) -> Option<Point2> {
        if self.polygons.iter().any(|polygon| polygon.contains(p)) {
            return Some(p);
        }
        let near = |(a, b): (Point2, Point2)| {
            let along = b - a;
            let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            a + along * share.clamp(0.0, 1.0)
        };
        let edges = self.polygons.iter().flat_map(Polygon::rings).flat_map(fgm_core::Ring::edges);
        let nearest = edges
            .map(near)
            .min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p)))?;
        let far = nearest.distance(p);
        if far > self.width {
            return None;
        }
        Some(nearest + (nearest - p) * (HAIR * self.width / far.max(f64::MIN_POSITIVE)))
    }

    fn tighten(&self, way: &mut Vec<Point2>) {
        for _ in 0..PASSES {
            let before = way.len();
            self.pull(way);
            way.reverse();
            self.pull(way);
            way.reverse();
            if way.len() == before {
                break;
            }
        }
    }

    /// The straight line with the borders in its way walked along, the shorter way round: up to the
    /// last crossing of a border, or to the next.
    fn walk(
        &self,
        from: Point2,
        to: Point2,
        crossed: &[Crossing],
        at_once: bool,
    ) -> Option<Vec<Point2>> {
        let mut way = vec![from];
        let mut rest = crossed;
        while let [leave, others @ ..] = rest {
            let same = |crossing: &Crossing| crossing.ring == leave.ring;
            let enter =
                if at_once { others.iter().rposition(same) } else { others.iter().position(same) }?;
            self.go_round(leave, &others[enter], &mut way);
            rest = &others[enter + 1..];
        }
        way.push(to);
        Some(way)
    }

    /// Appends the shorter way along a ring between places on two of its edges.
    fn go_round(&self, leave: &Crossing, enter: &Crossing, way: &mut Vec<Point2>) {
        let first = self.rings[leave.ring];
        let corners = &self.corners[first..self.rings[leave.ring + 1]];
        let count = corners.len();
        let (out, back) = (leave.edge as usize - first, enter.edge as usize - first);
        // Edge i runs from corner i to the next one.
        let steps = (back + count - out) % count;
        let forward = || (1..=steps).map(|k| corners[(out + k) % count]);
        let backward = || (0..count - steps).map(|k| corners[(out + count - k) % count]);
        let length = |middle: &mut dyn Iterator<Item = Point2>| {
            let mut at = leave.at;
            let mut sum = 0.0;
            for p in middle {
                sum += at.distance(p);
                at = p;
            }
            sum + at.distance(enter.at)
        };
        way.push(leave.at);
        // On one edge there is a straight way, whichever the order.
        if steps > 0 {
            if length(&mut forward()) <= length(&mut backward()) {
                way.extend(forward());
            } else {
                way.extend(backward());
            }
        }
        way.push(enter.at);
    }

    /// Leaves out what can be left out without crossing a limit: from each point on to the farthest
    /// one in sight that doubling steps find.
    fn pull(&self, way: &mut Vec<Point2>) {
        let mut kept = Vec::with_capacity(way.len());
        let mut at = 0;
        let last = way.len() - 1;
        kept.push(way[0]);
        while at < last {
            let sees = |to: usize| to == at + 1 || self.sees(way[at], way[to]);
            let mut seen = at + 1;
            let mut step = 1;
            if sees(last) {
                seen = last;
            }
            while seen < last {
                let to = (seen + step).min(last);
                if sees(to) {
                    (seen, step) = (to, 2 * step);
                } else if step > 1 {
                    step /= 4;
                    step = step.max(1);
                } else {
                    break;
                }
            }
            kept.push(way[seen]);
            at = seen;
        }
        *way = kept;
    }

    fn sees(&self, a: Point2, b: Point2) -> bool {
        let mut crossed = Vec::new();
        self.limits.crossed(a, b, &mut crossed);
        crossed.is_empty()
    }
}
