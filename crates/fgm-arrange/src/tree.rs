use crate::block::{Block, FAN, Lanes, Probe, Reach, Window, lower};
use crate::hilbert::HilbertOrder;
use fgm_core::{Bounds2, Point2};

/// Room for the stack of a depth-first search: 11 levels hold 2^32 items.
const DEPTH: usize = 11 * (FAN - 1) + 2;

/// A packed tree of boxes in Hilbert order (Kamel and Faloutsos, "Hilbert R-tree", 1994), built at
/// once, without pointers: each level has [`FAN`] times fewer blocks than the one below.
///
/// Its boxes are a little too large (see [`Block`]), so what it finds are candidates.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoxTree {
    blocks: Vec<Block>,
    /// The items of the lowest level's boxes.
    items: Vec<u32>,
    /// Where each level begins in `blocks`, the lowest first, and the end.
    levels: Vec<u32>,
    origin: Point2,
    size: Point2,
}

/// A block and its level.
type Place = (u32, u32);

impl BoxTree {
    /// Replaces the items by `count` boxes; an item's name is its index.
    pub(crate) fn build(
        &mut self,
        count: usize,
        bounds: impl Fn(usize) -> Bounds2,
        order: &mut HilbertOrder,
    ) {
        self.blocks.clear();
        self.items.clear();
        self.levels.clear();
        if count == 0 {
            return;
        }
        let all = (0..count).fold(Bounds2::EMPTY, |all, i| {
            let b = bounds(i);
            Bounds2::new(all.min.min(b.min), all.max.max(b.max))
        });
        (self.origin, self.size) = (all.min, all.max - all.min);
        self.items.extend(order.of(&all, count, &bounds));
        self.blocks.reserve(count.div_ceil(FAN) * FAN / (FAN - 1) + DEPTH);
        self.levels.push(0);
        for items in self.items.chunks(FAN) {
            let mut block = Block::EMPTY;
            for (lane, &item) in items.iter().enumerate() {
                block.set(lane, &Window::new(&bounds(item as usize), self.origin));
            }
            self.blocks.push(block);
        }
        self.levels.push(self.blocks.len() as u32);
        let mut start = 0;
        while self.blocks.len() - start > 1 {
            let end = self.blocks.len();
            for first in (start..end).step_by(FAN) {
                let mut block = Block::EMPTY;
                for child in first..(first + FAN).min(end) {
                    block.set(child - first, &self.blocks[child].around());
                }
                self.blocks.push(block);
            }
            self.levels.push(self.blocks.len() as u32);
            start = end;
        }
    }

    /// Number of items.
    pub(crate) fn len(&self) -> usize {
        self.items.len()
    }

    /// What shares a point with a box.
    #[inline]
    pub(crate) fn window(&self, bounds: &Bounds2) -> Window {
        Window::new(bounds, self.origin)
    }

    /// What a segment meets.
    #[inline]
    pub(crate) fn probe(&self, a: Point2, b: Point2) -> Probe {
        Probe::new(a, b, self.origin, self.size)
    }

    fn top(&self) -> Option<Place> {
        let level = self.levels.len().checked_sub(2)?;
        Some((level as u32, self.levels[level]))
    }

    /// The block below a box of a block.
    #[inline]
    fn child(&self, (level, block): Place, lane: usize) -> Place {
        let (below, here) = (self.levels[level as usize - 1], self.levels[level as usize]);
        (level - 1, below + (block - here) * FAN as u32 + lane as u32)
    }

    #[inline]
    fn item(&self, block: u32, lane: usize) -> u32 {
        self.items[block as usize * FAN + lane]
    }

    /// Calls `found` with every item that `reach` may mean.
    #[inline]
    pub(crate) fn query(&self, reach: &impl Reach, mut found: impl FnMut(u32)) {
        let Some(top) = self.top() else { return };
        let mut stack = [(0, 0); DEPTH];
        stack[0] = top;
        let mut held = 1;
        while held > 0 {
            held -= 1;
            let place = stack[held];
            let lanes = reach.lanes(&self.blocks[place.1 as usize]);
            if place.0 == 0 {
                lanes.for_each(|lane| found(self.item(place.1, lane)));
                continue;
            }
            for lane in lanes {
                stack[held] = self.child(place, lane);
                held += 1;
            }
        }
    }

