//! What the towers have to take: how much on a layer, and up to which one.

use fgm_core::{ColorId, MaterialError, MaterialField, Point3};
use fgm_palette::Palette;

use super::needs::Needs;

/// What may be asked of the towers of a print.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Demand {
    /// The last layer in which each colour may be purged for, counted from the first printed.
    pub(crate) last: Vec<Option<usize>>,
    /// The last layer with a change that may be purged.
    pub(crate) last_change: Option<usize>,
    /// The most on one layer, mm³.
    pub(crate) most: f64,
}

impl Demand {
    /// From the colours that may occur in each layer.
    pub(crate) fn of(needs: &Needs, layers: impl Iterator<Item = Vec<bool>>) -> Self {
        let mut demand = Self::default();
        let mut before: Option<Vec<bool>> = None;
        let (mut changes, mut most, mut repeated) = (false, 0.0, false);
        for (count, layer) in layers.enumerate() {
            demand.last.resize(layer.len(), None);
            for (last, _) in demand.last.iter_mut().zip(&layer).filter(|(_, occurs)| **occurs) {
                *last = Some(count);
            }
            // Layers mostly have the same colours as the two before.
            let same = before.as_ref() == Some(&layer);
            if !(same && repeated) {
                let now = colors(&layer);
                let inside = needs.most_in_layer(&now);
                let entering = match &before {
                    Some(before) => needs.most_between(&colors(before), &now),
                    None => now.iter().map(|to| needs.volume(None, *to)).fold(0.0, f64::max),
                };
                // What is in the nozzle at the start is no reason for a tower.
                changes = inside > 0.0 || (entering > 0.0 && before.is_some());
                most = inside + entering;
            }
            if changes {
                demand.last_change = Some(count);
            }
            demand.most = demand.most.max(most);
            repeated = same;
            before = Some(layer);
        }
        demand
    }
}

fn colors(layer: &[bool]) -> Vec<ColorId> {
    (0..).map(ColorId).zip(layer).filter(|(_, occurs)| **occurs).map(|(color, _)| color).collect()
}

/// Whether any change is worth a purge, as far as points all over the part tell, slice by slice:
/// between colours that follow each other in a slice, or where two slices have none in common and
/// even the nearest are far apart.
pub(crate) fn is_needed(
    needs: &Needs,
    palette: &Palette,
    material: &dyn MaterialField,
    points: &[Point3],
) -> Result<bool, MaterialError> {
    let mut before: Vec<ColorId> = Vec::new();
    for slice in points.chunk_by(|a, b| a.z == b.z) {
        let mut occurs = vec![false; palette.colors()];
        for p in slice {
            let band = palette.band(&material.mixture(*p)?);
            occurs[band.first.index()] = true;
            occurs[band.second.index()] = true;
        }
        let now = colors(&occurs);
        let inside = now.windows(2).any(|w| needs.volume(Some(w[0]), w[1]) > 0.0);
        let to_any = |from: &ColorId| now.iter().any(|to| needs.volume(Some(*from), *to) == 0.0);
        if inside || !(before.is_empty() || before.iter().any(to_any)) {
            return Ok(true);
        }
        before = now;
    }
    Ok(false)
}
