//! A border in square cells, for asking what comes near it.

use fgm_core::{Bounds2, Point2, Polygon};

/// The most cells a part of the border: a long thin border must not make mostly empty cells,
/// which cost more to clear than they save.
const CELLS_A_PART: f64 = 8.0;
/// The longest part and the side of a cell, in reaches.
const LONGEST: f64 = 1.5;
const CELL: f64 = 0.7;
/// No edge has this number.
pub(crate) const NO_EDGE: u32 = u32::MAX;
/// No edge is cut into more parts than this.
const MOST_PARTS: f64 = 1e4;

/// Edges, long ones cut into parts, each in the cell of its middle: one place a part, side by side
/// with the others of its row of cells.
pub(crate) struct NearBorder {
    origin: Point2,
    /// Cells a millimetre.
    per_mm: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    parts: Vec<Part>,
    /// Half the longest part, mm.
    half: f64,
}

#[derive(Clone, Copy)]
struct Part {
    from: Point2,
    to: Point2,
    /// The edge it is part of, counted through all rings.
    edge: u32,
}

impl NearBorder {
    /// The edges of a region's rings, for questions about distances of about `reach` mm.
    pub(crate) fn new(region: &[Polygon], reach: f64) -> Self {
        Self::of(&region, reach)
    }

    /// Any edges, for questions about distances of about `reach` mm.
    pub(crate) fn of_edges(edges: &[(Point2, Point2)], reach: f64) -> Self {
        Self::of(&edges, reach)
    }

    fn of(all: &impl Edges, reach: f64) -> Self {
        let (mut edges, mut length, mut bounds) = (0, 0.0, Bounds2::EMPTY);
        all.each(|from, to, _| {
            edges += 1;
            length += from.distance(to);
            bounds = Bounds2 { min: bounds.min.min(to), max: bounds.max.max(to) };
        });
        let scale = reach.max(length / f64::from(edges.max(1)));
        let mut parts = Vec::with_capacity(edges as usize + (length / scale) as usize / 2);
        let mut longest: f64 = 0.0;
        all.each(|from, to, edge| {
            longest = longest.max(cut(from, to, edge, LONGEST * scale, &mut parts));
        });
        let half = longest.sqrt() * 0.5;
        let size = if bounds.is_finite() { bounds.size() } else { Point2::ZERO };
        let most = CELLS_A_PART * parts.len().max(1) as f64;
        // Along a border as straight as a line, too, where the area says nothing.
        let least = (size.x * size.y / most).sqrt().max(size.max_element() / most);
        let cell = (CELL * scale).max(least).max(1e-6);
        let count = |length: f64| (length / cell) as usize + 1;
        let mut near = Self {
            origin: bounds.min,
            per_mm: 1.0 / cell,
            columns: count(size.x),
            rows: count(size.y),
            starts: Vec::new(),
            parts: Vec::new(),
            half,
        };
        near.sort(&parts);
        near
    }

    fn sort(&mut self, parts: &[Part]) {
        let cell = |part: &Part| {
            let middle = (part.from + part.to) * 0.5;
            (self.row(middle.y) * self.columns + self.column(middle.x)) as u32
        };
        let cells: Vec<u32> = parts.iter().map(cell).collect();
        let mut starts = vec![0; self.columns * self.rows + 1];
        for &cell in &cells {
            starts[cell as usize] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        let mut sorted = parts.to_vec();
        // From the back, each cell's end moves down to its start.
        for (part, &cell) in parts.iter().zip(&cells).rev() {
            let place = &mut starts[cell as usize];
            *place -= 1;
            sorted[*place as usize] = *part;
        }
        (self.starts, self.parts) = (starts, sorted);
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.per_mm) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.per_mm) as usize).min(self.rows - 1)
    }

    /// Visits every edge that may come within `reach` mm of a point, by its number; some more than
    /// once.
    pub(crate) fn around(&self, p: Point2, reach: f64, mut visit: impl FnMut(u32)) {
        let reach = reach + self.half;
        let (left, right) = (self.column(p.x - reach), self.column(p.x + reach));
        for row in self.row(p.y - reach)..=self.row(p.y + reach) {
            let cells = row * self.columns;
            let range = self.starts[cells + left] as usize..self.starts[cells + right + 1] as usize;
            for part in &self.parts[range] {
                let middle = (part.from + part.to) * 0.5;
                if middle.distance_squared(p) <= reach * reach {
                    visit(part.edge);
                }
            }
        }
    }

    /// Whether any edge but those to `skip` (by their numbers, counted through the rings, or
    /// [`NO_EDGE`]) comes closer than `distance` to the segment from `a` to `b`.
    pub(crate) fn any_within(&self, a: Point2, b: Point2, distance: f64, skip: [u32; 3]) -> bool {
        let probe = Probe::new(a, b, distance);
        let reach = distance + self.half;
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        let (left, right) = (self.column(low.x), self.column(high.x));
        for row in self.row(low.y)..=self.row(high.y) {
            let cells = row * self.columns;
            let range = self.starts[cells + left] as usize..self.starts[cells + right + 1] as usize;
            let meets = |part: &Part| {
                probe.may_be_within(part.from, part.to)
                    && !skip.contains(&part.edge)
                    && probe.within(part.from, part.to)
            };
            if self.parts[range].iter().any(meets) {
                return true;
            }
        }
        false
    }
}

/// Numbered edges.
trait Edges {
    fn each(&self, visit: impl FnMut(Point2, Point2, u32));
}

impl Edges for &[(Point2, Point2)] {
    fn each(&self, mut visit: impl FnMut(Point2, Point2, u32)) {
        (0..).zip(self.iter()).for_each(|(number, &(from, to))| visit(from, to, number));
    }
}

