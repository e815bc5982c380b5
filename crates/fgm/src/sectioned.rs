//! Strategy 1: ordinary toolpaths, sectioned by colour.

use std::collections::BTreeSet;

use fgm_contour::ContourOptions;
use fgm_core::{Band, Point2, Polygon, Role, Sectioner, bead};
use fgm_toolpath::{
    BridgeOptions, InfillOptions, Path, Pattern, Piece, SectionOptions, WallOptions, infill,
    infill_graded, infill_lightning, seam_length, section, skins_with, walls,
};

use crate::{
    boundaries::Bands,
    bridged::{Bridged, bridged},
    choice::{SectionBy, Zipper},
    error::SliceError,
    field_sections::FieldSections,
    graded::{GradedLayer, check_material},
    heights::Heights,
    job::{Job, Seams},
    layers::Layer,
    outlines::{Outline, SharedOutline},
    rising_sections::RisingSections,
    short_sections::ShortSections,
    stages::{StageSeconds, timed},
};

/// A layer's pieces, before ordering.
pub(crate) struct Sectioned {
    pub(crate) pieces: Vec<Piece>,
    /// Faces of one colour, or the fewest that there can be.
    pub(crate) faces: usize,
    pub(crate) seams: Seams,
}

/// The pieces of a layer, before ordering.
pub(crate) fn pieces(
    job: &Job<'_>,
    layer: &Layer,
    region: &[Polygon],
    below: Option<&Outline>,
    seconds: &mut StageSeconds,
) -> Result<Sectioned, SliceError> {
    let neighbours = Neighbours::of(job, layer, seconds)?;
    let paths = timed(&mut seconds.toolpath, || {
        let simple = |path: Path| path.simplified(job.settings.contour.resolution);
        let paths = paths(job, layer, region, below, &neighbours)?.into_iter();
        Ok::<_, SliceError>(paths.map(simple).collect::<Vec<_>>())
    })?;
    let mut pieces = Vec::new();
    let material = job.design.fractions.as_ref();
    let cut = |sections: &dyn Sectioner<Band>, pieces: &mut Vec<Piece>| {
        cut(job, layer, &paths, sections, pieces);
    };
    let faces = match job.settings.section.by {
        SectionBy::Field => {
            timed(&mut seconds.contour, || check_material(region, layer.cut, material))?;
            timed(&mut seconds.toolpath, || {
                let sections = by_field(job, layer, job.bands);
                cut(&sections, &mut pieces);
                sections.finish()
            })?;
            pieces.iter().map(|piece| piece.color).collect::<BTreeSet<_>>().len()
        }
        SectionBy::Faces => {
            let graded = GradedLayer::new(job, layer, region, seconds)?;
            timed(&mut seconds.toolpath, || cut(&graded, &mut pieces));
            graded.count()
        }
    };
    let mut seams = Seams::default();
    if let Some(palette) = &job.straight {
        timed(&mut seconds.toolpath, || {
            let mut straight = Vec::new();
            let bands = Bands::new(material, palette, Zipper::NONE);
            cut(&by_field(job, layer, bands), &mut straight);
            seams.straight = seam_length(&straight, layer.height);
            seams.zipped = seam_length(&pieces, layer.height);
        });
    }
    Ok(Sectioned { pieces, faces, seams })
}

/// Cuts paths by colour, and shares out what is too short.
pub(crate) fn cut(
    job: &Job<'_>,
    layer: &Layer,
    paths: &[Path],
    sections: &dyn Sectioner<Band>,
    pieces: &mut Vec<Piece>,
) {
    let settings = &job.settings.section;
    let is_wall = |path: &Path| matches!(path.role, Role::OuterWall | Role::InnerWall);
    for paths in paths.chunk_by(|a, b| is_wall(a) == is_wall(b)) {
        let wall = paths.first().is_some_and(is_wall);
        let shortest = if wall { settings.shortest_wall } else { settings.shortest };
        cut_at(job, layer, Heights::flat(layer.cut), shortest, paths, sections, pieces);
    }
}

