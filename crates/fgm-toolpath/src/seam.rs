//! How long the seam between colours is.

use fgm_core::{Bounds2, ColorId, Point2, bead};

use crate::{Piece, order::MEETS};

/// Side of the cells that tell where colours are near each other, in widths.
const COARSE: f64 = 4.0;
/// How far from where it should be a neighbour is looked for, in spacings.
const REACH: f64 = 0.75;
/// Cosine of the greatest angle between beads that lie side by side.
const PARALLEL: f64 = 0.8;
/// The most cells along a side of a grid.
const MOST: f64 = 4096.0;

/// The length, mm, over which beads of different colours touch in a layer of this height, mm: side
/// by side, and end to end over their width where a line changes colour.
///
/// Where beads lie side by side is found by samples, one a width. Beads that do not touch, as in
/// sparse infill, count only where they end.
pub fn seam_length(pieces: &[Piece], height: f64) -> f64 {
    end_to_end(pieces) + side_by_side(pieces, height)
}

/// Over the width of beads that end where one of another colour begins.
fn end_to_end(pieces: &[Piece]) -> f64 {
    let key = |p: &Point2| ((p.x / MEETS).round() as i64, (p.y / MEETS).round() as i64);
    let ends = |piece: &Piece| {
        let of = |p: Option<&Point2>| p.map(|p| (key(p), piece.color, piece.width));
        [of(piece.points.first()), of(piece.points.last())]
    };
    let mut ends: Vec<_> = pieces.iter().flat_map(ends).flatten().collect();
    ends.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    let same = ends.chunk_by(|a, b| a.0 == b.0);
    let pairs = same.flat_map(|meeting| meeting.windows(2));
    pairs.filter(|pair| pair[0].1 != pair[1].1).map(|pair| pair[0].2.min(pair[1].2)).sum()
}

fn side_by_side(pieces: &[Piece], height: f64) -> f64 {
    let widest = pieces.iter().map(|piece| piece.width).fold(0.0, f64::max);
    let points = || pieces.iter().flat_map(|piece| &piece.points).filter(|p| p.is_finite());
    let bounds = Bounds2::of(points().copied());
    if bounds.is_empty() || widest <= 0.0 {
        return 0.0;
    }
    let near = Borders::new(pieces, Cells::new(&bounds, COARSE * widest));
    let mut samples = Vec::new();
    for piece in pieces.iter().filter(|piece| piece.width > 0.0) {
        for (chunk, direction) in chunks(piece, 0.5 * near.cells.side) {
            if near.border[near.cells.of(chunk.middle())] {
                let length = chunk.length();
                let count = (length / piece.width).ceil().max(1.0);
                samples.extend((0..count as u32).map(|i| Sample {
                    at: chunk.from.lerp(chunk.to, (f64::from(i) + 0.5) / count),
                    direction,
                    length: length / count,
                    width: piece.width,
                    color: piece.color,
                }));
            }
        }
    }
    let grid = Grid::new(&samples, Cells::new(&bounds, widest));
    let touches = |s: &Sample, side: f64| {
        let spacing = bead::spacing(s.width, height);
        let beside = s.at + s.direction.perp() * (side * spacing);
        let there = grid.nearest(beside, REACH * spacing, s.direction);
        there.is_some_and(|color| color != s.color)
    };
    // Each of the two beads counts half.
    let half = |s: &Sample| {
        let sides = [-1.0, 1.0].into_iter().filter(|side| touches(s, *side)).count();
        0.5 * s.length * sides as f64
    };
    samples.iter().map(half).sum()
}

/// A straight stretch.
#[derive(Clone, Copy)]
struct Chunk {
    from: Point2,
    to: Point2,
}

impl Chunk {
    fn middle(&self) -> Point2 {
        self.from.midpoint(self.to)
    }

    fn length(&self) -> f64 {
        self.from.distance(self.to)
    }
}

/// A piece in stretches no longer than `most`, each with its direction.
fn chunks(piece: &Piece, most: f64) -> impl Iterator<Item = (Chunk, Point2)> {
    piece.points.windows(2).flat_map(move |ends| {
        let (a, b) = (ends[0], ends[1]);
        let length = a.distance(b);
        let counts = length.is_finite() && length > MEETS;
        let count = if counts { (length / most).ceil().clamp(1.0, 1e6) as u32 } else { 0 };
        let at = move |i: u32| a.lerp(b, f64::from(i) / f64::from(count));
        (0..count).map(move |i| (Chunk { from: at(i), to: at(i + 1) }, (b - a) / length))
    })
}

/// Square cells over a rectangle.
#[derive(Clone, Copy)]
struct Cells {
    low: Point2,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    fn new(bounds: &Bounds2, side: f64) -> Self {
        let size = bounds.size();
        let side = side.max(size.max_element() / MOST);
        let [columns, rows] = [size.x, size.y].map(|length| (length / side) as usize + 1);
        Self { low: bounds.min, side, columns, rows }
    }

    fn count(&self) -> usize {
        self.columns * self.rows
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.low.x) / self.side).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.side).max(0.0) as usize).min(self.rows - 1)
    }

    fn of(&self, p: Point2) -> usize {
        self.row(p.y) * self.columns + self.column(p.x)
    }
}

/// Where beads of different colours may touch.
struct Borders {
    cells: Cells,
    /// Cells with more than one colour in them and those around them.
    border: Vec<bool>,
}

