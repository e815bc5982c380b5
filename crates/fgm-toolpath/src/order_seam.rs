//! Where loops begin.

use fgm_core::{Point2, Role};

use crate::{
    Piece,
    order::{MEETS, begun_at, take},
    order_options::OrderOptions,
};

/// A corner that hides a seam turns by as much, radians.
const LEAST_CORNER: f64 = 20.0 * std::f64::consts::PI / 180.0;

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

/// Begins every loop of the outer wall somewhere else.
pub(crate) fn scatter(pieces: &mut [Piece], layer: u32) {
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
pub(crate) fn seam_of(piece: &Piece, options: &OrderOptions) -> Option<usize> {
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
