use fgm_core::{ColorId, Polygon, Role, bead};

use crate::{Inset, Path, Piece, walls::loops};

/// Loops that hold the part's rim to the bed on the first layer.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct BrimOptions {
    /// How far it reaches out from the part, mm: as many loops as come nearest to that, at least
    /// one; 0 is no brim.
    pub width: f64,
    /// Room between the part and the brim, mm; at 0 the brim's first bead is the outer wall's
    /// neighbour.
    pub gap: f64,
    /// Width of the beads, mm.
    pub bead_width: f64,
    /// Layer height, mm.
    pub height: f64,
}

impl Default for BrimOptions {
    fn default() -> Self {
        Self { width: 0.0, gap: 0.0, bead_width: 0.4, height: 0.2 }
    }
}

impl BrimOptions {
    /// How far the sides of the outer beads lie from the part, mm; 0 without a brim.
    pub fn reach(&self) -> f64 {
        match self.loops() {
            0 => 0.0,
            loops => self.distance(loops - 1) + 0.5 * self.bead_width,
        }
    }

    fn spacing(&self) -> f64 {
        bead::spacing(self.bead_width, self.height)
    }

    fn loops(&self) -> u32 {
        let spacing = self.spacing();
        let sizes = spacing > 0.0 && self.width.is_finite() && self.gap.is_finite();
        if !(sizes && self.width > 0.0 && self.gap >= 0.0) {
            return 0;
        }
        (self.width / spacing).round().max(1.0) as u32
    }

    /// From the part to a loop's centre, mm.
    fn distance(&self, index: u32) -> f64 {
        self.gap + (f64::from(index) + 1.0) * self.spacing() - 0.5 * self.bead_width
    }
}

