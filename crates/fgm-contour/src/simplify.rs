use crate::contact::{Contacts, Segment};
use crate::lines::{Line, Lines};
use fgm_core::{Point2, Polygon, Polyline, Ring};

/// A ring with fewer vertices: each removed vertex lies within `tolerance` of the result, and the
/// result within `tolerance` of the ring.
///
/// A ring that does not cross or touch itself still does not; at least 3 of its vertices stay.
/// After Douglas and Peucker, Cartographica 10 (1973), with chords that would touch another taken
/// back. A tolerance that is not above 0 changes nothing.
pub fn simplify_ring(ring: &Ring, tolerance: f64) -> Ring {
    let mut lines = Lines::default();
    lines.push(&ring.points, true, 0);
    Simplifier::default().run(&mut lines, tolerance);
    Ring::new(lines.points)
}

/// A line with fewer vertices and the same ends, under the terms of [`simplify_ring`].
pub fn simplify_line(line: &Polyline, tolerance: f64) -> Polyline {
    let mut lines = Lines::default();
    lines.push(&line.points, false, 0);
    Simplifier::default().run(&mut lines, tolerance);
    Polyline::new(lines.points)
}

/// Polygons with fewer vertices, under the terms of [`simplify_ring`], which here hold between
/// all rings: what did not cross or touch still does not.
pub fn simplify_polygons(polygons: &[Polygon], tolerance: f64) -> Vec<Polygon> {
    let mut lines = Lines::default();
    for ring in polygons.iter().flat_map(Polygon::rings) {
        lines.push(&ring.points, true, 0);
    }
    Simplifier::default().run(&mut lines, tolerance);
    let mut rings = lines.list.iter().map(|line| Ring::new(lines.points(line).to_vec()));
    let mut next = || rings.next().unwrap_or_default();
    polygons
        .iter()
        .map(|p| Polygon { outer: next(), holes: p.holes.iter().map(|_| next()).collect() })
        .collect()
}

/// Removes vertices from many lines at once.
#[derive(Debug, Default)]
pub(crate) struct Simplifier {
    keep: Vec<bool>,
    stack: Vec<(usize, usize)>,
    segments: Vec<Segment>,
    /// For each segment: the first and last of its line's vertices that it stands for.
    spans: Vec<(u32, u32, u32)>,
    contacts: Contacts,
}

impl Simplifier {
    /// Removes what lies within `tolerance`, without a new contact between any two lines.
    pub(crate) fn run(&mut self, lines: &mut Lines, tolerance: f64) {
        if tolerance.is_nan() || tolerance <= 0.0 {
            return;
        }
        self.keep.clear();
        self.keep.resize(lines.points.len(), false);
        for line in &lines.list {
            self.mark(lines, line, tolerance * tolerance);
        }
        while self.take_back(lines) {}
        self.compact(lines);
    }

    /// Marks the vertices of one line that stay.
    fn mark(&mut self, lines: &Lines, line: &Line, limit: f64) {
        let points = lines.points(line);
        let n = points.len();
        let keep = &mut self.keep[line.from..line.to];
        if n <= if line.closed { 3 } else { 2 } {
            keep.fill(true);
            return;
        }
        let (first, second) = if line.closed { anchors(points) } else { (0, n - 1) };
        keep[first] = true;
        keep[second] = true;
        self.stack.push((first, second));
        if line.closed {
            self.stack.push((second, first + n));
        }
        let mut kept = 2;
        while let Some((from, to)) = self.stack.pop() {
            let (a, b) = (points[from % n], points[to % n]);
            let (mut farthest, mut most) = (0, limit);
            for k in from + 1..to {
                let d = distance_squared(points[k % n], a, b);
                if d > most {
                    (farthest, most) = (k, d);
                }
            }
            if farthest > 0 {
                keep[farthest % n] = true;
                kept += 1;
                self.stack.push((from, farthest));
                self.stack.push((farthest, to));
            }
        }
        if line.closed && kept < 3 {
            let (a, b) = (points[first], points[second]);
            let off = |k: &usize| distance_squared(points[*k], a, b);
            let third = (0..n)
                .filter(|k| *k != first && *k != second)
                .max_by(|i, j| off(i).total_cmp(&off(j)));
            third.into_iter().for_each(|k| keep[k] = true);
        } else if line.closed {
            release(points, keep, [first, second], limit);
        }
    }

