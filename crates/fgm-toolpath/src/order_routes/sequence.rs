//! Which route follows which, inside every colour and from colour to colour.

use std::ops::Range;

use fgm_core::Point2;

use super::Round;

/// Routes of a colour whose sequence is looked for among all; more are taken nearest first.
const MOST_EXACT: usize = 8;
/// Vertices by which the distance between routes is taken.
const MOST_SAMPLES: usize = 32;

/// Puts the routes of each colour into the sequence of least travels, routes taken to be entered
/// and left where they are nearest to their neighbours.
///
/// A colour's routes are gone through in every sequence (Held and Karp, 1962), and the colours
/// chained by the routes they begin and end with.
pub(super) fn sequence(rounds: Vec<Round>, start: Point2) -> Vec<Round> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    for (i, round) in rounds.iter().enumerate() {
        match groups.last_mut() {
            Some(group) if rounds[group.start].color() == round.color() => group.end = i + 1,
            _ => groups.push(i..i + 1),
        }
    }
    let samples: Vec<Vec<Point2>> = rounds.iter().map(samples).collect();
    let mut chain = Chain { samples: &samples, start, stages: Vec::new() };
    groups.into_iter().for_each(|group| chain.add(group));
    let order = chain.finish();
    let mut rounds: Vec<Option<Round>> = rounds.into_iter().map(Some).collect();
    order.into_iter().filter_map(|i| rounds[i].take()).collect()
}

/// Vertices all along a route.
fn samples(round: &Round) -> Vec<Point2> {
    let count: usize = round.pieces.iter().map(|piece| piece.points.len()).sum();
    let points = round.pieces.iter().flat_map(|piece| piece.points.iter().copied());
    points.step_by(count.div_ceil(MOST_SAMPLES).max(1)).collect()
}

fn distance(a: &[Point2], b: &[Point2]) -> f64 {
    let least = |p: Point2| b.iter().map(|q| p.distance_squared(*q)).fold(f64::INFINITY, f64::min);
    a.iter().map(|&p| least(p)).fold(f64::INFINITY, f64::min).sqrt()
}

/// The colours so far, with the best way to end with each of their routes.
struct Chain<'a> {
    samples: &'a [Vec<Point2>],
    start: Point2,
    stages: Vec<Stage>,
}

struct Stage {
    first: usize,
    /// For each route, the best way that ends with it.
    ways: Vec<Way>,
}

/// The routes of a colour in sequence.
#[derive(Clone)]
struct Way {
    cost: f64,
    /// Which way of the stage before it follows.
    after: usize,
    routes: Vec<usize>,
}

impl Chain<'_> {
    fn add(&mut self, group: Range<usize>) {
        let samples = &self.samples[group.clone()];
        let count = samples.len();
        // What it costs to begin with each route, and after which way.
        let begin: Vec<(f64, usize)> = samples.iter().map(|route| self.begin(route)).collect();
        let mut apart = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..i {
                let d = distance(&samples[i], &samples[j]);
                (apart[i * count + j], apart[j * count + i]) = (d, d);
            }
        }
        let ways = if count <= MOST_EXACT {
            exact(count, &apart, &begin)
        } else {
            vec![nearest_first(count, &apart, &begin)]
        };
        self.stages.push(Stage { first: group.start, ways });
    }

    fn begin(&self, route: &[Point2]) -> (f64, usize) {
        let Some(stage) = self.stages.last() else {
            return (distance(&[self.start], route), 0);
        };
        let ways = stage.ways.iter().enumerate().filter_map(|(k, way)| {
            let last = stage.first + way.routes.last()?;
            Some((way.cost + distance(&self.samples[last], route), k))
        });
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
    }

    fn finish(self) -> Vec<usize> {
        let mut at = self.stages.last().and_then(|stage| {
            let ways = stage.ways.iter().enumerate();
            ways.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost)).map(|(k, _)| k)
        });
        let mut back = Vec::with_capacity(self.samples.len());
        for stage in self.stages.iter().rev() {
            let Some(way) = at.and_then(|k| stage.ways.get(k)) else { break };
            back.extend(way.routes.iter().rev().map(|route| stage.first + route));
            at = Some(way.after);
        }
        back.reverse();
        back
    }
}

/// The best way to end with each of a few routes.
fn exact(count: usize, apart: &[f64], begin: &[(f64, usize)]) -> Vec<Way> {
    // By the set of routes gone through and the last of them: the cost, and the one before.
    let mut best = vec![(f64::INFINITY, usize::MAX); count << count];
    for (i, &(cost, _)) in begin.iter().enumerate() {
        best[(1 << i) * count + i] = (cost, usize::MAX);
    }
    for set in 1..1usize << count {
        for last in (0..count).filter(|i| set >> i & 1 == 1) {
            let cost = best[set * count + last].0;
            for next in (0..count).filter(|i| set >> i & 1 == 0) {
                let to = &mut best[(set | 1 << next) * count + next];
                let way = cost + apart[last * count + next];
                if way < to.0 {
                    *to = (way, last);
                }
            }
        }
    }
    let whole = (1 << count) - 1;
    let way = |end: usize| {
        let (mut set, mut last, mut routes) = (whole, end, Vec::with_capacity(count));
        loop {
            routes.push(last);
            let before = best[set * count + last].1;
            set &= !(1 << last);
            if before == usize::MAX {
                break;
            }
            last = before;
        }
        routes.reverse();
        Way { cost: best[whole * count + end].0, after: begin[last].1, routes }
    };
    (0..count).map(way).collect()
}

/// Many routes, each the nearest to the one before.
fn nearest_first(count: usize, apart: &[f64], begin: &[(f64, usize)]) -> Way {
    let first = (0..count).min_by(|&a, &b| begin[a].0.total_cmp(&begin[b].0)).unwrap_or(0);
    let mut way = Way { cost: begin[first].0, after: begin[first].1, routes: vec![first] };
    let mut left: Vec<usize> = (0..count).filter(|&i| i != first).collect();
    let mut last = first;
    while let Some((k, d)) = left
        .iter()
        .map(|&next| apart[last * count + next])
        .enumerate()
        .min_by(|a, b| a.1.total_cmp(&b.1))
    {
        last = left.remove(k);
        way.cost += d;
        way.routes.push(last);
    }
    way
}
