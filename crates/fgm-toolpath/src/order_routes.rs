//! Putting routes in order: each is printed whole, from wherever it is best begun.

mod sequence;

use fgm_core::{ColorId, Point2};

use crate::{
    Piece,
    order::MEETS,
    order_color::{Change, ColorOrder},
    order_walk::{Door, Part, Stop, walk},
};
use sequence::{MOST_EXACT, sequence, stops};

/// Passes over a layer in which every route's place to begin is chosen anew, among all its vertices.
const PASSES: usize = 2;
/// Routes of a colour that may change places with every other one; beyond that with their
/// neighbours only.
const MOST_SWAPS: usize = 12;

/// Puts the routes of one layer into printing order.
///
/// A route is a round of pieces of one colour, as [`route`](crate::route) gives them: it may be
/// begun at any vertex, and in either direction. Colour follows colour as in `colors`, or, with
/// [`ColorOrder::change`], route follows route as travels and changes of colour together cost least.
/// Inside a colour, and from one to the next, routes follow in the sequence of least
/// travels, each begun where the travels to it and on from it are shortest; where it has a travel of
/// its own, that may be left out. `start` is where the nozzle is before the first piece, mm.
///
/// Every piece is kept, though one may be cut in two where its route begins. Empty pieces are
/// dropped. The same routes in the same order give the same answer.
pub fn order_routes<'a>(
    routes: Vec<Vec<Piece>>,
    colors: impl Into<ColorOrder<'a>>,
    start: Point2,
) -> Vec<Piece> {
    let colors = colors.into();
    let mut rounds: Vec<Round> = routes.into_iter().filter_map(Round::new).collect();
    let ranks = colors.ranks(rounds.iter().map(Round::color));
    rounds.sort_by_key(|round| (ranks[round.color().index()], round.color()));
    let stops: Vec<Vec<Gate>> = rounds.iter().map(stops).collect();
    // A tour that is walked anew needs no more than a beginning.
    let most_exact = if colors.change.is_some() { 1 } else { MOST_EXACT };
    let mut tour = sequence(&rounds, &stops, start, most_exact);
    if let Some(change) = colors.change {
        go_by_place(&rounds, &stops, &mut tour, start, change);
    }
    let mut gates: Vec<Gate> = tour.iter().map(|&(i, gate)| stops[i][gate as usize]).collect();
    let mut rounds: Vec<Option<Round>> = rounds.into_iter().map(Some).collect();
    let mut rounds: Vec<Round> = tour.iter().filter_map(|&(i, _)| rounds[i].take()).collect();
    for _ in 0..PASSES {
        swap(&mut rounds, &mut gates, start);
        choose(&rounds, &mut gates, start);
    }
    let count = rounds.iter().map(|round| round.pieces.len() + 1).sum();
    let mut out = Vec::with_capacity(count);
    for (round, gate) in rounds.into_iter().zip(gates) {
        round.begun_at(gate.begin, &mut out);
    }
    out
}

/// Comes back to a colour where that saves more travel than the changes cost.
fn go_by_place(
    rounds: &[Round],
    stops: &[Vec<Gate>],
    tour: &mut [Stop],
    start: Point2,
    change: Change<'_>,
) {
    let doors = |gates: &Vec<Gate>| {
        let back = |gate: &Gate| gates.iter().position(|other| other.begin == gate.turned().begin);
        let door = |(gate, i): (&Gate, u32)| Door {
            enter: gate.enter,
            exit: gate.exit,
            cost: gate.cost,
            back: back(gate).map_or(i, |back| back as u32),
        };
        gates.iter().zip(0..).map(door).collect()
    };
    let part = |(round, gates): (&Round, _)| Part { color: round.color(), doors: doors(gates) };
    let parts: Vec<Part> = rounds.iter().zip(stops).map(part).collect();
    walk(&parts, tour, start, change);
}

/// A route with what is asked about it.
struct Round {
    pieces: Vec<Piece>,
    /// The travels, as the pieces they follow.
    travels: Vec<usize>,
}

/// Where a route is entered and left.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gate {
    begin: Begin,
    enter: Point2,
    exit: Point2,
    /// What it costs beside the travels to and from: less than none where one is left out.
    cost: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Begin {
    /// At a vertex of a piece.
    Vertex(usize, usize),
    /// After the travel that follows a piece, or before it and backwards.
    Travel(usize, bool),
}

impl Gate {
    fn at(p: Point2) -> Self {
        Self { begin: Begin::Vertex(0, 0), enter: p, exit: p, cost: 0.0 }
    }

    /// Backwards.
    fn turned(self) -> Self {
        let begin = match self.begin {
            Begin::Travel(piece, turned) => Begin::Travel(piece, !turned),
            vertex => vertex,
        };
        Self { begin, enter: self.exit, exit: self.enter, ..self }
    }
}

