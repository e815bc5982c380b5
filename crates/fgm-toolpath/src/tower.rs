use fgm_core::{Bounds2, ColorId, Point2, Role, bead};

use crate::{Piece, ToolpathError, tower_layout};

/// How purge towers are sized and placed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct TowerOptions {
    /// Extruded before each colour's pieces, mm³, at least: the machine's dead volume. The default
    /// is the Geeetech Mizar M's, 960 mm of a 0.4 x 0.2 bead.
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
    /// Between the lines of a spot that is not purged on but has to grow, mm.
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

    /// Length of bead that holds the volume, mm.
    pub fn length(&self) -> f64 {
        self.length_of(self.volume)
    }

    fn length_of(&self, volume: f64) -> f64 {
        volume / bead::area(self.width, self.height)
    }

    /// The sides of a spot, beads included, whose one side is `ratio` (1 or more) times the other:
    /// the longer, the shorter, mm.
    ///
    /// Lines of either direction in it hold the volume at their proper spacing: with sides `qy`
    /// and `y` between the middles of the outer beads, spacing `s` and length `L`, the `k` lines
    /// `k q y + y >= L` have room where `(k - 1) s <= y`, which `q y² + s y >= L s` ensures.
    pub(crate) fn sides(&self, ratio: f64) -> Point2 {
        let (s, length) = (bead::spacing(self.width, self.height), self.length());
        let y = ((s * s + 4.0 * ratio * length * s).sqrt() - s) / (2.0 * ratio);
        let y = y.max(self.least_side - self.width).max(s);
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

/// The purge towers of a print: one spot beside the part for each colour, where the colour before
/// goes until the new one has come through.
///
/// # The rule
/// A tower has to stand on itself. So on every layer, from the first on, every spot is printed:
/// - whole, with its own colour, where the nozzle changes to that colour ([`Towers::purge`]);
/// - else as a thin lattice, in whatever colour is at hand ([`Towers::keep`]); on the first layer
///   whole, so that it sticks.
///
/// A spot is left alone above the layer told to [`Towers::finish`]; a stream that does not know
/// what is above need not call it. [`Towers::print`] applies all of this to a layer,
/// [`Towers::keep_others`] the second part.
///
/// Lines run along x on even layers and along y on odd ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Towers {
    options: TowerOptions,
    /// One a colour, with the beads.
    spots: Vec<Bounds2>,
    /// The last layer each is needed on.
    last: Vec<Option<usize>>,
}

