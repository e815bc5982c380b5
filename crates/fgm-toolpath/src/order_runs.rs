//! Pieces in order, put into another as travels and changes of colour together cost least.

use fgm_core::Point2;

use crate::{
    Piece,
    order_color::Change,
    order_walk::{Door, Part, Stop, walk},
};

/// Shorter travels, mm, stay as they are.
const SHORT: f64 = 2.0;
/// Most runs of a layer: the longest travels part them.
const MOST: usize = 600;

/// Moves runs, pieces that follow each other without a long travel or a change of colour, to where
/// they cost least. `pieces` are in order; `start` is where the nozzle is before them. Where a piece
/// has no points, or some that are not finite, all stay as they are.
pub(crate) fn by_place(pieces: Vec<Piece>, start: Point2, change: Change<'_>) -> Vec<Piece> {
    if pieces.iter().any(|p| p.points.is_empty() || !p.points.iter().all(|p| p.is_finite())) {
        return pieces;
    }
    let mut runs = runs(pieces);
    let part = |run: &Vec<Piece>| {
        let (enter, exit) = (first(&run[0]), last(&run[run.len() - 1]));
        let door = |enter, exit, back| Door { enter, exit, cost: 0.0, back };
        Part { color: run[0].color, doors: vec![door(enter, exit, 1), door(exit, enter, 0)] }
    };
    let parts: Vec<Part> = runs.iter().map(part).collect();
    let mut tour: Vec<Stop> = (0..parts.len()).map(|run| (run, 0)).collect();
    walk(&parts, &mut tour, start, change);
    let mut out = Vec::with_capacity(runs.iter().map(Vec::len).sum());
    for (run, door) in tour {
        let mut run = std::mem::take(&mut runs[run]);
        if door == 1 {
            run.reverse();
            let open = run.iter_mut().filter(|piece| !piece.is_loop());
            open.for_each(|piece| piece.points.reverse());
        }
        out.append(&mut run);
    }
    out
}

fn runs(pieces: Vec<Piece>) -> Vec<Vec<Piece>> {
    let travel = |a: &Piece, b: &Piece| last(a).distance(first(b));
    let travels = pieces.windows(2).filter(|w| w[0].color == w[1].color);
    let mut long: Vec<f64> = travels.map(|w| travel(&w[0], &w[1])).filter(|l| *l > SHORT).collect();
    let longest = match long.len().checked_sub(MOST) {
        Some(rest) if rest > 0 => *long.select_nth_unstable_by(rest, f64::total_cmp).1,
        _ => SHORT,
    };
    let mut runs: Vec<Vec<Piece>> = Vec::new();
    for piece in pieces {
        match runs.last_mut() {
            Some(run)
                if run.last().is_some_and(|before| {
                    before.color == piece.color && travel(before, &piece) <= longest
                }) =>
            {
                run.push(piece);
            }
            _ => runs.push(vec![piece]),
        }
    }
    runs
}

fn first(piece: &Piece) -> Point2 {
    piece.points.first().copied().unwrap_or_default()
}

fn last(piece: &Piece) -> Point2 {
    piece.points.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::{ColorId, Role};
    use proptest::prelude::*;

    fn piece(points: &[(f64, f64)], color: u16) -> Piece {
        let points = points.iter().map(|&p| Point2::from(p)).collect();
        Piece::new(points, Role::Infill, 0.4, ColorId(color))
    }

    fn change(a: ColorId, b: ColorId) -> f64 {
        f64::from(a.0.abs_diff(b.0))
    }

    fn travel(pieces: &[Piece], start: Point2) -> f64 {
        let from = std::iter::once(start).chain(pieces.iter().map(last));
        from.zip(pieces).map(|(from, piece)| from.distance(first(piece))).sum()
    }

    #[test]
    fn loops_keep_their_direction_and_short_travels_their_place() {
        let square = [(25.0, 0.0), (26.0, 0.0), (26.0, 1.0), (25.0, 0.0)];
        let pieces = vec![
            piece(&[(0.0, 0.0), (9.0, 0.0)], 0),
            piece(&[(30.0, 0.0), (27.0, 0.0)], 0),
            piece(&square, 0),
            piece(&[(24.0, 0.0), (20.0, 0.0)], 0),
            piece(&[(40.0, 0.0), (0.0, 30.0)], 0),
        ];
        let out = by_place(pieces, Point2::ZERO, &change);
        let lines = |p: &Piece| p.points.iter().map(|q| (q.x, q.y)).collect::<Vec<_>>();
        let starts: Vec<f64> = out.iter().map(|p| p.points[0].x).collect();
        assert_eq!(starts, [0.0, 20.0, 25.0, 27.0, 40.0]);
        assert_eq!(lines(&out[2]), square);
    }

    #[test]
    fn what_has_no_place_stays() {
        let pieces = vec![
            piece(&[(9.0, 0.0), (8.0, 0.0)], 0),
            piece(&[], 1),
            piece(&[(0.0, 0.0), (1.0, 0.0)], 0),
        ];
        let out = by_place(pieces.clone(), Point2::ZERO, &change);
        assert_eq!(out, pieces);
        let far =
            vec![piece(&[(9.0, 0.0), (f64::NAN, 0.0)], 0), piece(&[(0.0, 0.0), (1.0, 0.0)], 0)];
        assert_eq!(by_place(far, Point2::ZERO, &change)[0].points[0].x, 9.0);
        assert!(by_place(Vec::new(), Point2::ZERO, &change).is_empty());
    }

    proptest! {
        #[test]
        fn every_piece_stays(
            lines in prop::collection::vec((0..4u16, 0..40i32, 0..40i32, -3..4i32, -3..4i32), 0..60),
        ) {
            let line = |&(color, x, y, u, v): &(u16, i32, i32, i32, i32)| {
                let (x, y) = (f64::from(x), f64::from(y));
                piece(&[(x, y), (x + f64::from(u), y + f64::from(v))], color)
            };
            let mut pieces: Vec<Piece> = lines.iter().map(line).collect();
            let free = |_: ColorId, _: ColorId| 0.0;
            let mut out = by_place(pieces.clone(), Point2::ZERO, &free);
            // On the way back, too.
            let way = |p: &[Piece]| travel(p, Point2::ZERO) + p.last().map_or(0.0, |p| last(p).length());
            prop_assert!(way(&out) <= way(&pieces) + 1e-6);
            let key = |p: &Piece| {
                let mut ends = [first(p), last(p)].map(|p| (p.x as i64, p.y as i64));
                ends.sort_unstable();
                (p.color, ends)
            };
            pieces.sort_by_key(key);
            out.sort_by_key(key);
            prop_assert!(pieces.iter().map(key).eq(out.iter().map(key)));
        }
    }
}
