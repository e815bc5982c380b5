use fgm_core::{Band, ColorId, MAX_MATERIALS, Mixture};

use crate::{
    PaletteError,
    cells::{self, Cell},
    path, tour,
};

/// The most colours of a palette.
pub const MAX_COLORS: usize = 256;

/// Where a palette changes colour: a surface in the space of mixtures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// Where the fraction of a material has a value.
    Level {
        /// The material, from 0.
        material: usize,
        /// The fraction.
        value: f64,
    },
    /// Where the fraction of material `a` exceeds that of `b` by `by`.
    Difference {
        /// A material, from 0.
        a: usize,
        /// A later material.
        b: usize,
        /// Of either sign; 0 without an overlap.
        by: f64,
    },
}

/// What a palette's boundaries are levels of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The fraction of a material, from 0.
    Fraction {
        /// The material.
        material: usize,
    },
    /// By how much the fraction of material `a` exceeds that of `b`.
    Difference {
        /// A material, from 0.
        a: usize,
        /// Another.
        b: usize,
    },
}

/// The widest overlap, as a share of the width at which overlaps on either side of a band meet.
const WIDEST: f64 = 0.98;

/// Mixture space divided into colours, each of which stands for the mixtures of its cell by the
/// state in the middle. See the [crate's documentation](crate) for the divisions there are.
///
/// Colours are numbered in the order of printing.
#[derive(Clone, Debug)]
pub struct Palette {
    materials: usize,
    division: Division,
    /// Share of the gradient.
    overlap: f64,
    states: Vec<Mixture>,
    boundaries: Vec<Boundary>,
    /// By material, ascending.
    levels: Vec<Vec<f64>>,
}

#[derive(Clone, Debug)]
enum Division {
    /// By the planes `f_i = j / k`.
    Cells { k: usize, colors: Vec<(Cell, ColorId)> },
    /// By the greatest fraction.
    Greatest,
}

impl Palette {
    /// A palette of `colors` equal parts of the mixtures of `materials` materials.
    ///
    /// Two materials divide into any number of colours: colour `i` of `N` has a fraction of
    /// material 0 from `i / N` to `(i + 1) / N`, and the middle as its state, so that colour 0 has
    /// the least of material 0. Of three or more materials the cells between the planes
    /// `f_i = j / k` are the colours: `k²` for three, 1, 5, 15, 34 and so on for four.
    ///
    /// # Errors
    /// [`PaletteError`] for fewer than 2 or too many materials, for 0 or more than [`MAX_COLORS`]
    /// colours, and for a number of colours into which the materials do not divide, with the
    /// nearest numbers.
    pub fn new(materials: usize, colors: usize) -> Result<Self, PaletteError> {
        check(materials)?;
        if !(1..=MAX_COLORS).contains(&colors) {
            return Err(PaletteError::Colors { colors });
        }
        let k = division(materials, colors)?;
        let path = path::path(materials, k);
        let state = |cell: &Cell| {
            let centroid = cells::centroid(cell, materials, k).map(|c| c as f64);
            Ok(Mixture::from_weights(&centroid[..materials])?)
        };
        let states = path.iter().map(state).collect::<Result<_, PaletteError>>()?;
        let mut colors: Vec<_> = path.into_iter().zip((0..).map(ColorId)).collect();
        colors.sort_unstable();
        Ok(Self::finished(materials, Division::Cells { k, colors }, 0.0, states))
    }

    /// A palette of one colour a material, not mixed: the greatest fraction wins, and of equal
    /// ones the first. Colour `i` is material `i`.
    ///
    /// # Errors
    /// [`PaletteError::Materials`] for fewer than 2 or too many.
    pub fn pure(materials: usize) -> Result<Self, PaletteError> {
        check(materials)?;
        let state = |i| Ok(Mixture::pure(i, materials)?);
        let states = (0..materials).map(state).collect::<Result<_, PaletteError>>()?;
        Ok(Self::finished(materials, Division::Greatest, 0.0, states))
    }

