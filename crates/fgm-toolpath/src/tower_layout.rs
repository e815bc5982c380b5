//! Where the spots of purge towers go: in rows along the sides of the part, inside the bed.

use std::fmt;

use fgm_core::{Bounds2, Point2};

use crate::{ToolpathError, TowerOptions};

/// How many times as long as wide spots are tried, in this order.
const RATIOS: [f64; 3] = [1.0, 2.0, 4.0];
/// Room for the rounding of sums of sides, mm.
const SLACK: f64 = 1e-9;

/// A side of the part, seen from above: the front has the least y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Greater x.
    Right,
    /// Less x.
    Left,
    /// Greater y.
    Back,
    /// Less y.
    Front,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "right",
            Self::Left => "left",
            Self::Back => "back",
            Self::Front => "front",
        })
    }
}

impl Side {
    const ALL: [Self; 4] = [Self::Right, Self::Left, Self::Back, Self::Front];

    /// Whether rows on this side run along y.
    fn is_upright(self) -> bool {
        matches!(self, Self::Right | Self::Left)
    }

    /// The part of the bed beside `taken` on this side, over the whole of the other extent.
    fn strip(self, taken: &Bounds2, bed: &Bounds2) -> Bounds2 {
        let mut strip = *bed;
        match self {
            Self::Right => strip.min.x = strip.min.x.max(taken.max.x),
            Self::Left => strip.max.x = strip.max.x.min(taken.min.x),
            Self::Back => strip.min.y = strip.min.y.max(taken.max.y),
            Self::Front => strip.max.y = strip.max.y.min(taken.min.y),
        }
        strip
    }
}

/// Rows of spots on one side.
struct Rows {
    side: Side,
    strip: Bounds2,
    /// Along the rows and across them.
    spot: Point2,
    gap: f64,
    per_row: usize,
    rows: usize,
}

impl Rows {
    fn new(side: Side, strip: Bounds2, spot: Point2, gap: f64) -> Self {
        let fit = |room: f64, size: f64| ((room + gap + SLACK) / (size + gap)).max(0.0) as usize;
        let room = along_across(side, strip.size());
        Self { side, strip, spot, gap, per_row: fit(room.x, spot.x), rows: fit(room.y, spot.y) }
    }

    fn capacity(&self) -> usize {
        self.per_row.saturating_mul(self.rows)
    }

    fn rows_for(&self, count: usize) -> usize {
        count.div_ceil(self.per_row.max(1))
    }

    /// The length or depth, mm, that is missing for this many spots.
    fn missing(&self, count: usize) -> f64 {
        let room = along_across(self.side, self.strip.size());
        let depth = self.rows_for(count) as f64 * (self.spot.y + self.gap) - self.gap;
        (depth - room.y.max(0.0)).max(self.spot.x - room.x).max(0.0)
    }

    /// Rows from the part outwards, around its middle, back and forth, so that spots that follow
    /// each other are neighbours.
    fn place(&self, count: usize, middle: Point2, spots: &mut Vec<Bounds2>) {
        let rows = self.rows_for(count);
        let each = count.div_ceil(rows.max(1));
        let low = along_across(self.side, self.strip.min);
        let high = along_across(self.side, self.strip.max);
        let length = each as f64 * (self.spot.x + self.gap) - self.gap;
        let start = along_across(self.side, middle).x - length * 0.5;
        let start = start.min(high.x - length).max(low.x);
        for i in 0..count {
            let row = i / each;
            let column = if row.is_multiple_of(2) { i % each } else { each - 1 - i % each };
            let step = self.spot + self.gap;
            let outward = row as f64 * step.y;
            let across = match self.side {
                Side::Right | Side::Back => low.y + outward,
                Side::Left | Side::Front => high.y - outward - self.spot.y,
            };
            let min = Point2::new(start + column as f64 * step.x, across);
            let [min, max] = [min, min + self.spot].map(|p| along_across(self.side, p));
            spots.push(Bounds2::new(min, max));
        }
    }
}

/// Swaps between x and y, and along a row and across it.
fn along_across(side: Side, p: Point2) -> Point2 {
    if side.is_upright() { Point2::new(p.y, p.x) } else { p }
}

/// One spot a colour; see [`crate::Towers::place`].
pub(crate) fn spots(
    part: &Bounds2,
    bed: &Bounds2,
    colors: usize,
    options: &TowerOptions,
) -> Result<Vec<Bounds2>, ToolpathError> {
    let taken = part.grown(options.clearance);
    let mut spots = Vec::with_capacity(colors);
    let rows = |side: Side, strip, ratio| Rows::new(side, strip, options.sides(ratio), options.gap);
    for ratio in RATIOS {
        let sides = Side::ALL.map(|side| rows(side, side.strip(&taken, bed), ratio));
        let fitting = sides.iter().filter(|rows| rows.capacity() >= colors);
        if let Some(best) = fitting.min_by_key(|rows| rows.rows_for(colors)) {
            best.place(colors, part.center(), &mut spots);
            return Ok(spots);
        }
    }
    let mut fit = 0;
    for ratio in RATIOS {
        let sides =
            Side::ALL.map(|side| rows(side, corner_free(side, &taken, bed, options), ratio));
        let capacity = sides.iter().map(Rows::capacity).sum::<usize>();
        if capacity >= colors {
            // Around the part, so that colours that follow each other stay neighbours.
            let [right, left, back, front] = &sides;
            for side in [right, back, left, front] {
                let count = side.capacity().min(colors - spots.len());
                side.place(count, part.center(), &mut spots);
            }
            return Ok(spots);
        }
        fit = fit.max(capacity);
    }
    let lacking = RATIOS.into_iter().flat_map(|ratio| {
        Side::ALL.map(|side| (rows(side, side.strip(&taken, bed), ratio).missing(colors), side))
    });
    let (missing, side) = lacking.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, Side::Right));
    let spot = options.sides(1.0).x;
    Err(ToolpathError::NoRoomForTowers { colors, fit, spot, missing, side })
}

/// The strip of a side such that the strips of the four sides do not overlap.
fn corner_free(side: Side, taken: &Bounds2, bed: &Bounds2, options: &TowerOptions) -> Bounds2 {
    let mut strip = side.strip(taken, bed);
    if !side.is_upright() {
        strip.min.x = strip.min.x.max(taken.min.x + options.gap);
        strip.max.x = strip.max.x.min(taken.max.x - options.gap);
    }
    strip
}
