//! Strategy 2: every face filled against the gradient.

use std::collections::BTreeMap;

use fgm_core::{ColorId, Point2, Polygon, bead};
use fgm_toolpath::{
    AgainstOptions, BridgeOptions, Inset, Path, Piece, against, join_ends, order_with, region,
    route,
};
use rayon::prelude::*;

use crate::{
    bridged::{Bridged, bridged},
    error::SliceError,
    graded::GradedLayer,
    job::Job,
    layers::Layer,
    outlines::Outline,
    sectioned::{by_field, cut},
    stages::{StageSeconds, timed},
};

/// The least share of its volume that a face's beads must have; else it is narrower than a bead.
const LEAST_FILLED: f64 = 0.5;
/// The share of a layer's area in faces narrower than a bead that is not worth a thought.
const NEGLIGIBLE: f64 = 0.002;
/// The share of the area taken together that the colours told of hold for.
const MOST_AREA: f64 = 0.9;
/// The most colours that are taken for one, where bands are narrower than a bead.
const MOST_MERGED: u16 = 64;

/// How many beads over air, side by side along what holds them, are no bridge yet: as many as the
/// walls of strategy 1 are.
const LEDGE: f64 = 3.0;

/// How many beads' widths loops may go through the air: what is shorter is no bridge.
const SHORTEST: f64 = 12.0;

/// The faces of a layer, filled.
pub(crate) struct Filled {
    /// A round of pieces for each face, and for each colour of a bridge, before ordering.
    pub(crate) routes: Vec<Vec<Piece>>,
    pub(crate) faces: usize,
    /// How many colours were taken for one, but for few places; 1 where every band is wide enough.
    pub(crate) merged: u16,
}

/// The pieces of a layer, a round for each face, before ordering.
pub(crate) fn routes(
    job: &Job<'_>,
    layer: &Layer,
    region: &[Polygon],
    below: Option<&Outline>,
    seconds: &mut StageSeconds,
) -> Result<Filled, SliceError> {
    let settings = job.settings;
    let width = settings.layer.bead_width;
    // Faces are filled up to half a spacing from their border, so that neighbours' beads touch by
    // volume. The part's own border must lie half a width outside the bead instead.
    let shrink = 0.5 * (width - bead::spacing(width, layer.height));
    let region = timed(&mut seconds.toolpath, || job.inset.inset(region, shrink));
    let below = below.filter(|_| settings.bridges.enabled);
    let (bridges, region) = match below {
        Some(below) => timed(&mut seconds.toolpath, || bridge_routes(job, layer, region, below))?,
        None => (Vec::new(), region),
    };
    let graded = GradedLayer::new(job, layer, &region, seconds)?;
    let options = fill_options(job, layer);
    timed(&mut seconds.toolpath, || {
        let faces: Vec<_> =
            graded.faces().map(|(band, face)| Face { color: band.first, polygon: face }).collect();
        let fill = |face: &Face| -> Vec<Piece> {
            let paths = against(std::slice::from_ref(&face.polygon), &options, &job.inset);
            let simple = |path: Path| path.simplified(settings.contour.resolution);
            let paths = route(paths.into_iter().map(simple).collect(), width, layer.height);
            paths.into_iter().map(|path| path.in_color(face.color)).collect()
        };
        // In parallel, so that no thread waits while another fills the last layer.
        let routes: Vec<Vec<Piece>> = faces.par_iter().map(fill).collect();
        let count = faces.len();
        let (mut filled, mut narrow) = (Vec::with_capacity(count), Vec::new());
        for (face, route) in faces.into_iter().zip(routes) {
            let wide = is_filled(&face, &route, layer.height);
            if wide { filled.push(route) } else { narrow.push((face, route)) }
        }
        let least = NEGLIGIBLE * region::area(&region);
        let lost: f64 = narrow.iter().map(|(face, _)| face.polygon.area()).sum();
        let mut merged = 1;
        if lost <= least {
            filled.extend(narrow.into_iter().map(|(_, route)| route));
        } else {
            let narrow = narrow.into_iter().map(|(face, _)| face).collect();
            let last = ColorId(job.palette.colors().saturating_sub(1) as u16);
            merged = merge(narrow, last, layer.height, &fill, &mut filled);
        }
        filled.extend(bridges);
        Ok(Filled { routes: filled, faces: count, merged })
    })
}

