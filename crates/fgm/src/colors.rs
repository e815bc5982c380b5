//! The palette of a slice: how many colours, and how far they overlap.

use std::ops::Range;

use fgm_core::{Bounds2, ColorId, Field, Interval, MAX_MATERIALS, Mixture, Point3, Role};
use fgm_field::Design;
use fgm_palette::{Measure, Palette};
use fgm_toolpath::Piece;

use crate::{
    boundaries::Bands,
    choice::{Strategy, Zipper},
    error::SliceError,
    layers::Layers,
    outlines::Outliner,
    samples,
    settings::Settings,
};

/// Colours of a palette where neither the settings nor the machine say.
const DEFAULT_COLORS: usize = 16;
/// The most colours that `auto` tries.
const MOST_AUTO_COLORS: usize = 64;

/// Step of the differences that measure a gradient, mm.
const STEP: f64 = 1e-3;

/// A palette of `count` colours for the design, with the zipper that the settings ask for
/// where it is a share of the gradient.
pub(crate) fn palette(
    count: usize,
    design: &Design,
    settings: &Settings,
) -> Result<Palette, SliceError> {
    let materials = design.materials.len();
    // As many colours as three or more materials: one head a material, nothing mixed.
    let palette = if materials > 2 && count == materials {
        Palette::pure(materials)?
    } else {
        Palette::new(materials, count)?
    };
    match settings.palette.zipper {
        Zipper::Share(share) if settings.slice.strategy == Strategy::Sectioned => {
            Ok(palette.with_overlap(share)?)
        }
        _ => Ok(palette),
    }
}

/// That a zipper's length is more than a band in parts of the design, where it is narrowed.
///
/// # Errors
/// [`SliceError::FlatZipper`] where there is no gradient that a length could be along.
pub(crate) fn narrowed(
    palette: &Palette,
    design: &Design,
    settings: &Settings,
    outliner: &Outliner<'_>,
) -> Result<Option<String>, SliceError> {
    let Zipper::Length(length) = settings.palette.zipper else { return Ok(None) };
    if length <= 0.0 || settings.slice.strategy == Strategy::Against {
        return Ok(None);
    }
    let steep = gradients(design, outliner)?;
    if steep.iter().all(|slope| *slope <= 0.0) {
        return Err(SliceError::FlatZipper { length });
    }
    let widest = 2.0 * palette.widest(Measure::Fraction { material: 0 });
    let narrowed = steep.iter().filter(|slope| length * **slope > widest).count();
    Ok((narrowed > 0).then(|| {
        let share = 100.0 * narrowed as f64 / steep.len().max(1) as f64;
        format!(
            "the zipper of {length} mm is wider than a colour's band in {share:.0} % of the part, \
             and as wide as the band there (fewer colours make wider bands)"
        )
    }))
}

/// The colours of a palette.
pub(crate) fn ids(palette: &Palette) -> impl Iterator<Item = ColorId> + use<> {
    (0..palette.colors() as u16).map(ColorId)
}

/// Shown for materials that have no colour of their own, in their order.
const SHOWN: [[u8; 3]; MAX_MATERIALS] = [
    [30, 90, 200],
    [250, 210, 40],
    [210, 40, 50],
    [40, 160, 80],
    [150, 70, 180],
    [250, 130, 30],
    [60, 190, 200],
    [120, 120, 120],
];

/// Colours (red, green, blue) for materials that have none of their own, in their order.
pub fn usual_colors() -> &'static [[u8; 3]] {
    &SHOWN
}

/// How each material of a design is shown: in its own colour (red, green, blue), else in a usual
/// one.
pub fn material_colors(design: &Design) -> Vec<[u8; 3]> {
    let materials = design.materials.iter().zip(SHOWN);
    materials.map(|(material, usual)| material.color.unwrap_or(usual)).collect()
}

/// How a mixture is shown: its materials' colours, mixed by volume.
pub(crate) fn shown(design: &Design, mixture: &Mixture) -> [u8; 3] {
    let colors = material_colors(design);
    std::array::from_fn(|channel| {
        let parts = colors.iter().zip(mixture.fractions());
        parts.map(|(color, share)| f64::from(color[channel]) * share).sum::<f64>().round() as u8
    })
}

/// Which colours may occur in each layer of `range`.
///
/// From the bounds of the fractions over whole layers: never too few, often too many.
pub(crate) fn occurring<'a>(
    design: &'a Design,
    bands: Bands<'a>,
    window: Bounds2,
    layers: Layers,
    range: Range<usize>,
) -> impl Iterator<Item = Vec<bool>> + use<'a> {
    let palette = bands.palette;
    // Half a band about a state is its band; the overlap of a zipper reaches beyond.
    let reach = palette.half_band() + bands.reach() + 1e-9;
    range.map(move |index| {
        let cut = layers.get(index).cut;
        let bounds: Vec<Interval> = (0..design.materials.len())
            .map(|m| design.fractions.fraction(m).at_z(cut).bounds(&window))
            .collect();
        if bounds.iter().all(|b| b.lo == b.hi)
            && let Ok(band) = bands.at(window.center().extend(cut))
        {
            return ids(palette).map(|id| id == band.first || id == band.second).collect();
        }
        let occurs = |color: ColorId| {
            let state = palette.state(color);
            let mut of_materials = bounds.iter().zip(state.fractions());
            of_materials.all(|(b, f)| b.lo <= f + reach && f - reach <= b.hi)
        };
        ids(palette).map(occurs).collect()
    })
}

