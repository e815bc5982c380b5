use fgm_core::{Bounds2, Point2};

/// Bits of a coordinate at most: enough for an order that keeps neighbours together.
const MOST_BITS: u32 = 12;

/// For each orientation of the curve and quadrant: the quadrant's place, and its orientation.
const CURVE: [[(u8, u8); 4]; 4] = [
    [(0, 1), (1, 0), (3, 3), (2, 0)],
    [(0, 0), (3, 2), (1, 1), (2, 1)],
    [(2, 2), (3, 1), (1, 2), (0, 3)],
    [(2, 3), (1, 3), (3, 0), (0, 2)],
];

/// Two steps of [`CURVE`] in one, for two bits of x and two of y.
const TWO_STEPS: [[(u8, u8); 16]; 4] = two_steps();

const fn two_steps() -> [[(u8, u8); 16]; 4] {
    let mut table = [[(0, 0); 16]; 4];
    let mut state = 0;
    while state < 4 {
        let mut cell = 0;
        while cell < 16 {
            let (x, y) = (cell >> 2, cell & 3);
            let (high, next) = CURVE[state][(x >> 1) << 1 | y >> 1];
            let (low, last) = CURVE[next as usize][(x & 1) << 1 | y & 1];
            table[state][cell] = (high << 2 | low, last);
            cell += 1;
        }
        state += 1;
    }
    table
}

/// The place of a cell on the Hilbert curve through `4^bits` cells; `bits` is even.
fn hilbert(x: u32, y: u32, bits: u32) -> u64 {
    let (mut code, mut state) = (0u64, 0u8);
    for shift in (0..bits).step_by(2).rev() {
        let cell = (x >> shift & 3) << 2 | (y >> shift & 3);
        let (place, next) = TWO_STEPS[state as usize][cell as usize];
        code = code << 4 | u64::from(place);
        state = next;
    }
    code
}

/// Puts boxes in the order of a Hilbert curve through their centres.
#[derive(Debug, Default)]
pub(crate) struct HilbertOrder {
    /// `code << 32 | index`.
    keys: Vec<u64>,
    spare: Vec<u64>,
    counts: Vec<u32>,
}

impl HilbertOrder {
    /// The indices of `count` boxes within `all`, in order. Equal places keep the order of the
    /// indices.
    pub(crate) fn of(
        &mut self,
        all: &Bounds2,
        count: usize,
        bounds: impl Fn(usize) -> Bounds2,
    ) -> impl ExactSizeIterator<Item = u32> + '_ {
        // A few cells for each box; even.
        let bits = (((usize::BITS - count.leading_zeros()) / 2 + 3) & !1).clamp(2, MOST_BITS);
        let cells = f64::from((1u32 << bits) - 1);
        let scale = |size: f64| if size > 0.0 { cells / size } else { 0.0 };
        let scale = Point2::new(scale(all.max.x - all.min.x), scale(all.max.y - all.min.y));
        self.keys.clear();
        self.keys.extend((0..count).map(|i| {
            let b = bounds(i);
            let cell = ((b.min + b.max) * 0.5 - all.min) * scale;
            hilbert(cell.x as u32, cell.y as u32, bits) << 32 | i as u64
        }));
        self.sort_digit(32, bits);
        self.sort_digit(32 + bits, bits);
        self.keys.iter().map(|&key| key as u32)
    }

    /// Sorts by some bits of the keys; equal ones keep their order.
    fn sort_digit(&mut self, shift: u32, bits: u32) {
        let digit = |key: u64| (key >> shift) as usize & ((1 << bits) - 1);
        self.counts.clear();
        self.counts.resize(1 << bits, 0);
        for &key in &self.keys {
            self.counts[digit(key)] += 1;
        }
        let mut sum = 0;
        for count in &mut self.counts {
            sum += std::mem::replace(count, sum);
        }
        self.spare.resize(self.keys.len(), 0);
        for &key in &self.keys {
            let place = &mut self.counts[digit(key)];
            self.spare[*place as usize] = key;
            *place += 1;
        }
        std::mem::swap(&mut self.keys, &mut self.spare);
    }

    /// Gives back what a large set needed.
    pub(crate) fn rest(&mut self) {
        crate::memory::rest(&mut self.keys);
        crate::memory::rest(&mut self.spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_curve_visits_neighbours_in_turn() {
        let side = 1u32 << 4;
        let mut cells: Vec<_> = (0..side * side)
            .map(|i| (i % side, i / side))
            .map(|(x, y)| (hilbert(x, y, 4), x, y))
            .collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let ((_, x, y), (_, u, v)) = (pair[0], pair[1]);
            assert_eq!(x.abs_diff(u) + y.abs_diff(v), 1, "({x}, {y}) to ({u}, {v})");
        }
    }

    proptest! {
        #[test]
        fn every_index_comes_once_in_order_of_its_code(
            points in prop::collection::vec((0..1000i32, 0..1000i32), 0..300),
        ) {
            let bounds = |i: usize| {
                let p = Point2::new(f64::from(points[i].0), f64::from(points[i].1));
                Bounds2::new(p, p)
            };
            let all = (0..points.len()).fold(Bounds2::EMPTY, |a, i| a.union(&bounds(i)));
            let mut order = HilbertOrder::default();
            let mut found: Vec<_> = order.of(&all, points.len(), bounds).collect();
            prop_assert!(order.keys.is_sorted());
            found.sort_unstable();
            prop_assert_eq!(found, (0..points.len() as u32).collect::<Vec<_>>());
        }
    }
}