    /// Restores the vertices under chords that touch another segment; answers whether any did.
    fn take_back(&mut self, lines: &Lines) -> bool {
        self.segments.clear();
        self.spans.clear();
        for (index, line) in lines.list.iter().enumerate() {
            self.chords(lines, line, index as u32);
        }
        let (keep, spans) = (&mut self.keep, &self.spans);
        let mut changed = false;
        let segments = &self.segments;
        self.contacts.find(segments, |s, t| {
            // The same chord twice: lines of several levels along a jump of the field.
            if segments[s].coincides(&segments[t]) {
                return;
            }
            for (line, from, to) in [spans[s], spans[t]] {
                let line = &lines.list[line as usize];
                let n = line.to - line.from;
                for k in from as usize + 1..to as usize {
                    let slot = &mut keep[line.from + k % n];
                    changed |= !*slot;
                    *slot = true;
                }
            }
        });
        changed
    }

    fn chords(&mut self, lines: &Lines, line: &Line, index: u32) {
        let points = lines.points(line);
        let keep = &self.keep[line.from..line.to];
        let n = points.len();
        let Some(first) = keep.iter().position(|&k| k) else { return };
        let mut from = first;
        let end = if line.closed { first + n } else { n - 1 };
        for to in first + 1..=end {
            if keep[to % n] {
                let (a, b) = (points[from % n], points[to % n]);
                self.segments.push(Segment { a, b, tag: 0 });
                self.spans.push((index, from as u32, to as u32));
                from = to;
            }
        }
    }

    fn compact(&self, lines: &mut Lines) {
        let mut to = 0;
        for line in &mut lines.list {
            let from = to;
            for k in line.from..line.to {
                if self.keep[k] {
                    lines.points[to] = lines.points[k];
                    to += 1;
                }
            }
            (line.from, line.to) = (from, to);
        }
        lines.points.truncate(to);
    }
}

/// Two vertices of a ring that stay: the least by x, then y, which is a corner of its hull, and
/// the one farthest from it.
fn anchors(points: &[Point2]) -> (usize, usize) {
    let least = |a: &Point2, b: &Point2| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
    let first = (0..points.len()).min_by(|&i, &j| least(&points[i], &points[j])).unwrap_or(0);
    let off = |i: usize| points[i].distance_squared(points[first]);
    let second = (0..points.len())
        .filter(|&i| i != first)
        .max_by(|&i, &j| off(i).total_cmp(&off(j)))
        .unwrap_or(first);
    (first.min(second), first.max(second))
}

/// Drops the anchors of a ring where the chord past them will do: rounding may have put the least
/// vertex amid a straight side.
fn release(points: &[Point2], keep: &mut [bool], anchors: [usize; 2], limit: f64) {
    let n = points.len();
    for anchor in anchors {
        let kept = |k: &usize| keep[*k % n];
        let (after, before) =
            ((anchor + 1..anchor + n).find(kept), (anchor + 1..anchor + n).rev().find(kept));
        let (Some(after), Some(before)) = (after, before) else { continue };
        // Another two vertices at least must be left beside the chord.
        if keep.iter().filter(|k| **k).count() <= 3 {
            return;
        }
        let (a, b) = (points[before % n], points[after % n]);
        let near = |k: usize| distance_squared(points[k % n], a, b) <= limit;
        if (before + 1..after + n).all(near) {
            keep[anchor] = false;
        }
    }
}

/// From a point to a segment, squared.
pub(crate) fn distance_squared(p: Point2, a: Point2, b: Point2) -> f64 {
    let edge = b - a;
    let length = edge.length_squared();
    if length == 0.0 {
        return p.distance_squared(a);
    }
    let t = ((p - a).dot(edge) / length).clamp(0.0, 1.0);
    p.distance_squared(a + edge * t)
}
