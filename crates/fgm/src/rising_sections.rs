//! Sections of a path that rises, straight from the material.

use std::sync::OnceLock;

use fgm_core::{Band, MaterialError, Point2, Sectioner, Span, slice_path};

use crate::{boundaries::Bands, field_sections::FieldSections, heights::Heights};

/// The path is cut into so many parts of one height each: where it rises by a layer of 0.2 mm, the
/// height is off by 0.00625 mm at most.
const PARTS: u32 = 16;

/// Cuts a path as [`FieldSections`] does, at the height that each part of it has.
pub(crate) struct RisingSections<'a> {
    bands: Bands<'a>,
    heights: Heights,
    step: f64,
    tolerance: f64,
    /// The first place without a mixture.
    failure: OnceLock<MaterialError>,
}

impl<'a> RisingSections<'a> {
    /// Sections at these heights; the rest as for [`FieldSections::new`].
    pub(crate) fn new(bands: Bands<'a>, heights: Heights, step: f64, tolerance: f64) -> Self {
        Self { bands, heights, step, tolerance, failure: OnceLock::new() }
    }

    /// Whether all that was sectioned has a mixture.
    pub(crate) fn finish(self) -> Result<(), MaterialError> {
        self.failure.into_inner().map_or(Ok(()), Err)
    }

    /// Appends the spans of the part of a path between two parameters, all at one height.
    fn part(&self, path: &[Point2], (from, to): (f64, f64), z: f64, spans: &mut Vec<Span<Band>>) {
        let mut part = Vec::new();
        slice_path(path, from, to, &mut part);
        if part.len() < 2 {
            return;
        }
        let sections = FieldSections::new(self.bands, z, self.step, self.tolerance);
        let mut found = Vec::new();
        sections.section(&part, &mut found);
        if let Err(error) = sections.finish() {
            self.failure.get_or_init(|| error);
        }
        let last = part.len() - 1;
        // The path's parameter at a vertex of the part.
        let vertex = |i: usize| match i {
            0 => from,
            i if i == last => to,
            i => from.floor() + i as f64,
        };
        let place = |at: f64| {
            let segment = (at as usize).min(last - 1);
            let (a, b) = (vertex(segment), vertex(segment + 1));
            a + (b - a) * (at - segment as f64)
        };
        for (i, span) in found.iter().enumerate() {
            let end = if i + 1 == found.len() { to } else { place(span.to) };
            match spans.last_mut() {
                Some(last) if last.label == span.label => last.to = end,
                Some(Span { to: begin, .. }) => {
                    let from = *begin;
                    spans.push(Span { from, to: end, label: span.label });
                }
                None => spans.push(Span { from: 0.0, to: end, label: span.label }),
            }
        }
    }
}

impl Sectioner<Band> for RisingSections<'_> {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        spans.clear();
        if path.len() < 2 {
            return;
        }
        let parts = if self.heights.is_flat() { 1 } else { PARTS };
        let whole: f64 = path.windows(2).map(|w| w[0].distance(w[1])).sum();
        let end = (path.len() - 1) as f64;
        let (mut from, mut segment, mut before) = (0.0, 0, 0.0);
        for part in 0..parts {
            let share = |i: f64| i / f64::from(parts);
            let length = whole * share(f64::from(part) + 1.0);
            let mut to = end;
            while let Some(w) = path.get(segment..segment + 2).filter(|_| part + 1 < parts) {
                let step = w[0].distance(w[1]);
                if before + step >= length {
                    to = segment as f64 + if step > 0.0 { (length - before) / step } else { 1.0 };
                    break;
                }
                (segment, before) = (segment + 1, before + step);
            }
            self.part(path, (from, to), self.heights.at(share(f64::from(part) + 0.5)), spans);
            from = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Zipper;
    use fgm_palette::Palette;

    /// The colours along a line of 40 mm in pieces of these lengths, and where they end, mm.
    fn cut(fraction: &str, lengths: &[f64], heights: Heights) -> Vec<(u16, f64)> {
        let source = format!(
            "fgrade([\"{fraction}\", \"1 - ({fraction})\"], [\"a\", \"b\"]) {{ cube(90); }}"
        );
        let loaded = fgm_design::parse_vcad(&source, ".".as_ref(), &Default::default()).unwrap();
        let palette = Palette::new(2, 4).unwrap();
        let bands = Bands::new(loaded.design.fractions.as_ref(), &palette, Zipper::NONE);
        let sections = RisingSections::new(bands, heights, 0.5, 1e-9);
        let mut x = 0.0;
        let mut path = vec![Point2::ZERO];
        path.extend(lengths.iter().map(|length| {
            x += length;
            Point2::new(x, 0.0)
        }));
        let mut spans = Vec::new();
        sections.section(&path, &mut spans);
        assert_eq!(sections.finish(), Ok(()));
        assert_eq!((spans[0].from, spans[spans.len() - 1].to), (0.0, lengths.len() as f64));
        assert!(spans.windows(2).all(|w| w[0].to == w[1].from && w[0].label != w[1].label));
        let place = |at: f64| fgm_core::point_at(&path, at).x;
        spans.iter().map(|s| (s.label.first.0, (place(s.to) * 1e3).round() / 1e3)).collect()
    }

    #[test]
    fn the_colour_changes_where_the_path_is_as_high() {
        let rising = Heights { from: 1.0, to: 3.0 };
        for lengths in [&[40.0][..], &[10.0, 10.0, 20.0], &[0.5, 0.0, 39.0, 0.5], &[2.5; 16]] {
            // By height alone: within half a part of 2.5 mm.
            let found = cut("z/4", lengths, rising);
            assert_eq!(found.iter().map(|s| s.0).collect::<Vec<_>>(), [1, 2], "{found:?}");
            assert!((found[0].1 - 20.0).abs() <= 1.25, "{found:?}");
            // By place alone: exactly.
            assert_eq!(cut("x/80 + 0.5", lengths, rising), [(2, 20.0), (3, 40.0)]);
            assert_eq!(cut("z/4", lengths, Heights::flat(2.5)), [(2, 40.0)]);
            // By both, 0.4 + x/200 + (1 + x/20)/40: 0.5 at 12, 0.75 beyond the end.
            let found = cut("x/200 + z/40 + 0.4", lengths, rising);
            assert!(found.len() == 2 && (found[0].1 - 12.0).abs() < 0.3, "{found:?}");
        }
    }

    #[test]
    fn a_place_without_a_mixture_is_told() {
        let source = "fgrade([\"sqrt(2 - z)\", \"1 - sqrt(2 - z)\"], [\"a\", \"b\"]) { cube(9); }";
        let loaded = fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap();
        let palette = Palette::new(2, 4).unwrap();
        let bands = Bands::new(loaded.design.fractions.as_ref(), &palette, Zipper::NONE);
        let sections = RisingSections::new(bands, Heights { from: 1.5, to: 2.5 }, 0.5, 1e-6);
        sections.section(&[Point2::ZERO, Point2::X], &mut Vec::new());
        assert!(sections.finish().is_err());
    }
}
