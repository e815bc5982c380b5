use crate::piece::Piece;
use crate::pixel::Place;
use crate::predicate::passes;
use fgm_core::Point2;

/// Pixels in a strip: few enough to stay in the cache while all segments look for theirs.
const STRIP: usize = 2048;

/// Finds which segments pass through which pixels, for many pixels and long segments.
///
/// The pixels, sorted by x, are taken a strip at a time; each segment that reaches into a strip
/// looks up the heights that it has there. Memory is looked at from left to right, where a tree
/// would be entered anew for each segment.
#[derive(Debug, Default)]
pub(crate) struct Strips {
    /// The strip's pixels by height: places with x and y exchanged.
    rows: Vec<Place>,
    /// First points of segments, by the least x of the segment.
    order: Vec<u32>,
    /// Those that reach into the strip.
    active: Vec<u32>,
}

impl Strips {
    /// Calls `found` with every segment of the pieces and the pixel of `pixels` that it passes
    /// through; pixels are indices into `hot`, in order of place.
    pub(crate) fn search(
        &mut self,
        (points, pieces): (&[Point2], &[Piece]),
        (hot, pixels): (&[Point2], &[u32]),
        mut found: impl FnMut(u32, u32),
    ) {
        let ends = |segment: u32| (points[segment as usize], points[segment as usize + 1]);
        let least = |segment: u32| ends(segment).0.x.min(ends(segment).1.x);
        self.order.clear();
        self.order.extend(pieces.iter().flat_map(|piece| piece.first..piece.last));
        self.order.sort_unstable_by(|&a, &b| least(a).total_cmp(&least(b)).then(a.cmp(&b)));
        self.active.clear();
        let mut rest = self.order.iter().copied().peekable();
        for strip in pixels.chunks(STRIP) {
            self.rows.clear();
            self.rows.extend(strip.iter().map(|&pixel| {
                let at = hot[pixel as usize];
                Place::new(Point2::new(at.y, at.x), pixel)
            }));
            self.rows.sort_unstable();
            let [from, to] = [strip[0], strip[strip.len() - 1]].map(|p| hot[p as usize].x);
            self.active.retain(|&s| ends(s).0.x.max(ends(s).1.x) >= from);
            while let Some(segment) = rest.next_if(|&segment| least(segment) <= to) {
                if ends(segment).0.x.max(ends(segment).1.x) >= from {
                    self.active.push(segment);
                }
            }
            for &segment in &self.active {
                let (a, b) = ends(segment);
                let (low, high) = heights(a, b, from, to);
                let first = self.rows.partition_point(|row| row.at().x < low);
                for row in &self.rows[first..] {
                    let turned = row.at();
                    if turned.x > high {
                        break;
                    }
                    if passes(a, b, Point2::new(turned.y, turned.x)) {
                        found(segment, row.source());
                    }
                }
            }
        }
    }
}

/// The heights between which a segment stays from `from` to `to` in x, and a step more: pixels
/// reach half a step from their centres, rounding much less.
fn heights(a: Point2, b: Point2, from: f64, to: f64) -> (f64, f64) {
    let d = b - a;
    let height = |x: f64| a.y + d.y * ((x - a.x) / d.x).clamp(0.0, 1.0);
    // Half a step more on both sides, for the pixels' width.
    let (start, end) = if d.x == 0.0 { (a.y, b.y) } else { (height(from - 0.5), height(to + 0.5)) };
    (start.min(end) - 1.0, start.max(end) + 1.0)
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
            let mut found = Vec::new();
            Strips::default().search((&points, &pieces), (&hot, &pixels), |s, p| found.push((s, p)));
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
