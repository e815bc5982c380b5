use fgm_core::Interval;

/// One layer of the part: where it is cut and where its beads' tops lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// From 0 at the bottom of the part.
    pub index: usize,
    /// Height of the cut, in the middle of the layer, in the design's coordinates, mm.
    pub cut: f64,
    /// Height of the beads' tops, in the design's coordinates, mm.
    pub top: f64,
    /// Thickness, mm.
    pub height: f64,
}

/// The layers of a part: as many as have their middle inside it.
///
/// Heights are computed from the index, never added up, so that the last layer of a tall part is
/// where it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    bottom: f64,
    first_height: f64,
    height: f64,
    count: usize,
}

/// A share of a layer below which a part's height counts as a whole number of layers.
const SLACK: f64 = 1e-6;

impl Layers {
    /// The layers of a part that reaches over `z`. Both heights are positive, mm.
    pub fn new(z: Interval, first_height: f64, height: f64) -> Self {
        let above_first = z.width() - first_height;
        let count = if above_first > 0.0 {
            1 + (above_first / height - 0.5 - SLACK).ceil().max(0.0) as usize
        } else {
            usize::from(z.width() > first_height * (0.5 + SLACK))
        };
        Self { bottom: z.lo, first_height, height, count }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The layer at an index from 0.
    pub fn get(&self, index: usize) -> Layer {
        let (below, height) = match index {
            0 => (self.bottom, self.first_height),
            _ => (self.bottom + self.first_height + (index - 1) as f64 * self.height, self.height),
        };
        Layer { index, cut: below + 0.5 * height, top: below + height, height }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        for (height, first, layer, count) in [
            (10.0, 0.2, 0.2, 50),
            (48.0, 0.2, 0.2, 240),
            (100.0, 0.2, 0.2, 500),
            (10.0, 0.3, 0.2, 49),
            (0.09, 0.2, 0.2, 0),
            (0.1, 0.2, 0.2, 0),
            (0.11, 0.2, 0.2, 1),
            (0.31, 0.2, 0.2, 2),
            (0.29, 0.2, 0.2, 1),
            (0.0, 0.2, 0.2, 0),
        ] {
            let layers = Layers::new(Interval::new(-3.0, height - 3.0), first, layer);
            assert_eq!(layers.count(), count, "{height} {first} {layer}");
        }
    }

    #[test]
    fn first_and_last_are_cut_at_their_middle() {
        let layers = Layers::new(Interval::new(0.0, 10.0), 0.2, 0.2);
        assert_eq!(layers.get(0).cut, 0.1);
        assert!((layers.get(49).cut - 9.9).abs() < 1e-12);
        assert!((layers.get(49).top - 10.0).abs() < 1e-12);
    }
}
