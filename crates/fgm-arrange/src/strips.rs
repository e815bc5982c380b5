use crate::parallel;
use crate::piece::Piece;
use crate::pixel::Place;
use crate::predicate::{cross_near, passes};
use fgm_core::Point2;
use std::ops::Range;

/// Pixels in a strip: few enough to stay in the cache while all segments look for theirs.
const STRIP: usize = 2048;

/// Strips that are worth a thread.
const LEAST: usize = 16;

/// Finds which segments pass through which pixels, for many pixels and long segments.
///
/// The pixels, sorted by x, are taken a strip at a time; each segment that reaches into a strip
/// looks up the heights that it has there. Memory is looked at from left to right, where a tree
/// would be entered anew for each segment.
pub(crate) struct Strips<'a> {
    /// The segments by the least x of each.
    segments: Vec<Segment>,
    /// Places of pixels, by x.
    hot: &'a [Point2],
    /// Those to look at, as indices into `hot`.
    pixels: &'a [u32],
}

/// A segment, drawn from its left end to its right one.
#[derive(Clone, Copy)]
struct Segment {
    left: Point2,
    right: Point2,
    slope: f64,
    name: u32,
}

impl<'a> Strips<'a> {
    /// The segments of the pieces of a line; pixels are indices into `hot`, in order of place.
    pub(crate) fn new(
        (points, pieces): (&[Point2], &[Piece]),
        (hot, pixels): (&'a [Point2], &'a [u32]),
    ) -> Self {
        let names = pieces.iter().flat_map(|piece| piece.first..piece.last);
        let mut segments: Vec<_> = names
            .map(|name| {
                let (a, b) = (points[name as usize], points[name as usize + 1]);
                let (left, right) = if b.x < a.x { (b, a) } else { (a, b) };
                let d = right - left;
                Segment { left, right, slope: if d.x > 0.0 { d.y / d.x } else { 0.0 }, name }
            })
            .collect();
        let least = |s: &Segment| s.left.x;
        segments.sort_unstable_by(|a, b| least(a).total_cmp(&least(b)).then(a.name.cmp(&b.name)));
        Self { segments, hot, pixels }
    }

    /// Makes something of every segment and pixel that it passes through. The results come in
    /// parts, in the order of strips; each segment's pixels come in order along it.
    pub(crate) fn search<T: Send>(&self, make: impl Fn(u32, u32) -> T + Sync) -> Vec<Vec<T>> {
        let strips = self.pixels.len().div_ceil(STRIP);
        parallel::parts(strips, LEAST, |part| {
            let mut found = Vec::new();
            self.search_part(part, |segment, pixel| found.push(make(segment, pixel)));
            found
        })
    }

    /// Searches some consecutive strips.
    fn search_part(&self, strips: Range<usize>, mut found: impl FnMut(u32, u32)) {
        let mut active: Vec<Segment> = Vec::new();
        let mut rest = self.segments.iter().peekable();
        let mut rows = Rows::default();
        for strip in self.pixels.chunks(STRIP).skip(strips.start).take(strips.len()) {
            let [from, to] = [strip[0], strip[strip.len() - 1]].map(|p| self.hot[p as usize].x);
            rows.fill(self.hot, strip);
            active.retain(|segment| segment.right.x >= from);
            while let Some(segment) = rest.next_if(|segment| segment.left.x <= to) {
                if segment.right.x >= from {
                    active.push(*segment);
                }
            }
            for segment in &active {
                let (low, high) = segment.heights(from, to);
                let mut check = |row: usize| {
                    if segment.passes(rows.at[row]) {
                        found(segment.name, rows.pixels[row]);
                    }
                };
                if segment.slope < 0.0 {
                    let rows_down = (0..rows.first_above(high)).rev();
                    rows_down.take_while(|&row| rows.at[row].y >= low).for_each(&mut check);
                } else {
                    let rows_up = rows.first_from(low)..rows.at.len();
                    rows_up.take_while(|&row| rows.at[row].y <= high).for_each(&mut check);
                }
            }
        }
    }
}

impl Segment {
    /// The heights between which it stays from `from` to `to` in x, and a step more: pixels reach
    /// half a step from their centres, rounding much less.
    #[inline]
    fn heights(&self, from: f64, to: f64) -> (f64, f64) {
        let Self { left, right, slope, .. } = *self;
        // Half a step more on both sides, for the pixels' width.
        let (from, to) = ((from - 0.5).max(left.x), (to + 0.5).min(right.x));
        let start = if from > left.x { left.y + slope * (from - left.x) } else { left.y };
        let end = if to < right.x { left.y + slope * (to - left.x) } else { right.y };
        (start.min(end) - 1.0, start.max(end) + 1.0)
    }

