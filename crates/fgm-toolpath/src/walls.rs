//! Walls: loops along the outline, inside holes too.

pub(crate) mod peel;
mod split;

use fgm_core::{Polygon, Role, bead};

use crate::{GapOptions, Inset, Path, gap::fill_thin};
use peel::{HALF_LOOP, Peeling, peel};

/// How walls are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallOptions {
    /// How many, from the outline inward.
    pub count: usize,
    /// Width of a bead, mm.
    pub width: f64,
    /// Layer height, mm.
    pub height: f64,
    /// The narrowest bead for thin parts, mm.
    pub min_width: f64,
    /// The widest bead for thin parts, mm.
    pub max_width: f64,
}

impl WallOptions {
    /// Walls of one width; thin parts take beads of 0.6 to 1.6 times that.
    pub fn new(count: usize, width: f64, height: f64) -> Self {
        Self { count, width, height, min_width: 0.6 * width, max_width: 1.6 * width }
    }
}

/// The walls of a layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    /// Closed loops from outside to inside, `turn` 0 for the outer wall, 1 for the next; then the
    /// beads of thin parts.
    pub paths: Vec<Path>,
    /// What the walls leave for skins and infill: its border is where their beads may reach to.
    pub inside: Vec<Polygon>,
}

/// The walls of a region.
///
/// The first wall's centre lies half a bead inside the outline, the next ones a
/// [spacing](bead::spacing) apart, so that walls fill their share of the volume exactly. Islands
/// and holes all get walls. Where no loop fits, beads of varying width along the middle
/// ([`gap_fill`](crate::gap_fill)) take its place, so that thin parts are printed.
pub fn walls(region: &[Polygon], options: &WallOptions, inset: &dyn Inset) -> Walls {
    let spacing = bead::spacing(options.width, options.height);
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Walls::default();
    }
    // The beads' volume ends here; their round sides reach on to the outline.
    let border = inset.inset(region, 0.5 * (options.width - spacing));
    let peeling = Peeling { spacing, half_loop: HALF_LOOP, most: options.count };
    let peel = peel(&border, peeling, inset);
    let mut paths = loops(&peel.loops, options.width, |turn| {
        if turn == 0 { Role::OuterWall } else { Role::InnerWall }
    });
    paths.extend(fill_thin(
        &peel.thin,
        &GapOptions {
            width: options.width,
            height: options.height,
            min_width: options.min_width,
            max_width: options.max_width,
            loops: false,
        },
        0.0,
    ));
    Walls { paths, inside: peel.rest }
}

/// Closed paths around regions, level by level.
pub(crate) fn loops(levels: &[Vec<Polygon>], width: f64, role: impl Fn(u32) -> Role) -> Vec<Path> {
    let mut out = Vec::new();
    for (turn, level) in (0u32..).zip(levels) {
        for ring in level.iter().flat_map(Polygon::rings) {
            out.push(Path {
                points: ring.points.clone(),
                closed: true,
                role: role(turn),
                width,
                turn,
                turns: Vec::new(),
            });
        }
    }
    out
}

#[cfg(test)]
#[path = "walls_tests.rs"]
mod tests;
