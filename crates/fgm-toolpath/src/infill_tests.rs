use super::*;
use crate::{ClipperInset, region_shapes::*};
use fgm_core::Point2;
use proptest::prelude::*;

fn options(pattern: Pattern, density: f64) -> InfillOptions {
    InfillOptions { pattern, density, ..InfillOptions::new(WIDTH, HEIGHT) }
}

/// The volume of a pattern over that of its density.
fn share(region: &[Polygon], pattern: Pattern, density: f64) -> f64 {
    // The gyroid's lines vary over its height.
    let heights = if pattern == Pattern::Gyroid { 4 } else { 1 };
    let scale = 0.3913 * bead::spacing(WIDTH, HEIGHT) / density;
    let sum: f64 = (0..heights)
        .map(|i| {
            let z = (f64::from(i) + 0.3) / f64::from(heights) * scale * std::f64::consts::TAU;
            let options = InfillOptions { z, angle: 0.2, ..options(pattern, density) };
            volume(&infill(region, &options, &ClipperInset::default()))
        })
        .sum();
    sum / f64::from(heights) / (region[0].area() * HEIGHT * density)
}

#[test]
fn patterns_have_their_density() {
    for pattern in Pattern::ALL {
        // Curves have many vertices, and nothing joins them on top.
        let size = if pattern == Pattern::Gyroid { 300.0 } else { 600.0 };
        let region = [rectangle(0.0, 0.0, size, size)];
        for percent in [15, 40, 80] {
            let got = share(&region, pattern, f64::from(percent) * 0.01);
            assert!((got - 1.0).abs() < 0.02, "{pattern} {percent}: {got}");
        }
    }
}

/// What joins the lines comes on top: once round the border at most.
#[test]
fn small_regions_have_their_density_and_a_border() {
    let region = [rectangle(0.0, 0.0, 120.0, 120.0)];
    for pattern in Pattern::ALL {
        for percent in [10, 20, 50, 100] {
            let density = f64::from(percent) * 0.01;
            let lines = density * region[0].area() / bead::spacing(WIDTH, HEIGHT);
            let got = share(&region, pattern, density);
            assert!(got > 0.97 && got < 1.03 + 480.0 / lines, "{pattern} {percent}: {got}");
        }
    }
}

/// Three families want the same border; each stretch is laid by one.
#[test]
fn no_stretch_of_border_is_laid_twice() {
    let region = [tube(15.0, 6.0)];
    for pattern in [Pattern::Grid, Pattern::Triangles] {
        let paths = infill(&region, &options(pattern, 0.5), &ClipperInset::default());
        let half = 0.5 * bead::spacing(WIDTH, HEIGHT);
        for (radius, out) in [(15.0 - half, 1.0), (6.0 + half, -1.0)] {
            let on = |p: Point2| out * (p.length() - radius) > -2e-2;
            let steps = paths.iter().flat_map(segments);
            let round: f64 = steps
                .filter(|(a, b)| on(*a) && on(*b) && on(a.midpoint(*b)))
                .map(|(a, b)| a.distance(b))
                .sum();
            let whole = std::f64::consts::TAU * radius;
            assert!(round > 0.3 * whole && round < whole, "{pattern}: {round} of {whole}");
        }
    }
}

/// Regular, and apart: two waves never come nearer than a spacing.
#[test]
fn honeycombs_have_hexagons() {
    let options = options(Pattern::Honeycomb, 0.2);
    let region = [rectangle(0.0, 0.0, 40.0, 40.0)];
    let paths = infill(&region, &options, &ClipperInset::default());
    let spacing = bead::spacing(WIDTH, HEIGHT);
    let side = spacing * (4.0 / 0.6 - 1.0) / 0.75_f64.sqrt();
    let mut whole = 0;
    for path in &paths {
        let inner = path.points.windows(2).skip(1);
        for pair in inner.take(path.points.len().saturating_sub(3)) {
            assert!((pair[0].distance(pair[1]) - side).abs() < 1e-9);
            whole += 1;
        }
    }
    assert!(whole > 200, "{whole}");
    for (i, a) in paths.iter().enumerate() {
        for b in &paths[i + 1..] {
            let apart = a.points.iter().flat_map(|p| {
                segments(b).map(move |(q, r)| {
                    let share = (p - q).dot(r - q) / (r - q).length_squared();
                    p.distance(q + (r - q) * share.clamp(0.0, 1.0))
                })
            });
            assert!(apart.fold(f64::INFINITY, f64::min) > spacing - 1e-9);
        }
    }
}

#[test]
fn only_rectilinear_lines_turn() {
    let region = [rectangle(0.0, 0.0, 20.0, 10.0)];
    for pattern in Pattern::ALL {
        for density in [0.3, 1.0] {
            let on = |layer| {
                let options = InfillOptions { layer, ..options(pattern, density) };
                infill(&region, &options, &ClipperInset::default())
            };
            assert_eq!(on(0), on(2));
            let turns = match pattern {
                Pattern::Rectilinear => true,
                Pattern::Aligned | Pattern::Concentric => false,
                _ => density == 1.0,
            };
            assert_eq!(on(0) != on(1), turns, "{pattern} {density}");
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
            &mut join::Laid::default(),
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
        "no infill pattern `zigzag`: rectilinear, aligned, grid, triangles, honeycomb, concentric or gyroid"
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
