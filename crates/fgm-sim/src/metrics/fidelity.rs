use fgm_core::{MAX_MATERIALS, MaterialField, Mixture, Point3};
use serde::Serialize;

use super::{Shades, Spread, SpreadFigures};
use crate::Piece;

/// Samples are compared in blocks of this many.
const BLOCK: usize = 256;
/// Greatest difference of colours that is told apart.
const MOST_DIFFERENCE: f64 = 128.0;

/// The design that a print is compared with.
#[derive(Clone, Copy)]
pub struct Reference<'a> {
    /// Its volume fractions.
    pub materials: &'a dyn MaterialField,
    /// Bed position = design position + this, mm; z of the beads' tops.
    pub offset: Point3,
}

/// Compares what is commanded and what is laid down with a design, piece by piece, weighed by
/// volume.
///
/// The error of a place is the greatest difference of a material's fraction. Pieces are sampled
/// at even distances, at half the height of their beads. Only beads of the part count.
pub struct Fidelity<'a> {
    reference: Reference<'a>,
    shades: Shades,
    spacing: f64,
    samples: Vec<Sample>,
    points: Vec<Point3>,
    wanted: Vec<f64>,
    commanded: Spread,
    deposited: Spread,
    deposited_seen: Spread,
    commanded_colors: Spread,
    deposited_colors: Spread,
    undefined: u64,
}

#[derive(Clone, Copy)]
struct Sample {
    line: u64,
    layer: u32,
    seen: bool,
    volume: f64,
    commanded: Mixture,
    deposited: Mixture,
}

/// The figures of a [`Fidelity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FidelityFigures {
    /// Error of the composition as commanded.
    pub commanded: SpreadFigures,
    /// Error of the composition as laid down.
    pub deposited: SpreadFigures,
    /// The same without infill, which walls and skins hide; all 0 where there is nothing else.
    pub deposited_seen: SpreadFigures,
    /// Difference of colour (CIEDE2000) as commanded.
    pub commanded_delta_e: SpreadFigures,
    /// Difference of colour (CIEDE2000) as laid down.
    pub deposited_delta_e: SpreadFigures,
    /// Samples where the design has no mixture; they are left out.
    pub undefined: u64,
}

impl<'a> Fidelity<'a> {
    /// Samples every `spacing` mm at least.
    pub fn new(reference: Reference<'a>, shades: Shades, spacing: f64) -> Self {
        Self {
            reference,
            shades,
            spacing: if spacing > 0.0 { spacing } else { f64::INFINITY },
            samples: Vec::with_capacity(BLOCK),
            points: Vec::with_capacity(BLOCK),
            wanted: Vec::new(),
            commanded: Spread::new(1.0),
            deposited: Spread::new(1.0),
            deposited_seen: Spread::new(1.0),
            commanded_colors: Spread::new(MOST_DIFFERENCE),
            deposited_colors: Spread::new(MOST_DIFFERENCE),
            undefined: 0,
        }
    }

    /// Samples a piece.
    #[inline]
    pub fn piece(&mut self, piece: &Piece) {
        let Some(layer) = piece.layer.filter(|_| piece.is_part()) else { return };
        let count = (piece.length() / self.spacing).ceil().clamp(1.0, 1e6) as u32;
        let volume = piece.volume / f64::from(count);
        let seen = piece.role.is_none_or(|role| !role.is_hidden());
        let shift = self.reference.offset + Point3::Z * (0.5 * piece.height);
        for i in 0..count {
            let share = (f64::from(i) + 0.5) / f64::from(count);
            self.points.push(piece.at(share) - shift);
            self.samples.push(Sample {
                line: piece.line,
                layer,
                seen,
                volume,
                commanded: piece.commanded,
                deposited: piece.mixture_at(share),
            });
            if self.samples.len() >= BLOCK {
                self.compare();
            }
        }
    }

    /// Compares the samples that have come together.
    fn compare(&mut self) {
        let materials = self.reference.materials.materials().min(MAX_MATERIALS);
        let count = self.points.len();
        self.wanted.resize(materials * count, 0.0);
        for (material, out) in self.wanted.chunks_mut(count.max(1)).take(materials).enumerate() {
            self.reference.materials.fraction(material).eval_into(&self.points, out);
        }
        for (i, (sample, at)) in self.samples.iter().zip(&self.points).enumerate() {
            let mut weights = [0.0; MAX_MATERIALS];
            for (material, weight) in weights.iter_mut().take(materials).enumerate() {
                *weight = self.wanted[material * count + i];
            }
            let Ok(wanted) = Mixture::from_weights(&weights[..materials]) else {
                self.undefined += 1;
                continue;
            };
            for (mixture, errors, colors) in [
                (&sample.commanded, &mut self.commanded, &mut self.commanded_colors),
                (&sample.deposited, &mut self.deposited, &mut self.deposited_colors),
            ] {
                let error = wanted.distance(mixture);
                errors.add(error, sample.volume, sample.line, sample.layer, *at);
                let difference = self.shades.difference(&wanted, mixture);
                colors.add(difference, sample.volume, sample.line, sample.layer, *at);
            }
            if sample.seen {
                let error = wanted.distance(&sample.deposited);
                self.deposited_seen.add(error, sample.volume, sample.line, sample.layer, *at);
            }
        }
        self.samples.clear();
        self.points.clear();
    }

    /// The figures of everything so far.
    pub fn figures(&mut self) -> FidelityFigures {
        self.compare();
        FidelityFigures {
            commanded: self.commanded.figures(),
            deposited: self.deposited.figures(),
            deposited_seen: self.deposited_seen.figures(),
            commanded_delta_e: self.commanded_colors.figures(),
            deposited_delta_e: self.deposited_colors.figures(),
            undefined: self.undefined,
        }
    }
}