    /// The palette with a zipper: within `overlap / 2` of a boundary between two colours, as a
    /// share of the gradient, paths alternate between them. 0 is no zipper.
    ///
    /// # Errors
    /// [`PaletteError::Overlap`] for an overlap that is negative, not a number, or not narrower
    /// than [`Palette::band_width`].
    pub fn with_overlap(self, overlap: f64) -> Result<Self, PaletteError> {
        let limit = self.band_width();
        if !(0.0..limit).contains(&overlap) {
            return Err(PaletteError::Overlap { overlap, limit });
        }
        Ok(Self::finished(self.materials, self.division, overlap, self.states))
    }

    fn finished(materials: usize, division: Division, overlap: f64, states: Vec<Mixture>) -> Self {
        let boundaries = boundaries(materials, &division, overlap);
        let mut levels = vec![Vec::new(); materials];
        for boundary in &boundaries {
            if let Boundary::Level { material, value } = *boundary {
                levels[material].push(value);
            }
        }
        Self { materials, division, overlap, states, boundaries, levels }
    }

    /// How many materials are mixed.
    pub fn materials(&self) -> usize {
        self.materials
    }

    /// How many colours there are.
    pub fn colors(&self) -> usize {
        self.states.len()
    }

    /// What a colour is mixed of: the centroid of its cell. A colour that the palette does not
    /// have is taken for its last.
    pub fn state(&self, id: ColorId) -> Mixture {
        self.states[id.index().min(self.states.len() - 1)]
    }

    /// The overlap of neighbouring colours, as a share of the gradient.
    pub fn overlap(&self) -> f64 {
        self.overlap
    }

    /// The width of a colour's band, as a share of the gradient: `1 / N` for two materials,
    /// `1 / k` for more, a half where nothing is mixed.
    pub fn band_width(&self) -> f64 {
        match &self.division {
            Division::Cells { k, .. } => 1.0 / *k as f64,
            Division::Greatest => 0.5,
        }
    }

    /// The most by which a fraction may differ from the state of its colour, in a band of one
    /// colour: half a band for two materials, `(n - 1) / n` of it for `n`, since a simplex's
    /// centroid is nearer to a facet than to the corner opposite.
    pub fn half_band(&self) -> f64 {
        let n = self.materials as f64;
        match &self.division {
            Division::Cells { k, .. } => (n - 1.0) / (n * *k as f64),
            Division::Greatest => (n - 1.0) / n,
        }
    }

    /// Every surface at which the [band](Self::band) may change; those of a material by ascending
    /// value.
    pub fn boundaries(&self) -> &[Boundary] {
        &self.boundaries
    }

    /// The fractions of a material at which the band may change, ascending; with an overlap, its
    /// two edges. None for material 1 of two, which has no boundaries of its own, and where
    /// boundaries are [differences](Boundary::Difference).
    pub fn levels(&self, material: usize) -> &[f64] {
        self.levels.get(material).map_or(&[], Vec::as_slice)
    }

    /// The colour of a mixture, or the two colours of an overlap.
    ///
    /// It depends only on which side of every boundary the mixture lies. Where more than two
    /// colours overlap, near a common corner, two of them are taken. Fractions of materials that
    /// the palette does not have are left out of account.
    pub fn band(&self, mixture: &Mixture) -> Band {
        let parts = |material: usize, fraction: f64| self.parts(material, fraction);
        self.band_by(mixture, parts, |_, _| self.overlap)
    }

    /// As [`band`](Self::band), for a palette without an overlap of its own, where `half` says how
    /// far on either side of a boundary colours overlap: by how much its measure differs from the
    /// boundary's value, up to the [widest](Self::widest). For overlaps that are to be as wide
    /// everywhere in space, not in the mixture.
    pub fn band_within(&self, mixture: &Mixture, half: impl Fn(Measure) -> f64) -> Band {
        let half = |measure: Measure| half(measure).clamp(0.0, self.widest(measure));
        let parts = |material: usize, fraction: f64| {
            let half = half(Measure::Fraction { material });
            let passed =
                |by: f64| self.levels[material].partition_point(|level| level + by <= fraction);
            let (begun, over) = (passed(-half), passed(half));
            (over as u16, begun > over)
        };
        self.band_by(mixture, parts, |a, b| half(Measure::Difference { a, b }))
    }

