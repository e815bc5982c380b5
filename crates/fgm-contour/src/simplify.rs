use crate::contact::{Contacts, Segment};
use crate::lines::{Line, Lines};
use fgm_core::{Point2, Polygon, Polyline, Ring, long_chords};

/// A ring with fewer vertices: each removed vertex lies within `tolerance` of the result, and the
/// result within `tolerance` of the ring.
///
/// A ring that does not cross or touch itself still does not; at least 3 of its vertices stay.
/// Chords as [`long_chords`] finds them, with those that would touch another taken back. A tolerance that is not above 0 changes nothing.
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

/// The cosine of the least turn, 15 degrees, that is a corner. Smooth lines turn by less at a kept
/// vertex, but where their bends are not much wider than the tolerance.
const SHARP: f64 = 0.966;

/// Removes vertices from many lines at once.
#[derive(Debug, Default)]
pub(crate) struct Simplifier {
    keep: Vec<bool>,
    /// Of one line.
    kept: Vec<usize>,
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
            self.mark(lines, line, tolerance);
        }
        while self.take_back(lines) {}
        self.compact(lines);
    }

    /// Marks the vertices of one line that stay.
    fn mark(&mut self, lines: &Lines, line: &Line, tolerance: f64) {
        let points = lines.points(line);
        let n = points.len();
        let keep = &mut self.keep[line.from..line.to];
        if n <= if line.closed { 3 } else { 2 } {
            keep.fill(true);
            return;
        }
        self.kept.clear();
        long_chords(points, line.closed, tolerance, |k| self.kept.push(k));
        sharpen(points, line.closed, &mut self.kept, tolerance);
        self.kept.iter().for_each(|&k| keep[k] = true);
        if line.closed && self.kept.len() < 3 {
            keep_triangle(points, keep);
        } else if line.closed {
            release(points, keep, tolerance);
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

/// Puts kept vertices where a line turns sharply on the corner itself: long chords go past it.
fn sharpen(points: &[Point2], closed: bool, kept: &mut [usize], tolerance: f64) {
    let (n, m) = (points.len(), kept.len());
    if m < 3 {
        return;
    }
    let limit = tolerance * tolerance;
    let at = |k: usize| points[k % n];
    for i in if closed { 0..m } else { 1..m - 1 } {
        let (before, k, after) = (kept[(i + m - 1) % m], kept[i], kept[(i + 1) % m]);
        let (u, v) = (at(k) - at(before), at(after) - at(k));
        if u.dot(v) > SHARP * (u.length_squared() * v.length_squared()).sqrt() {
            continue;
        }
        // Counted on past the ring's first vertex.
        let (from, to) = (before, if after > before { after } else { after + n });
        let off = |j: &usize| distance_squared(at(*j), at(from), at(to));
        let Some(corner) = (from + 1..to).max_by(|i, j| off(i).total_cmp(&off(j))) else {
            continue;
        };
        let near = |j: usize, a: usize, b: usize| distance_squared(at(j), at(a), at(b)) <= limit;
        if (from + 1..corner).all(|j| near(j, from, corner))
            && (corner + 1..to).all(|j| near(j, corner, to))
        {
            kept[i] = corner % n;
        }
    }
}

/// Keeps three vertices of a ring that would keep fewer: the first, the one farthest from it, and
/// the one farthest from the chord between them.
fn keep_triangle(points: &[Point2], keep: &mut [bool]) {
    let first = points[0];
    let farthest = |off: &dyn Fn(usize) -> f64| {
        (1..points.len()).max_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap_or(0)
    };
    let second = farthest(&|i| points[i].distance_squared(first));
    let third = farthest(&|i| distance_squared(points[i], first, points[second]));
    [0, second, third].into_iter().for_each(|k| keep[k] = true);
}

/// Drops the vertex where a ring was begun if the chord past it will do.
fn release(points: &[Point2], keep: &mut [bool], tolerance: f64) {
    let n = points.len();
    let kept = |k: &usize| keep[*k];
    let (Some(after), Some(before)) = ((1..n).find(kept), (1..n).rev().find(kept)) else { return };
    // Another two vertices at least must be left beside the chord.
    if keep.iter().filter(|k| **k).count() <= 3 {
        return;
    }
    let (a, b) = (points[before], points[after]);
    let near = |k: usize| distance_squared(points[k % n], a, b) <= tolerance * tolerance;
    keep[0] = !(before + 1..after + n).all(near);
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
