//! Which part of a layer is seen from above or below.

use fgm_core::Polygon;

use crate::{ClipperInset, Inset, region};

/// The narrowest skin worth printing where nothing else is asked, mm: an ordinary bead.
const LEAST: f64 = 0.4;

/// The inside of a layer, shared out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skins {
    /// Not covered by every layer above.
    pub top: Vec<Polygon>,
    /// Not held up by every layer below, and not `top`.
    pub bottom: Vec<Polygon>,
    /// Between others: may be filled sparsely.
    pub sparse: Vec<Polygon>,
}

/// Shares out `here`, the inside of a layer's walls, by its neighbours: `above` and `below` hold
/// the whole outlines of as many layers as skins are thick. A layer that is missing is an empty
/// region: all of `here` is then skin.
///
/// The three parts are disjoint and together `here`. Skins narrower than 0.4 mm go to `sparse`;
/// see [`skins_with`] for another limit.
pub fn skins(here: &[Polygon], above: &[&[Polygon]], below: &[&[Polygon]]) -> Skins {
    skins_with(here, above, below, LEAST, &ClipperInset::default())
}

/// [`skins`] with the narrowest skin, `least` mm (about a bead's width), and the offsetter named.
pub fn skins_with(
    here: &[Polygon],
    above: &[&[Polygon]],
    below: &[&[Polygon]],
    least: f64,
    inset: &dyn Inset,
) -> Skins {
    let top = seen(here, above, least, inset);
    let left = without(here, &top);
    let bottom = seen(&left, below, least, inset);
    let sparse = without(&left, &bottom);
    Skins { top, bottom, sparse }
}

/// The part of `here` that some neighbour does not cover, thin slivers left out.
fn seen(here: &[Polygon], layers: &[&[Polygon]], least: f64, inset: &dyn Inset) -> Vec<Polygon> {
    if here.is_empty() || layers.is_empty() {
        return Vec::new();
    }
    if layers.iter().any(|l| l.is_empty()) {
        return here.to_vec();
    }
    let mut open: Vec<Polygon> = Vec::new();
    for layer in layers {
        let bare = region::difference(here, layer);
        // Opened: shrunk until slivers vanish, then grown back, within what it was.
        let core = inset.inset(&bare, 0.5 * least);
        if core.is_empty() {
            continue;
        }
        let grown = region::intersection(&inset.inset(&core, -0.5 * least), &bare);
        open = if open.is_empty() { grown } else { region::union(&open, &grown) };
    }
    open
}

fn without(region: &[Polygon], part: &[Polygon]) -> Vec<Polygon> {
    if part.is_empty() { region.to_vec() } else { region::difference(region, part) }
}

#[cfg(test)]
#[path = "skins_tests.rs"]
mod tests;
