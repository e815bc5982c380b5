//! Filling one face with lines along its border, so that what changes across the face does not
//! change along a line.

use fgm_core::{Polygon, Role, bead};

use crate::{
    FaceFill, GapOptions, InfillOptions, Inset, Path, Pattern,
    gap::fill_thin,
    infill,
    walls::{
        loops,
        peel::{HALF_LOOP, Peeling, peel},
    },
};

/// More loops than any face has: a backstop, 10 m of loops 0.1 mm apart.
const MOST_LOOPS: usize = 100_000;

/// How a face is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgainstOptions {
    /// Width of a bead, mm.
    pub width: f64,
    /// Layer height, mm.
    pub height: f64,
    /// What lies inside the first loop.
    pub fill: FaceFill,
    /// The narrowest bead for thin places, mm.
    pub min_width: f64,
    /// The widest bead for thin places, mm.
    pub max_width: f64,
    /// Direction of straight lines, radians.
    pub angle: f64,
    /// The layer, from 0: straight lines turn by a quarter on every other one.
    pub layer: usize,
}

impl AgainstOptions {
    /// Loops of one width; thin places take beads of 0.6 to 1.6 times that.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            fill: FaceFill::Concentric,
            min_width: 0.6 * width,
            max_width: 1.6 * width,
            angle: 0.0,
            layer: 0,
        }
    }
}

/// Fills a face whole: strategy 2 of the gradient-slicing paper (its algorithm 4).
///
/// The first loop lies half a [spacing](bead::spacing) inside the face, the next ones a spacing
/// further: beads of neighbouring faces then share out the volume between them, without gap or
/// overlap. Faces are to be cut from an outline shrunk by `(width - spacing) / 2`; the outermost
/// bead then lies half its width inside the true outline.
///
/// What the loops leave, and faces too thin for loops, takes two beads of varying width
/// ([`gap_fill`](crate::gap_fill)), one where two do not fit. Two make a loop; with beads from 0.6 to
/// 1.6 widths there is room for two wherever the last loop ends, so that a face is nothing but loops,
/// its tips apart. [`route`](crate::route) joins them to few. Loops have `turn` 0, 1, ... from outside to inside and [`Role::SolidInfill`].
pub fn against(face: &[Polygon], options: &AgainstOptions, inset: &dyn Inset) -> Vec<Path> {
    let AgainstOptions { width, height, .. } = *options;
    let spacing = bead::spacing(width, height);
    let rectilinear = options.fill == FaceFill::Rectilinear;
    let most = if rectilinear { 1 } else { MOST_LOOPS };
    let peeling = Peeling { spacing, half_loop: half_loop(options), most };
    let peel = peel(face, peeling, inset);
    let mut out = loops(&peel.loops, width, |_| Role::SolidInfill);
    if rectilinear {
        let lines = InfillOptions {
            pattern: Pattern::Rectilinear,
            density: 1.0,
            angle: options.angle,
            width,
            height,
            z: 0.0,
            layer: options.layer,
            role: Role::SolidInfill,
        };
        out.extend(infill(&peel.rest, &lines, inset));
    }
    let AgainstOptions { min_width, max_width, .. } = *options;
    let gaps = GapOptions { width, height, min_width, max_width, loops: true };
    out.extend(fill_thin(&peel.thin, &gaps, 0.0));
    out
}

/// Half the thickness, in spacings, below which a face takes no loop. Two beads are to fit inside
/// the last loop, and no more than two where there is none: then the lines everywhere are loops,
/// and no single bead leads away from them. Where the nozzle's limits are too narrow for that, one
/// bead has to fit inside.
fn half_loop(options: &AgainstOptions) -> f64 {
    let AgainstOptions { width, height, min_width, max_width, .. } = *options;
    let spacing = bead::spacing(width, height);
    let in_spacings = |width: f64| bead::spacing(width, height) / spacing;
    let (least, most) = (1.0 + in_spacings(min_width), in_spacings(max_width));
    if least <= most { 0.5 * (least + most) } else { HALF_LOOP }
}

#[cfg(test)]
#[path = "against_tests.rs"]
mod tests;
