use fgm_core::{Bounds2, ColorId, Point2, Role, bead};

use crate::{Piece, ToolpathError, tower_layout};

/// How purge towers are sized and placed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct TowerOptions {
    /// The most that a spot takes on a layer, mm³. The default is the dead volume of the Geeetech
    /// Mizar M, 960 mm of a 0.4 x 0.2 bead: for spots that are each purged on once a layer.
    pub volume: f64,
    /// Width of the beads, mm.
    pub width: f64,
    /// Height of the thinnest layer, mm.
    pub height: f64,
    /// From the part to the spots, mm.
    pub clearance: f64,
    /// Between spots, mm.
    pub gap: f64,
    /// The shortest side a spot may have, mm: a thinner one would not stand.
    pub least_side: f64,
    /// The most between the lines of a spot above the first layer, mm.
    pub lattice: f64,
}

impl Default for TowerOptions {
    fn default() -> Self {
        Self {
            volume: 68.6,
            width: 0.4,
            height: 0.2,
            clearance: 3.0,
            gap: 1.0,
            least_side: 6.0,
            lattice: 4.0,
        }
    }
}

impl TowerOptions {
    /// The defaults for beads of this width and, in the thinnest layer, this height, mm.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// Length of bead that holds the volume in the thinnest layer, mm.
    pub fn length(&self) -> f64 {
        self.volume / bead::area(self.width, self.height)
    }

    /// The sides of a spot, beads included, whose one side is `ratio` (1 or more) times the other:
    /// the longer, the shorter, mm.
    ///
    /// A frame of `x` by `y` between the middles of its beads and the lines inside it, all a
    /// spacing `s` apart, are `x y / s` long or longer, in either direction.
    pub(crate) fn sides(&self, ratio: f64) -> Point2 {
        let s = bead::spacing(self.width, self.height);
        let y = (self.length() * s / ratio).sqrt();
        let y = y.max(self.least_side - self.width).max(4.0 * s);
        Point2::new(y * ratio, y) + self.width
    }

    fn check(&self) -> Result<(), ToolpathError> {
        let positive = [
            ("volume", self.volume),
            ("width", self.width),
            ("height", self.height),
            ("lattice", self.lattice),
        ];
        let not_negative =
            [("clearance", self.clearance), ("gap", self.gap), ("least_side", self.least_side)];
        for (setting, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(ToolpathError::BadTower { setting, value, least: "above 0" });
            }
        }
        for (setting, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ToolpathError::BadTower { setting, value, least: "at least 0" });
            }
        }
        Ok(())
    }
}

/// The purge towers of a print, spots beside the part where the colour before goes until the new
/// one has come through: one for each colour, or one for all.
///
/// # The rule
/// A tower has to stand on itself. So on every layer up to the last one that it is needed on
/// ([`Towers::finish`]) every spot is printed by [`Towers::grow`]: a frame, and in it lines back
/// and forth, along x on even layers and along y on odd ones, evenly over the whole spot. There
/// are as many lines as the layer's purges need, but at least one every [`TowerOptions::lattice`],
/// and on the first layer, which has to stick, as many as there is room for.
///
/// All of that is one line, and each purge takes a stretch of it that holds its volume exactly,
/// one after the other; what is left over goes to the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Towers {
    options: TowerOptions,
    /// With the beads.
    spots: Vec<Bounds2>,
    /// The last layer each is needed on.
    last: Vec<Option<usize>>,
}

impl Towers {
    /// Finds room for `count` spots in rows beside the part: on one side if they fit there, the
    /// one with the fewest rows, else around the part. Spots are square where that fits, else up
    /// to four times as long as wide.
    ///
    /// `part` and `bed` are in the same coordinates; the spots, beads included, lie in `bed` and
    /// [`TowerOptions::clearance`] away from `part`. Give a part that includes its skirt.
    ///
    /// # Errors
    /// [`ToolpathError::NoRoomForTowers`], which says how much is missing;
    /// [`ToolpathError::BadTower`] for options that cannot be; [`ToolpathError::BadBounds`] for
    /// bounds that are empty or not finite.
    pub fn place(
        part: &Bounds2,
        bed: &Bounds2,
        count: usize,
        options: &TowerOptions,
    ) -> Result<Self, ToolpathError> {
        options.check()?;
        for (what, bounds) in [("part", part), ("bed", bed)] {
            if !bounds.is_finite() {
                return Err(ToolpathError::BadBounds { what });
            }
        }
        let spots = tower_layout::spots(part, bed, count, options)?;
        Ok(Self { options: *options, last: vec![None; spots.len()], spots })
    }

