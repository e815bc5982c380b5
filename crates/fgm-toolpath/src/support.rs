//! What lies below a line: the region of the layer below, asked along paths.

use fgm_core::{Point2, Polygon};

use crate::inset::grid::{EdgeGrid, crossing};

/// Side of a cell, mm; sparse borders get larger ones.
const CELL: f64 = 1.0;
/// Parameters no further apart than this are one.
const HAIR: f64 = 1e-9;

/// A region whose border can be asked for what crosses it and what comes near it.
///
/// Built once a layer: it is what holds the beads of the layer above, and what travels of its own
/// layer should not cross.
pub struct Support {
    grid: EdgeGrid,
}

/// How far a bead reaches over what lies below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hold {
    /// Held, but for at most the share that is not worth a thought.
    Held,
    /// Less than half of its width over air.
    Slight,
    /// More than half of its width over air.
    Half,
    /// Nearly all of its width over air.
    Air,
}

/// A stretch of a line that is held alike, by parameters as [`fgm_core::point_at`] takes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// How it is held.
    pub hold: Hold,
}

/// What the questions along one line need, kept between them.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Where the line is near the border, as intervals of its parameter.
    close: Vec<(f64, f64)>,
    crossings: Vec<f64>,
    /// Edges already counted for a segment.
    crossed: Vec<u32>,
    cuts: Vec<f64>,
}

impl Support {
    /// The border of a region.
    pub fn new(region: &[Polygon]) -> Self {
        let edges =
            region.iter().flat_map(Polygon::rings).flat_map(fgm_core::Ring::edges).collect();
        Self { grid: EdgeGrid::for_along(edges, CELL) }
    }

    /// Whether a point lies inside. On the border either answer is possible.
    pub fn contains(&self, p: Point2) -> bool {
        self.grid.contains(p)
    }

    /// Appends where the way from `a` to `b` crosses the border, as shares of it, in order.
    pub fn crossings(&self, a: Point2, b: Point2, out: &mut Vec<f64>) {
        self.grid.crossings(a, b, out);
    }

    /// Divides a line by how its bead of `width` mm is held: what has more than `share` of its
    /// width (up to a half) over air hangs over. Stretches replace those in `out`; they follow each
    /// other without gap, and neighbours differ. None for a line of fewer than two points.
    ///
    /// A bead's width beyond the border counts by the distance of its middle from the border,
    /// which is exact where the border is straight.
    pub fn stretches(
        &self,
        line: &[Point2],
        width: f64,
        share: f64,
        scratch: &mut Scratch,
        out: &mut Vec<Stretch>,
    ) {
        out.clear();
        if line.len() < 2 {
            return;
        }
        let band = (0.5 - share.clamp(0.0, 0.5)) * width;
        if self.grid.is_deep_inside(line, band) {
            out.push(Stretch { from: 0.0, to: (line.len() - 1) as f64, hold: Hold::Held });
            return;
        }
        let Scratch { close, crossings, crossed, cuts } = scratch;
        close.clear();
        crossings.clear();
        for (i, w) in line.windows(2).enumerate() {
            let (start, first) = (i as f64, crossings.len());
            crossed.clear();
            self.grid.along(w[0], w[1], band, |(from, to), edge, (c, d)| {
                let (p, q) = (w[0].lerp(w[1], from), w[0].lerp(w[1], to));
                let place = |t: f64| start + from + (to - from) * t;
                if let Some((t0, t1)) = within(p, q, c, d, band) {
                    close.push((place(t0), place(t1)));
                }
                // An edge may come more than once.
                if let Some(t) = crossing(w[0], w[1], c, d).filter(|_| !crossed.contains(&edge)) {
                    crossed.push(edge);
                    crossings.push(start + t);
                }
            });
            crossings[first..].sort_unstable_by(f64::total_cmp);
        }
        merge(close);
        let end = (line.len() - 1) as f64;
        cuts.clear();
        cuts.push(0.0);
        cuts.extend(close.iter().flat_map(|c| [c.0, c.1]));
        cuts.extend(crossings.iter());
        cuts.push(end);
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.dedup_by(|next, last| *next - *last <= HAIR);
        if let Some(last) = cuts.last_mut().filter(|last| **last > 0.0) {
            *last = end;
        }
        self.classify(line, cuts, close, crossings, out);
    }

    fn classify(
        &self,
        line: &[Point2],
        cuts: &[f64],
        close: &[(f64, f64)],
        crossings: &[f64],
        out: &mut Vec<Stretch>,
    ) {
        let mut close = close.iter().peekable();
        let mut crossings = crossings.iter().peekable();
        // Inside or not is the same up to the next crossing.
        let mut inside = None;
        for pair in cuts.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let middle = 0.5 * (from + to);
            while crossings.next_if(|t| **t <= from + HAIR).is_some() {
                inside = None;
            }
            while close.next_if(|c| c.1 <= middle).is_some() {}
            let is_close = close.peek().is_some_and(|c| c.0 <= middle);
            let held =
                *inside.get_or_insert_with(|| self.contains(fgm_core::point_at(line, middle)));
            let hold = match (held, is_close) {
                (true, false) => Hold::Held,
                (true, true) => Hold::Slight,
                (false, true) => Hold::Half,
                (false, false) => Hold::Air,
            };
            match out.last_mut() {
                Some(last) if last.hold == hold => last.to = to,
                _ => out.push(Stretch { from, to, hold }),
            }
        }
    }
}

/// Sorts intervals and joins those that meet.
fn merge(intervals: &mut Vec<(f64, f64)>) {
    intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    intervals.dedup_by(|next, into| {
        let meet = next.0 <= into.1 + HAIR;
        if meet {
            into.1 = into.1.max(next.1);
        }
        meet
    });
}

/// The shares of the way from `a` to `b` between which it is nearer than `reach` to the segment
/// from `c` to `d`. What is near a segment is convex, so that it is one stretch.
fn within(a: Point2, b: Point2, c: Point2, d: Point2, reach: f64) -> Option<(f64, f64)> {
    let mut whole: Option<(f64, f64)> = None;
    let mut add = |from: f64, to: f64| {
        let (from, to) = (from.max(0.0), to.min(1.0));
        if from < to {
            let (low, high) = whole.unwrap_or((from, to));
            whole = Some((low.min(from), high.max(to)));
        }
    };
    let way = b - a;
    let squared = way.length_squared();
    if squared <= 0.0 {
        return None;
    }
    // Round the ends of the segment.
    for end in [c, d] {
        let middle = (end - a).dot(way) / squared;
        let left = reach * reach - (a + way * middle - end).length_squared();
        if left > 0.0 {
            let half = (left / squared).sqrt();
            add(middle - half, middle + half);
        }
    }
    // Beside it.
    let edge = d - c;
    let length = edge.length();
    if length > 0.0 {
        let (along, across) = (edge / length, (edge / length).perp());
        let low = span(along.dot(a - c), along.dot(way), 0.0, length);
        let side = span(across.dot(a - c), across.dot(way), -reach, reach);
        if let (Some(one), Some(other)) = (low, side) {
            add(one.0.max(other.0), one.1.min(other.1));
        }
    }
    whole
}

/// Where `at + t * step` lies between two values.
fn span(at: f64, step: f64, low: f64, high: f64) -> Option<(f64, f64)> {
    if step == 0.0 {
        return (low < at && at < high).then_some((0.0, 1.0));
    }
    let (t0, t1) = ((low - at) / step, (high - at) / step);
    Some((t0.min(t1), t0.max(t1)))
}

#[cfg(test)]
#[path = "support_tests.rs"]
mod tests;
