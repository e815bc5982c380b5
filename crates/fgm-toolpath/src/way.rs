//! Travels that go round instead of over the outer wall.

mod round;

use fgm_core::{Point2, Polygon};

use crate::{Inset, Piece, order::MEETS, support::Support};
use round::Rooms;

/// The shares of a bead's width inside the outline at which ways go along it: behind the outer wall,
/// or, where the part is too thin for that, on it.
const INSIDE: [f64; 2] = [1.0, 0.4];
/// What no way crosses: a little less than where the outer wall's middle lies, so that its points
/// lie inside.
const LIMIT: f64 = 0.35;

/// How travels keep off the outer wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WayOptions {
    /// Width of a bead, mm.
    pub width: f64,
    /// What a way round may be longer than the straight one, mm.
    pub max_detour: f64,
}

/// Gives the pieces of a layer, in printing order, their [ways](Piece::way): where the straight
/// travel to a piece would cross the border of `region`, whose [`Support`] is `border`, the nozzle
/// goes round inside, if both ends lie in one part of it and the detour is no more than it may be.
/// `from` is where the nozzle is before, if that is known.
///
/// Ways bend where they have to: along the outline, a bead inside it, and round holes. They are short, though not always the shortest: a way follows the borders that are in the
/// way of the straight line, each the shorter way round, and is then pulled taut.
pub fn find_ways(
    pieces: &mut [Piece],
    from: Option<Point2>,
    region: &[Polygon],
    border: &Support,
    options: &WayOptions,
    inset: &dyn Inset,
) {
    let (mut rooms, mut crossings, mut at) = ([None, None], Vec::new(), from);
    for piece in pieces {
        let (Some(&first), Some(&last)) = (piece.points.first(), piece.points.last()) else {
            continue;
        };
        let from = at.replace(last).filter(|from| from.distance(first) > MEETS);
        let Some(from) = from.filter(|_| piece.role.is_part()) else { continue };
        crossings.clear();
        border.crossings(from, first, &mut crossings);
        if crossings.is_empty() {
            continue;
        }
        let most = from.distance(first) + options.max_detour;
        piece.way = INSIDE
            .iter()
            .zip(&mut rooms)
            .find_map(|(share, rooms)| {
                let rooms = rooms.get_or_insert_with(|| {
                    let at = |share: f64| inset.inset(region, share * options.width);
                    Rooms::new(at(*share), &at(LIMIT), options.width)
                });
                rooms.way(from, first, most)
            })
            .unwrap_or_default();
    }
}

#[cfg(test)]
#[path = "way_tests.rs"]
mod tests;
