use std::ops::Range;

use fgm_core::{Point2, Role};

use crate::{
    Piece,
    level_ends::{self, PieceEnd},
    order_color::ColorOrder,
    order_monotone,
    order_near::Near,
    order_options::{Monotonic, OrderOptions, RoleOrder},
    order_runs,
    order_seam::{Seam, scatter, seam_of},
    travel::{Leg, improve},
};

/// Points nearer than this, mm, are one point: no travel lies between them.
pub(crate) const MEETS: f64 = 1e-6;

/// Puts the pieces of one layer into printing order with [`OrderOptions::default`].
///
/// See [`order_with`].
pub fn order<'a>(
    pieces: Vec<Piece>,
    colors: impl Into<ColorOrder<'a>>,
    start: Point2,
) -> Vec<Piece> {
    order_with(pieces, colors, start, &OrderOptions::default())
}

/// Puts the pieces of one layer into printing order.
///
/// Colour follows colour as in `colors`; colours that are not in there come last, by number. With
/// [`ColorOrder::change`] pieces near each other then move to where travels and changes of colour
/// together cost least, unless an order of roles or lines is asked for. Inside a colour the next piece
/// is the nearest one: an open piece may be printed from either end, a loop (a piece whose last point
/// is its first) from any vertex. Pieces of one colour that meet end to end are printed without a
/// travel between them. Then the order is changed where that shortens the travels. `start` is where the
/// nozzle is before the first piece, mm.
///
/// Skins that are to be [`Monotonic`](crate::Monotonic) come last in their colour. Of two of their
/// lines beside each other, in one colour, the one to the right of [`OrderOptions::direction`] is then
/// printed first; lines joined into one piece are parted where that asks for it.
///
/// Every piece is kept, once, or parted so; with [`OrderOptions::turns`] ends may move. Pieces with
/// points that are not finite come last in their colour. The same pieces in the same order give the
/// same answer.
pub fn order_with<'a>(
    mut pieces: Vec<Piece>,
    colors: impl Into<ColorOrder<'a>>,
    start: Point2,
    options: &OrderOptions,
) -> Vec<Piece> {
    let colors = colors.into();
    let ranks = colors.ranks(pieces.iter().map(|p| p.color));
    if options.seam == Seam::Random {
        scatter(&mut pieces, options.layer);
    }
    pieces.sort_by_key(|p| (ranks[p.color.index()], p.color, class(p.role, options)));
    let key = |p: &Piece| (p.color, class(p.role, options));
    let free = options.roles == RoleOrder::Any && options.monotonic == Monotonic::Off;
    let mut out = Vec::with_capacity(pieces.len());
    let (mut at, total) = (start, pieces.len());
    let ends = options.turns.map(|turns| (turns, level_ends::Ends::of(&pieces)));
    let mut pairs = Vec::new();
    let mut rest = pieces.as_mut_slice();
    while let Some(piece) = rest.first() {
        let first = key(piece);
        let count = rest.iter().take_while(|p| key(p) == first).count();
        let (group, others) = rest.split_at_mut(count);
        let printed = out.len();
        at = if options.monotonic.takes(group[0].role) {
            order_monotone::order(group, at, options.direction, &mut out)
        } else {
            let first = total - others.len() - count;
            order_group(group, at, options, &pairs_of(&pairs, first..first + count), &mut out)
        };
        if let Some((turns, ends)) = &ends {
            ends.level(&mut out[printed..], others, total - others.len(), turns, &mut pairs);
        }
        if let Some(via) = colors.via.filter(|_| free) {
            let group = out.split_off(printed);
            out.append(&mut order_runs::by_place(group, via, &|_, _| 0.0));
            at = via;
        }
        rest = others;
    }
    match colors.change {
        Some(change) if free => order_runs::by_place(out, start, change),
        _ => out,
    }
}

fn class(role: Role, options: &OrderOptions) -> u8 {
    match (role, options.roles) {
        (role, _) if options.monotonic.takes(role) => 4 + u8::from(role == Role::TopSkin),
        (Role::PurgeTower | Role::Skirt, _) => 0,
        (Role::OuterWall, RoleOrder::OuterFirst) | (Role::InnerWall, RoleOrder::InnerFirst) => 1,
        (Role::InnerWall, RoleOrder::OuterFirst) | (Role::OuterWall, RoleOrder::InnerFirst) => 2,
        _ => 3,
    }
}