    /// How many spots there are.
    pub fn count(&self) -> usize {
        self.spots.len()
    }

    /// The rectangle around all spots, beads included.
    pub fn bounds(&self) -> Bounds2 {
        self.spots.iter().fold(Bounds2::EMPTY, |all, spot| all.union(spot))
    }

    /// A spot, beads included.
    pub fn spot(&self, spot: usize) -> Option<Bounds2> {
        self.spots.get(spot).copied()
    }

    /// Tells that a spot is not purged on above layer `last`.
    pub fn finish(&mut self, spot: usize, last: usize) {
        if let Some(slot) = self.last.get_mut(spot) {
            *slot = Some(last);
        }
    }

    /// What a spot takes on a layer (from 0) of this height, mm: a piece for each purge, its
    /// volume in mm³ and its colour, in that order; one piece in the colour `hand` where there is
    /// no purge and the spot has to grow. Nothing above its last layer, and for a spot that there
    /// is not.
    ///
    /// A piece begins where the one before it ends and holds its volume; the last may hold more.
    /// Purges that are together more than the spot has room for all get less, in proportion.
    pub fn grow(
        &self,
        spot: usize,
        purges: &[(f64, ColorId)],
        hand: ColorId,
        layer: usize,
        height: f64,
    ) -> Vec<Piece> {
        let over = self.last.get(spot).copied().flatten().is_some_and(|last| layer > last);
        let Some(spot) = self.spot(spot).filter(|_| !over || !purges.is_empty()) else {
            return Vec::new();
        };
        let area = bead::area(self.options.width, height);
        let needed: f64 = purges.iter().map(|(volume, _)| volume / area).sum();
        let line = self.line(&spot, needed, layer, height);
        let piece = |points, color| {
            let width = self.options.width;
            Piece::new(points, Role::PurgeTower, width, color)
        };
        let Some((last, others)) = purges.split_last() else { return vec![piece(line, hand)] };
        let mut rest = piece(line, last.1);
        let share = (rest.length() / needed).min(1.0);
        let mut pieces = Vec::with_capacity(purges.len());
        for &(volume, color) in others {
            let (first, second) = rest.split(share * volume / area);
            pieces.push(Piece { color, ..first });
            rest = second;
        }
        pieces.push(rest);
        pieces
    }

    /// The frame of a spot and the lines inside, at least `needed` mm where there is room.
    fn line(&self, spot: &Bounds2, needed: f64, layer: usize, height: f64) -> Vec<Point2> {
        let TowerOptions { width, lattice, .. } = self.options;
        let spacing = bead::spacing(width, height);
        let upright = !layer.is_multiple_of(2);
        let turned = |p: Point2| if upright { Point2::new(p.y, p.x) } else { p };
        let size = turned(spot.size() - width);
        let inner = (size - 2.0 * spacing).max(Point2::ZERO);
        let room = (inner.y / spacing + 1e-9).floor() + 1.0;
        let frame = 2.0 * (size.x + size.y) + spacing * std::f64::consts::SQRT_2;
        let lines = if layer == 0 {
            room
        } else {
            let least = (inner.y / lattice).ceil() + 1.0;
            let wanted = ((needed - frame - inner.y) / inner.x - 1e-9).ceil();
            wanted.max(least).min(room)
        };
        let step = inner.y / (lines - 1.0).max(1.0);
        let mut points = Vec::with_capacity(5 + 2 * lines as usize);
        let corners = [(0.0, 0.0), (0.0, size.y), (size.x, size.y), (size.x, 0.0), (0.0, 0.0)];
        points.extend(corners.map(|(x, y)| Point2::new(x, y)));
        for i in 0..lines as u32 {
            let y = spacing + f64::from(i) * step;
            let ends = [spacing, spacing + inner.x];
            let [start, end] = if i % 2 == 0 { ends } else { [ends[1], ends[0]] };
            points.extend([Point2::new(start, y), Point2::new(end, y)]);
        }
        let corner = spot.min + width * 0.5;
        points.iter_mut().for_each(|p| *p = corner + turned(*p));
        points
    }
}

#[cfg(test)]
#[path = "tower_tests.rs"]
mod tests;