    /// The most that half an overlap can be, so that no three colours overlap in a band.
    pub fn widest(&self, measure: Measure) -> f64 {
        let whole = WIDEST * self.band_width();
        match measure {
            Measure::Fraction { .. } => 0.5 * whole,
            Measure::Difference { .. } => whole,
        }
    }

    fn band_by(
        &self,
        mixture: &Mixture,
        parts: impl Fn(usize, f64) -> (u16, bool),
        apart: impl Fn(usize, usize) -> f64,
    ) -> Band {
        let mut fractions = [0.0; MAX_MATERIALS];
        let given = mixture.fractions().iter().take(self.materials);
        fractions.iter_mut().zip(given).for_each(|(slot, f)| *slot = *f);
        match &self.division {
            Division::Cells { k, colors } => self.cell_band(&fractions, *k, colors, parts),
            Division::Greatest => greatest_band(&fractions[..self.materials], apart),
        }
    }

    /// The print order of a layer: the path of least change, reversed on every other layer, so
    /// that a layer starts in the colour in which the one below ended.
    pub fn order(&self, layer: usize) -> Vec<ColorId> {
        let mut ids: Vec<_> = (0..self.states.len() as u16).map(ColorId).collect();
        if !layer.is_multiple_of(2) {
            ids.reverse();
        }
        ids
    }

    /// The print order of a layer in which only some colours occur, each at most once: along the
    /// gradient for two materials; else the order in which the fractions change least in all, the best
    /// there is for up to ten colours, and for more one that no turn of a stretch and no move of one
    /// colour improves. Reversed on every other layer. Colours that the palette does not have are
    /// left out.
    pub fn order_of(&self, used: &[ColorId], layer: usize) -> Vec<ColorId> {
        let mut ids: Vec<ColorId> =
            used.iter().copied().filter(|id| id.index() < self.states.len()).collect();
        ids.sort_unstable();
        ids.dedup();
        let mixed = matches!(self.division, Division::Cells { .. });
        if mixed && self.materials > 2 && ids.len() < self.states.len() {
            let change = |a: usize, b: usize| self.state(ids[a]).distance(&self.state(ids[b]));
            let order = tour::least_change(ids.len(), change);
            ids = order.into_iter().map(|i| ids[i]).collect();
        }
        if !layer.is_multiple_of(2) {
            ids.reverse();
        }
        ids
    }

    fn cell_band(
        &self,
        fractions: &[f64; MAX_MATERIALS],
        k: usize,
        colors: &[(Cell, ColorId)],
        parts: impl Fn(usize, f64) -> (u16, bool),
    ) -> Band {
        if self.materials == 2 {
            let (low, between) = parts(0, fractions[0]);
            return Band::overlap(ColorId(low), ColorId(low + u16::from(between)));
        }
        let color = |cell: &Cell| {
            let at = colors.binary_search_by(|(c, _)| c.cmp(cell)).unwrap_or_else(|i| i);
            colors.get(at).map_or(ColorId(0), |(_, color)| *color)
        };
        let mut low = [0; MAX_MATERIALS];
        let mut between = [false; MAX_MATERIALS];
        for i in 0..self.materials {
            (low[i], between[i]) = parts(i, fractions[i]);
        }
        // Of the parts that lie between two values, so many take the upper one that the cell is
        // there; one more gives its neighbour.
        let lift = (cells::rest(&low, k) - self.materials as i64 + 1).max(0) as usize;
        let mut lifted = (0..self.materials).filter(|&i| between[i]);
        let mut first = low;
        lifted.by_ref().take(lift).for_each(|i| first[i] += 1);
        if !cells::exists(&first, self.materials, k) {
            return Band::pure(color(&nearest_cell(fractions, self.materials, k)));
        }
        let mut second = first;
        if let Some(i) = lifted.next() {
            second[i] += 1;
        }
        if !cells::exists(&second, self.materials, k) {
            second = first;
        }
        Band::overlap(color(&first), color(&second))
    }