/// The pairs of ends of some pieces, by their number among these.
fn pairs_of(pairs: &[[PieceEnd; 2]], pieces: Range<usize>) -> Vec<[PieceEnd; 2]> {
    let inside = |pair: &&[PieceEnd; 2]| pair.iter().all(|end| pieces.contains(&end.piece));
    let own = |end: PieceEnd| PieceEnd { piece: end.piece - pieces.start, ..end };
    pairs.iter().filter(inside).map(|pair| pair.map(own)).collect()
}

/// Orders pieces that may stand in any order, moves them to `out`, and returns where the nozzle
/// then is. Ends that make a pair follow each other.
fn order_group(
    pieces: &mut [Piece],
    start: Point2,
    options: &OrderOptions,
    pairs: &[[PieceEnd; 2]],
    out: &mut Vec<Piece>,
) -> Point2 {
    let mut ends = Ends::of(pieces, options);
    let mut near = Near::new(&ends.at);
    ends.link(&near, pairs);
    let mut legs = ends.tour(&mut near, start);
    if options.improve > 0 {
        improve(&mut legs, start, options.improve);
        ends.begin_loops(&mut legs, start);
    }

    let mut taken = vec![false; pieces.len()];
    for leg in &legs {
        let mut id = leg.first;
        while id != NONE {
            let i = ends.piece[id as usize] as usize;
            taken[i] = true;
            out.push(begun_at(take(&mut pieces[i]), ends.vertex[id as usize]));
            id = ends.link[ends.other(id) as usize];
        }
    }
    let left = pieces.iter_mut().zip(&taken).filter(|(_, taken)| !**taken);
    out.extend(left.map(|(piece, _)| take(piece)));
    legs.last().map_or(start, |leg| leg.exit)
}

pub(crate) fn take(piece: &mut Piece) -> Piece {
    let (points, way) = (std::mem::take(&mut piece.points), std::mem::take(&mut piece.way));
    let Piece { role, width, color, .. } = *piece;
    Piece { points, role, width, color, way }
}

/// The piece, begun at a vertex: an open piece at its first or its last, a loop at any.
pub(crate) fn begun_at(mut piece: Piece, vertex: u32) -> Piece {
    if piece.is_loop() {
        piece.points.pop();
        piece.points.rotate_left(vertex as usize);
        piece.points.extend(piece.points.first().copied());
    } else if vertex > 0 {
        piece.points.reverse();
    }
    piece
}

const NONE: u32 = u32::MAX;

/// The points at which pieces may be begun, by number.
struct Ends {
    at: Vec<Point2>,
    /// The piece it belongs to.
    piece: Vec<u32>,
    /// The vertex of the piece.
    vertex: Vec<u32>,
    /// The end of another piece that it meets.
    link: Vec<u32>,
    /// The first end of every piece, and the number of ends last.
    first: Vec<u32>,
    /// Whether a piece is open: it then has two ends, its first and its last point.
    open: Vec<bool>,
}

impl Ends {
    fn of(pieces: &[Piece], options: &OrderOptions) -> Self {
        let count = pieces.len();
        let mut ends = Self {
            at: Vec::with_capacity(2 * count),
            piece: Vec::with_capacity(2 * count),
            vertex: Vec::with_capacity(2 * count),
            link: Vec::new(),
            first: Vec::with_capacity(count + 1),
            open: Vec::with_capacity(count),
        };
        for (piece, i) in pieces.iter().zip(0_u32..) {
            ends.first.push(ends.at.len() as u32);
            ends.open.push(!piece.is_loop());
            let last = piece.points.len().saturating_sub(1);
            if !piece.points.iter().all(|p| p.is_finite()) {
                continue;
            }
            if piece.is_loop() {
                let seam = seam_of(piece, options);
                let vertices = seam.map_or(0..last, |vertex| vertex..vertex + 1);
                vertices.for_each(|vertex| ends.push(piece, i, vertex));
            } else if last > 0 {
                ends.push(piece, i, 0);
                ends.push(piece, i, last);
            }
        }
        ends.first.push(ends.at.len() as u32);
        ends.link = vec![NONE; ends.at.len()];
        ends
    }

