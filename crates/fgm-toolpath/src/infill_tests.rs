use super::*;
use crate::{ClipperInset, region_shapes::*};
use fgm_core::Point2;
use proptest::prelude::*;

fn options(pattern: Pattern, density: f64) -> InfillOptions {
    InfillOptions { pattern, density, ..InfillOptions::new(WIDTH, HEIGHT) }
}

#[test]
fn patterns_have_their_density() {
    let region = [rectangle(0.0, 0.0, 120.0, 120.0)];
    for pattern in Pattern::ALL {
        for percent in [10, 15, 40, 80, 100] {
            let density = f64::from(percent) * 0.01;
            // The gyroid's lines vary over its height.
            let heights = if pattern == Pattern::Gyroid { 8 } else { 1 };
            let scale = 0.3913 * bead::spacing(WIDTH, HEIGHT) / density;
            let sum: f64 = (0..heights)
                .map(|i| {
                    let z =
                        (f64::from(i) + 0.3) / f64::from(heights) * scale * std::f64::consts::TAU;
                    let options = InfillOptions { z, ..options(pattern, density) };
                    volume(&infill(&region, &options, &ClipperInset::default()))
                })
                .sum();
            let got = sum / f64::from(heights) / (region[0].area() * HEIGHT);
            assert!((got / density - 1.0).abs() < 0.1, "{pattern} {density}: {got}");
        }
    }
}

#[test]
fn lines_stay_inside() {
    let regions = [tube(15.0, 6.0), star(5, 20.0, 9.0), l_shape()];
    for region in regions {
        let region = [region];
        for pattern in Pattern::ALL {
            for density in [0.2, 1.0] {
                let options = InfillOptions { angle: 0.3, ..options(pattern, density) };
                let paths = infill(&region, &options, &ClipperInset::default());
                assert!(!paths.is_empty(), "{pattern}");
                let cover = cover(&region, &paths, 0.1);
                assert!(cover.outside < 0.04, "{pattern} {density}: {cover:?}");
                let inside = |p: &Point2| region[0].contains(*p);
                assert!(paths.iter().all(|p| p.points.iter().all(inside)), "{pattern} {density}");
            }
        }
    }
}

/// Joined along the border: the scan lines themselves are all there, once.
#[test]
fn serpentines_keep_every_line() {
    for region in [tube(15.0, 6.0), star(5, 20.0, 9.0), l_shape()] {
        let lattice = scan::Lattice { angle: 0.4, pitch: 0.5, phase: 0.1 };
        let rings: Vec<_> = region.rings().collect();
        let crossings = lattice.crossings(rings.iter().copied());
        let expected: f64 = crossings.chunks(2).map(|c| c[1].u - c[0].u).sum();
        let region = [region];
        let paths = join::serpentines(
            &region,
            &lattice,
            &join::Beads { width: WIDTH, spacing: None, role: Role::Infill },
        );
        let axis = lattice.axis();
        let mut lines = 0.0;
        for path in &paths {
            assert_eq!(path.turns.len(), path.points.len() - 1);
            for pair in path.points.windows(2) {
                let step = pair[1] - pair[0];
                let v = (-pair[0].perp_dot(axis) - lattice.phase) / lattice.pitch;
                let on_line = (v - v.round()).abs() < 1e-6 && step.perp_dot(axis).abs() < 1e-9;
                lines += if on_line { step.length() } else { 0.0 };
            }
        }
        assert!((lines - expected).abs() < 1e-6 * expected, "{lines} {expected}");
        assert!(paths.len() < 20, "{} paths of {} lines", paths.len(), crossings.len() / 2);
    }
}

#[test]
fn turns_follow_the_lines() {
    let region = [rectangle(0.0, 0.0, 20.0, 20.0)];
    let paths = infill(&region, &options(Pattern::Rectilinear, 1.0), &ClipperInset::default());
    assert_eq!(paths.len(), 1, "one serpentine");
    let path = &paths[0];
    let lines: Vec<u32> = path
        .points
        .windows(2)
        .enumerate()
        .filter(|(_, w)| (w[0].y - w[1].y).abs() < 1e-9 && w[0].distance(w[1]) > 5.0)
        .map(|(i, _)| path.turn_of(i))
        .collect();
    assert!(lines.len() > 50 && lines.windows(2).all(|w| w[1] == w[0] + 1), "{lines:?}");
}

#[test]
fn rectilinear_lines_turn_with_the_layer() {
    let region = [rectangle(0.0, 0.0, 20.0, 10.0)];
    for (layer, along_x) in [(0, true), (1, false), (2, true)] {
        let options = InfillOptions { layer, ..options(Pattern::Rectilinear, 0.3) };
        let paths = infill(&region, &options, &ClipperInset::default());
        let (x, y) = paths.iter().flat_map(|p| p.points.windows(2)).fold((0.0, 0.0), |s, w| {
            let d = (w[1] - w[0]).abs();
            (s.0 + d.x, s.1 + d.y)
        });
        assert_eq!(x > y, along_x, "layer {layer}");
    }
}

#[test]
fn sparse_lines_lie_on_one_lattice() {
    let options = options(Pattern::Rectilinear, 0.25);
    let lines = |x: f64| {
        let region = [rectangle(x, x, 10.0, 10.0)];
        let paths = infill(&region, &options, &ClipperInset::default());
        paths[0].points[0].y / options.pitch()
    };
    let apart = lines(0.0) - lines(3.21);
    assert!((apart - apart.round()).abs() < 1e-9, "{apart}");
}

#[test]
fn names_go_both_ways() {
    for pattern in Pattern::ALL {
        assert_eq!(pattern.to_string().parse(), Ok(pattern));
    }
    let error = "zigzag".parse::<Pattern>().unwrap_err();
    assert_eq!(
        error.to_string(),
        "no infill pattern `zigzag`: rectilinear, grid, concentric or gyroid"
    );
}

#[test]
fn options_without_sense_fill_nothing() {
    let region = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let inset = ClipperInset::default();
    for bad in [f64::NAN, 0.0, -1.0] {
        for pattern in Pattern::ALL {
            assert!(infill(&region, &options(pattern, bad), &inset).is_empty());
            let width = InfillOptions { width: bad, ..options(pattern, 0.5) };
            assert!(infill(&region, &width, &inset).is_empty());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn solid_filling_has_the_volume(
        radius in 6.0..15.0f64, k in 1u32..6, wobble in 0.0..0.2f64, angle in 0.0..3.2f64,
        bore in prop::option::of(0.2..0.5f64),
    ) {
        let outer = |a: f64| radius * (1.0 + wobble * (f64::from(k) * a).sin());
        let mut region = Polygon::simple(radial(Point2::new(30.0, 20.0), 120, outer));
        if let Some(bore) = bore {
            let mut hole = radial(Point2::new(30.0, 20.0), 90, |a| bore * outer(a));
            hole.reverse();
            region.holes.push(hole);
        }
        let region = [region];
        let options = InfillOptions { angle, ..InfillOptions::new(WIDTH, HEIGHT) };
        let paths = infill(&region, &options, &ClipperInset::default());
        let share = volume(&paths) / (region[0].area() * HEIGHT);
        prop_assert!((share - 1.0).abs() < 0.02, "{}", share);
        let centred = |p: &Path| p.points.iter().all(|&q| region[0].contains(q));
        prop_assert!(paths.iter().all(centred));
    }
}
