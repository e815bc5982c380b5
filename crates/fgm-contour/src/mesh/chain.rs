use super::section::SectionWarning;
use fgm_core::{Point2, Ring};

/// How many open chains are matched with each other; more are closed each on its own.
const MOST_MATCHED: usize = 1000;
/// An opening wider than this share of its border's length encloses nothing.
const WIDEST_OPENING: f64 = 0.5;

/// A stretch of border: closed, or with two ends in the open.
#[derive(Clone, Debug, Default)]
pub(crate) struct Border {
    pub(crate) points: Vec<Point2>,
    /// Length run with the inside on the left, less that with it on the right.
    pub(crate) votes: f64,
}

impl Border {
    fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    fn ends(&self) -> (Point2, Point2) {
        match self.points.as_slice() {
            [a, .., b] => (*a, *b),
            [a] => (*a, *a),
            [] => (Point2::ZERO, Point2::ZERO),
        }
    }

    fn turned(mut self) -> Self {
        self.points.reverse();
        self.votes = -self.votes;
        self
    }

    /// As a ring that runs with the inside on its left, without repeated points and without
    /// whiskers; none without an area.
    pub(crate) fn into_ring(self) -> Option<Ring> {
        let mut points: Vec<Point2> = Vec::with_capacity(self.points.len());
        for p in self.points {
            push(&mut points, p);
        }
        let (mut from, mut to) = (0, points.len());
        while to - from > 2 {
            if points[from] == points[to - 1] || points[from] == points[to - 2] {
                to -= 1;
            } else if points[from + 1] == points[to - 1] {
                from += 1;
            } else {
                break;
            }
        }
        points.truncate(to);
        points.drain(..from);
        if self.votes < 0.0 {
            points.reverse();
        }
        let ring = Ring::new(points);
        // Thinner than rounding: a plane through a ridge.
        let solid = ring.points.len() > 2 && ring.area().abs() > 1e-9 * ring.length();
        solid.then_some(ring)
    }
}

/// Adds a point, unless it repeats the last; a step back over the last step takes both away.
fn push(points: &mut Vec<Point2>, p: Point2) {
    match points.as_slice() {
        [.., last] if *last == p => {}
        [.., before, _] if *before == p => {
            points.pop();
        }
        _ => points.push(p),
    }
}

/// Joins open chains into closed ones: first over gaps of up to `gap`, nearest first, then over
/// wider openings as well as possible.
pub(crate) fn close(
    open: Vec<Border>,
    gap: f64,
    warnings: &mut Vec<SectionWarning>,
) -> Vec<Border> {
    let mut closed = Vec::new();
    let rest = join(open, gap, &mut closed, warnings);
    let rest = join(rest, f64::INFINITY, &mut closed, warnings);
    for border in rest {
        let (a, b) = border.ends();
        finish(border, a, a.distance(b), gap, &mut closed, warnings);
    }
    closed
}

/// Joins the nearest ends, of one chain or of two, while they are at most `limit` apart.
fn join(
    open: Vec<Border>,
    limit: f64,
    closed: &mut Vec<Border>,
    warnings: &mut Vec<SectionWarning>,
) -> Vec<Border> {
    let pairs = candidates(&open, limit);
    let mut chains: Vec<Option<Border>> = open.into_iter().map(Some).collect();
    // Where each end of each original chain is now: chain and whether at its end; joined ends
    // are gone.
    let mut place: Vec<Option<(usize, bool)>> =
        (0..2 * chains.len()).map(|e| Some((e / 2, e % 2 == 1))).collect();
    for (distance, e, f) in pairs {
        let (Some((a, a_end)), Some((b, b_end))) = (place[e], place[f]) else { continue };
        (place[e], place[f]) = (None, None);
        if a == b {
            let Some(border) = chains[a].take() else { continue };
            let at = border.ends().1;
            finish(border, at, distance, limit, closed, warnings);
            continue;
        }
        let (Some(first), Some(second)) = (chains[a].take(), chains[b].take()) else { continue };
        // First runs to the joint, second from it.
        let mut first = if a_end { first } else { first.turned() };
        let second = if b_end { second.turned() } else { second };
        let at = first.ends().1;
        report(at, distance, limit, warnings);
        first.points.extend_from_slice(&second.points);
        first.votes += second.votes;
        for slot in place.iter_mut().flatten() {
            if slot.0 == a {
                slot.1 = false;
            } else if slot.0 == b {
                *slot = (a, true);
            }
        }
        chains[a] = Some(first);
    }
    chains.into_iter().flatten().collect()
}

/// Pairs of ends at most `limit` apart, nearest first.
fn candidates(open: &[Border], limit: f64) -> Vec<(f64, usize, usize)> {
    let mut ends: Vec<(Point2, usize)> = open
        .iter()
        .enumerate()
        .flat_map(|(k, c)| [(c.ends().0, 2 * k), (c.ends().1, 2 * k + 1)])
        .collect();
    ends.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)));
    let mut pairs = Vec::new();
    if limit.is_infinite() && open.len() > MOST_MATCHED {
        return pairs;
    }
    for (k, &(p, e)) in ends.iter().enumerate() {
        for &(q, f) in ends[k + 1..].iter().take_while(|n| n.0.x - p.x <= limit) {
            let distance = p.distance(q);
            let (e, f) = (e.min(f), e.max(f));
            let itself = e / 2 == f / 2;
            // A chain shorter than its own opening is better joined to others.
            if distance <= limit && !(itself && distance > WIDEST_OPENING * open[e / 2].length()) {
                pairs.push((distance, e, f));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs
}

fn report(at: Point2, gap: f64, limit: f64, warnings: &mut Vec<SectionWarning>) {
    warnings.push(if limit.is_finite() {
        SectionWarning::GapClosed { at, gap }
    } else {
        SectionWarning::OpeningClosed { at, gap }
    });
}

/// Closes a chain upon itself, or leaves it out where it encloses nothing.
fn finish(
    border: Border,
    at: Point2,
    distance: f64,
    limit: f64,
    closed: &mut Vec<Border>,
    warnings: &mut Vec<SectionWarning>,
) {
    let length = border.length();
    if border.points.len() < 3 || distance > WIDEST_OPENING * length {
        warnings.push(SectionWarning::Dropped { at: border.ends().0, length });
        return;
    }
    report(at, distance, limit, warnings);
    closed.push(border);
}
