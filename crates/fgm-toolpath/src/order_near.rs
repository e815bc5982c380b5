//! Nearest points among those not yet taken: a uniform grid whose points can be removed, made anew
//! with larger cells when most of them are gone.
//!
//! Beads have a width, so that points cannot crowd: cells stay nearly even.

use fgm_core::{Bounds2, Point2};

/// Points in a cell, on average, when a grid is made.
const FILL: f64 = 2.0;
/// A grid is made anew when one in this many points is left.
const THIN: usize = 4;
/// Smaller sides of a cell, mm, serve no printer.
const LEAST_CELL: f64 = 1e-3;

#[derive(Clone, Copy)]
struct Entry {
    at: Point2,
    id: u32,
}

/// Points by number, from 0.
pub(crate) struct Near {
    /// The points cell by cell, row by row.
    entries: Vec<Entry>,
    /// The first entry of each cell, and the number of entries last.
    starts: Vec<u32>,
    /// How many entries of each cell are left.
    counts: Vec<u32>,
    /// Where the entry of an id stands; [`GONE`] once removed.
    place: Vec<u32>,
    live: usize,
    bounds: Bounds2,
    cell: f64,
    columns: usize,
    rows: usize,
}

const GONE: u32 = u32::MAX;

impl Near {
    /// A grid of finite points.
    pub(crate) fn new(points: &[Point2]) -> Self {
        let entries = points.iter().zip(0..).map(|(&at, id)| Entry { at, id }).collect();
        let mut near = Self {
            entries,
            starts: Vec::new(),
            counts: Vec::new(),
            place: vec![GONE; points.len()],
            live: points.len(),
            bounds: Bounds2::EMPTY,
            cell: 1.0,
            columns: 0,
            rows: 0,
        };
        near.sort_into_cells();
        near
    }

    /// Takes a point out, if it is still in.
    pub(crate) fn remove(&mut self, id: u32) {
        let place = self.place[id as usize];
        if place == GONE {
            return;
        }
        let cell = self.cell_of(self.entries[place as usize].at);
        self.counts[cell] -= 1;
        let last = self.starts[cell] + self.counts[cell];
        let moved = self.entries[last as usize];
        self.entries[place as usize] = moved;
        self.place[moved.id as usize] = place;
        self.place[id as usize] = GONE;
        self.live -= 1;
        if self.live * THIN <= self.entries.len() {
            self.thin_out();
        }
    }

    fn thin_out(&mut self) {
        let mut left = Vec::with_capacity(self.live);
        for (&start, &count) in self.starts.iter().zip(&self.counts) {
            left.extend_from_slice(&self.entries[start as usize..(start + count) as usize]);
        }
        self.entries = left;
        self.sort_into_cells();
    }

    /// Counting sort of the entries by cell.
    fn sort_into_cells(&mut self) {
        self.bounds = Bounds2::of(self.entries.iter().map(|entry| entry.at));
        let count = self.entries.len() as f64;
        let size = self.bounds.size().max(Point2::ZERO);
        // By area, and along the line where there is none.
        let even = (size.x * size.y * FILL / count).sqrt();
        let along = size.x.max(size.y) * FILL / count;
        self.cell = even.max(along).max(LEAST_CELL);
        self.columns = (size.x / self.cell) as usize + 1;
        self.rows = (size.y / self.cell) as usize + 1;

        let cells: Vec<_> = self.entries.iter().map(|e| self.cell_of(e.at) as u32).collect();
        self.counts = vec![0; self.columns * self.rows];
        cells.iter().for_each(|&cell| self.counts[cell as usize] += 1);
        let mut at = 0;
        self.starts.clear();
        self.starts.extend(self.counts.iter().map(|count| {
            at += count;
            at - count
        }));
        let mut next = self.starts.clone();
        let mut sorted = self.entries.clone();
        for (entry, cell) in self.entries.iter().zip(cells) {
            let place = &mut next[cell as usize];
            self.place[entry.id as usize] = *place;
            sorted[*place as usize] = *entry;
            *place += 1;
        }
        self.entries = sorted;
    }

    fn column(&self, p: Point2) -> usize {
        (((p.x - self.bounds.min.x) / self.cell) as usize).min(self.columns - 1)
    }

    fn row(&self, p: Point2) -> usize {
        (((p.y - self.bounds.min.y) / self.cell) as usize).min(self.rows - 1)
    }

    fn cell_of(&self, p: Point2) -> usize {
        self.row(p) * self.columns + self.column(p)
    }

    /// The point nearest to `p`; of equally near ones the one with the least number.
    pub(crate) fn nearest(&self, p: Point2) -> Option<u32> {
        if self.live == 0 {
            return None;
        }
        let (column, row) = (self.column(p), self.row(p));
        // What lies outside the cells around is at least as far as their nearest side: from the
        // point of the grid nearest to `p` if `p` lies outside.
        let inside = p.clamp(self.bounds.min, self.bounds.max) - self.bounds.min;
        let offset = inside - Point2::new(column as f64, row as f64) * self.cell;
        let side = offset.min(Point2::splat(self.cell) - offset).min_element();

        let mut best = Best { distance: f64::INFINITY, id: None };
        for ring in 0..self.columns.max(self.rows) {
            let (low, high) = (row.saturating_sub(ring), (row + ring).min(self.rows - 1));
            let (left, right) =
                (column.saturating_sub(ring), (column + ring).min(self.columns - 1));
            for y in low..=high {
                if y + ring == row || y == row + ring {
                    self.scan(y, left, right, p, &mut best);
                } else {
                    if left + ring == column {
                        self.scan(y, left, left, p, &mut best);
                    }
                    if right == column + ring {
                        self.scan(y, right, right, p, &mut best);
                    }
                }
            }
            let reached = (ring as f64 * self.cell + side).max(0.0);
            if best.distance < reached * reached || best.distance == 0.0 {
                break;
            }
        }
        best.id
    }

