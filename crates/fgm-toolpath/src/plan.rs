use std::collections::BTreeMap;

use fgm_core::{ColorId, Motion, Point2, Role, bead};

use crate::{Piece, ToolpathError, order::MEETS};

/// Pieces of the part shorter than this, mm, print badly: the paper's bound for the size of a
/// palette.
pub const SHORT_PIECE: f64 = 5.0;

/// One layer ready to print.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerPlan {
    /// From 0.
    pub index: u32,
    /// Height of the beads' tops, mm.
    pub z: f64,
    /// Thickness, mm.
    pub height: f64,
    /// What is printed, in that order.
    pub pieces: Vec<Piece>,
    /// How the layer rises; none for one that lies flat.
    pub rise: Option<Rise>,
}

/// A layer's beads rise to its height along the first of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rise {
    /// Height of the beads' tops where they begin, mm.
    pub from: f64,
    /// Length of the beads that rise, mm; those after them lie flat.
    pub length: f64,
}

/// What a layer, or many, come to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerStats {
    /// Extruded volume, mm³, by colour and role.
    pub volume: BTreeMap<(ColorId, Role), f64>,
    /// Length of the beads, mm.
    pub extruded: f64,
    /// Length of the moves without extrusion inside layers, mm.
    pub travel: f64,
    /// Moves without extrusion, those to the first piece of a layer not counted.
    pub travels: usize,
    /// Pieces that have a length.
    pub pieces: usize,
    /// Stretches of the part printed in one colour and without a travel that are shorter than
    /// [`SHORT_PIECE`].
    pub short_pieces: usize,
    /// Changes of colour between the pieces of a layer.
    pub color_changes: usize,
}

impl LayerStats {
    /// Adds another layer's figures.
    pub fn add(&mut self, other: &Self) {
        for (key, volume) in &other.volume {
            *self.volume.entry(*key).or_default() += volume;
        }
        self.extruded += other.extruded;
        self.travel += other.travel;
        self.travels += other.travels;
        self.pieces += other.pieces;
        self.short_pieces += other.short_pieces;
        self.color_changes += other.color_changes;
    }

    /// The volume of the roles that `which` takes, mm³.
    pub fn volume_of(&self, which: impl Fn(Role) -> bool) -> f64 {
        self.volume.iter().filter(|((_, role), _)| which(*role)).map(|(_, volume)| volume).sum()
    }
}

impl LayerPlan {
    /// A layer of pieces in printing order.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for a point, width, height or z that is not finite.
    pub fn new(index: u32, z: f64, height: f64, pieces: Vec<Piece>) -> Result<Self, ToolpathError> {
        let not_finite = |what, piece| Err(ToolpathError::NotFinite { layer: index, piece, what });
        if !(z.is_finite() && height.is_finite()) {
            return not_finite("height", 0);
        }
        for (i, piece) in pieces.iter().enumerate() {
            if !piece.width.is_finite() {
                return not_finite("width", i);
            }
            if !piece.points.iter().all(|p| p.is_finite()) {
                return not_finite("point", i);
            }
        }
        Ok(Self { index, z, height, pieces, rise: None })
    }

    /// The layer, rising.
    ///
    /// # Errors
    /// [`ToolpathError::NotFinite`] for a height or length that is not finite.
    pub fn rising(mut self, rise: Rise) -> Result<Self, ToolpathError> {
        if !(rise.from.is_finite() && rise.length.is_finite()) {
            return Err(ToolpathError::NotFinite { layer: self.index, piece: 0, what: "height" });
        }
        self.rise = Some(rise);
        Ok(self)
    }

    /// The first colour printed.
    pub fn first_color(&self) -> Option<ColorId> {
        self.printed().next().map(|piece| piece.color)
    }

    /// The last colour printed.
    pub fn last_color(&self) -> Option<ColorId> {
        self.printed().last().map(|piece| piece.color)
    }

    /// Where the nozzle is after the layer.
    pub fn end(&self) -> Option<Point2> {
        self.printed().last().and_then(|piece| piece.points.last().copied())
    }

    /// The pieces that have a length.
    fn printed(&self) -> impl Iterator<Item = &Piece> {
        self.pieces.iter().filter(|piece| has_length(piece))
    }

