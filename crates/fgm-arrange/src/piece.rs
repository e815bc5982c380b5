use fgm_core::{Bounds2, Point2};
use std::ops::Range;

/// Segments in a piece at most. Longer pieces make fewer boxes, shorter ones tighter boxes.
const LONGEST: usize = 8;

/// A run of segments that go one way in x and one way in y, so that its least rectangle, and that
/// of every part of it, is given by its end points, and it does not meet itself.
///
/// After the monotone chains of JTS's `index.chain`, with bounded length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Index of the first point.
    pub(crate) first: u32,
    /// Index of the last point, above `first`.
    pub(crate) last: u32,
    /// The line that it is a part of.
    pub(crate) owner: u32,
    /// The ways it goes, as [`heading`] tells them.
    heading: u8,
}

/// Bits of a heading; the one after each is for the opposite way.
const RIGHT: u8 = 1;
const UP: u8 = 4;

/// A bit each for going right, left, up and down.
#[inline]
fn heading(a: Point2, b: Point2) -> u8 {
    let bit = |goes: bool, bit: u8| u8::from(goes) * bit;
    let (right, left) = (bit(a.x < b.x, RIGHT), bit(a.x > b.x, RIGHT << 1));
    let (up, down) = (bit(a.y < b.y, UP), bit(a.y > b.y, UP << 1));
    right | left | up | down
}

/// Whether these are opposite ways.
#[inline]
fn turns_back(heading: u8) -> bool {
    heading & (heading >> 1) & 0b0101 != 0
}

/// Cuts the line through `points[first..=last]` into pieces.
pub(crate) fn split(
    points: &[Point2],
    first: usize,
    last: usize,
    owner: u32,
    out: &mut Vec<Piece>,
) {
    let mut start = first;
    while start < last {
        let end = (start + LONGEST).min(last);
        let mut seen = heading(points[start], points[start + 1]);
        let mut at = start + 1;
        while at < end {
            let more = seen | heading(points[at], points[at + 1]);
            if turns_back(more) {
                break;
            }
            seen = more;
            at += 1;
        }
        out.push(Piece { first: start as u32, last: at as u32, owner, heading: seen });
        start = at;
    }
}

/// The least rectangle around a segment.
#[inline]
pub(crate) fn around(a: Point2, b: Point2) -> Bounds2 {
    Bounds2::new(a.min(b), a.max(b))
}

/// Whether two rectangles share a point.
#[inline]
pub(crate) fn overlap(a: &Bounds2, b: &Bounds2) -> bool {
    // Without branches: which of the four fails cannot be predicted.
    (a.min.x <= b.max.x) & (b.min.x <= a.max.x) & (a.min.y <= b.max.y) & (b.min.y <= a.max.y)
}

impl Piece {
    #[inline]
    pub(crate) fn bounds(&self, points: &[Point2]) -> Bounds2 {
        around(points[self.first as usize], points[self.last as usize])
    }

    /// Whether another piece of the same line only goes on from this one, so that the two meet in
    /// their common point alone.
    #[inline]
    pub(crate) fn goes_on_into(&self, other: &Self) -> bool {
        let (a, b) = if self.first < other.first { (self, other) } else { (other, self) };
        a.last == b.first && a.owner == b.owner && !turns_back(a.heading | b.heading)
    }

    /// The first points of its segments.
    #[inline]
    pub(crate) fn segments(&self) -> Range<usize> {
        self.first as usize..self.last as usize
    }

    /// The segments whose rectangles reach into `window`: neighbours all, as the piece is monotone.
    #[inline]
    pub(crate) fn clip(&self, points: &[Point2], window: &Bounds2) -> Range<usize> {
        // Counted, not searched: where each search would end cannot be predicted.
        let (mut below, mut above) = ([0; 2], [0; 2]);
        for p in &points[self.first as usize..=self.last as usize] {
            below[0] += usize::from(p.x < window.min.x);
            below[1] += usize::from(p.y < window.min.y);
            above[0] += usize::from(p.x > window.max.x);
            above[1] += usize::from(p.y > window.max.y);
        }
        let first = |forth: bool, axis: usize| if forth { below[axis] } else { above[axis] };
        let last = |forth: bool, axis: usize| if forth { above[axis] } else { below[axis] };
        let (right, up) = (self.heading & RIGHT != 0, self.heading & UP != 0);
        // A segment is beside the window when both its ends are, on one side.
        let start = first(right, 0).max(first(up, 1)).saturating_sub(1);
        let end = last(right, 0).max(last(up, 1)).saturating_sub(1);
        self.first as usize + start..self.last as usize - end
    }
}

/// Calls `found` with every pair of segments, one of each piece, whose rectangles share a point.
#[inline]
pub(crate) fn for_pairs(
    (points, piece): (&[Point2], &Piece),
    (others, other): (&[Point2], &Piece),
    mut found: impl FnMut(usize, usize),
) {
    let mine = piece.clip(points, &other.bounds(others));
    if mine.is_empty() {
        return;
    }
    let theirs = other.clip(others, &around(points[mine.start], points[mine.end]));
    for i in mine {
        let bounds = around(points[i], points[i + 1]);
        for j in theirs.clone() {
            if overlap(&bounds, &around(others[j], others[j + 1])) {
                found(i, j);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn pieces_cover_the_line_and_their_ends_bound_them(
            line in prop::collection::vec((-5..5i32, -5..5i32), 2..60),
        ) {
            let points: Vec<_> =
                line.iter().map(|&(x, y)| Point2::new(f64::from(x), f64::from(y))).collect();
            let mut pieces = Vec::new();
            split(&points, 0, points.len() - 1, 7, &mut pieces);
            let mut at = 0;
            for piece in &pieces {
                prop_assert_eq!(piece.first, at);
                prop_assert!(piece.last > piece.first && piece.segments().len() <= LONGEST);
                let bounds = piece.bounds(&points);
                let inside = |i: usize| bounds.contains(points[i]);
                prop_assert!((piece.first as usize..=piece.last as usize).all(inside));
                at = piece.last;
            }
            prop_assert_eq!(at as usize, points.len() - 1);
        }

        #[test]
        fn clipping_leaves_the_segments_that_reach_into_the_window(
            line in prop::collection::vec((-5..5i32, -5..5i32), 2..30),
            corner in (-6..6i32, -6..6i32),
            size in (0..6i32, 0..6i32),
        ) {
            let point = |(x, y): (i32, i32)| Point2::new(f64::from(x), f64::from(y));
            let points: Vec<_> = line.iter().copied().map(point).collect();
            let window = Bounds2::new(point(corner), point(corner) + point(size));
            let mut pieces = Vec::new();
            split(&points, 0, points.len() - 1, 0, &mut pieces);
            for piece in &pieces {
                let reaches = |&i: &usize| overlap(&around(points[i], points[i + 1]), &window);
                let plain: Vec<_> = piece.segments().filter(reaches).collect();
                prop_assert_eq!(piece.clip(&points, &window).collect::<Vec<_>>(), plain);
            }
        }
    }
}
