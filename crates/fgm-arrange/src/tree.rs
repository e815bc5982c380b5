use crate::piece::overlap;
use fgm_core::{Bounds2, Point2};

/// Children of a node.
const FAN: usize = 8;

/// Bits of a Hilbert coordinate: enough for an order that keeps neighbours together.
const BITS: u32 = 12;

/// Room for the stack of a depth-first search: 11 levels hold 2^32 items.
const DEPTH: usize = 11 * (FAN - 1) + 2;

/// A packed tree of boxes in Hilbert order (Kamel and Faloutsos, "Hilbert R-tree", 1994), built at
/// once, without pointers: each level is a run of [`FAN`] times fewer boxes than the one below.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoxTree {
    boxes: Vec<Bounds2>,
    items: Vec<u32>,
    /// Where each level begins in `boxes`, and the end.
    levels: Vec<u32>,
}

/// For each orientation of the curve and quadrant: the quadrant's place, and its orientation.
const CURVE: [[(u8, u8); 4]; 4] = [
    [(0, 1), (1, 0), (3, 3), (2, 0)],
    [(0, 0), (3, 2), (1, 1), (2, 1)],
    [(2, 2), (3, 1), (1, 2), (0, 3)],
    [(2, 3), (1, 3), (3, 0), (0, 2)],
];

/// The place of a cell on the Hilbert curve.
fn hilbert(x: u32, y: u32) -> u64 {
    let (mut code, mut state) = (0u64, 0u8);
    for bit in (0..BITS).rev() {
        let quadrant = (x >> bit & 1) << 1 | (y >> bit & 1);
        let (place, next) = CURVE[state as usize][quadrant as usize];
        code = code << 2 | u64::from(place);
        state = next;
    }
    code
}

#[inline]
fn union(a: &Bounds2, b: &Bounds2) -> Bounds2 {
    Bounds2::new(a.min.min(b.min), a.max.max(b.max))
}

impl BoxTree {
    /// Replaces the items by `bounds`; an item's name is its index. `keys` is scratch.
    pub(crate) fn build(&mut self, bounds: &[Bounds2], keys: &mut Vec<u64>) {
        self.boxes.clear();
        self.items.clear();
        self.levels.clear();
        if bounds.is_empty() {
            return;
        }
        let all = bounds.iter().fold(Bounds2::EMPTY, |a, b| union(&a, b));
        let cells = f64::from((1u32 << BITS) - 1);
        let scale = |size: f64| if size > 0.0 { cells / size } else { 0.0 };
        let scale = Point2::new(scale(all.max.x - all.min.x), scale(all.max.y - all.min.y));
        keys.clear();
        keys.extend(bounds.iter().enumerate().map(|(i, b)| {
            let cell = ((b.min + b.max) * 0.5 - all.min) * scale;
            hilbert(cell.x as u32, cell.y as u32) << 32 | i as u64
        }));
        keys.sort_unstable();
        self.items.extend(keys.iter().map(|&key| key as u32));
        self.boxes.extend(self.items.iter().map(|&i| bounds[i as usize]));
        self.levels.extend([0, self.boxes.len() as u32]);
        let mut start = 0;
        while self.boxes.len() - start > 1 {
            let end = self.boxes.len();
            for node in (start..end).step_by(FAN) {
                let children = &self.boxes[node..(node + FAN).min(end)];
                let around = children.iter().fold(Bounds2::EMPTY, |a, b| union(&a, b));
                self.boxes.push(around);
            }
            self.levels.push(self.boxes.len() as u32);
            start = end;
        }
    }

    /// Number of items.
    pub(crate) fn len(&self) -> usize {
        self.items.len()
    }

    /// Calls `found` with every item whose box, and the boxes around it, satisfy `reaches`.
    #[inline]
    pub(crate) fn query(&self, reaches: impl Fn(&Bounds2) -> bool, mut found: impl FnMut(u32)) {
        let Some(top) = self.levels.len().checked_sub(2) else { return };
        let mut stack = [(0u32, 0u32); DEPTH];
        stack[0] = (top as u32, self.levels[top]);
        let mut held = 1;
        if !reaches(&self.boxes[self.levels[top] as usize]) {
            return;
        }
        while held > 0 {
            held -= 1;
            let (level, node) = stack[held];
            if level == 0 {
                found(self.items[node as usize]);
                continue;
            }
            for child in self.children(level as usize, node as usize) {
                if !reaches(&self.boxes[child]) {
                    continue;
                }
                if level == 1 {
                    found(self.items[child]);
                } else {
                    stack[held] = (level - 1, child as u32);
                    held += 1;
                }
            }
        }
    }

