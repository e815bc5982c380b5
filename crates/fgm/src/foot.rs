use fgm_core::Polygon;
use fgm_toolpath::{ClipperInset, Inset, region};

/// Parts of a region narrower than this share of a bead are corners' tips, not thin parts.
const TIP: f64 = 0.5;

/// The outline of the first layer, drawn in by `by` mm against the elephant's foot: the bed
/// squeezes the first layer's beads outwards.
///
/// What would be left narrower than a bead of `width` mm keeps its width, so that thin parts are
/// still printed.
pub(crate) fn drawn_in(
    outline: &[Polygon],
    by: f64,
    width: f64,
    inset: &ClipperInset,
) -> Vec<Polygon> {
    let least = by + 0.5 * width;
    let wide = inset.inset(&inset.inset(outline, least), -least);
    let narrow = region::difference(outline, &wide);
    let core = inset.inset(&narrow, 0.5 * TIP * width);
    let shrunk = inset.inset(outline, by);
    if core.is_empty() {
        return shrunk;
    }
    // Grown back, and on into what was drawn in around it.
    let thin = inset.inset(&core, -(0.5 * TIP * width + by));
    region::union(&shrunk, &region::intersection(&thin, outline))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::{Point2, Ring};

    fn polygon(points: &[(f64, f64)]) -> Vec<Polygon> {
        let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        vec![Polygon::simple(Ring::new(points))]
    }

    fn drawn(outline: &[Polygon], by: f64) -> Vec<Polygon> {
        drawn_in(outline, by, 0.4, &ClipperInset::default())
    }

    #[test]
    fn wide_parts_are_drawn_in_and_thin_ones_kept() {
        let square = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
        assert!((region::area(&drawn(&square, 0.2)) - 9.6 * 9.6).abs() < 1e-3);
        let strip = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 0.6), (0.0, 0.6)]);
        assert!((region::area(&drawn(&strip, 0.2)) - 6.0).abs() < 1e-2);
        // A fin on a block stays on the block.
        let fin = polygon(&[
            (0.0, 0.0),
            (10.0, 0.0),
            (10.0, 4.7),
            (15.0, 4.7),
            (15.0, 5.3),
            (10.0, 5.3),
            (10.0, 10.0),
            (0.0, 10.0),
        ]);
        let got = drawn(&fin, 0.2);
        assert_eq!(got.len(), 1);
        assert!(
            got[0].contains(Point2::new(14.9, 4.75)) && !got[0].contains(Point2::new(9.9, 2.0))
        );
    }
}
