use fgm_core::{Bounds2, Point2};

/// Boxes in a block.
pub(crate) const FAN: usize = 8;

/// By how much, relative, boxes are made larger: twice what rounding to `f32` may take away.
const SLACK: f32 = 1.0 / (1 << 22) as f32;

/// Eight boxes in `f32`, a list for each side, so that all are compared at once. Rounded outwards,
/// relative to an origin near by: what is found here is looked at exactly afterwards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    pub(crate) min_x: [f32; FAN],
    pub(crate) min_y: [f32; FAN],
    pub(crate) max_x: [f32; FAN],
    pub(crate) max_y: [f32; FAN],
}

/// Which boxes of a block: a byte each, 0 or 1, the first one lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lanes(u64);

impl Lanes {
    #[inline(always)]
    fn of(test: impl Fn(usize) -> bool) -> Self {
        let mut bytes = [0u8; FAN];
        for (lane, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from(test(lane));
        }
        Self(u64::from_le_bytes(bytes))
    }

    /// Those from `lane` on.
    #[inline]
    pub(crate) fn starting_at(self, lane: usize) -> Self {
        Self(self.0 & u64::MAX.checked_shl(8 * lane as u32).unwrap_or(0))
    }
}

impl Iterator for Lanes {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let lane = self.0.trailing_zeros() / 8;
        self.0 &= self.0 - 1;
        Some(lane as usize)
    }
}

/// What larger numbers are taken for: far beyond the lattice, but finite, so that nothing reaches
/// the empty boxes of a block.
const FAR: f32 = 1e37;

/// A number not above `v`, or not above [`FAR`].
#[inline]
pub(crate) fn lower(v: f64) -> f32 {
    let near = (v as f32).clamp(-FAR, FAR);
    near - near.abs() * SLACK
}

/// A number not below `v`, or not below -[`FAR`].
#[inline]
pub(crate) fn upper(v: f64) -> f32 {
    let near = (v as f32).clamp(-FAR, FAR);
    near + near.abs() * SLACK
}

impl Block {
    /// Boxes that touch nothing.
    pub(crate) const EMPTY: Self = Self {
        min_x: [f32::INFINITY; FAN],
        min_y: [f32::INFINITY; FAN],
        max_x: [f32::NEG_INFINITY; FAN],
        max_y: [f32::NEG_INFINITY; FAN],
    };

    #[inline]
    pub(crate) fn set(&mut self, lane: usize, window: &Window) {
        self.min_x[lane] = window.min_x;
        self.min_y[lane] = window.min_y;
        self.max_x[lane] = window.max_x;
        self.max_y[lane] = window.max_y;
    }

    #[inline]
    pub(crate) fn window(&self, lane: usize) -> Window {
        Window {
            min_x: self.min_x[lane],
            min_y: self.min_y[lane],
            max_x: self.max_x[lane],
            max_y: self.max_y[lane],
        }
    }

    /// The least box around all.
    pub(crate) fn around(&self) -> Window {
        let least = |sides: &[f32; FAN]| sides.iter().copied().fold(f32::INFINITY, f32::min);
        let most = |sides: &[f32; FAN]| sides.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        Window {
            min_x: least(&self.min_x),
            min_y: least(&self.min_y),
            max_x: most(&self.max_x),
            max_y: most(&self.max_y),
        }
    }
}

/// What a tree is asked for.
pub(crate) trait Reach {
    /// The boxes of a block that may be meant.
    fn lanes(&self, block: &Block) -> Lanes;
}

/// A box: all that share a point with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub(crate) min_x: f32,
    pub(crate) min_y: f32,
    pub(crate) max_x: f32,
    pub(crate) max_y: f32,
}

impl Window {
    /// A box as seen from an origin.
    #[inline]
    pub(crate) fn new(bounds: &Bounds2, origin: Point2) -> Self {
        let (min, max) = (bounds.min - origin, bounds.max - origin);
        Self { min_x: lower(min.x), min_y: lower(min.y), max_x: upper(max.x), max_y: upper(max.y) }
    }
}

impl Reach for Window {
    #[inline]
    fn lanes(&self, block: &Block) -> Lanes {
        Lanes::of(|i| {
            (block.min_x[i] <= self.max_x)
                & (self.min_x <= block.max_x[i])
                & (block.min_y[i] <= self.max_y)
                & (self.min_y <= block.max_y[i])
        })
    }
}