impl Towers {
    /// Finds room for the spots of `colors` colours in rows beside the part: on one side if they
    /// fit there, the one with the fewest rows, else around the part. Spots are square where that
    /// fits, else up to four times as long as wide.
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
        colors: usize,
        options: &TowerOptions,
    ) -> Result<Self, ToolpathError> {
        options.check()?;
        for (what, bounds) in [("part", part), ("bed", bed)] {
            if !bounds.is_finite() {
                return Err(ToolpathError::BadBounds { what });
            }
        }
        let spots = tower_layout::spots(part, bed, colors, options)?;
        Ok(Self { options: *options, last: vec![None; spots.len()], spots })
    }

    /// The rectangle around all spots, beads included.
    pub fn bounds(&self) -> Bounds2 {
        self.spots.iter().fold(Bounds2::EMPTY, |all, spot| all.union(spot))
    }

    /// A colour's spot, beads included.
    pub fn spot(&self, color: ColorId) -> Option<Bounds2> {
        self.spots.get(color.index()).copied()
    }

    /// Tells that a colour is not changed to above layer `last`.
    pub fn finish(&mut self, color: ColorId, last: usize) {
        if let Some(slot) = self.last.get_mut(color.index()) {
            *slot = Some(last);
        }
    }

    /// Appends a block that holds at least the volume, and less than a line more (at least two
    /// lines), on the spot of a colour; nothing for a colour that has none.
    pub fn purge(&self, color: ColorId, layer: usize, out: &mut Vec<Piece>) {
        self.purge_volume(color, self.options.volume, layer, out);
    }

    /// As [`purge`](Self::purge), with another volume, mm³: one that is less than the towers' own
    /// spreads its lines over the spot. On layer 0 the block is whole, so that it sticks.
    pub fn purge_volume(&self, color: ColorId, volume: f64, layer: usize, out: &mut Vec<Piece>) {
        if let Some(spot) = self.spot(color) {
            let (along, across) = self.sides(&spot, layer);
            let whole = self.options.length();
            let length = if layer == 0 { whole } else { self.options.length_of(volume).min(whole) };
            let lines = ((length - across) / along - 1e-9).ceil().max(2.0);
            out.push(self.serpentine(&spot, layer, lines as u32, color));
        }
    }

    /// Appends what a spot that is not purged on needs to grow, printed in colour `with`: a
    /// lattice, on layer 0 a whole block.
    pub fn keep(&self, color: ColorId, with: ColorId, layer: usize, out: &mut Vec<Piece>) {
        if layer == 0 {
            let first = out.len();
            self.purge(color, layer, out);
            out[first..].iter_mut().for_each(|piece| piece.color = with);
        } else if let Some(spot) = self.spot(color) {
            let (_, across) = self.sides(&spot, layer);
            let lines = (across / self.options.lattice).ceil() + 1.0;
            out.push(self.serpentine(&spot, layer, lines as u32, with));
        }
    }

    /// Appends all that the towers need on a layer that is printed in the colours `used`, in that
    /// order, after a layer that ended in `previous`.
    ///
    /// The first colour is not purged for where it is `previous`. A layer without colours gets
    /// nothing.
    pub fn print(
        &self,
        used: &[ColorId],
        previous: Option<ColorId>,
        layer: usize,
        out: &mut Vec<Piece>,
    ) {
        let Some(&hand) = used.first() else { return };
        let changes = if previous == Some(hand) { &used[1..] } else { used };
        changes.iter().for_each(|&color| self.purge(color, layer, out));
        self.keep_others(changes, hand, layer, out);
    }

    /// Appends what every spot but those of `purged` needs to grow, printed in colour `with`; for
    /// those who place the purges of a layer themselves.
    pub fn keep_others(
        &self,
        purged: &[ColorId],
        with: ColorId,
        layer: usize,
        out: &mut Vec<Piece>,
    ) {
        for (last, color) in self.last.iter().zip((0..).map(ColorId)) {
            if !purged.contains(&color) && last.is_none_or(|last| layer <= last) {
                self.keep(color, with, layer, out);
            }
        }
    }

    /// Length of a line and the width of a block of them, between the middles of beads, mm.
    fn sides(&self, spot: &Bounds2, layer: usize) -> (f64, f64) {
        let size = spot.size() - self.options.width;
        if layer.is_multiple_of(2) { (size.x, size.y) } else { (size.y, size.x) }
    }

    /// Lines back and forth, evenly over the whole spot.
    fn serpentine(&self, spot: &Bounds2, layer: usize, lines: u32, color: ColorId) -> Piece {
        let (along, across) = self.sides(spot, layer);
        let corner = spot.min + self.options.width * 0.5;
        let step = across / f64::from(lines.saturating_sub(1).max(1));
        let mut points = Vec::with_capacity(2 * lines as usize);
        for i in 0..lines {
            let (start, end) = if i % 2 == 0 { (0.0, along) } else { (along, 0.0) };
            points.extend([start, end].map(|at| {
                let (u, v) = (at, f64::from(i) * step);
                corner + if layer.is_multiple_of(2) { Point2::new(u, v) } else { Point2::new(v, u) }
            }));
        }
        Piece { points, role: Role::PurgeTower, width: self.options.width, color }
    }
}

#[cfg(test)]
#[path = "tower_tests.rs"]
mod tests;
