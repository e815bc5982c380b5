//! Sections of paths straight from the material, without faces.

use std::sync::OnceLock;

use fgm_contour::{Crossing, Crossings};
use fgm_core::{Band, MaterialError, Point2, Sectioner, Span, point_at};

use crate::boundaries::{Bands, BoundaryField};

/// Cuts paths where they cross the palette's boundaries, found along the path by root finding.
///
/// The same spans as those by faces, whose borders are these boundaries traced and simplified; but
/// no contour is traced and nothing arranged, and the ends lie on the true boundary.
pub(crate) struct FieldSections<'a> {
    bands: Bands<'a>,
    z: f64,
    boundaries: Vec<BoundaryField<'a>>,
    step: f64,
    tolerance: f64,
    /// The first place without a mixture.
    failure: OnceLock<MaterialError>,
}

impl<'a> FieldSections<'a> {
    /// Sections at height `z`: the field is looked at every `step` mm, and boundaries are found to
    /// `tolerance` mm.
    pub(crate) fn new(bands: Bands<'a>, z: f64, step: f64, tolerance: f64) -> Self {
        let boundaries = bands.boundary_fields(z);
        Self { bands, z, boundaries, step, tolerance, failure: OnceLock::new() }
    }

    /// Whether all that was sectioned has a mixture.
    pub(crate) fn finish(self) -> Result<(), MaterialError> {
        self.failure.into_inner().map_or(Ok(()), Err)
    }

    /// The places where a path crosses any boundary, in order.
    fn cuts(&self, path: &[Point2]) -> Vec<f64> {
        let mut crossings = Crossings::new(self.step, self.tolerance);
        let (mut found, mut cuts): (Vec<Crossing>, Vec<f64>) = Default::default();
        for BoundaryField { field, levels } in &self.boundaries {
            crossings.find(field.as_ref(), path, levels, &mut found);
            cuts.extend(found.iter().map(|crossing| crossing.at));
        }
        if self.boundaries.len() > 1 {
            cuts.sort_by(f64::total_cmp);
        }
        cuts
    }

    /// The band of a stretch between two cuts, which has one but for points where it touches a
    /// boundary: asked for at two places, and where these differ at a third.
    fn band(&self, path: &[Point2], from: f64, to: f64) -> Option<Band> {
        let at = |share: f64| self.band_at(point_at(path, from + share * (to - from)));
        let (one, other) = (at(0.38), at(0.62));
        if one == other { one } else { at(0.5).or(one).or(other) }
    }

    fn band_at(&self, p: Point2) -> Option<Band> {
        match self.bands.at(p.extend(self.z)) {
            Ok(band) => Some(band),
            Err(error) => {
                self.failure.get_or_init(|| error);
                None
            }
        }
    }
}

impl Sectioner<Band> for FieldSections<'_> {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        spans.clear();
        if path.len() < 2 {
            return;
        }
        let end = (path.len() - 1) as f64;
        let mut from = 0.0;
        for to in self.cuts(path).into_iter().chain([end]) {
            if to <= from && spans.last().is_some() {
                continue;
            }
            let Some(band) = self.band(path, from, to) else { continue };
            match spans.last_mut() {
                Some(last) if last.label == band => last.to = to,
                _ => spans.push(Span { from, to, label: band }),
            }
            from = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Zipper;
    use fgm_palette::Palette;

    #[test]
    fn a_line_that_touches_a_boundary_in_its_middle_keeps_its_colour() {
        let source = "fgrade([\"0.5 - x*x/400\", \"0.5 + x*x/400\"], [\"a\", \"b\"]) { cube(20); }";
        let loaded = fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap();
        let material = loaded.design.fractions.as_ref();
        let palette = Palette::new(2, 4).unwrap();
        let bands = Bands::new(material, &palette, Zipper::NONE);
        let sections = FieldSections::new(bands, 0.0, 0.5, 1e-6);
        let line = [Point2::new(-8.0, 0.0), Point2::new(8.0, 0.0)];
        let mut spans = Vec::new();
        sections.section(&line, &mut spans);
        let beside = palette.band(&material.mixture(Point2::new(3.0, 0.0).extend(0.0)).unwrap());
        assert!(spans.iter().all(|span| span.label == beside), "{spans:?}");
        assert_eq!((spans[0].from, spans[spans.len() - 1].to), (0.0, 1.0));
        assert_eq!(sections.finish(), Ok(()));
    }
}
