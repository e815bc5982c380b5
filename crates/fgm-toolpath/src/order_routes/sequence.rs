//! Which route follows which, inside every colour and from colour to colour, and where each is
//! begun.

use std::ops::Range;

use fgm_core::Point2;

use super::{Begin, Gate, Round};
use crate::order_walk::Stop;

/// Routes of a colour of which every sequence is gone through; more are taken nearest first.
pub(super) const MOST_EXACT: usize = 5;
/// Vertices of a route at which it may be begun, as far as the sequence is concerned.
const MOST_STOPS: usize = 24;
/// Travels of its own that a route may be begun after or before, the longest.
const MOST_TRAVELS: usize = 4;

/// Puts the routes of each colour into the sequence of least travels, with the place to begin each.
///
/// A route is left where it is begun, but for travels of its own. So the state of the search is the
/// set of routes printed, the last of them and where it was left (Held and Karp, 1962, with places):
/// colour by colour, the best way to every place a colour may end at.
pub(super) fn sequence(
    rounds: &[Round],
    stops: &[Vec<Gate>],
    start: Point2,
    most_exact: usize,
) -> Vec<Stop> {
    let mut search = Search::new(stops, start);
    let mut ends: Vec<Nodes> = std::iter::once(0..1).collect();
    let mut first = 0;
    while first < rounds.len() {
        let color = rounds[first].color();
        let count = rounds[first..].iter().take_while(|round| round.color() == color).count();
        let group = first..first + count;
        ends = if count <= most_exact {
            search.exact(&ends, group)
        } else {
            search.nearest_first(&ends, group)
        };
        first += count;
    }
    search.best(&ends)
}

/// Where a route may be begun and left.
pub(super) fn stops(round: &Round) -> Vec<Gate> {
    let count: usize = round.pieces.iter().map(|piece| piece.points.len()).sum();
    let points = round.pieces.iter().enumerate().flat_map(|(i, piece)| {
        piece.points.iter().enumerate().map(move |(j, &p)| (Begin::Vertex(i, j), p))
    });
    let at = |(begin, p)| Gate { begin, ..Gate::at(p) };
    let mut out: Vec<Gate> = points.step_by(count.div_ceil(MOST_STOPS).max(1)).map(at).collect();
    let mut travels = round.travel_gates();
    travels.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    travels.truncate(MOST_TRAVELS);
    out.extend(travels.into_iter().flat_map(|gate| [gate, gate.turned()]));
    out
}

/// A route printed, and how one came to that.
#[derive(Clone, Copy, Debug)]
struct Node {
    cost: f64,
    exit: Point2,
    before: u32,
    /// The route, and which of its stops.
    round: u32,
    stop: u32,
}

struct Search<'a> {
    stops: &'a [Vec<Gate>],
    /// The first stands for the beginning.
    nodes: Vec<Node>,
}

/// The nodes of all stops of a route.
type Nodes = Range<usize>;

impl<'a> Search<'a> {
    fn new(stops: &'a [Vec<Gate>], start: Point2) -> Self {
        let begin = Node { cost: 0.0, exit: start, before: 0, round: u32::MAX, stop: 0 };
        Self { stops, nodes: vec![begin] }
    }

    /// Prints a route after the best of the nodes `before`, at each of its stops.
    fn extend<'n>(
        &mut self,
        before: &(impl Iterator<Item = &'n Nodes> + Clone),
        round: usize,
    ) -> Nodes {
        let first = self.nodes.len();
        for (number, stop) in (0..).zip(&self.stops[round]) {
            let mut best = (f64::INFINITY, 0);
            for nodes in before.clone() {
                for (i, node) in nodes.clone().zip(&self.nodes[nodes.clone()]) {
                    if node.cost < best.0 {
                        let cost = node.cost + node.exit.distance(stop.enter);
                        if cost < best.0 {
                            best = (cost, i as u32);
                        }
                    }
                }
            }
            self.nodes.push(Node {
                cost: best.0 + stop.cost,
                exit: stop.exit,
                before: best.1,
                round: round as u32,
                stop: number,
            });
        }
        first..self.nodes.len()
    }

    /// The best ways to end with each of a colour's routes.
    fn exact(&mut self, before: &[Nodes], group: Range<usize>) -> Vec<Nodes> {
        let count = group.len();
        let whole = (1 << count) - 1;
        let mut table: Vec<Nodes> = vec![0..0; count << count];
        for set in 1..=whole {
            for last in (0..count).filter(|i| set >> i & 1 == 1) {
                let rest = set & !(1 << last);
                let round = group.start + last;
                table[set * count + last] = if rest == 0 {
                    self.extend(&before.iter(), round)
                } else {
                    let others = (0..count).filter(|i| rest >> i & 1 == 1);
                    self.extend(&others.map(|i| &table[rest * count + i]), round)
                };
            }
        }
        table.split_off(whole * count)
    }

    /// Each route the nearest to the one before.
    fn nearest_first(&mut self, before: &[Nodes], group: Range<usize>) -> Vec<Nodes> {
        let mut left: Vec<usize> = group.collect();
        let mut ends = before.to_vec();
        while !left.is_empty() {
            let from: Vec<Point2> = self.exits(&ends).collect();
            let near = |round: usize| {
                let places = self.stops[round].iter().map(|stop| stop.enter);
                let squares = places.flat_map(|p| from.iter().map(move |q| p.distance_squared(*q)));
                squares.fold(f64::INFINITY, f64::min)
            };
            let distances = left.iter().map(|&round| near(round)).enumerate();
            let Some((k, _)) = distances.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let round = left.remove(k);
            ends = vec![self.extend(&ends.iter(), round)];
        }
        ends
    }

    fn exits(&self, nodes: &[Nodes]) -> impl Iterator<Item = Point2> {
        nodes.iter().flat_map(|nodes| self.nodes[nodes.clone()].iter().map(|node| node.exit))
    }

    /// The routes and where they are begun, on the best way to one of the nodes.
    fn best(&self, ends: &[Nodes]) -> Vec<Stop> {
        let nodes = ends.iter().cloned().flatten();
        let cost = |i: &usize| self.nodes[*i].cost;
        let mut at = nodes.min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(0);
        let mut back = Vec::with_capacity(self.stops.len());
        while at != 0 {
            let node = self.nodes[at];
            back.push((node.round as usize, node.stop));
            at = node.before as usize;
        }
        back.reverse();
        back
    }
}