    /// Calls `found` with the items below `p` or at it, the highest boxes first. It answers with a
    /// height: nothing that lies wholly below it is of interest any more.
    #[inline]
    pub(crate) fn query_down(&self, p: Point2, mut found: impl FnMut(u32) -> f64) {
        let Some(top) = self.top() else { return };
        let mut column = self.window(&Bounds2::new(p, p));
        column.min_y = f32::NEG_INFINITY;
        let mut stack = [((0, 0), 0.0f32); DEPTH];
        stack[0] = (top, f32::INFINITY);
        let mut held = 1;
        while held > 0 {
            held -= 1;
            let (place, height) = stack[held];
            // Something higher may have been found since.
            if height < column.min_y {
                continue;
            }
            let block = &self.blocks[place.1 as usize];
            let base = held;
            for lane in column.lanes(block) {
                if place.0 == 0 {
                    let floor = lower(found(self.item(place.1, lane)) - self.origin.y);
                    column.min_y = column.min_y.max(floor);
                    continue;
                }
                let (mut at, height) = (held, block.max_y[lane]);
                while at > base && stack[at - 1].1 > height {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = (self.child(place, lane), height);
                held += 1;
            }
        }
    }

    /// Calls `found` once with every two items whose boxes share a point.
    #[inline]
    pub(crate) fn self_join(&self, mut found: impl FnMut(u32, u32)) {
        let Some((level, root)) = self.top() else { return };
        let mut stack = vec![(level, root, root)];
        while let Some((level, a, b)) = stack.pop() {
            let (mine, theirs) = (&self.blocks[a as usize], &self.blocks[b as usize]);
            for i in 0..FAN {
                let mut lanes: Lanes = mine.window(i).lanes(theirs);
                if a == b {
                    lanes = lanes.starting_at(i + usize::from(level == 0));
                }
                for j in lanes {
                    if level == 0 {
                        found(self.item(a, i), self.item(b, j));
                    } else {
                        let (_, child) = self.child((level, a), i);
                        stack.push((level - 1, child, self.child((level, b), j).1));
                    }
                }
            }
        }
    }

    /// Gives back what a large set needed.
    pub(crate) fn rest(&mut self) {
        self.levels.clear();
        crate::memory::rest(&mut self.blocks);
        crate::memory::rest(&mut self.items);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Bounds2>> {
        let one = (0..100i32, 0..100i32, 0..20i32, 0..20i32).prop_map(|(x, y, w, h)| {
            let min = Point2::new(f64::from(x), f64::from(y));
            Bounds2::new(min, min + Point2::new(f64::from(w), f64::from(h)))
        });
        prop::collection::vec(one, 0..700)
    }

    fn tree(boxes: &[Bounds2]) -> BoxTree {
        let mut tree = BoxTree::default();
        tree.build(boxes.len(), |i| boxes[i], &mut HilbertOrder::default());
        tree
    }

    proptest! {
        #[test]
        fn finds_what_a_plain_search_finds(boxes in boxes(), window in boxes()) {
            let tree = tree(&boxes);
            for window in window.iter().take(5) {
                let mut found = Vec::new();
                tree.query(&tree.window(window), |i| found.push(i as usize));
                found.retain(|&i| boxes[i].intersects(window));
                found.sort_unstable();
                let plain: Vec<_> =
                    (0..boxes.len()).filter(|&i| boxes[i].intersects(window)).collect();
                prop_assert_eq!(found, plain);
            }
            let mut pairs = Vec::new();
            tree.self_join(|a, b| pairs.push((a.min(b) as usize, a.max(b) as usize)));
            pairs.retain(|&(a, b)| boxes[a].intersects(&boxes[b]));
            pairs.sort_unstable();
            let n = boxes.len();
            let plain: Vec<_> = (0..n)
                .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
                .filter(|&(i, j)| boxes[i].intersects(&boxes[j]))
                .collect();
            prop_assert_eq!(pairs, plain);
        }

        #[test]
        fn the_highest_top_below_a_point_is_found(boxes in boxes(), x in 0..120i32, y in 0..120i32) {
            let p = Point2::new(f64::from(x), f64::from(y));
            let top = |b: &Bounds2| {
                let below = b.min.x <= p.x && p.x <= b.max.x && b.max.y <= p.y;
                if below { b.max.y } else { f64::NEG_INFINITY }
            };
            let mut best = f64::NEG_INFINITY;
            tree(&boxes).query_down(p, |i| {
                best = best.max(top(&boxes[i as usize]));
                best
            });
            prop_assert_eq!(best, boxes.iter().map(top).fold(f64::NEG_INFINITY, f64::max));
        }
    }
}