impl Borders {
    fn new(pieces: &[Piece], cells: Cells) -> Self {
        let mut colors: Vec<Content> = vec![Content::Nothing; cells.count()];
        for piece in pieces {
            for (chunk, _) in chunks(piece, 0.5 * cells.side) {
                let cell = &mut colors[cells.of(chunk.middle())];
                *cell = cell.with(Content::One(piece.color));
            }
        }
        let around = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
        let mixed = |cell: usize| {
            let (row, column) = (cell / cells.columns, cell % cells.columns);
            let rows = around(row, cells.rows);
            let all = rows.flat_map(|row| {
                around(column, cells.columns).map(move |column| row * cells.columns + column)
            });
            all.fold(Content::Nothing, |sum, i| sum.with(colors[i])) == Content::Many
        };
        let border = (0..cells.count()).map(mixed).collect();
        Self { cells, border }
    }
}

/// The colours in a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Content {
    Nothing,
    One(ColorId),
    Many,
}

impl Content {
    fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, some) | (some, Self::Nothing) => some,
            (a, b) if a == b => a,
            _ => Self::Many,
        }
    }
}

/// A short stretch of a bead.
#[derive(Clone, Copy)]
struct Sample {
    at: Point2,
    direction: Point2,
    length: f64,
    width: f64,
    color: ColorId,
}

/// Samples by cells, row by row.
struct Grid {
    samples: Vec<Sample>,
    cells: Cells,
    /// The first sample of each cell, and the number of samples last.
    first: Vec<u32>,
}

impl Grid {
    fn new(samples: &[Sample], cells: Cells) -> Self {
        let places: Vec<usize> = samples.iter().map(|s| cells.of(s.at)).collect();
        let mut first = vec![0_u32; cells.count() + 1];
        places.iter().for_each(|&cell| first[cell + 1] += 1);
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut sorted = samples.to_vec();
        for (sample, cell) in samples.iter().zip(places) {
            sorted[next[cell] as usize] = *sample;
            next[cell] += 1;
        }
        Self { samples: sorted, cells, first }
    }

    /// The colour of the nearest sample within `reach` of a point whose bead runs in this direction.
    fn nearest(&self, p: Point2, reach: f64, direction: Point2) -> Option<ColorId> {
        let cells = &self.cells;
        let (low, high) = (cells.column(p.x - reach), cells.column(p.x + reach));
        let mut best = (reach * reach, None);
        for row in cells.row(p.y - reach)..=cells.row(p.y + reach) {
            let start = row * cells.columns;
            let range = self.first[start + low] as usize..self.first[start + high + 1] as usize;
            for s in &self.samples[range] {
                let distance = s.at.distance_squared(p);
                if distance < best.0 && s.direction.dot(direction).abs() > PARALLEL {
                    best = (distance, Some(s.color));
                }
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Role;

    /// Horizontal beads: y in spacings, from, to, colour.
    fn seam(lines: &[(f64, f64, f64, u16)]) -> f64 {
        let spacing = bead::spacing(0.4, 0.2);
        let piece = |&(y, from, to, color): &(f64, f64, f64, u16)| Piece {
            points: [from, to].map(|x| Point2::new(x, y * spacing)).into(),
            role: Role::Infill,
            width: 0.4,
            way: Vec::new(),
            color: ColorId(color),
        };
        seam_length(&lines.iter().map(piece).collect::<Vec<_>>(), 0.2)
    }

    #[test]
    fn seams_are_ends_and_sides() {
        for (lines, want) in [
            (&[][..], 0.0),
            (&[(0.0, 0.0, 10.0, 1)], 0.0),
            // A line that changes colour; two that end at the same place.
            (&[(0.0, 0.0, 5.0, 1), (0.0, 5.0, 10.0, 2)], 0.4),
            (&[(0.0, 0.0, 5.0, 1), (0.0, 5.0, 10.0, 1)], 0.0),
            (&[(0.0, 0.0, 5.0, 1), (0.0, 10.0, 5.0, 2), (1.0, 0.0, 10.0, 2)], 0.4 + 5.0),
            // Side by side, and too far apart to touch.
            (&[(0.0, 0.0, 10.0, 1), (1.0, 10.0, 0.0, 2)], 10.0),
            (&[(0.0, 0.0, 10.0, 1), (2.0, 0.0, 10.0, 2)], 0.0),
            // A zipper of three teeth, 4 mm long.
            (
                &[
                    (0.0, 0.0, 7.0, 1),
                    (0.0, 7.0, 10.0, 2),
                    (1.0, 0.0, 3.0, 1),
                    (1.0, 3.0, 10.0, 2),
                    (2.0, 0.0, 7.0, 1),
                    (2.0, 7.0, 10.0, 2),
                ],
                3.0 * 0.4 + 2.0 * 4.0,
            ),
        ] {
            let found = seam(lines);
            assert!((found - want).abs() < 0.41, "{lines:?}: {found}");
        }
    }

    #[test]
    fn a_straight_seam_across_lines_is_as_long_as_it_is() {
        let lines: Vec<_> = (0..50)
            .flat_map(|i| [(f64::from(i), 0.0, 5.0, 1), (f64::from(i), 5.0, 9.0, 2)])
            .collect();
        assert!((seam(&lines) - 50.0 * 0.4).abs() < 1e-9);
    }
}