    /// The whole part of a fraction, and whether it lies between this and the next.
    fn parts(&self, material: usize, fraction: f64) -> (u16, bool) {
        let below = self.levels[material].partition_point(|level| *level <= fraction);
        if self.overlap > 0.0 {
            ((below / 2) as u16, !below.is_multiple_of(2))
        } else {
            (below as u16, false)
        }
    }
}

/// The material of the greatest fraction, and the first that comes nearer to it than they are told
/// to be apart.
fn greatest_band(fractions: &[f64], apart: impl Fn(usize, usize) -> f64) -> Band {
    let greatest = fractions.iter().fold(0.0_f64, |a, b| a.max(*b));
    let most = fractions.iter().position(|f| *f == greatest).unwrap_or(0);
    let near = |i: usize| i != most && greatest - fractions[i] < apart(most, i);
    let mut ids = (0..fractions.len()).filter(|&i| i == most || near(i)).map(|i| ColorId(i as u16));
    let first = ids.next().unwrap_or_default();
    Band::overlap(first, ids.next().unwrap_or(first))
}

fn check(materials: usize) -> Result<(), PaletteError> {
    if (2..=MAX_MATERIALS).contains(&materials) {
        Ok(())
    } else {
        Err(PaletteError::Materials { count: materials })
    }
}

/// Into how many parts every fraction is cut for so many colours.
fn division(materials: usize, colors: usize) -> Result<usize, PaletteError> {
    let (mut k, mut below) = (1, 1);
    loop {
        let count = cells::count(materials, k);
        if count == colors {
            return Ok(k);
        }
        if count > colors {
            let above = Some(count).filter(|count| *count <= MAX_COLORS);
            return Err(PaletteError::Division { materials, colors, below, above });
        }
        (k, below) = (k + 1, count);
    }
}

fn boundaries(materials: usize, division: &Division, overlap: f64) -> Vec<Boundary> {
    let around = |value: f64, width: f64| {
        if width > 0.0 { vec![value - width * 0.5, value + width * 0.5] } else { vec![value] }
    };
    match division {
        Division::Cells { k, .. } => {
            // One of two fractions tells the other.
            let own = if materials == 2 { 1 } else { materials };
            let level = |material| {
                let values = (1..*k).flat_map(move |j| around(j as f64 / *k as f64, overlap));
                values.map(move |value| Boundary::Level { material, value })
            };
            (0..own).flat_map(level).collect()
        }
        Division::Greatest if materials == 2 => around(0.5, overlap)
            .into_iter()
            .map(|value| Boundary::Level { material: 0, value })
            .collect(),
        Division::Greatest => {
            let pairs = (0..materials).flat_map(|a| (a + 1..materials).map(move |b| (a, b)));
            pairs
                .flat_map(|(a, b)| {
                    around(0.0, 2.0 * overlap).into_iter().map(move |by| Boundary::Difference {
                        a,
                        b,
                        by,
                    })
                })
                .collect()
        }
    }
}

/// The cell of a mixture that lies on several boundaries, or so near that rounding has put it in
/// none: parts are moved over the nearest boundary until there is a cell.
fn nearest_cell(fractions: &[f64; MAX_MATERIALS], materials: usize, k: usize) -> Cell {
    let scaled = fractions.map(|f| f * k as f64);
    let mut cell: Cell = scaled.map(|f| f.floor().clamp(0.0, (k - 1) as f64) as u16);
    while !cells::exists(&cell, materials, k) {
        let too_much = cells::rest(&cell, k) < 1;
        let movable = (0..materials)
            .filter(|&i| if too_much { cell[i] > 0 } else { usize::from(cell[i]) + 1 < k });
        let excess = |i: usize| {
            let past = scaled[i] - f64::from(cell[i]);
            if too_much { past } else { 1.0 - past }
        };
        let Some(i) = movable.min_by(|&a, &b| excess(a).total_cmp(&excess(b))) else { break };
        if too_much {
            cell[i] -= 1;
        } else {
            cell[i] += 1;
        }
    }
    cell
}

#[cfg(test)]
#[path = "palette_tests.rs"]
mod tests;
