//! Filling regions with lines: solid, or as sparse as asked.

mod clip;
mod graded;
mod gyroid;
mod honeycomb;
mod join;
mod lightning;
mod pattern;
mod rims;
mod scan;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use fgm_core::{Polygon, Role, bead};

use crate::{
    GapOptions, Inset, Path,
    gap::fill_thin,
    gap_fill, region,
    walls::{
        loops,
        peel::{HALF_LOOP, Peeling, peel},
    },
};
pub use graded::infill_graded;
pub use lightning::infill_lightning;
pub use pattern::Pattern;

/// From this density on a filling is solid.
const SOLID: f64 = 0.999;

/// How a region is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfillOptions {
    /// The lines' arrangement.
    pub pattern: Pattern,
    /// The share of the volume to fill, 0..=1; nothing at 0.
    pub density: f64,
    /// Direction of the lines, radians from +x.
    pub angle: f64,
    /// Width of a bead, mm.
    pub width: f64,
    /// Layer height, mm.
    pub height: f64,
    /// Height of the layer's middle, mm: the gyroid changes with it.
    pub z: f64,
    /// The layer, from 0: rectilinear lines, and solid ones of most patterns, turn by a quarter on
    /// every other one.
    pub layer: usize,
    /// What the beads are for.
    pub role: Role,
}

impl InfillOptions {
    /// Solid rectilinear lines along x.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            pattern: Pattern::Rectilinear,
            density: 1.0,
            angle: 0.0,
            width,
            height,
            z: 0.0,
            layer: 0,
            role: Role::SolidInfill,
        }
    }

    /// Direction of the lines of a solid filling, radians from +x, where it has straight ones.
    pub fn solid_direction(&self) -> f64 {
        let lines = match self.pattern {
            Pattern::Aligned => Pattern::Aligned,
            _ => Pattern::Rectilinear,
        };
        lines.families(self).angle
    }

    fn spacing(&self) -> f64 {
        bead::spacing(self.width, self.height)
    }

    /// Distance between lines at the density.
    fn pitch(&self) -> f64 {
        self.spacing() / self.density
    }

    fn is_valid(&self) -> bool {
        let spacing = self.spacing();
        let sizes = spacing > 0.0 && spacing.is_finite() && self.width.is_finite();
        sizes && self.density > 1e-3 && self.angle.is_finite() && self.z.is_finite()
    }
}

/// An arrangement of lines. [`Pattern`] has those of this crate.
pub trait Infill: Sync {
    /// Lines that fill `region`: beads reach to its border and not beyond, so that the lines
    /// themselves keep half a [spacing](bead::spacing) off it.
    fn lines(&self, region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path>;
}

/// Fills a region, the inside of walls, by [`InfillOptions::pattern`].
///
/// Lines of straight patterns are joined along the border into long paths, where no other path
/// lies there; a segment's [turn](Path::turn_of) is the number of its scan line, a joining
/// segment's that of the line before. A sparse filling's lines by themselves have the density's
/// volume; what joins them, at most once round the border, comes on top. Sparse patterns lie on one lattice for all regions and layers. A solid filling spreads
/// its lines evenly over each polygon instead, so that beads' volume is the region's, and fills
/// what is too thin for a line by [`gap_fill`].
///
/// Options without sense (density, width or height not above 0, not finite) fill nothing.
pub fn infill(region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    options.pattern.lines(region, options, inset)
}

impl Infill for Pattern {
    fn lines(&self, region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
        if !options.is_valid() {
            return Vec::new();
        }
        let solid = options.density >= SOLID;
        match self {
            Self::Concentric if solid => solid_loops(region, options, inset),
            Self::Concentric => sparse_loops(region, options, inset),
            _ if solid => region.iter().flat_map(|p| solid_lines(p, options, inset)).collect(),
            Self::Rectilinear | Self::Aligned | Self::Grid | Self::Triangles => {
                sparse_lines(region, options, self.families(options), inset)
            }
            Self::Honeycomb => honeycomb::lines(region, options, inset),
            Self::Gyroid => gyroid::lines(region, options, inset),
            Self::Lightning => infill_lightning(region, &lightning::Roof, 0.0, options, inset),
        }
    }
}

/// How a pattern of straight lines is made up.
#[derive(Clone, Copy)]
struct Families {
    /// Of the first family's lines, radians from +x.
    angle: f64,
    /// From each family to the next, radians.
    turn: f64,
    count: u32,
    /// Where line 0 lies, in pitches.
    phase: f64,
}

impl Families {
    /// The lattice of each family, which together lie `pitch` mm apart.
    fn lattices(self, pitch: f64) -> impl Iterator<Item = scan::Lattice> {
        let Self { angle, turn, count, phase } = self;
        let pitch = f64::from(count) * pitch;
        (0..count).map(move |i| {
            let angle = angle + f64::from(i) * turn;
            scan::Lattice { angle, pitch, phase: phase * pitch }
        })
    }
}

impl Pattern {
    /// Whether it is made of straight lines, which [`infill_graded`] can thin.
    pub fn is_straight(self) -> bool {
        matches!(self, Self::Rectilinear | Self::Aligned | Self::Grid | Self::Triangles)
    }

