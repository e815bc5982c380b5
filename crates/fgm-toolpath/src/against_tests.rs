use super::*;
use crate::{ClipperInset, region_shapes::*};
use fgm_core::Point2;
use proptest::prelude::*;

fn fill(face: &Polygon) -> (Vec<Path>, f64) {
    let face = std::slice::from_ref(face);
    let paths = against(face, &AgainstOptions::new(WIDTH, HEIGHT), &ClipperInset::default());
    let volume = volume(&paths) / (face[0].area() * HEIGHT);
    (paths, volume)
}

/// Volume within 2 %, at least 97 % of the area under beads, next to nothing doubled.
fn check(name: &str, face: &Polygon) {
    let (paths, volume) = fill(face);
    assert!((volume - 1.0).abs() < 0.02, "{name}: volume {volume}");
    let cover = cover(std::slice::from_ref(face), &paths, 0.07);
    assert!(cover.covered > 0.97, "{name}: {cover:?}");
    assert!(cover.doubled < 0.06, "{name}: {cover:?}");
    assert!(cover.outside < 0.06, "{name}: {cover:?}");
}

#[test]
fn bands_are_filled_to_their_volume() {
    for tenths in [10, 13, 16, 19, 25, 31, 40, 60] {
        let w = f64::from(tenths) * 0.1;
        check(&format!("straight {w}"), &band(40.0, |_| 0.0, |_| w));
        let low = |x: f64| (x * 0.3).sin();
        let high = |x: f64| low(x) + w + 0.4 * (x * 0.17).sin();
        check(&format!("wavy {w}"), &band(60.0, low, high));
    }
    check("wedge", &band(60.0, |_| 0.0, |x| 0.2 + 0.02 * x));
    check("sliver", &band(40.0, |_| 0.0, |x| 0.3 + 0.01 * x));
    check("ring", &tube(6.0, 4.3));
    check("l", &l_shape());
}

#[test]
fn the_first_loop_lies_half_a_spacing_inside_and_the_outermost_half_a_bead() {
    let outline = [rectangle(0.0, 0.0, 20.0, 15.0)];
    let inset = ClipperInset::default();
    let spacing = bead::spacing(WIDTH, HEIGHT);
    let face = inset.inset(&outline, 0.5 * (WIDTH - spacing));
    let paths = against(&face, &AgainstOptions::new(WIDTH, HEIGHT), &inset);
    let first = &paths[0];
    assert!(first.closed && first.turn == 0);
    for p in &first.points {
        let edge = p.x.min(p.y).min(20.0 - p.x).min(15.0 - p.y);
        assert!((edge - 0.5 * WIDTH).abs() < 1e-4, "{p}");
    }
}

#[test]
fn rectilinear_faces_have_one_loop_and_lines() {
    let face = [band(40.0, |x| (x * 0.2).sin(), |x| 9.0 + (x * 0.2).sin())];
    for layer in 0..2 {
        let options = AgainstOptions {
            fill: FaceFill::Rectilinear,
            angle: 0.6,
            layer,
            ..AgainstOptions::new(WIDTH, HEIGHT)
        };
        let paths = against(&face, &options, &ClipperInset::default());
        assert_eq!(paths.iter().filter(|p| p.closed).count(), 1);
        let share = volume(&paths) / (face[0].area() * HEIGHT);
        assert!((share - 1.0).abs() < 0.02, "layer {layer}: {share}");
        let cover = cover(&face, &paths, 0.07);
        assert!(cover.covered > 0.97, "{cover:?}");
    }
}

#[test]
fn nothing_is_filled_without_sense() {
    let bad = [f64::NAN, 0.0, -1.0, f64::INFINITY];
    for value in bad {
        let face = [rectangle(0.0, 0.0, 5.0, 5.0)];
        let inset = ClipperInset::default();
        assert!(against(&face, &AgainstOptions::new(value, HEIGHT), &inset).is_empty());
        assert!(against(&face, &AgainstOptions::new(WIDTH, value), &inset).is_empty());
    }
    let nan = Polygon::simple(ring(&[(0.0, 0.0), (f64::NAN, 0.0), (5.0, 5.0)]));
    assert!(fill(&nan).0.is_empty());
}