/// The same, where the material is looked up at these heights, and what is shorter than so many mm
/// is shared out.
fn cut_at(
    job: &Job<'_>,
    layer: &Layer,
    heights: Heights,
    shortest: f64,
    paths: &[Path],
    sections: &dyn Sectioner<Band>,
    pieces: &mut Vec<Piece>,
) {
    // The layer's index makes a zipper's teeth alternate upwards, too.
    let options = SectionOptions { shift: layer.index as u32, ..SectionOptions::default() };
    let (material, palette) = (job.design.fractions.as_ref(), job.palette);
    if shortest > 0.0 {
        let sections = ShortSections { sections, material, palette, heights, shortest };
        section(paths, &sections, &options, pieces);
    } else {
        section(paths, sections, &options, pieces);
    }
}

/// The pieces of a wall that is seen along a line, whose material is looked up at these heights.
pub(crate) fn rising_wall(
    job: &Job<'_>,
    layer: &Layer,
    line: Vec<Point2>,
    heights: Heights,
) -> Result<Vec<Piece>, SliceError> {
    let path = Path {
        points: line,
        closed: false,
        role: Role::OuterWall,
        width: job.settings.layer.bead_width,
        turn: 0,
        turns: Vec::new(),
    };
    let ContourOptions { cell, root_tolerance, .. } = job.isolines;
    let sections = RisingSections::new(job.bands, heights, cell, root_tolerance);
    let mut pieces = Vec::new();
    // No travel parts its pieces, so that short ones do no harm.
    let shortest = job.settings.section.shortest;
    cut_at(job, layer, heights, shortest, &[path], &sections, &mut pieces);
    sections.finish()?;
    Ok(pieces)
}

/// Where the material itself changes its colour.
pub(crate) fn by_field<'a>(job: &Job<'_>, layer: &Layer, bands: Bands<'a>) -> FieldSections<'a> {
    let ContourOptions { cell, root_tolerance, .. } = job.isolines;
    FieldSections::new(bands, layer.cut, cell, root_tolerance)
}

/// The outlines that skins look at; none past the part's ends.
struct Neighbours {
    above: Vec<SharedOutline>,
    below: Vec<SharedOutline>,
}

impl Neighbours {
    fn of(job: &Job<'_>, layer: &Layer, seconds: &mut StageSeconds) -> Result<Self, SliceError> {
        // What is solid anyway has no skins, unless it matters what is seen of it.
        if job.filling.is_solid() && job.hidden_purges.is_none() {
            return Ok(Self { above: Vec::new(), below: Vec::new() });
        }
        let get = |index: Option<usize>| match index {
            Some(index) if index < job.layers.count() => job.outlines.get(&job.layers.get(index)),
            _ => Ok(SharedOutline::default()),
        };
        timed(&mut seconds.contour, || {
            let skins = &job.settings.skins;
            let above = (1..=skins.top).map(|k| get(layer.index.checked_add(k)));
            let below = (1..=skins.bottom).map(|k| get(layer.index.checked_sub(k)));
            Ok(Self {
                above: above.collect::<Result<_, _>>()?,
                below: below.collect::<Result<_, _>>()?,
            })
        })
    }
}

/// How a layer is filled.
fn sparse_options(job: &Job<'_>, layer: &Layer) -> InfillOptions {
    let settings = job.settings;
    let (angle, turning) = settings.infill_direction(layer.index);
    InfillOptions {
        pattern: settings.infill.pattern,
        density: job.filling.same().unwrap_or(0.0),
        angle,
        width: settings.layer.bead_width,
        height: layer.height,
        z: layer.cut,
        layer: turning,
        role: Role::Infill,
    }
}

