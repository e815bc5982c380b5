//! Sections too short to print well, shared out between their neighbours.

use fgm_core::{Band, ColorId, MaterialField, Point2, Sectioner, Span, point_at};
use fgm_palette::Palette;

use crate::heights::Heights;

/// Halvings in the search for the place where two colours are equally wrong.
const HALVINGS: usize = 26;
/// What the search may add to an error.
const HAIR: f64 = 1e-6;

/// Cuts paths as another sectioner does, and shares out what is short between the stretches before
/// and after it on the path, as far as no place is then off by more than a band.
///
/// Where the gradient is steep every other colour is left out: the others each reach over half of
/// its band on either side, so that the error doubles and the pieces do too.
pub(crate) struct ShortSections<'a> {
    pub(crate) sections: &'a dyn Sectioner<Band>,
    pub(crate) material: &'a dyn MaterialField,
    pub(crate) palette: &'a Palette,
    pub(crate) heights: Heights,
    /// Shorter stretches are shared out, mm.
    pub(crate) shortest: f64,
}

/// A stretch among its neighbours.
struct Stretch {
    span: Span<Band>,
    length: f64,
    before: Option<usize>,
    after: Option<usize>,
    gone: bool,
}

impl Sectioner<Band> for ShortSections<'_> {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        self.sections.section(path, spans);
        if spans.len() < 2 {
            return;
        }
        let line = Line::new(path);
        let count = spans.len();
        let stretch = |(i, span): (usize, &Span<Band>)| Stretch {
            span: *span,
            length: line.length(span.from, span.to),
            before: i.checked_sub(1),
            after: (i + 1 < count).then_some(i + 1),
            gone: false,
        };
        let mut stretches: Vec<Stretch> = spans.iter().enumerate().map(stretch).collect();
        let mut shortest_first: Vec<usize> =
            (0..count).filter(|&i| stretches[i].length < self.shortest).collect();
        shortest_first
            .sort_by(|&a, &b| stretches[a].length.total_cmp(&stretches[b].length).then(a.cmp(&b)));
        for i in shortest_first {
            // Its neighbours may have lengthened it since.
            if stretches[i].length < self.shortest {
                self.share_out(&line, &mut stretches, i);
            }
        }
        spans.clear();
        for stretch in stretches.iter().filter(|stretch| !stretch.gone) {
            match spans.last_mut() {
                Some(last) if last.label == stretch.span.label => last.to = stretch.span.to,
                _ => spans.push(stretch.span),
            }
        }
    }
}

impl ShortSections<'_> {
    /// Gives a stretch to its neighbours, if both may have it.
    fn share_out(&self, line: &Line<'_>, stretches: &mut [Stretch], i: usize) {
        let Stretch { span, before, after, .. } = stretches[i];
        let color = |i: usize| {
            let label = stretches[i].span.label;
            label.is_pure().then_some(label.first)
        };
        if !span.label.is_pure() {
            return;
        }
        let cut = match (before, after) {
            (Some(before), Some(after)) => {
                let (Some(one), Some(other)) = (color(before), color(after)) else { return };
                self.middle(line, &span, one, other)
            }
            (Some(before), None) => {
                let Some(color) = color(before) else { return };
                self.fits(line, &span, color).then_some(span.to)
            }
            (None, Some(after)) => {
                let Some(color) = color(after) else { return };
                self.fits(line, &span, color).then_some(span.from)
            }
            (None, None) => None,
        };
        let Some(cut) = cut else { return };
        stretches[i].gone = true;
        if let Some(before) = before {
            stretches[before].span.to = cut;
            stretches[before].length += line.length(span.from, cut);
            stretches[before].after = after;
        }
        if let Some(after) = after {
            stretches[after].span.from = cut;
            stretches[after].length += line.length(cut, span.to);
            stretches[after].before = before;
        }
    }

    /// How far a colour is from what the design asks for at a place; infinite where that is nothing.
    fn error(&self, line: &Line<'_>, at: f64, color: ColorId) -> f64 {
        let z = self.heights.at(line.share(at));
        let mixture = self.material.mixture(point_at(line.points, at).extend(z));
        mixture.map_or(f64::INFINITY, |mixture| mixture.distance(&self.palette.state(color)))
    }

    fn most(&self) -> f64 {
        self.palette.band_width() + HAIR
    }

    /// Whether a colour will do all over a stretch, looked at where it begins, ends, and between.
    fn fits(&self, line: &Line<'_>, span: &Span<Band>, color: ColorId) -> bool {
        let at = |share: f64| span.from + share * (span.to - span.from);
        [0.0, 0.5, 1.0].iter().all(|&share| self.error(line, at(share), color) <= self.most())
    }

    /// The place in a stretch up to which the colour before it and from which the one after it
    /// will do, both as wrong there; none where they will not.
    fn middle(
        &self,
        line: &Line<'_>,
        span: &Span<Band>,
        before: ColorId,
        after: ColorId,
    ) -> Option<f64> {
        let (mut low, mut high) = (span.from, span.to);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.error(line, middle, before) < self.error(line, middle, after) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let cut = 0.5 * (low + high);
        let (first, second) = (Span { to: cut, ..*span }, Span { from: cut, ..*span });
        (self.fits(line, &first, before) && self.fits(line, &second, after)).then_some(cut)
    }
}

