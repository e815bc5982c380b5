use std::borrow::Cow;

use fgm_arrange::{ArrangeOptions, Arrangement, Chain, FaceId};
use fgm_core::{Band, MaterialField, Point2, Polygon, Sectioner, Span};

use crate::{
    boundary_lines::BoundaryLine,
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
        let z = layer.cut;
        let material = job.design.fractions.as_ref();
        let boundaries = timed(&mut seconds.contour, || {
            check_material(region, z, material)?;
            job.boundaries.in_layer(region, z)
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
                    Ok(Some(job.bands.at(inside.extend(z))?))
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

/// Step of the samples at which the material is looked at, mm, and the fewest along a side.
const CHECK_STEP: f64 = 2.0;
const CHECK_LEAST: usize = 16;

/// That the material is known all over the region, on a grid of samples.
///
/// The isolines pass over what is no number, since a design need not say what lies outside it;
/// inside it, such a place would be printed in a neighbour's colour.
pub(crate) fn check_material(
    region: &[Polygon],
    z: f64,
    material: &dyn MaterialField,
) -> Result<(), SliceError> {
    let fraction = material.fraction(0).at_z(z);
    let mut values = Vec::new();
    for polygon in region {
        let bounds = polygon.bounds();
        let count = |side: f64| ((side / CHECK_STEP).ceil() as usize).max(CHECK_LEAST);
        let (columns, rows) = (count(bounds.size().x), count(bounds.size().y));
        let step = bounds.size() / Point2::new(columns as f64, rows as f64);
        let row = |j: usize| {
            let place = move |i: usize| Point2::new(i as f64 + 0.5, j as f64 + 0.5);
            (0..columns).map(move |i| bounds.min + place(i) * step)
        };
        let points: Vec<Point2> = (0..rows).flat_map(row).collect();
        values.clear();
        values.resize(points.len(), 0.0);
        fraction.eval_into(&points, &mut values);
        for (p, value) in points.iter().zip(&values) {
            if value.is_nan() && polygon.contains(*p) {
                material.mixture(p.extend(z))?;
            }
        }
    }
    Ok(())
}

fn arrange(
    region: &[Polygon],
    boundaries: &[Cow<'_, BoundaryLine>],
) -> Result<Arrangement<Line>, SliceError> {
    let outlines = region.iter().flat_map(Polygon::rings).map(|ring| Chain {
        points: &ring.points,
        closed: true,
        label: Line::Outline,
    });
    let boundaries = boundaries.iter().map(|line| Chain {
        points: &line.points,
        closed: line.closed,
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