    /// As [`query`](Self::query), but takes what is highest first, and asks `reaches` again when
    /// its turn has come: what was found meanwhile may rule it out.
    #[inline]
    pub(crate) fn query_from_above(
        &self,
        reaches: impl Fn(&Bounds2) -> bool,
        mut found: impl FnMut(u32),
    ) {
        let Some(top) = self.levels.len().checked_sub(2) else { return };
        let mut stack = [(0u32, 0u32); DEPTH];
        stack[0] = (top as u32, self.levels[top]);
        let mut held = 1;
        while held > 0 {
            held -= 1;
            let (level, node) = stack[held];
            if !reaches(&self.boxes[node as usize]) {
                continue;
            }
            if level == 0 {
                found(self.items[node as usize]);
                continue;
            }
            let base = held;
            for child in self.children(level as usize, node as usize) {
                if reaches(&self.boxes[child]) {
                    let mut at = held;
                    let height = self.boxes[child].max.y;
                    while at > base && self.boxes[stack[at - 1].1 as usize].max.y > height {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = (level - 1, child as u32);
                    held += 1;
                }
            }
        }
    }

    /// The boxes below a node.
    #[inline]
    fn children(&self, level: usize, node: usize) -> std::ops::Range<usize> {
        let (below, here) = (self.levels[level - 1] as usize, self.levels[level] as usize);
        let first = below + (node - here) * FAN;
        first..(first + FAN).min(here)
    }

    /// Calls `found` once with every two items whose boxes share a point.
    pub(crate) fn self_join(&self, mut found: impl FnMut(u32, u32)) {
        let Some(top) = self.levels.len().checked_sub(2) else { return };
        let root = self.levels[top];
        let mut stack = vec![(top as u32, root, root)];
        while let Some((level, a, b)) = stack.pop() {
            if level == 0 {
                continue;
            }
            let mine = self.children(level as usize, a as usize);
            let theirs = self.children(level as usize, b as usize);
            for i in mine {
                let bounds = self.boxes[i];
                let from = if a == b { i + usize::from(level == 1) } else { theirs.start };
                for j in from..theirs.end {
                    if overlap(&bounds, &self.boxes[j]) {
                        if level == 1 {
                            found(self.items[i], self.items[j]);
                        } else {
                            stack.push((level - 1, i as u32, j as u32));
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_curve_visits_neighbours_in_turn() {
        let side = 1u32 << 4;
        let shift = BITS - 4;
        let mut cells: Vec<_> = (0..side * side)
            .map(|i| (i % side, i / side))
            .map(|(x, y)| (hilbert(x << shift, y << shift), x, y))
            .collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let ((_, x, y), (_, u, v)) = (pair[0], pair[1]);
            assert_eq!(x.abs_diff(u) + y.abs_diff(v), 1, "({x}, {y}) to ({u}, {v})");
        }
    }

    fn boxes() -> impl Strategy<Value = Vec<Bounds2>> {
        let one = (0..100i32, 0..100i32, 0..20i32, 0..20i32).prop_map(|(x, y, w, h)| {
            let min = Point2::new(f64::from(x), f64::from(y));
            Bounds2::new(min, min + Point2::new(f64::from(w), f64::from(h)))
        });
        prop::collection::vec(one, 0..150)
    }

    proptest! {
        #[test]
        fn finds_what_a_plain_search_finds(boxes in boxes(), window in boxes()) {
            let mut tree = BoxTree::default();
            tree.build(&boxes, &mut Vec::new());
            for window in window.iter().take(5) {
                let mut found = Vec::new();
                tree.query(|b| overlap(b, window), |i| found.push(i as usize));
                found.sort_unstable();
                let plain: Vec<_> = (0..boxes.len()).filter(|&i| overlap(&boxes[i], window)).collect();
                prop_assert_eq!(found, plain);
            }
            let mut pairs = Vec::new();
            tree.self_join(|a, b| pairs.push((a.min(b), a.max(b))));
            pairs.sort_unstable();
            let n = boxes.len();
            let plain: Vec<_> = (0..n)
                .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
                .filter(|&(i, j)| overlap(&boxes[i], &boxes[j]))
                .map(|(i, j)| (i as u32, j as u32))
                .collect();
            prop_assert_eq!(pairs, plain);
        }
    }
}
