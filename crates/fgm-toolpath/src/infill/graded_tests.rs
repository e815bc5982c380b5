use super::*;
use crate::{ClipperInset, Pattern, region_shapes::*};

fn lines(region: &[Polygon], density: &dyn PlanarField, pattern: Pattern, angle: f64) -> Vec<Path> {
    let options = InfillOptions { pattern, angle, ..InfillOptions::new(WIDTH, HEIGHT) };
    infill_graded(region, density, 0.5, &options, &ClipperInset::default()).unwrap()
}

/// Volume of beads inside a box, over the box's.
fn share(paths: &[Path], low: Point2, high: Point2) -> f64 {
    let mut length = 0.0;
    for (a, b) in paths.iter().flat_map(segments) {
        // The part of the segment inside, by the four sides (Liang and Barsky).
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (start, step) = (a[axis], b[axis] - a[axis]);
            if step == 0.0 {
                if start < low[axis] || start >= high[axis] {
                    to = from;
                }
                continue;
            }
            let (p, q) = ((low[axis] - start) / step, (high[axis] - start) / step);
            from = from.max(p.min(q));
            to = to.min(p.max(q));
        }
        length += a.distance(b) * (to - from).max(0.0);
    }
    let size = high - low;
    length * fgm_core::bead::spacing(WIDTH, HEIGHT) / (size.x * size.y)
}

#[test]
fn ranks_are_spread_evenly() {
    let mut all: Vec<f64> = (0..i64::from(RANKS)).map(threshold).collect();
    assert!(all[..4] == [0.5, 512.5, 256.5, 768.5].map(|r| r / 1024.0), "{:?}", &all[..4]);
    assert_eq!(threshold(-1), threshold(1023));
    // Among any lines side by side, within three of the share.
    for density in [0.05, 0.15, 0.4, 0.77] {
        for count in [10, 50, 200] {
            for from in 0..300 {
                let kept = (from..from + count).filter(|&i| threshold(i) < density).count() as f64;
                assert!((kept - density * count as f64).abs() < 3.0, "{density} {count} {from}");
            }
        }
    }
    all.sort_by(f64::total_cmp);
    assert!(all.windows(2).all(|w| (w[1] - w[0] - 1.0 / 1024.0).abs() < 1e-12));
}

/// Everywhere away from the border: over 20 mm squares (56 lines of a solid filling, shared by the
/// directions) within 0.036 of the volume, two lines', for lines of one direction, on the whole within 3 % of
/// what is asked for.
#[test]
fn the_local_volume_follows_the_density() {
    let region = [rectangle(0.0, 0.0, 120.0, 120.0)];
    let ramp = |p: Point2| 0.05 + 0.6 * p.x / 120.0;
    let hill = |p: Point2| 0.8 * (-(p - 60.0).length_squared() / 1800.0).exp();
    for (name, field) in [("ramp", &ramp as &dyn PlanarField), ("hill", &hill)] {
        for pattern in [Pattern::Rectilinear, Pattern::Aligned, Pattern::Grid, Pattern::Triangles] {
            for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_2] {
                let paths = lines(&region, field, pattern, angle);
                let (mut all, mut wanted) = (0.0, 0.0);
                let mut worst = 0.0_f64;
                for (i, j) in (0..25).map(|k| (k / 5, k % 5)) {
                    let low = Point2::new(10.0 + 20.0 * f64::from(i), 10.0 + 20.0 * f64::from(j));
                    let mean: f64 = (0..400)
                        .map(|k| {
                            let cell = Point2::new(f64::from(k / 20), f64::from(k % 20)) + 0.5;
                            field.eval(low + cell)
                        })
                        .sum::<f64>()
                        / 400.0;
                    let got = share(&paths, low, low + 20.0);
                    worst = worst.max((got - mean).abs());
                    (all, wanted) = (all + got, wanted + mean);
                }
                let most = match pattern {
                    Pattern::Grid => 0.045,
                    Pattern::Triangles => 0.06,
                    _ => 0.036,
                };
                assert!(worst < most, "{name} {pattern} {angle}: {worst}");
                assert!(
                    (all / wanted - 1.0).abs() < 0.03,
                    "{name} {pattern} {angle}: {}",
                    all / wanted
                );
            }
        }
    }
}

#[test]
fn lines_end_where_the_density_falls() {
    let region = [rectangle(0.0, 0.0, 60.0, 60.0)];
    let step = |p: Point2| if p.x < 30.0 { 0.5 } else { 0.0 };
    let paths = lines(&region, &step, Pattern::Aligned, 0.0);
    let far = paths.iter().flat_map(|p| &p.points).map(|p| p.x).fold(0.0, f64::max);
    assert!((far - 30.0).abs() < 0.02, "{far}");
    // Joined along the border in pairs, at least.
    let rows = 60.0 / fgm_core::bead::spacing(WIDTH, HEIGHT) / 2.0;
    assert!((paths.len() as f64) < 0.6 * rows, "{}", paths.len());
    assert!(lines(&region, &|_: Point2| -3.0, Pattern::Grid, 0.0).is_empty());
}

/// Thinner layers stand on the lines of denser ones.
#[test]
fn lines_of_a_thin_filling_are_among_those_of_a_dense_one() {
    let region = [rectangle(0.0, 0.0, 60.0, 60.0)];
    let rows = |density: f64| {
        let field = move |_: Point2| density;
        let paths = lines(&region, &field, Pattern::Aligned, 0.0);
        let level = |(a, b): &(Point2, Point2)| a.y == b.y && (a.x - b.x).abs() > 1.0;
        let rows = paths.iter().flat_map(segments).filter(level).map(|(a, _)| (a.y * 1e6) as i64);
        rows.collect::<std::collections::BTreeSet<_>>()
    };
    let (thin, dense) = (rows(0.15), rows(0.4));
    assert!(thin.len() > 20 && thin.is_subset(&dense) && dense.len() > 2 * thin.len());
}

#[test]
fn a_density_that_is_no_number_is_an_error() {
    let region = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let hole = |p: Point2| if p.x > 7.0 { f64::NAN } else { 0.3 };
    let options = InfillOptions { z: 2.5, ..InfillOptions::new(WIDTH, HEIGHT) };
    let error = infill_graded(&region, &hole, 0.5, &options, &ClipperInset::default()).unwrap_err();
    assert!(matches!(error, ToolpathError::Density { x, z, .. } if x > 7.0 && z == 2.5), "{error}");
    let bad = InfillOptions { width: f64::NAN, ..options };
    assert_eq!(infill_graded(&region, &hole, 0.5, &bad, &ClipperInset::default()), Ok(Vec::new()));
}