    #[inline]
    fn passes(&self, at: Point2) -> bool {
        let d = self.right - self.left;
        let (det, error) = cross_near(d, at - self.left);
        // Most are far away.
        2.0 * (det.abs() - error) <= d.x + d.y.abs() && passes(self.left, self.right, at)
    }
}

/// A strip's pixels by height.
#[derive(Default)]
struct Rows {
    places: Vec<Place>,
    at: Vec<Point2>,
    pixels: Vec<u32>,
    /// The strip's height in equal shares: the first row of each, and the end.
    starts: Vec<u32>,
    least: f64,
    shares: f64,
}

impl Rows {
    /// Replaces the rows by a strip's.
    fn fill(&mut self, hot: &[Point2], strip: &[u32]) {
        self.places.clear();
        // With x and y exchanged, as places sort by x.
        let turned = |&pixel: &u32| Place::new(turn(hot[pixel as usize]), pixel);
        self.places.extend(strip.iter().map(turned));
        self.places.sort_unstable();
        self.at.clear();
        self.at.extend(self.places.iter().map(|place| turn(place.at())));
        self.pixels.clear();
        self.pixels.extend(self.places.iter().map(|place| place.source()));
        let (least, most) = (self.at[0].y, self.at[self.at.len() - 1].y);
        let size = if most > least { most - least } else { 1.0 };
        (self.least, self.shares) = (least, STRIP as f64 / size);
        self.starts.clear();
        for row in 0..self.at.len() {
            let share = self.share(self.at[row].y);
            self.starts.resize(self.starts.len().max(share + 1), row as u32);
        }
        self.starts.resize(STRIP + 1, self.at.len() as u32);
    }

    #[inline]
    fn share(&self, y: f64) -> usize {
        (((y - self.least) * self.shares) as usize).min(STRIP - 1)
    }

    /// The first row that is not below a height.
    #[inline]
    fn first_from(&self, y: f64) -> usize {
        self.bound(y, |at| at < y)
    }

    /// The first row above a height.
    #[inline]
    fn first_above(&self, y: f64) -> usize {
        self.bound(y, |at| at <= y)
    }

    #[inline]
    fn bound(&self, y: f64, below: impl Fn(f64) -> bool) -> usize {
        let share = self.share(y);
        let (first, end) = (self.starts[share] as usize, self.starts[share + 1] as usize);
        first + self.at[first..end].partition_point(|at| below(at.y))
    }
}

fn turn(p: Point2) -> Point2 {
    Point2::new(p.y, p.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::piece;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_a_plain_search_finds(
            segments in prop::collection::vec(prop::array::uniform4(-60..60i32), 1..20),
            upright in any::<bool>(),
            seed in 1..97i64,
        ) {
            let mut points = Vec::new();
            let mut pieces = Vec::new();
            for [x, y, u, v] in segments.into_iter().map(|s| s.map(f64::from)) {
                let (first, u) = (points.len(), if upright { x } else { u });
                if (x, y) != (u, v) {
                    points.extend([Point2::new(x, y), Point2::new(u, v)]);
                    piece::split(&points, first, first + 1, 0, &mut pieces);
                }
            }
            // More than one strip.
            let mut hot: Vec<_> = (0..3000)
                .map(|i| i * seed)
                .map(|i| Point2::new((i % 101 - 50) as f64, (i / 101 % 103 - 50) as f64))
                .collect();
            hot.sort_unstable_by(|&a, &b| crate::predicate::by_place(a, b));
            hot.dedup();
            let pixels: Vec<_> = (0..hot.len() as u32).collect();
            let strips = Strips::new((&points, &pieces), (&hot, &pixels));
            let mut found: Vec<_> = strips.search(|s, p| (s, p)).into_iter().flatten().collect();
            found.sort_unstable();
            let first = (0..points.len()).step_by(2);
            let plain: Vec<_> = first
                .flat_map(|s| pixels.iter().map(move |&p| (s, p)))
                .filter(|&(s, p)| passes(points[s], points[s + 1], hot[p as usize]))
                .map(|(s, p)| (s as u32, p))
                .collect();
            prop_assert_eq!(found, plain);
        }
    }
}
