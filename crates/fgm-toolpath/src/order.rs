use fgm_core::{ColorId, Point2, Role};

use crate::{
    Piece, order_monotone,
    order_near::Near,
    travel::{Leg, improve},
};

/// Points nearer than this, mm, are one point: no travel lies between them.
pub(crate) const MEETS: f64 = 1e-6;

/// How the pieces of a layer are put in order.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct OrderOptions {
    /// Which roles come first inside a colour.
    pub roles: RoleOrder,
    /// Where loops of the outer wall start.
    pub seam: Seam,
    /// The point that [`Seam::Aligned`] looks at, mm.
    pub seam_point: Point2,
    /// The layer, from 0: [`Seam::Random`] differs by it.
    pub layer: u32,
    /// Changes of the nearest-neighbour order that are tried for each piece, to shorten the
    /// travels; 0 leaves that order as it is.
    pub improve: u32,
    /// Which skins are laid line beside line.
    pub monotonic: Monotonic,
    /// Direction of the skins' lines, radians from +x.
    pub direction: f64,
}

impl Default for OrderOptions {
    fn default() -> Self {
        Self {
            roles: RoleOrder::Any,
            seam: Seam::Nearest,
            seam_point: Point2::ZERO,
            layer: 0,
            improve: 32,
            monotonic: Monotonic::Off,
            direction: 0.0,
        }
    }
}

/// Which skins are laid line beside line, in one direction of advance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Monotonic {
    /// None: the least travel.
    #[default]
    Off,
    /// Those seen from above.
    Top,
    /// Those seen from above and from below.
    All,
}

impl Monotonic {
    /// Whether it takes pieces of this role.
    fn takes(self, role: Role) -> bool {
        match role {
            Role::TopSkin => self != Self::Off,
            Role::BottomSkin => self == Self::All,
            _ => false,
        }
    }
}

/// Which roles come first inside a colour. Purge towers and skirts always do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum RoleOrder {
    /// Whatever is nearest: the least travel.
    #[default]
    Any,
    /// Outer walls, then inner walls, then the rest: the truest outline.
    OuterFirst,
    /// Inner walls, then outer walls, then the rest: outer walls find something to lean on.
    InnerFirst,
}

/// Where a loop of the outer wall starts and ends. Other loops start at their nearest vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Seam {
    /// At the vertex nearest to where the nozzle is.
    #[default]
    Nearest,
    /// At the vertex of greatest y: one line up the back.
    Rear,
    /// At the vertex nearest to [`OrderOptions::seam_point`], the same for all layers: one line,
    /// along an edge of the part where the point lies beyond one.
    Aligned,
    /// Anywhere along the loop, evenly spread and the same every time: by the layer and by the
    /// piece's place among those given.
    Random,
    /// At the vertex with the sharpest turn, where a seam shows least.
    Sharpest,
    /// In the sharpest corner that goes into the part, where a seam is in the shade; at the nearest
    /// vertex where none does by 20 degrees.
    Hidden,
}

/// Puts the pieces of one layer into printing order with [`OrderOptions::default`].
///
/// See [`order_with`].
pub fn order(pieces: Vec<Piece>, colors: &[ColorId], start: Point2) -> Vec<Piece> {
    order_with(pieces, colors, start, &OrderOptions::default())
}