    /// The layer as a stream of motions: [`Motion::Layer`], [`Motion::Rise`] where it rises, then the
    /// pieces.
    ///
    /// A colour is set where it changes, for the first piece where it is not `previous`, the last
    /// colour of the layer before. A piece is travelled to unless the one before ends where it
    /// begins, within 1e-6 mm, over its [way](Piece::way) where it has one; the first one always is. Shorter segments are left out, with what
    /// has no length at all.
    pub fn motions(&self, previous: Option<ColorId>) -> Motions<'_> {
        self.motions_from(None, previous)
    }

    /// As [`motions`](Self::motions), where the layer before ended at a known place: the first piece
    /// may then have a way, too.
    pub fn motions_from(&self, end: Option<Point2>, previous: Option<ColorId>) -> Motions<'_> {
        let (piece, point, step) = (0, 0, 0);
        let (rise, at) = (self.rise, None);
        Motions { plan: self, piece, point, step, at, end, color: previous, begun: false, rise }
    }

    /// What the layer comes to.
    pub fn stats(&self) -> LayerStats {
        let mut stats = LayerStats::default();
        let mut last: Option<&Piece> = None;
        // Length of what is printed in one colour without a travel, and of the part only.
        let (mut stretch, mut whole) = (0.0, true);
        let end_stretch = |length: f64, part: bool, stats: &mut LayerStats| {
            stats.short_pieces += usize::from(part && length > 0.0 && length < SHORT_PIECE);
        };
        for piece in self.printed() {
            let gap = last.and_then(|l| l.points.last()).zip(piece.points.first());
            let gap = gap.map(|(a, b)| a.distance(*b)).filter(|gap| *gap > MEETS);
            let changed = last.is_some_and(|l| l.color != piece.color);
            if gap.is_some() || changed {
                end_stretch(stretch, whole, &mut stats);
                (stretch, whole) = (0.0, true);
            }
            let length = piece.length();
            if let (Some(_), Some(from)) = (gap, last.and_then(|l| l.points.last())) {
                stats.travel += travel(*from, piece);
            }
            stats.travels += usize::from(gap.is_some());
            stats.color_changes += usize::from(changed);
            stats.pieces += 1;
            stats.extruded += length;
            *stats.volume.entry((piece.color, piece.role)).or_default() +=
                length * bead::area(piece.width, self.height);
            stretch += length;
            whole &= piece.role.is_part();
            last = Some(piece);
        }
        end_stretch(stretch, whole, &mut stats);
        stats
    }
}

/// The points that the nozzle travels over from a place to a piece.
fn way_from(from: Option<Point2>, piece: &Piece) -> &[Point2] {
    match (piece.way.split_first(), from) {
        (Some((first, rest)), Some(from)) if first.distance(from) <= MEETS => rest,
        _ => &[],
    }
}

/// The length of the travel from a place to a piece, mm.
fn travel(from: Point2, piece: &Piece) -> f64 {
    let way = way_from(Some(from), piece).iter().chain(piece.points.first());
    let mut at = from;
    way.map(|&p| std::mem::replace(&mut at, p).distance(p)).sum()
}

fn has_length(piece: &Piece) -> bool {
    piece.points.iter().skip(1).any(|p| p.distance(piece.points[0]) > MEETS)
}

/// The motions of a layer; see [`LayerPlan::motions`].
#[derive(Clone, Debug)]
pub struct Motions<'a> {
    plan: &'a LayerPlan,
    piece: usize,
    /// The next point of the piece; 0 before the piece has begun.
    point: usize,
    /// Points of the way to the piece that are behind.
    step: usize,
    at: Option<Point2>,
    /// Where the piece before ended.
    end: Option<Point2>,
    color: Option<ColorId>,
    begun: bool,
    /// Not told yet.
    rise: Option<Rise>,
}

impl Iterator for Motions<'_> {
    type Item = Motion;

    fn next(&mut self) -> Option<Motion> {
        if !self.begun {
            self.begun = true;
            let LayerPlan { index, z, height, .. } = *self.plan;
            return Some(Motion::Layer { index, z, height });
        }
        if let Some(Rise { from, length }) = self.rise.take() {
            return Some(Motion::Rise { from, length });
        }
        loop {
            let piece = self.plan.pieces.get(self.piece)?;
            if self.point == 0 {
                if !has_length(piece) {
                    self.piece += 1;
                    continue;
                }
                if self.color != Some(piece.color) {
                    self.color = Some(piece.color);
                    return Some(Motion::Color(piece.color));
                }
                if let Some(&to) = way_from(self.end, piece).get(self.step) {
                    self.step += 1;
                    self.at = Some(to);
                    return Some(Motion::Travel { to });
                }
                self.point = 1;
                let to = piece.points[0];
                if self.at.is_none_or(|at| at.distance(to) > MEETS) {
                    self.at = Some(to);
                    return Some(Motion::Travel { to });
                }
            }
            let Some(&to) = piece.points.get(self.point) else {
                (self.piece, self.point, self.step) = (self.piece + 1, 0, 0);
                self.end = self.at;
                continue;
            };
            self.point += 1;
            if self.at.is_none_or(|at| at.distance(to) > MEETS) {
                self.at = Some(to);
                return Some(Motion::Extrude { to, width: piece.width, role: piece.role });
            }
        }
    }
}

#[cfg(test)]
#[path = "plan_tests.rs"]
mod tests;