/// How a layer's skins are filled.
fn solid_options(job: &Job<'_>, layer: &Layer) -> InfillOptions {
    let sparse = sparse_options(job, layer);
    // Where all is solid the pattern speaks for skins as well.
    let pattern = if job.filling.is_solid() { sparse.pattern } else { Pattern::Rectilinear };
    InfillOptions { pattern, density: 1.0, ..sparse }
}

/// Direction of the lines of a layer's skins, radians.
pub(crate) fn skin_direction(job: &Job<'_>, layer: &Layer) -> f64 {
    solid_options(job, layer).solid_direction()
}

fn paths(
    job: &Job<'_>,
    layer: &Layer,
    region: &[Polygon],
    under: Option<&Outline>,
    neighbours: &Neighbours,
) -> Result<Vec<Path>, SliceError> {
    let settings = job.settings;
    let width = settings.layer.bead_width;
    let options = WallOptions::new(settings.walls.count, width, layer.height);
    let walls = walls(region, &options, &job.inset);
    let mut paths = walls.paths;
    let sparse = sparse_options(job, layer);
    let fill = |region: &[Polygon], options: InfillOptions| infill(region, &options, &job.inset);
    let sparse = match &job.hidden_purges {
        Some(_) if job.filling.is_solid() => InfillOptions { role: Role::SolidInfill, ..sparse },
        _ => sparse,
    };
    let inside = match under.filter(|_| settings.bridges.enabled) {
        Some(under) => beside_bridges(job, layer, walls.inside, under, &mut paths),
        None => walls.inside,
    };
    if job.filling.is_solid() && job.hidden_purges.is_none() {
        let role = match layer.index {
            0 => Role::BottomSkin,
            i if i + 1 == job.layers.count() => Role::TopSkin,
            _ => Role::SolidInfill,
        };
        paths.extend(fill(&inside, InfillOptions { density: 1.0, role, ..sparse }));
        return Ok(paths);
    }
    let above: Vec<&[Polygon]> = neighbours.above.iter().map(|o| o.region.as_slice()).collect();
    let below: Vec<&[Polygon]> = neighbours.below.iter().map(|o| o.region.as_slice()).collect();
    let skins = skins_with(&inside, &above, &below, width, &job.inset);
    let solid = solid_options(job, layer);
    paths.extend(fill(&skins.top, InfillOptions { role: Role::TopSkin, ..solid }));
    paths.extend(fill(&skins.bottom, InfillOptions { role: Role::BottomSkin, ..solid }));
    if let Some(shares) = job.filling.at_z(layer.cut) {
        let step = settings.contour.cell;
        paths.extend(infill_graded(&skins.sparse, &shares, step, &sparse, &job.inset)?);
    } else if let Some(covers) = &job.covers {
        let depths = covers.depths(&job.outlines, layer)?;
        // Branches stand on each other, so they keep their direction.
        let sparse = InfillOptions { angle: settings.infill.angle.to_radians(), ..sparse };
        let reach = settings.infill.reach;
        paths.extend(infill_lightning(&skins.sparse, &depths, reach, &sparse, &job.inset));
    } else if sparse.density > 0.0 {
        paths.extend(fill(&skins.sparse, sparse));
    }
    Ok(paths)
}

/// Fills the bridges inside the walls and appends their lines; what is left beside them.
fn beside_bridges(
    job: &Job<'_>,
    layer: &Layer,
    inside: Vec<Polygon>,
    below: &Outline,
    paths: &mut Vec<Path>,
) -> Vec<Polygon> {
    let width = job.settings.layer.bead_width;
    let others = job.settings.walls.count.saturating_sub(1) as f64;
    let options = BridgeOptions {
        width,
        anchor: job.settings.bridges.anchor,
        reach: width + others * bead::spacing(width, layer.height),
        // Ledges are the walls' own, and what is left beside a bridge is filled however narrow.
        ledge: 0.0,
        shortest: 0.0,
        least: 0.0,
    };
    let Bridged { lines, rest } = bridged(job, layer, inside, below, &options);
    paths.extend(lines.into_iter().flatten());
    rest
}