/// Puts the pieces of one layer into printing order.
///
/// Colour follows colour as in `colors`; colours that are not in there come last, by number.
/// Inside a colour the next piece is the nearest one: an open piece may be printed from either
/// end, a loop (a piece whose last point is its first) from any vertex. Pieces of one colour that
/// meet end to end are printed without a travel between them. Then the order is changed where that
/// shortens the travels. `start` is where the nozzle is before the first piece, mm.
///
/// Skins that are to be [`Monotonic`] come last in their colour. Of two of their lines beside each
/// other, in one colour, the one to the right of [`OrderOptions::direction`] is then printed first;
/// lines joined into one piece are parted where that asks for it.
///
/// Every piece is kept, once, or parted so. Pieces with points that are not finite come last in their colour.
/// The same pieces in the same order give the same answer.
pub fn order_with(
    mut pieces: Vec<Piece>,
    colors: &[ColorId],
    start: Point2,
    options: &OrderOptions,
) -> Vec<Piece> {
    let used = pieces.iter().map(|p| p.color.index() + 1).max().unwrap_or_default();
    let mut rank = vec![usize::MAX; used];
    for (i, color) in colors.iter().enumerate().rev() {
        if let Some(rank) = rank.get_mut(color.index()) {
            *rank = i;
        }
    }
    if options.seam == Seam::Random {
        scatter(&mut pieces, options.layer);
    }
    let key = |p: &Piece| (rank[p.color.index()], p.color, class(p.role, options));
    pieces.sort_by_key(key);

    let mut out = Vec::with_capacity(pieces.len());
    let mut at = start;
    let mut rest = pieces.as_mut_slice();
    while let Some(first) = rest.first() {
        let same = key(first);
        let count = rest.partition_point(|p| key(p) <= same);
        let (group, others) = rest.split_at_mut(count);
        at = if options.monotonic.takes(group[0].role) {
            order_monotone::order(group, at, options.direction, &mut out)
        } else {
            order_group(group, at, options, &mut out)
        };
        rest = others;
    }
    out
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

/// Orders pieces that may stand in any order, moves them to `out`, and returns where the nozzle
/// then is.
fn order_group(
    pieces: &mut [Piece],
    start: Point2,
    options: &OrderOptions,
    out: &mut Vec<Piece>,
) -> Point2 {
    let mut ends = Ends::of(pieces, options);
    let mut near = Near::new(&ends.at);
    ends.link(&near);
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

fn take(piece: &mut Piece) -> Piece {
    let (points, way) = (std::mem::take(&mut piece.points), std::mem::take(&mut piece.way));
    let Piece { role, width, color, .. } = *piece;
    Piece { points, role, width, color, way }
}

/// The piece, begun at a vertex: an open piece at its first or its last, a loop at any.
fn begun_at(mut piece: Piece, vertex: u32) -> Piece {
    if piece.is_loop() {
        piece.points.pop();
        piece.points.rotate_left(vertex as usize);
        piece.points.extend(piece.points.first().copied());
    } else if vertex > 0 {
        piece.points.reverse();
    }
    piece
}

/// Begins every loop of the outer wall somewhere else.
fn scatter(pieces: &mut [Piece], layer: u32) {
    for (piece, i) in pieces.iter_mut().zip(0_u32..) {
        let finite = piece.points.iter().all(|p| p.is_finite());
        if finite && piece.role == Role::OuterWall && piece.is_loop() {
            let share = share_of(u64::from(layer) << 32 | u64::from(i));
            begin_along(&mut piece.points, share);
        }
    }
}

/// A number in 0..1 for every number given, evenly spread (the finaliser of splitmix64).
fn share_of(number: u64) -> f64 {
    let mut x = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^= x >> 31;
    (x >> 11) as f64 / (1_u64 << 53) as f64
}

/// Turns a loop so that it begins at a share of its length, at a new vertex.
fn begin_along(points: &mut Vec<Point2>, share: f64) {
    let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = share * length;
    for i in 1..points.len() {
        let (a, b) = (points[i - 1], points[i]);
        let step = a.distance(b);
        if left < step {
            let start = a.lerp(b, left / step);
            points.pop();
            let after = i % points.len();
            points.rotate_left(after);
            if start.distance(a) > MEETS {
                points.insert(0, start);
            } else {
                points.rotate_right(1);
            }
            points.extend(points.first().copied());
            return;
        }
        left -= step;
    }
}

/// Begins the loops among pieces that are in order already, whatever their role, where
/// [`OrderOptions::seam`] wants them to; those that may begin anywhere stay as they are.
///
/// For fills against the gradient ([`order_routes`](crate::order_routes)), whose loops are no walls.
pub fn begin_at_seams(pieces: &mut [Piece], options: &OrderOptions) {
    for (i, piece) in (0_u32..).zip(pieces) {
        if !piece.is_loop() || !piece.points.iter().all(|p| p.is_finite()) {
            continue;
        }
        if options.seam == Seam::Random {
            begin_along(&mut piece.points, share_of(u64::from(options.layer) << 32 | u64::from(i)));
        } else if let Some(vertex) = seam_vertex(&piece.points, options) {
            *piece = begun_at(take(piece), vertex as u32);
        }
    }
}

/// The vertex at which a piece has to start, if it has to.
fn seam_of(piece: &Piece, options: &OrderOptions) -> Option<usize> {
    (piece.role == Role::OuterWall).then(|| seam_vertex(&piece.points, options)).flatten()
}

/// The vertex at which a loop, its first point repeated at the end, has to start.
fn seam_vertex(points: &[Point2], options: &OrderOptions) -> Option<usize> {
    let ring = &points[..points.len() - 1];
    // Positive to the left: borders have the part on their left, so that it lies outside of the
    // corner where they turn right.
    let turn = |i: usize| {
        let before = ring[i] - ring[(i + ring.len() - 1) % ring.len()];
        let after = ring[(i + 1) % ring.len()] - ring[i];
        before.perp_dot(after).atan2(before.dot(after))
    };
    let best = |key: &dyn Fn(usize) -> f64| {
        (0..ring.len()).max_by(|&a, &b| key(a).total_cmp(&key(b)).then(b.cmp(&a)))
    };
    match options.seam {
        Seam::Nearest => None,
        Seam::Random => Some(0),
        Seam::Rear => best(&|i| ring[i].y),
        Seam::Aligned => best(&|i| -ring[i].distance_squared(options.seam_point)),
        Seam::Sharpest => best(&|i| turn(i).abs()),
        Seam::Hidden => best(&|i| -turn(i)).filter(|&i| -turn(i) >= LEAST_CORNER),
    }
}

/// A corner that hides a seam turns by as much, radians.
const LEAST_CORNER: f64 = 20.0 * std::f64::consts::PI / 180.0;

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

    fn of_piece(&self, id: u32) -> std::ops::Range<u32> {
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

    /// Joins open pieces that meet into chains.
    fn link(&mut self, near: &Near) {
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
                (self.link[id as usize], self.link[other as usize]) = (other, id);
                let (a, b) = (far[id as usize], far[other as usize]);
                (far[a as usize], far[b as usize]) = (b, a);
            }
        }
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