/// How a layer's faces are filled.
fn fill_options(job: &Job<'_>, layer: &Layer) -> AgainstOptions {
    let settings = job.settings;
    let (min_width, max_width) = settings.bead_widths();
    AgainstOptions {
        fill: settings.against.fill,
        min_width,
        max_width,
        angle: settings.infill.angle.to_radians(),
        layer: layer.index,
        ..AgainstOptions::new(settings.layer.bead_width, layer.height)
    }
}

/// The bridges in a layer's region, as a route for each of their colours, and what they leave of it.
///
/// Over air loops would fall: there the lines go straight across, to the region's border, and are
/// cut by colour like those of strategy 1.
fn bridge_routes(
    job: &Job<'_>,
    layer: &Layer,
    region: Vec<Polygon>,
    below: &Outline,
) -> Result<(Vec<Vec<Piece>>, Vec<Polygon>), SliceError> {
    let settings = job.settings;
    let width = settings.layer.bead_width;
    let options = BridgeOptions {
        width,
        anchor: settings.bridges.anchor,
        reach: width,
        ledge: LEDGE * width,
        shortest: SHORTEST * width,
        least: settings.bead_widths().0,
    };
    let Bridged { lines, rest } = bridged(job, layer, region, below, &options);
    let mut routes = Vec::new();
    for lines in lines {
        let simple = |path: Path| path.simplified(settings.contour.resolution);
        let lines: Vec<Path> = lines.into_iter().map(simple).collect();
        let (sections, mut pieces) = (by_field(job, layer, job.bands), Vec::new());
        cut(job, layer, &lines, &sections, &mut pieces);
        sections.finish()?;
        let mut colors: BTreeMap<ColorId, Vec<Piece>> = BTreeMap::new();
        for piece in pieces {
            colors.entry(piece.color).or_default().push(piece);
        }
        let order = settings.order_options(layer, Point2::ZERO);
        routes.extend(colors.into_iter().map(|(color, pieces)| {
            let start = pieces.first().and_then(|p| p.points.first().copied()).unwrap_or_default();
            let mut route = order_with(pieces, &[color], start, &order);
            join_ends(&mut route, &settings.turns(layer.height));
            route
        }));
    }
    Ok((routes, rest))
}

/// A region of one colour.
struct Face {
    color: ColorId,
    polygon: Polygon,
}

/// Whether a face has as much of beads as it may be expected to have.
fn is_filled(face: &Face, route: &[Piece], height: f64) -> bool {
    let volume = |piece: &Piece| piece.length() * bead::area(piece.width, height);
    let volume: f64 = route.iter().map(volume).sum();
    volume >= LEAST_FILLED * face.polygon.area() * height
}

/// Makes one face of neighbouring ones too narrow for a bead: of two colours, of four, and so on,
/// until they are wide enough. Appends their pieces; how many colours became one in nearly all of
/// their area.
fn merge(
    mut narrow: Vec<Face>,
    last: ColorId,
    height: f64,
    fill: &(dyn Fn(&Face) -> Vec<Piece> + Sync),
    filled: &mut Vec<Vec<Piece>>,
) -> u16 {
    let (mut areas, mut together) = (Vec::new(), 2);
    while narrow.len() > 1 && together <= MOST_MERGED {
        let mut groups: BTreeMap<u16, Vec<Face>> = BTreeMap::new();
        for face in narrow.drain(..) {
            groups.entry(face.color.0 / together).or_default().push(face);
        }
        for (group, mut faces) in groups {
            if faces.len() == 1 {
                narrow.append(&mut faces);
                continue;
            }
            // The colour in the middle: none of the others is off by more than half of them.
            let color = ColorId(group * together + together / 2).min(last);
            let polygons: Vec<Polygon> = faces.into_iter().map(|face| face.polygon).collect();
            for polygon in region::union(&polygons, &[]) {
                let face = Face { color, polygon };
                let route = fill(&face);
                if is_filled(&face, &route, height) {
                    filled.push(route);
                    areas.push((together, face.polygon.area()));
                } else {
                    narrow.push(face);
                }
            }
        }
        together *= 2;
    }
    filled.extend(narrow.iter().map(fill));
    let mut left = MOST_AREA * areas.iter().map(|(_, area)| area).sum::<f64>();
    let enough = areas.iter().find(|(_, area)| {
        left -= area;
        left <= 0.0
    });
    enough.map_or(1, |&(together, _)| together)
}