/// A path with the lengths up to its vertices.
struct Line<'a> {
    points: &'a [Point2],
    lengths: Vec<f64>,
}

impl<'a> Line<'a> {
    fn new(points: &'a [Point2]) -> Self {
        let mut sum = 0.0;
        let mut lengths = Vec::with_capacity(points.len());
        lengths.push(0.0);
        lengths.extend(points.windows(2).map(|w| {
            sum += w[0].distance(w[1]);
            sum
        }));
        Self { points, lengths }
    }

    fn length(&self, from: f64, to: f64) -> f64 {
        (self.up_to(to) - self.up_to(from)).max(0.0)
    }

    fn up_to(&self, at: f64) -> f64 {
        let segment = (at.max(0.0) as usize).min(self.lengths.len() - 1);
        let next = self.lengths.get(segment + 1).unwrap_or(&self.lengths[segment]);
        self.lengths[segment] + (next - self.lengths[segment]) * (at - segment as f64)
    }

    /// The share of the length up to a parameter.
    fn share(&self, at: f64) -> f64 {
        let whole = self.lengths.last().copied().unwrap_or(0.0);
        if whole > 0.0 { (self.up_to(at) / whole).clamp(0.0, 1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Zipper, boundaries::Bands, field_sections::FieldSections};

    /// The colours and lengths along a line from x = -10 to 10 whose fraction rises from 0 to 1 as
    /// `fraction` says.
    fn cut(fraction: &str, colors: usize, shortest: f64) -> Vec<(u16, f64)> {
        let source = format!(
            "fgrade([\"{fraction}\", \"1 - ({fraction})\"], [\"a\", \"b\"]) {{ cube(20); }}"
        );
        let loaded = fgm_design::parse_vcad(&source, ".".as_ref(), &Default::default()).unwrap();
        let material = loaded.design.fractions.as_ref();
        let palette = Palette::new(2, colors).unwrap();
        let bands = Bands::new(material, &palette, Zipper::NONE);
        let sections = FieldSections::new(bands, 0.0, 0.5, 1e-9);
        let heights = Heights::flat(0.0);
        let short =
            ShortSections { sections: &sections, material, palette: &palette, heights, shortest };
        let path = [Point2::new(-10.0, 0.0), Point2::new(10.0, 0.0)];
        let mut spans = Vec::new();
        short.section(&path, &mut spans);
        let whole: f64 = spans.iter().map(|span| span.to - span.from).sum();
        assert!((whole - 1.0).abs() < 1e-12);
        let length = |span: &Span<Band>| (20e3 * (span.to - span.from)).round() / 1e3;
        spans.iter().map(|span| (span.label.first.0, length(span))).collect()
    }

    #[test]
    fn every_other_colour_is_left_out_where_all_are_short() {
        let eight = cut("x/20 + 0.5", 8, 2.4);
        assert_eq!(eight.len(), 8, "{eight:?}");
        let found = cut("x/20 + 0.5", 8, 2.6);
        assert!(found.len() <= 5 && found.iter().all(|piece| piece.1 >= 2.5), "{found:?}");
    }

    #[test]
    fn what_would_be_off_by_more_than_a_band_stays() {
        // All eight bands in 2 mm, then nothing changes.
        let steep = cut("min(1, max(0, x/2 + 0.5))", 8, 5.0);
        assert!(steep.len() >= 4, "{steep:?}");
        assert_eq!((steep[0].0, steep[steep.len() - 1].0), (0, 7), "{steep:?}");
    }

    #[test]
    fn a_short_end_goes_with_its_neighbour() {
        assert_eq!(cut("x/20 + 0.5 + 0.24", 2, 6.0), [(0, 5.2), (1, 14.8)]);
        assert_eq!(cut("x/40 + 0.5 + 0.23", 2, 2.0), [(1, 20.0)]);
    }
}
