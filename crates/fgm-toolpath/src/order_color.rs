//! In which order colours are printed.

use fgm_core::{ColorId, Point2};

/// What it costs to go on in another colour, in mm of travel; the same both ways, none from a colour
/// to itself.
pub type Change<'a> = &'a dyn Fn(ColorId, ColorId) -> f64;

/// In which order colours are printed.
#[derive(Clone, Copy)]
pub struct ColorOrder<'a> {
    /// Colour follows colour as in here; others come last, by number.
    pub sequence: &'a [ColorId],
    /// Where none, a layer comes back to no colour. Else it goes from part to part as travels and
    /// changes together cost least, beginning near the first colour and ending near the last.
    pub change: Option<Change<'a>>,
    /// Where the nozzle goes between two colours, mm, as to a tower: a colour is then begun and ended
    /// near there.
    pub via: Option<Point2>,
}

impl ColorOrder<'_> {
    /// Where every colour stands in the sequence, up to the greatest that is asked for.
    pub(crate) fn ranks(&self, used: impl Iterator<Item = ColorId>) -> Vec<usize> {
        let count = used.map(|color| color.index() + 1).max().unwrap_or_default();
        let mut ranks = vec![usize::MAX; count];
        for (i, color) in self.sequence.iter().enumerate().rev() {
            if let Some(rank) = ranks.get_mut(color.index()) {
                *rank = i;
            }
        }
        ranks
    }
}

/// No colour is come back to.
impl<'a> From<&'a [ColorId]> for ColorOrder<'a> {
    fn from(sequence: &'a [ColorId]) -> Self {
        Self { sequence, change: None, via: None }
    }
}

impl<'a> From<&'a Vec<ColorId>> for ColorOrder<'a> {
    fn from(sequence: &'a Vec<ColorId>) -> Self {
        sequence.as_slice().into()
    }
}

impl<'a, const N: usize> From<&'a [ColorId; N]> for ColorOrder<'a> {
    fn from(sequence: &'a [ColorId; N]) -> Self {
        sequence.as_slice().into()
    }
}
