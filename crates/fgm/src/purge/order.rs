//! Hidden filling first, where it is to take the old colour.

use fgm_core::{ColorId, Point2, bead};
use fgm_toolpath::{OrderOptions, Piece, order_with};

use super::needs::Needs;

/// The pieces of a layer in printing order, each colour begun with as much hidden filling as the
/// change to it takes; the rest in its usual order.
///
/// The first colour begins as it comes: layers mostly begin in the colour in which the one below
/// ended.
pub(crate) fn hidden_first(
    pieces: Vec<Piece>,
    colors: &[ColorId],
    start: Point2,
    options: &OrderOptions,
    needs: &Needs,
    height: f64,
) -> Vec<Piece> {
    let mut groups: Vec<Vec<Piece>> = vec![Vec::new(); colors.len()];
    let mut others = Vec::new();
    for piece in pieces {
        match colors.iter().position(|color| *color == piece.color) {
            Some(i) => groups[i].push(piece),
            None => others.push(piece),
        }
    }
    let mut out: Vec<Piece> = Vec::new();
    let mut before = None;
    for (group, color) in groups.into_iter().zip(colors) {
        if group.is_empty() {
            continue;
        }
        let at = end(&out).unwrap_or(start);
        let volume = before.map_or(0.0, |before| needs.volume(Some(before), *color));
        before = Some(*color);
        if volume <= 0.0 {
            out.extend(order_with(group, colors, at, options));
            continue;
        }
        let (hidden, mut rest): (Vec<_>, Vec<_>) =
            group.into_iter().partition(|piece| piece.role.is_hidden());
        let mut taken = 0.0;
        for piece in order_with(hidden, colors, at, options) {
            if taken < volume {
                taken += piece.length() * bead::area(piece.width, height);
                out.push(piece);
            } else {
                rest.push(piece);
            }
        }
        let at = end(&out).unwrap_or(start);
        out.extend(order_with(rest, colors, at, options));
    }
    let at = end(&out).unwrap_or(start);
    out.extend(order_with(others, colors, at, options));
    out
}

fn end(pieces: &[Piece]) -> Option<Point2> {
    pieces.last().and_then(|piece| piece.points.last().copied())
}