/// The number of colours where none is asked for.
pub(crate) fn default_count(machine_colors: Option<usize>, materials: usize) -> usize {
    match machine_colors {
        Some(heads) if materials > 2 => {
            // One head a material, or as many cells of the simplex as there are heads for.
            let fits = |count| count == materials || Palette::new(materials, count).is_ok();
            (1..=heads).rev().find(|&count| fits(count)).unwrap_or(1)
        }
        Some(heads) => heads,
        None if materials > 2 => {
            // The finest division of the simplex with at most as many cells as the default.
            let divided = |count| Palette::new(materials, count).is_ok();
            (1..=DEFAULT_COLORS).rev().find(|&count| divided(count)).unwrap_or(1)
        }
        None => DEFAULT_COLORS,
    }
}

/// The most colours that keep the part printable.
///
/// Strategy 2: a band must be at least one bead wide (paper, section 3.5), so the steepest places
/// of the part but a few decide. Strategy 1: at most `palette.auto_short_share` of the pieces may
/// be shorter than `palette.short_piece` (paper, section 3.4.3); `short` gives their share in some
/// layers with a palette of so many colours.
pub(crate) fn auto_count(
    design: &Design,
    settings: &Settings,
    outliner: &Outliner<'_>,
    machine_colors: Option<usize>,
    short: &dyn Fn(usize) -> Result<f64, SliceError>,
) -> Result<usize, SliceError> {
    let counts: Vec<usize> = (1..=machine_colors.unwrap_or(MOST_AUTO_COLORS))
        .filter(|&n| Palette::new(design.materials.len(), n).is_ok())
        .collect();
    let fits = |count: usize| match settings.slice.strategy {
        Strategy::Against => {
            let mut steep = gradients(design, outliner)?;
            steep.sort_unstable_by(f64::total_cmp);
            let but_few = steep.get(steep.len().saturating_sub(1 + steep.len() / 20));
            let band = 1.0 / bands_along_gradient(count, design.materials.len());
            Ok(but_few.is_none_or(|g| g * settings.layer.bead_width <= band))
        }
        Strategy::Sectioned => {
            Ok::<_, SliceError>(short(count)? <= settings.palette.auto_short_share)
        }
    };
    // Pieces only get shorter with more colours: halve the list. One colour always fits.
    let (mut good, mut bad) = (0, counts.len());
    while bad - good > 1 {
        let middle = usize::midpoint(good, bad);
        if fits(counts[middle])? { good = middle } else { bad = middle }
    }
    Ok(counts.get(good).copied().unwrap_or(1))
}

/// Bands that one material's fraction passes through from 0 to 1.
fn bands_along_gradient(colors: usize, materials: usize) -> f64 {
    if materials <= 2 { colors as f64 } else { (colors as f64).powf(1.0 / (materials - 1) as f64) }
}

/// Whether a piece of the part is shorter than prints well.
pub(crate) fn is_short(piece: &Piece, settings: &Settings) -> bool {
    piece.role.is_part()
        && piece.role != Role::GapFill
        && piece.length() < settings.palette.short_piece
}

/// How steeply the material changes at points all over the part, in shares per mm.
fn gradients(design: &Design, outliner: &Outliner<'_>) -> Result<Vec<f64>, SliceError> {
    let steepest = |p: Point3| {
        (0..design.materials.len())
            .map(|m| gradient(design.fractions.fraction(m), p))
            .fold(0.0, f64::max)
    };
    let points = samples::inside(outliner, &design.bounds)?;
    Ok(points.into_iter().map(steepest).filter(|g| g.is_finite()).collect())
}

/// The slope of a fraction in a layer's plane.
pub(crate) fn gradient(fraction: &dyn Field, p: Point3) -> f64 {
    let along = |step: Point3| (fraction.eval(p + step) - fraction.eval(p - step)) / (2.0 * STEP);
    along(Point3::X * STEP).hypot(along(Point3::Y * STEP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_materials_take_the_finest_division_within_the_default() {
        assert_eq!(default_count(None, 2), 16);
        assert_eq!(default_count(Some(5), 2), 5);
        assert_eq!(default_count(None, 3), 16);
        assert_eq!(default_count(Some(5), 3), 4);
        assert_eq!(default_count(Some(5), 5), 5);
        assert!((1..=16).contains(&default_count(None, 4)));
    }
}