/// Ring by ring.
impl Edges for &[Polygon] {
    fn each(&self, visit: impl FnMut(Point2, Point2, u32)) {
        for_each_edge(self, visit);
    }
}

fn for_each_edge(region: &[Polygon], mut visit: impl FnMut(Point2, Point2, u32)) {
    let mut number = 0;
    for ring in region.iter().flat_map(Polygon::rings) {
        let Some((&first, rest)) = ring.points.split_first() else { continue };
        let mut from = first;
        for &to in rest {
            visit(from, to, number);
            from = to;
            number += 1;
        }
        visit(from, first, number);
        number += 1;
    }
}

/// Appends an edge in parts no longer than `longest`; the square of their length.
fn cut(from: Point2, to: Point2, edge: u32, longest: f64, parts: &mut Vec<Part>) -> f64 {
    let squared = from.distance_squared(to);
    if squared <= longest * longest {
        parts.push(Part { from, to, edge });
        return squared;
    }
    let count = (squared.sqrt() / longest).ceil().clamp(1.0, MOST_PARTS);
    let step = (to - from) / count;
    for i in 0..count as usize {
        let from = from + step * i as f64;
        parts.push(Part { from, to: from + step, edge });
    }
    step.length_squared()
}

/// A segment that edges are held against.
struct Probe {
    from: Point2,
    to: Point2,
    along: Point2,
    squared: f64,
    distance_squared: f64,
    /// The distance times the segment's length: what `perp_dot` gives at that distance.
    reach: f64,
}

impl Probe {
    fn new(from: Point2, to: Point2, distance: f64) -> Self {
        let along = to - from;
        let squared = along.length_squared();
        let reach = distance * squared.sqrt();
        Self { from, to, along, squared, distance_squared: distance * distance, reach }
    }

    /// Whether the edge from `c` to `d` may come closer than the distance: false where it lies far
    /// off to one side, or beyond one end, as most edges do.
    #[inline(always)]
    fn may_be_within(&self, c: Point2, d: Point2) -> bool {
        let (to_c, to_d) = (c - self.from, d - self.from);
        let (across_c, across_d) = (self.along.perp_dot(to_c), self.along.perp_dot(to_d));
        let (along_c, along_d) = (self.along.dot(to_c), self.along.dot(to_d));
        let reach = self.reach;
        let aside =
            (across_c >= reach) & (across_d >= reach) | (across_c <= -reach) & (across_d <= -reach);
        let beyond = self.squared + reach;
        let past =
            (along_c >= beyond) & (along_d >= beyond) | (along_c <= -reach) & (along_d <= -reach);
        !(aside | past) | (self.squared == 0.0)
    }

    /// Whether it does.
    #[inline(never)]
    fn within(&self, c: Point2, d: Point2) -> bool {
        let near = |p: Point2, q: Point2, r: Point2| {
            let (v, to) = (r - q, p - q);
            let (along, length) = (to.dot(v), v.length_squared());
            if along <= 0.0 {
                to.length_squared() < self.distance_squared
            } else if along >= length {
                p.distance_squared(r) < self.distance_squared
            } else {
                let across = v.perp_dot(to);
                across * across < self.distance_squared * length
            }
        };
        let (a, b) = (self.from, self.to);
        let crossing = || {
            let v = d - c;
            let sides = (self.along.perp_dot(c - a) > 0.0) != (self.along.perp_dot(d - a) > 0.0);
            sides && (v.perp_dot(a - c) > 0.0) != (v.perp_dot(b - c) > 0.0)
        };
        near(a, c, d) || near(b, c, d) || near(c, a, b) || near(d, a, b) || crossing()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Ring;
    use proptest::prelude::*;

    fn distance(a: (Point2, Point2), b: (Point2, Point2)) -> f64 {
        let part = |(p, q): (Point2, Point2), t: f64| p + (q - p) * t;
        let point = |p: Point2, (q, r): (Point2, Point2)| {
            let v = r - q;
            let t = ((p - q).dot(v) / v.length_squared().max(1e-300)).clamp(0.0, 1.0);
            p.distance(part((q, r), t))
        };
        let (u, v) = (a.1 - a.0, b.1 - b.0);
        let area = u.perp_dot(v);
        let (s, t) = ((b.0 - a.0).perp_dot(v) / area, (b.0 - a.0).perp_dot(u) / area);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return 0.0;
        }
        [point(a.0, b), point(a.1, b), point(b.0, a), point(b.1, a)].into_iter().fold(9e9, f64::min)
    }

    proptest! {
        #[test]
        fn it_finds_what_a_search_through_all_edges_finds(
            points in prop::collection::vec((-9.0..9.0f64, -9.0..9.0f64), 3..40),
            probes in prop::collection::vec((-9.0..9.0f64, -9.0..9.0f64, -2.0..2.0f64, -2.0..2.0f64), 1..20),
            reach in 0.05..3.0f64,
            skipped in 0u32..40,
        ) {
            let ring = Ring::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect());
            let near = NearBorder::new(&[Polygon::simple(ring.clone())], reach);
            for (x, y, u, v) in probes {
                let (a, b) = (Point2::new(x, y), Point2::new(x + u, y + v));
                for (a, b) in [(a, b), (a, a)] {
                    let numbered = ring.edges().zip(0u32..).filter(|(_, n)| *n != skipped);
                    let least = numbered.map(|(e, _)| distance(e, (a, b))).fold(9e9, f64::min);
                    let found = near.any_within(a, b, reach, [skipped, NO_EDGE, NO_EDGE]);
                    prop_assert!(found == (least < reach) || (least - reach).abs() < 1e-9);
                }
            }
        }
    }
}
