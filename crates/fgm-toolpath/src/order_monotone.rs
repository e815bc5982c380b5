//! Lines of a skin one after the other, each laid beside one that is there already.
//!
//! A bead that is laid between two others, or on the other side than the one before, is pressed
//! another way and shines another way. So the lines are taken in one direction of advance, across
//! them: of two lines beside each other the lower one always comes first.

use fgm_core::Point2;

use crate::{Piece, order::MEETS};

/// Lines that lie this far apart, in widths of a bead, are beside each other.
const BESIDE: std::ops::RangeInclusive<f64> = 0.3..=1.5;
/// How far the ends of a segment along the lines may differ across them, mm.
const LEVEL: f64 = 1e-6;

/// Moves pieces to `out` so that they follow each other across `direction`, the lines' in radians,
/// to its left, and returns where the nozzle then is.
///
/// Lines joined along a border are parted where their sequence asks for it. Of the lines that may
/// be next the nearest one is taken, from its nearer end. What has no segment along the direction
/// stands anywhere.
pub(crate) fn order(
    pieces: &mut [Piece],
    start: Point2,
    direction: f64,
    out: &mut Vec<Piece>,
) -> Point2 {
    let axis = Point2::from_angle(direction);
    let mut lines = Vec::new();
    for (piece, i) in pieces.iter().zip(0..) {
        part(piece, i, axis, &mut lines);
    }
    let (after, mut waits) = follow(&lines, pieces);
    let mut ready: Vec<u32> = (0..lines.len() as u32).filter(|&i| waits[i as usize] == 0).collect();
    let first = out.len();
    let mut at = start;
    while let Some(k) = nearest(&ready, &lines, at) {
        let i = ready.swap_remove(k) as usize;
        let mut points = std::mem::take(&mut lines[i].points);
        let turned = points.last().zip(points.first());
        if turned.is_some_and(|(b, a)| at.distance_squared(*b) < at.distance_squared(*a)) {
            points.reverse();
        }
        at = points.last().copied().unwrap_or(at);
        append(Piece { points, ..piece_of(&pieces[lines[i].piece as usize]) }, first, out);
        for &next in &after[i] {
            waits[next as usize] -= 1;
            if waits[next as usize] == 0 {
                ready.push(next);
            }
        }
    }
    // What is no line has no place.
    let left = pieces.iter_mut().filter(|piece| !is_line(piece));
    out.extend(
        left.map(|piece| Piece { points: std::mem::take(&mut piece.points), ..piece_of(piece) }),
    );
    at
}

/// A line with what joins it to the next above.
struct Line {
    points: Vec<Point2>,
    /// Of the line itself, along the direction.
    from: f64,
    to: f64,
    /// Across it; `None` for what has no direction.
    across: Option<f64>,
    piece: u32,
}

fn is_line(piece: &Piece) -> bool {
    piece.points.len() > 1 && piece.points.iter().all(|p| p.is_finite())
}

/// The piece without its points.
fn piece_of(piece: &Piece) -> Piece {
    Piece::new(Vec::new(), piece.role, piece.width, piece.color)
}

/// Parts a piece into its lines. What joins two belongs to the lower one.
fn part(piece: &Piece, number: u32, axis: Point2, lines: &mut Vec<Line>) {
    if !is_line(piece) {
        return;
    }
    let turned: Vec<Point2> =
        piece.points.iter().map(|p| Point2::new(p.dot(axis), axis.perp_dot(*p))).collect();
    let level = |i: usize| (turned[i + 1].y - turned[i].y).abs() <= LEVEL;
    let segments = turned.len() - 1;
    // The level stretches, by their first and last vertex.
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    for i in (0..segments).filter(|&i| level(i)) {
        match stretches.last_mut() {
            Some(last) if last.1 == i => last.1 = i + 1,
            _ => stretches.push((i, i + 1)),
        }
    }
    let mut begin = 0;
    for (k, &(first, last)) in stretches.iter().enumerate() {
        let end = match stretches.get(k + 1) {
            Some(next) if turned[next.0].y < turned[last].y => last,
            Some(next) => next.0,
            None => segments,
        };
        let (a, b) = (turned[first].x, turned[last].x);
        lines.push(Line {
            points: piece.points[begin..=end].to_vec(),
            from: a.min(b),
            to: a.max(b),
            across: Some(turned[first].y),
            piece: number,
        });
        begin = end;
    }
    if stretches.is_empty() {
        let points = piece.points.clone();
        lines.push(Line { points, from: 0.0, to: 0.0, across: None, piece: number });
    }
}

/// The lines that wait for each line, and for how many each waits.
fn follow(lines: &[Line], pieces: &[Piece]) -> (Vec<Vec<u32>>, Vec<u32>) {
    let mut order: Vec<(f64, u32)> =
        lines.iter().zip(0..).filter_map(|(line, i)| Some((line.across?, i))).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut after = vec![Vec::new(); lines.len()];
    let mut waits = vec![0; lines.len()];
    for (k, &(across, i)) in order.iter().enumerate() {
        let line = &lines[i as usize];
        let width = pieces[line.piece as usize].width;
        let (least, most) = (BESIDE.start() * width, BESIDE.end() * width);
        let above = order[k + 1..].iter().take_while(|next| next.0 - across <= most);
        for &(_, j) in above.filter(|next| next.0 - across >= least) {
            let next = &lines[j as usize];
            if line.to.min(next.to) > line.from.max(next.from) {
                after[i as usize].push(j);
                waits[j as usize] += 1;
            }
        }
    }
    (after, waits)
}

/// The place in `ready` of the line that begins or ends nearest to a point; of equally near ones
/// the first line.
fn nearest(ready: &[u32], lines: &[Line], at: Point2) -> Option<usize> {
    let distance = |i: u32| {
        let ends = [lines[i as usize].points.first(), lines[i as usize].points.last()];
        ends.into_iter().flatten().map(|p| p.distance_squared(at)).fold(f64::INFINITY, f64::min)
    };
    let keys = ready.iter().map(|&i| (distance(i), i)).enumerate();
    keys.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(k, _)| k)
}

/// Adds a piece, to the end of the last one (from `first` on) where they meet.
fn append(piece: Piece, first: usize, out: &mut Vec<Piece>) {
    if out.len() > first
        && let Some(last) = out.last_mut()
        && (last.role, last.width, last.color) == (piece.role, piece.width, piece.color)
        && let (Some(end), Some(start)) = (last.points.last(), piece.points.first())
        && end.distance(*start) <= MEETS
    {
        last.points.extend_from_slice(&piece.points[1..]);
        return;
    }
    out.push(piece);
}

#[cfg(test)]
#[path = "order_monotone_tests.rs"]
mod tests;