    /// The families of parallel lines of a straight pattern; those of the rectilinear one for
    /// others.
    fn families(self, options: &InfillOptions) -> Families {
        let angle = options.angle;
        match self {
            Self::Aligned => Families { angle, turn: 0.0, count: 1, phase: 0.5 },
            Self::Grid => Families { angle, turn: FRAC_PI_2, count: 2, phase: 0.5 },
            // Through one point, so that they meet everywhere.
            Self::Triangles => Families { angle, turn: FRAC_PI_3, count: 3, phase: 0.0 },
            _ => {
                let odd = !options.layer.is_multiple_of(2);
                let angle = angle + if odd { FRAC_PI_2 } else { 0.0 };
                Families { angle, turn: 0.0, count: 1, phase: 0.5 }
            }
        }
    }
}

fn sparse_lines(
    region: &[Polygon],
    options: &InfillOptions,
    families: Families,
    inset: &dyn Inset,
) -> Vec<Path> {
    let centres = inset.inset(region, 0.5 * options.spacing());
    let beads = join::Beads { width: options.width, spacing: None, role: options.role };
    // No stretch of border is laid twice.
    let mut laid = join::Laid::default();
    let family = |lattice| join::serpentines(&centres, &lattice, &beads, &mut laid);
    families.lattices(options.pitch()).flat_map(family).collect()
}

/// Solid lines over one polygon, as many as fit its extent best and spread evenly.
fn solid_lines(polygon: &Polygon, options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    let spacing = options.spacing();
    let angle = options.solid_direction();
    let (low, high) = scan::extent(polygon, angle);
    let extent = high - low;
    if !(extent > 0.0 && extent.is_finite()) {
        return Vec::new();
    }
    let pitch = extent / (extent / spacing).round().max(1.0);
    // A hair less, so that the first and last line lie on the inside of straight borders.
    let margin = 0.5 * pitch.min(spacing) - 2e-3;
    let polygon = std::slice::from_ref(polygon);
    let centres = inset.inset(polygon, margin);
    let lattice = scan::Lattice { angle, pitch, phase: low + 0.5 * pitch };
    let width = options.width - spacing + pitch;
    let beads = join::Beads { width, spacing: Some(spacing), role: options.role };
    let mut out = join::serpentines(&centres, &lattice, &beads, &mut join::Laid::default());

    let covered = inset.inset(&centres, -0.5 * spacing - 1e-2);
    if region::area(polygon) - region::area(&covered) > -1e-2 * spacing {
        let thin = region::difference(polygon, &covered);
        out.extend(gap_fill(&thin, &gaps(options)));
    }
    out
}

fn gaps(options: &InfillOptions) -> GapOptions {
    GapOptions {
        width: options.width,
        height: options.height,
        min_width: 0.6 * options.width,
        max_width: 1.6 * options.width,
        loops: false,
    }
}

fn solid_loops(region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    let peeling = Peeling { spacing: options.spacing(), half_loop: HALF_LOOP, most: usize::MAX };
    let peel = peel(region, peeling, inset);
    let mut out = loops(&peel.loops, options.width, |_| options.role);
    out.extend(fill_thin(&peel.thin, &gaps(options), 0.0));
    out
}

fn sparse_loops(region: &[Polygon], options: &InfillOptions, inset: &dyn Inset) -> Vec<Path> {
    let pitch = options.pitch();
    let mut levels = Vec::new();
    let mut now = inset.inset(region, 0.5 * pitch);
    while !now.is_empty() {
        let next = inset.inset(&now, pitch);
        levels.push(now);
        now = next;
    }
    loops(&levels, options.width, |_| options.role)
}

#[cfg(test)]
#[path = "infill_tests.rs"]
mod tests;