#[test]
fn a_wave_one_bead_and_a_half_thick_is_not_filled_across_its_bays() {
    // Zero-width spikes left by a difference once made the triangulation spill over the border.
    let low = |x: f64| (x * 0.3).sin();
    let face = band(60.0, low, |x| low(x) + 1.0 + 0.4 * (x * 0.17).sin());
    let (paths, _) = fill(&face);
    assert!(paths.iter().all(|p| p.width < 0.7), "{paths:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn any_wobbly_face_is_filled(
        radius in 0.4..6.0f64,
        waves in prop::collection::vec((1u32..12, 0.0..0.25f64, 0.0..6.0f64), 0..4),
        bore in prop::option::of(0.2..0.6f64),
    ) {
        let wobble = |a: f64| -> f64 {
            let sum: f64 = waves.iter().map(|&(k, h, p)| h * (f64::from(k) * a + p).sin()).sum();
            radius * (1.0 + 0.9 * sum).max(0.1)
        };
        let mut face = Polygon::simple(radial(Point2::new(100.0, -50.0), 160, wobble));
        if let Some(bore) = bore {
            let mut hole = radial(Point2::new(100.0, -50.0), 100, |a| wobble(a) * bore);
            hole.reverse();
            face.holes.push(hole);
        }
        let (paths, volume) = fill(&face);
        for path in &paths {
            prop_assert!(path.points.iter().all(|p| p.is_finite()));
            let width = path.width;
            prop_assert!(path.points.len() > 1 && width > 0.2 && width < 0.8, "{}", width);
            prop_assert!(path.points.iter().all(|&p| face.contains(p)));
        }
        // A face of a millimetre or two takes beads of the least width, which are too many where it
        // has many narrow arms.
        let most = if radius < 3.0 { 1.2 } else { 1.08 };
        prop_assert!(volume < most, "volume {}", volume);
        if radius > 3.0 && waves.is_empty() {
            prop_assert!(volume > 0.96, "volume {}", volume);
        }
    }
}

#[test]
fn lumps_side_by_side_share_a_loop() {
    // Seven loops, each around its own lump, once lay on top of each other between the lumps.
    let wobble = |a: f64| 1.5887 * (1.0 + 0.0882 * (7.0 * a).sin());
    let mut face = Polygon::simple(radial(Point2::new(100.0, -50.0), 160, wobble));
    let mut hole = radial(Point2::new(100.0, -50.0), 100, |a| wobble(a) * 0.3812);
    hole.reverse();
    face.holes.push(hole);
    let (paths, volume) = fill(&face);
    assert!((volume - 1.0).abs() < 0.03, "{volume}");
    let cover = cover(&[face], &paths, 0.05);
    assert!(cover.covered > 0.95 && cover.doubled < 0.04, "{cover:?}");
}

#[test]
fn a_neck_between_corners_is_filled() {
    let h = simple(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.6),
        (20.0, 4.6),
        (20.0, 0.0),
        (30.0, 0.0),
        (30.0, 10.0),
        (20.0, 10.0),
        (20.0, 5.4),
        (10.0, 5.4),
        (10.0, 10.0),
        (0.0, 10.0),
    ]);
    check("h", &h);
}

#[test]
fn a_lens_is_a_single_line() {
    // From one loop to four and back: as many places where a loop begins, and nothing but loops.
    let sagitta = |x: f64| 1.5 * (1.0 - (x / 30.0 - 1.0).powi(2)).max(0.0);
    let lens = band(60.0, |x| -sagitta(x), sagitta);
    let (paths, volume) = fill(&lens);
    assert!((volume - 1.0).abs() < 0.01, "{volume}");
    let row = crate::route(paths, WIDTH, HEIGHT);
    let ends = |path: &Path| {
        let last = if path.closed { 0 } else { path.points.len() - 1 };
        (path.points[0], path.points[last])
    };
    let hop = |w: &[Path]| ends(&w[0]).1.distance(ends(&w[1]).0);
    let travel: f64 = row.windows(2).map(hop).sum();
    assert!(travel < 2.0, "{travel}");
}