impl Round {
    fn new(mut pieces: Vec<Piece>) -> Option<Self> {
        pieces.retain(|p| p.points.len() >= 2 && p.points.iter().all(|p| p.is_finite()));
        if pieces.is_empty() {
            return None;
        }
        let mut round = Self { pieces, travels: Vec::new() };
        let apart = |&i: &usize| {
            let (p, q) = round.travel(i);
            p.distance(q) > MEETS
        };
        round.travels = (0..round.pieces.len()).filter(apart).collect();
        Some(round)
    }

    fn color(&self) -> ColorId {
        self.pieces[0].color
    }

    /// From the end of a piece to the start of the next.
    fn travel(&self, piece: usize) -> (Point2, Point2) {
        let next = &self.pieces[(piece + 1) % self.pieces.len()];
        (self.pieces[piece].points[self.pieces[piece].points.len() - 1], next.points[0])
    }

    /// After each of the travels, which is then left out.
    fn travel_gates(&self) -> Vec<Gate> {
        let gate = |&i: &usize| {
            let (exit, enter) = self.travel(i);
            Gate { begin: Begin::Travel(i, false), enter, exit, cost: -exit.distance(enter) }
        };
        self.travels.iter().map(gate).collect()
    }

    /// The shortest way in from `from` and, if there is a next place, out to it.
    fn gate(&self, from: Point2, to: Option<Point2>) -> Gate {
        let onward = |p: Point2| to.map_or(0.0, |to| p.distance(to));
        let mut best = (f64::INFINITY, Gate::at(from));
        for (i, piece) in self.pieces.iter().enumerate() {
            for (j, &p) in piece.points.iter().enumerate() {
                let way = p.distance(from) + onward(p);
                if way < best.0 {
                    best = (way, Gate { begin: Begin::Vertex(i, j), ..Gate::at(p) });
                }
            }
        }
        for gate in self.travel_gates() {
            for gate in [gate, gate.turned()] {
                let way = gate.enter.distance(from) + onward(gate.exit) + gate.cost;
                if way < best.0 {
                    best = (way, gate);
                }
            }
        }
        best.1
    }

    /// Appends the pieces from a place on.
    fn begun_at(mut self, begin: Begin, out: &mut Vec<Piece>) {
        let (first, vertex, turned) = match begin {
            Begin::Vertex(piece, vertex) => (piece, vertex, false),
            Begin::Travel(piece, turned) => ((piece + 1) % self.pieces.len(), 0, turned),
        };
        self.pieces.rotate_left(first);
        let last = self.pieces[0].points.len() - 1;
        if self.pieces.len() == 1 && self.pieces[0].is_loop() {
            let points = &mut self.pieces[0].points;
            points.pop();
            points.rotate_left(vertex % last);
            points.push(points[0]);
        } else if vertex == last {
            self.pieces.rotate_left(1);
        } else if vertex > 0 {
            let mut before = self.pieces[0].clone();
            self.pieces[0].points.drain(..vertex);
            before.points.truncate(vertex + 1);
            self.pieces.push(before);
        }
        if turned {
            self.pieces.reverse();
            self.pieces.iter_mut().for_each(|piece| piece.points.reverse());
        }
        out.append(&mut self.pieces);
    }
}

/// Chooses every gate anew, between the ones before and after; the last one towards `start`, where
/// the next layer begins if it is printed in the opposite order of colours.
fn choose(rounds: &[Round], gates: &mut [Gate], start: Point2) {
    for i in 0..rounds.len() {
        let from = i.checked_sub(1).map_or(start, |before| gates[before].exit);
        let to = gates.get(i + 1).map_or(start, |next| next.enter);
        gates[i] = rounds[i].gate(from, Some(to));
    }
}

/// Moves routes inside their colour where that shortens the travels between the gates.
fn swap(rounds: &mut [Round], gates: &mut [Gate], start: Point2) {
    let mut first = 0;
    while first < rounds.len() {
        let color = rounds[first].color();
        let count = rounds[first..].iter().take_while(|round| round.color() == color).count();
        let end = first + count;
        for i in first..end {
            for j in i + 1..end.min(i + 1 + MOST_SWAPS) {
                let before = i.checked_sub(1).map_or(start, |k| gates[k].exit);
                let after = gates.get(j + 1).map(|gate| gate.enter);
                if reversal(&gates[i..=j], before, after) < -1e-9 {
                    rounds[i..=j].reverse();
                    gates[i..=j].reverse();
                    gates[i..=j].iter_mut().for_each(|gate| *gate = gate.turned());
                }
            }
        }
        first = end;
    }
}

/// What it adds to the travels to print some routes the other way round.
fn reversal(gates: &[Gate], before: Point2, after: Option<Point2>) -> f64 {
    let (Some(first), Some(last)) = (gates.first(), gates.last()) else { return 0.0 };
    let onward = |p: Point2| after.map_or(0.0, |after| p.distance(after));
    let now = before.distance(first.enter) + onward(last.exit);
    before.distance(last.exit) + onward(first.enter) - now
}

#[cfg(test)]
#[path = "order_routes_tests.rs"]
mod tests;
