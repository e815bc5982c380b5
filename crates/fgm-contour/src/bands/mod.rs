//! Regions between lines.

mod assemble;
mod border;

pub(crate) use assemble::{AGAINST, Assembler, NONE, Rings, WITH};
pub(crate) use border::{Border, Event};

use crate::lines::Lines;
use crate::nest::{assemble, containing};
use fgm_core::{Polygon, Ring};

/// The region in which values lie between two levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The least value in it; negative infinity for the lowest band.
    pub lower: f64,
    /// What its values stay below; infinity for the highest band, which holds that value too.
    pub upper: f64,
    /// Outer rings anticlockwise, holes clockwise.
    pub polygons: Vec<Polygon>,
}

/// The bands below, between and above levels, which are in order; still without polygons.
fn between(levels: &[f64]) -> Vec<Band> {
    let lower = [f64::NEG_INFINITY].iter().chain(levels);
    let upper = levels.iter().chain(&[f64::INFINITY]);
    lower.zip(upper).map(|(&lower, &upper)| Band { lower, upper, polygons: Vec::new() }).collect()
}

/// The bands with their rings. `outer_of` says for each ring in which ring it is a hole, which is
/// itself for outer rings.
pub(crate) fn bands_by(levels: &[f64], rings: Vec<(u16, Ring)>, outer_of: &[u32]) -> Vec<Band> {
    let mut bands = between(levels);
    let mut place = vec![usize::MAX; rings.len()];
    let mut holes = Vec::new();
    for (k, (class, ring)) in rings.into_iter().enumerate() {
        let polygons = &mut bands[usize::from(class)].polygons;
        if outer_of[k] == k as u32 {
            if ring.points.len() > 2 {
                place[k] = polygons.len();
                polygons.push(Polygon::simple(ring));
            }
        } else {
            holes.push((class, outer_of[k], ring));
        }
    }
    for (class, outer, ring) in holes {
        let place = place.get(outer as usize).copied().unwrap_or(usize::MAX);
        if let Some(polygon) = bands[usize::from(class)].polygons.get_mut(place) {
            polygon.holes.push(ring);
        }
    }
    bands
}

/// The bands with their rings, holes told from outer rings by their direction.
pub(crate) fn bands_of(levels: &[f64], rings: Vec<(u16, Ring)>) -> Vec<Band> {
    let mut bands = between(levels);
    let mut by_class: Vec<Vec<Ring>> = vec![Vec::new(); bands.len()];
    for (class, ring) in rings {
        by_class[usize::from(class)].push(ring);
    }
    for (band, rings) in bands.iter_mut().zip(by_class) {
        band.polygons = polygons_of(rings);
    }
    bands
}

/// For each level the region below it.
pub(crate) fn below(levels: &[f64], lines: &Lines, border: &Border) -> Vec<Band> {
    let mut rings = Rings::default();
    let region = |(level, &upper): (usize, &f64)| {
        let level = level as u16;
        let border = border.of_level(level);
        let assembler = Assembler { lines, border: &border };
        assembler.run(|line| line.level == level, |class| class <= level, &mut rings);
        let rings = rings.list.drain(..).map(|r| r.1).collect();
        Band { lower: f64::NEG_INFINITY, upper, polygons: polygons_of(rings) }
    };
    levels.iter().enumerate().map(region).collect()
}

/// Rings to polygons; rings without an area are left out.
fn polygons_of(rings: Vec<Ring>) -> Vec<Polygon> {
    let (mut kept, mut holes) = (Vec::with_capacity(rings.len()), Vec::new());
    for ring in rings.into_iter().filter(|r| r.points.len() > 2) {
        let area = ring.area();
        if area != 0.0 {
            holes.push(Some(area < 0.0));
            kept.push(ring);
        }
    }
    let around = if holes.contains(&Some(true)) { containing(&kept) } else { Vec::new() };
    assemble(kept, &around, &holes)
}
