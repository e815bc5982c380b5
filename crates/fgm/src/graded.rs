use fgm_arrange::{ArrangeOptions, Arrangement, Chain, FaceId};
use fgm_contour::{ContourOptions, isolines};
use fgm_core::{Band, Bounds2, MaterialField, Point2, Polygon, Polyline, Sectioner, Span};
use fgm_palette::Palette;

use crate::{
    error::SliceError,
    job::Job,
    layers::Layer,
    stages::{StageSeconds, timed},
};

/// What a chain of the arrangement is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    /// A border of the part.
    Outline,
    /// A palette boundary.
    Boundary,
}

/// One layer divided into faces of one band each.
pub(crate) struct GradedLayer {
    arrangement: Arrangement<Line>,
    /// By face; none outside the part.
    bands: Vec<Option<Band>>,
}

impl GradedLayer {
    /// Divides `region`, a layer's part, by the palette's boundaries.
    pub(crate) fn new(
        job: &Job<'_>,
        layer: &Layer,
        region: &[Polygon],
        seconds: &mut StageSeconds,
    ) -> Result<Self, SliceError> {
        let (z, palette) = (layer.cut, job.palette);
        let material = job.design.fractions.as_ref();
        let boundaries = timed(&mut seconds.contour, || {
            palette_boundaries(region, z, material, palette, &job.isolines)
        })?;
        timed(&mut seconds.arrange, || {
            let arrangement = arrange(region, &boundaries)?;
            let bands = arrangement
                .faces()
                .map(|face| {
                    let inside = face.inside_point();
                    if !region.iter().any(|polygon| polygon.contains(inside)) {
                        return Ok(None);
                    }
                    let mixture = material.mixture(inside.extend(z))?;
                    Ok(Some(palette.band(&mixture)))
                })
                .collect::<Result<_, SliceError>>()?;
            Ok(Self { arrangement, bands })
        })
    }

    /// How many faces the part has in this layer.
    pub(crate) fn count(&self) -> usize {
        self.bands.iter().flatten().count()
    }

    /// The faces of the part with their bands, in the arrangement's order.
    pub(crate) fn faces(&self) -> impl Iterator<Item = (Band, Polygon)> + '_ {
        self.arrangement
            .faces()
            .zip(&self.bands)
            .filter_map(|(face, band)| band.map(|band| (band, face.polygon())))
    }

    fn band(&self, face: Option<FaceId>) -> Option<Band> {
        face.and_then(|face| self.bands[face.0 as usize])
    }
}

/// The lines at which the palette changes, inside the region's bounds.
fn palette_boundaries(
    region: &[Polygon],
    z: f64,
    material: &dyn MaterialField,
    palette: &Palette,
    options: &ContourOptions,
) -> Result<Vec<(bool, Vec<Point2>)>, SliceError> {
    let bounds = region.iter().fold(Bounds2::EMPTY, |b, p| b.union(&p.bounds()));
    let mut lines = Vec::new();
    if bounds.is_empty() {
        return Ok(lines);
    }
    let window = bounds.grown(options.cell);
    for index in 0..palette.materials() {
        let levels = palette.levels(index);
        if levels.is_empty() {
            continue;
        }
        let fraction = material.fraction(index).at_z(z);
        for level in isolines(fraction.as_ref(), &window, levels, options)? {
            lines.extend(level.rings.into_iter().map(|ring| (true, ring.points)));
            lines.extend(level.lines.into_iter().map(|Polyline { points }| (false, points)));
        }
    }
    Ok(lines)
}

fn arrange(
    region: &[Polygon],
    boundaries: &[(bool, Vec<Point2>)],
) -> Result<Arrangement<Line>, SliceError> {
    let outlines = region.iter().flat_map(Polygon::rings).map(|ring| Chain {
        points: &ring.points,
        closed: true,
        label: Line::Outline,
    });
    let boundaries = boundaries.iter().map(|(closed, points)| Chain {
        points,
        closed: *closed,
        label: Line::Boundary,
    });
    let chains: Vec<_> = outlines.chain(boundaries).collect();
    Ok(Arrangement::new(&chains, &ArrangeOptions::default())?)
}

impl Sectioner<Band> for GradedLayer {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        let mut cuts = Vec::new();
        self.arrangement.cut(path, &mut cuts);
        spans.clear();
        // What lies in no face of the part (a path on its border) goes with what comes before it,
        // or after it at the start: every stretch is printed in some colour of its own path.
        let mut pending = None;
        for cut in cuts {
            let from = pending.take().unwrap_or(cut.from);
            match (self.band(cut.label), spans.last_mut()) {
                (Some(band), Some(last)) if last.label == band => last.to = cut.to,
                (None, Some(last)) => last.to = cut.to,
                (Some(band), _) => spans.push(Span { from, to: cut.to, label: band }),
                (None, None) => pending = Some(from),
            }
        }
        if let (Some(from), true, Some(band)) = (pending, spans.is_empty(), self.nearest(path)) {
            spans.push(Span { from, to: path.len().saturating_sub(1) as f64, label: band });
        }
    }
}

impl GradedLayer {
    /// The band of the face whose inside point is nearest to a path that is in no face at all.
    fn nearest(&self, path: &[Point2]) -> Option<Band> {
        let from = *path.first()?;
        let faces = self.arrangement.faces().zip(&self.bands);
        faces
            .filter_map(|(face, band)| {
                band.map(|band| (face.inside_point().distance_squared(from), band))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, band)| band)
    }
}