/// A segment: all boxes that it comes near to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    window: Window,
    at: [f32; 2],
    d: [f32; 2],
    /// By how much boxes are to be larger.
    margin: [f32; 2],
}

impl Probe {
    /// The segment from `a` to `b`, among boxes that reach from `origin` to `origin + size`.
    pub(crate) fn new(a: Point2, b: Point2, origin: Point2, size: Point2) -> Self {
        let bounds = Bounds2::new(a.min(b), a.max(b));
        let (at, d) = (a - origin, b - a);
        // What rounding of coordinates may do to differences.
        let blur = (at.abs() + size) * f64::from(SLACK);
        Self {
            window: Window::new(&bounds, origin),
            at: [at.x as f32, at.y as f32],
            d: [d.x as f32, d.y as f32],
            margin: [upper(blur.x), upper(blur.y)],
        }
    }
}

impl Reach for Probe {
    #[inline]
    fn lanes(&self, block: &Block) -> Lanes {
        let ([x, y], [dx, dy], [mx, my]) = (self.at, self.d, self.margin);
        let (ax, ay) = (dx.abs(), dy.abs());
        Lanes::of(|i| {
            let w = &self.window;
            let overlap = (block.min_x[i] <= w.max_x)
                & (w.min_x <= block.max_x[i])
                & (block.min_y[i] <= w.max_y)
                & (w.min_y <= block.max_y[i]);
            let (cx, cy) = (
                (block.min_x[i] + block.max_x[i]) * 0.5 - x,
                (block.min_y[i] + block.max_y[i]) * 0.5 - y,
            );
            let (hx, hy) = (
                (block.max_x[i] - block.min_x[i]) * 0.5 + mx,
                (block.max_y[i] - block.min_y[i]) * 0.5 + my,
            );
            let (l, r, reach) = (dx * cy, dy * cx, ax * hy + ay * hx);
            let beside = (l - r).abs() > reach + (l.abs() + r.abs() + reach) * (4.0 * SLACK);
            // What is no number, of numbers too large, counts as near.
            overlap & !beside
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Bounds2>> {
        let scale = prop::sample::select(vec![1i64, 1000, 1 << 30]);
        let one = (0..1000i64, 0..1000i64, 0..200i64, 0..200i64, scale);
        let one = one.prop_map(|(x, y, w, h, scale)| {
            let at = |x: i64, y: i64| Point2::new((x * scale) as f64, (y * scale) as f64);
            Bounds2::new(at(x, y), at(x + w, y + h))
        });
        prop::collection::vec(one, 1..=FAN)
    }

    /// Whether a segment meets a box: clipped by its four sides.
    fn meets(a: Point2, b: Point2, bounds: &Bounds2) -> bool {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (a, d, min, max) in [
            (a.x, b.x - a.x, bounds.min.x, bounds.max.x),
            (a.y, b.y - a.y, bounds.min.y, bounds.max.y),
        ] {
            if d == 0.0 {
                if a < min || a > max {
                    return false;
                }
                continue;
            }
            let (s, t) = ((min - a) / d, (max - a) / d);
            (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
        }
        from <= to
    }

    proptest! {
        #[test]
        fn nothing_that_is_met_is_missed(boxes in boxes(), other in boxes(), shift in -1e9..1e9f64) {
            let mut block = Block::EMPTY;
            let origin = Point2::splat(shift.floor());
            for (lane, b) in boxes.iter().enumerate() {
                block.set(lane, &Window::new(b, origin));
            }
            let size = boxes.iter().fold(Bounds2::EMPTY, |a, b| a.union(b)).max - origin;
            for b in &other {
                let found = Window::new(b, origin).lanes(&block);
                let plain = (0..boxes.len()).filter(|&i| boxes[i].intersects(b));
                prop_assert!(plain.into_iter().all(|i| found.clone().any(|lane| lane == i)));
                let probe = Probe::new(b.min, b.max, origin, size.abs());
                let found = probe.lanes(&block);
                let plain = (0..boxes.len()).filter(|&i| meets(b.min, b.max, &boxes[i]));
                prop_assert!(plain.into_iter().all(|i| found.clone().any(|lane| lane == i)));
            }
            prop_assert_eq!(Lanes(u64::MAX).starting_at(8).count(), 0);
        }
    }
}