    fn push(&mut self, piece: &Piece, index: u32, vertex: usize) {
        self.at.push(piece.points[vertex]);
        self.piece.push(index);
        self.vertex.push(vertex as u32);
    }

    fn of_piece(&self, id: u32) -> Range<u32> {
        let piece = self.piece[id as usize] as usize;
        self.first[piece]..self.first[piece + 1]
    }

    /// Where a piece begun at `id` ends; the same for a loop.
    fn other(&self, id: u32) -> u32 {
        if !self.open[self.piece[id as usize] as usize] {
            return id;
        }
        let range = self.of_piece(id);
        range.start + (range.end - 1 - id)
    }

    /// Joins open pieces that meet, and pairs of ends, into chains.
    fn link(&mut self, near: &Near, pairs: &[[PieceEnd; 2]]) {
        // The other end of the chain that ends here.
        let mut far: Vec<u32> = (0..self.at.len() as u32).map(|id| self.other(id)).collect();
        for id in near.ids() {
            // A loop's ends have themselves at the other end.
            if self.link[id as usize] != NONE || far[id as usize] == id {
                continue;
            }
            let accept = |other: u32| {
                self.link[other as usize] == NONE
                    && far[other as usize] != other
                    && far[id as usize] != other
            };
            if let Some(other) = near.other_at(id, MEETS, accept) {
                self.tie(id, other, &mut far);
            }
        }
        for pair in pairs {
            let [Some(one), Some(other)] = pair.map(|end| self.of_open(end)) else { continue };
            let free = [one, other].iter().all(|&id| self.link[id as usize] == NONE);
            if free && far[one as usize] != other {
                self.tie(one, other, &mut far);
            }
        }
    }

    fn tie(&mut self, one: u32, other: u32, far: &mut [u32]) {
        (self.link[one as usize], self.link[other as usize]) = (other, one);
        let (a, b) = (far[one as usize], far[other as usize]);
        (far[a as usize], far[b as usize]) = (b, a);
    }

    /// The end of a piece, where that is open.
    fn of_open(&self, end: PieceEnd) -> Option<u32> {
        let range = self.first[end.piece]..self.first[end.piece + 1];
        let open = self.open[end.piece] && range.len() == 2;
        open.then_some(range.start + u32::from(end.last))
    }

    /// The other end of the chain that begins at `id`.
    fn end_of_chain(&self, mut id: u32) -> u32 {
        loop {
            id = self.other(id);
            match self.link[id as usize] {
                NONE => return id,
                next => id = next,
            }
        }
    }

    /// Begins every loop where the way from what is before it to what is after it is shortest.
    fn begin_loops(&self, legs: &mut [Leg], start: Point2) {
        let mut before = start;
        for i in 0..legs.len() {
            let leg = legs[i];
            if leg.first == leg.last {
                let next = legs.get(i + 1).map(|next| next.enter);
                let way = |id: u32| {
                    let at = self.at[id as usize];
                    before.distance(at) + next.map_or(0.0, |next| at.distance(next))
                };
                let best = self.of_piece(leg.first).min_by(|&a, &b| way(a).total_cmp(&way(b)));
                if let Some(id) = best.filter(|&id| way(id) < way(leg.first)) {
                    let at = self.at[id as usize];
                    legs[i] = Leg { enter: at, exit: at, first: id, last: id };
                }
            }
            before = legs[i].exit;
        }
    }

    /// Chains and loops, each the nearest one to the end of the one before.
    fn tour(&self, near: &mut Near, start: Point2) -> Vec<Leg> {
        let inside = self.link.iter().zip(0..).filter(|(link, _)| **link != NONE);
        inside.for_each(|(_, id)| near.remove(id));
        let mut legs = Vec::with_capacity(self.open.len());
        let mut at = start;
        while let Some(first) = near.nearest(at) {
            let last = self.end_of_chain(first);
            if first == last {
                self.of_piece(first).for_each(|id| near.remove(id));
            }
            near.remove(first);
            near.remove(last);
            let (enter, exit) = (self.at[first as usize], self.at[last as usize]);
            legs.push(Leg { enter, exit, first, last });
            at = exit;
        }
        legs
    }
}

#[cfg(test)]
#[path = "order_tests.rs"]
mod tests;