    /// The point nearest to point `id`, not farther than `within` mm, that `accept` takes; of
    /// equally near ones the one with the least number.
    pub(crate) fn other_at(
        &self,
        id: u32,
        within: f64,
        accept: impl Fn(u32) -> bool,
    ) -> Option<u32> {
        let p = self.entries[self.place[id as usize] as usize].at;
        let mut best = (within * within, u32::MAX);
        for row in self.row(p - within)..=self.row(p + within) {
            for column in self.column(p - within)..=self.column(p + within) {
                let cell = row * self.columns + column;
                let start = self.starts[cell] as usize;
                for entry in &self.entries[start..start + self.counts[cell] as usize] {
                    let distance = entry.at.distance_squared(p);
                    if (distance, entry.id) < best && entry.id != id && accept(entry.id) {
                        best = (distance, entry.id);
                    }
                }
            }
        }
        (best.1 != u32::MAX).then_some(best.1)
    }

    /// Every point that is left, neighbours near each other.
    pub(crate) fn ids(&self) -> Vec<u32> {
        let cells = self.starts.iter().zip(&self.counts);
        let cells = cells.map(|(&start, &count)| start as usize..(start + count) as usize);
        cells.flat_map(|cell| self.entries[cell].iter().map(|entry| entry.id)).collect()
    }

    /// Offers the points of some cells of a row.
    fn scan(&self, row: usize, left: usize, right: usize, p: Point2, best: &mut Best) {
        for cell in row * self.columns + left..=row * self.columns + right {
            let start = self.starts[cell] as usize;
            for entry in &self.entries[start..start + self.counts[cell] as usize] {
                best.offer(entry.at.distance_squared(p), entry.id);
            }
        }
    }
}

struct Best {
    /// Squared.
    distance: f64,
    id: Option<u32>,
}

impl Best {
    fn offer(&mut self, distance: f64, id: u32) {
        let nearer = distance < self.distance
            || (distance == self.distance && self.id.is_some_and(|best| id < best));
        if nearer {
            *self = Self { distance, id: Some(id) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(raw: &[(i32, i32)], unit: f64) -> Vec<Point2> {
        raw.iter().map(|p| Point2::new(f64::from(p.0), f64::from(p.1)) * unit).collect()
    }

    proptest! {
        #[test]
        fn nearest_as_a_plain_search_finds(
            raw in prop::collection::vec((0..12i32, 0..12i32), 0..120),
            queries in prop::collection::vec((-3.0..15.0f64, -3.0..15.0f64), 1..120),
        ) {
            let points = points(&raw, 1.0);
            let mut near = Near::new(&points);
            let mut live: Vec<bool> = vec![true; points.len()];
            for (x, y) in queries {
                let p = Point2::new(x, y);
                let least = (0..points.len())
                    .filter(|&i| live[i])
                    .map(|i| (points[i].distance_squared(p), i as u32))
                    .min_by(|a, b| a.partial_cmp(b).unwrap());
                let found = near.nearest(p);
                prop_assert_eq!(found, least.map(|(_, id)| id));
                if let Some(id) = found {
                    near.remove(id);
                    near.remove(id);
                    live[id as usize] = false;
                }
                let mut ids = near.ids();
                ids.sort_unstable();
                prop_assert!(ids.into_iter().eq((0..).zip(&live).filter(|l| *l.1).map(|l| l.0)));
            }
        }

        #[test]
        fn others_as_a_plain_search_finds(
            raw in prop::collection::vec((0..40i32, 0..40i32), 1..120),
            within in 0..4i32,
        ) {
            let (points, within) = (points(&raw, 0.25), f64::from(within) * 0.25);
            let near = Near::new(&points);
            for (p, id) in points.iter().zip(0_u32..) {
                let accept = |other: u32| !other.is_multiple_of(3);
                let plain = points
                    .iter()
                    .zip(0_u32..)
                    .filter(|&(_, other)| other != id && accept(other))
                    .map(|(q, other)| (p.distance_squared(*q), other))
                    .filter(|(d, _)| *d <= within * within)
                    .min_by(|a, b| a.partial_cmp(b).unwrap());
                prop_assert_eq!(near.other_at(id, within, accept), plain.map(|(_, other)| other));
            }
        }
    }

    #[test]
    fn no_points_and_equal_points() {
        assert_eq!(Near::new(&[]).nearest(Point2::ZERO), None);
        let mut near = Near::new(&[Point2::ONE; 100]);
        for _ in 0..100 {
            let id = near.nearest(Point2::ONE).unwrap();
            near.remove(id);
        }
        assert_eq!(near.nearest(Point2::ONE), None);
    }
}