/// Appends loops around every island of `region`, a [spacing](bead::spacing) apart, the outer ones
/// first, in one colour. Islands whose brims would meet share their loops. Holes get none, nor do
/// islands in holes.
///
/// Nothing for options without sense. Whether the loops fit on the bed is for the caller to check.
pub fn brim(
    region: &[Polygon],
    color: ColorId,
    options: &BrimOptions,
    inset: &dyn Inset,
    out: &mut Vec<Piece>,
) {
    let outside: Vec<Polygon> = region.iter().map(|p| Polygon::simple(p.outer.clone())).collect();
    // Islands in holes are swallowed here, and no border is offset against another.
    let outside = crate::region::union(&outside, &[]);
    for index in (0..options.loops()).rev() {
        let level = inset.inset(&outside, -options.distance(index));
        let paths = loops(&[level], options.bead_width, |_| Role::Skirt);
        out.extend(paths.into_iter().map(|path: Path| path.in_color(color)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ClipperInset, region, region_shapes::*};
    use fgm_core::Point2;
    use proptest::prelude::*;

    fn around(region: &[Polygon], width: f64, gap: f64) -> Vec<Piece> {
        let options = BrimOptions { width, gap, ..BrimOptions::default() };
        let mut out = Vec::new();
        brim(region, ColorId(2), &options, &ClipperInset::default(), &mut out);
        out
    }

    fn distance(p: Point2, a: Point2, b: Point2) -> f64 {
        let share = (p - a).dot(b - a) / (b - a).length_squared().max(1e-300);
        p.distance(a + (b - a) * share.clamp(0.0, 1.0))
    }

    /// The least distance of the loops' vertices and middles from the part.
    fn nearest(region: &[Polygon], pieces: &[Piece]) -> f64 {
        let points = pieces.iter().flat_map(|p| p.points.windows(2));
        let points = points.flat_map(|w| [w[0], w[0].midpoint(w[1])]);
        let edges: Vec<_> = region.iter().flat_map(|p| p.outer.edges()).collect();
        points
            .flat_map(|p| edges.iter().map(move |&(a, b)| distance(p, a, b)))
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_brim_fills_its_width_from_the_outside_in() {
        for (width, gap, loops) in [(4.0, 0.0, 11), (0.1, 0.0, 1), (2.0, 0.3, 6), (0.0, 1.0, 0)] {
            let part = [rectangle(0.0, 0.0, 20.0, 20.0)];
            let pieces = around(&part, width, gap);
            assert_eq!(pieces.len(), loops, "{width} {gap}");
            assert!(pieces.iter().all(|p| p.is_loop() && p.role == Role::Skirt));
            assert!(pieces.windows(2).all(|w| w[0].length() > w[1].length()));
            if loops == 0 {
                continue;
            }
            let spacing = bead::spacing(WIDTH, HEIGHT);
            let first = gap + spacing - 0.5 * WIDTH;
            assert!((nearest(&part, &pieces) - first).abs() < 1e-4);
            // As much as the band that it covers.
            let (low, high) = (first - 0.5 * spacing, first + (loops as f64 - 0.5) * spacing);
            let band = 80.0 * (high - low) + 4.0 * (high * high - low * low);
            let length: f64 = pieces.iter().map(Piece::length).sum();
            assert!((length * spacing / band - 1.0).abs() < 1e-3, "{length} {band}");
        }
    }

    #[test]
    fn islands_share_their_loops_and_holes_have_none() {
        let apart = [rectangle(0.0, 0.0, 10.0, 10.0), rectangle(13.0, 0.0, 10.0, 10.0)];
        let pieces = around(&apart, 4.0, 0.0);
        // Outer loops go around both, inner ones around each.
        assert!(pieces[0].length() > 70.0 && pieces.len() > 11 && pieces.len() < 22);
        let first = bead::spacing(WIDTH, HEIGHT) - 0.5 * WIDTH;
        assert!((nearest(&apart, &pieces) - first).abs() < 1e-4);

        let bored = [tube(15.0, 6.0)];
        let pieces = around(&bored, 1.0, 0.0);
        assert!(pieces.iter().all(|p| p.points.iter().all(|q| q.length() > 15.0)));
        let mut nested = bored.to_vec();
        nested.push(rectangle(-1.0, -1.0, 2.0, 2.0));
        assert_eq!(around(&nested, 1.0, 0.0).len(), pieces.len());
    }

    #[test]
    fn options_without_sense_give_no_brim() {
        let part = [rectangle(0.0, 0.0, 20.0, 20.0)];
        for (width, gap) in [(f64::NAN, 0.0), (f64::INFINITY, 0.0), (-1.0, 0.0), (3.0, f64::NAN)] {
            assert!(around(&part, width, gap).is_empty(), "{width} {gap}");
        }
        assert!(around(&[], 3.0, 0.0).is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn no_loop_touches_the_part(
            boxes in prop::collection::vec((0..40i32, 0..40i32, 2..12i32, 2..12i32), 1..6),
            gap in 0.0..1.0f64,
        ) {
            let boxes: Vec<_> = boxes
                .iter()
                .map(|&(x, y, w, h)| rectangle(x.into(), y.into(), w.into(), h.into()))
                .collect();
            let part = boxes.iter().fold(Vec::new(), |all, b| {
                region::union(&all, std::slice::from_ref(b))
            });
            let options = BrimOptions { width: 3.0, gap, ..BrimOptions::default() };
            let pieces = around(&part, 3.0, gap);
            let first = gap + bead::spacing(WIDTH, HEIGHT) - 0.5 * WIDTH;
            // A hole's border is no border of the brim's.
            let outside: Vec<_> = part.iter().map(|p| Polygon::simple(p.outer.clone())).collect();
            prop_assert!(nearest(&outside, &pieces) > first - 3e-3);
            let beyond = |p: &Point2| {
                outside.iter().flat_map(|o| o.outer.edges())
                    .map(|(a, b)| distance(*p, a, b)).fold(f64::INFINITY, f64::min)
            };
            // Mitred corners stand out by less than a half.
            let reach = 1.5 * options.reach();
            prop_assert!(pieces.iter().flat_map(|p| &p.points).all(|p| beyond(p) < reach));
        }
    }
}
