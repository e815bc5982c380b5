//! Patterns and directions of the filling, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{Pattern, Quiet, Settings, Slicer, Strategy, core::bead, gcode::Machine};

const BOX: &str = r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["a", "b"]) { rectprism(60, 60, 2); }"#;

/// The sparse filling of three layers between the skins.
fn filling(change: impl Fn(&mut Settings)) -> Vec<Bead> {
    let mut settings = settings(Strategy::Sectioned, 3);
    settings.purge.enabled = Some(false);
    (settings.skins.top, settings.skins.bottom, settings.infill.density) = (3, 3, 30.0.into());
    settings.slice.last_layer = Some(7);
    change(&mut settings);
    let beads = deposit(&slice(&parse(BOX), "generic-mixing", &settings).1).beads;
    beads.into_iter().filter(|b| b.role == "Internal infill").collect()
}

/// Inside three walls.
fn inside() -> f64 {
    let spacing = bead::spacing(0.4, 0.2);
    let side = 60.0 - 2.0 * (0.2 + 2.5 * spacing);
    side * side
}

#[test]
fn every_pattern_fills_its_share() {
    // Lightning's is that right below a roof.
    for pattern in Pattern::ALL.into_iter().filter(|p| *p != Pattern::Lightning) {
        let beads = filling(|s| s.infill.pattern = pattern);
        let layers = 4.0;
        assert!(beads.iter().all(|b| (3..7).contains(&b.layer)), "{pattern}");
        let volume: f64 = beads.iter().map(|b| b.volume).sum();
        let share = volume / (layers * inside() * 0.2 * 0.3);
        // A border's joining pieces on top, at most.
        assert!(share > 0.95 && share < 1.09, "{pattern}: {share}");
    }
}

/// Thin at one end and at the bottom, dense at the other and higher up; near the walls where asked.
#[test]
fn the_density_follows_a_formula() {
    let volume = |beads: &[Bead], low: f64, layers: std::ops::Range<usize>| -> f64 {
        let inside = |b: &&Bead| {
            let middle = b.from.midpoint(b.to);
            // Lines run all the way; what joins them lies at their ends.
            layers.contains(&b.layer)
                && (low..low + 20.0).contains(&middle.x)
                && middle.y.abs() < 20.0
        };
        beads.iter().filter(inside).map(|b| b.volume).sum()
    };
    // Lines across the gradient, so that a bead lies at one density.
    let graded = |text: &str| {
        filling(|s| {
            s.infill.density = text.parse().unwrap();
            s.infill.pattern = Pattern::Aligned;
            s.infill.angle = 90.0;
        })
    };
    let solid = 20.0 * inside().sqrt() * 0.2;
    let beads = graded("30 + x");
    for (low, wanted) in [(-25.0, 0.15), (-10.0, 0.3), (5.0, 0.45)] {
        let share = volume(&beads, low, 3..7) / (4.0 * solid);
        assert!((share - wanted).abs() < 0.036, "{low}: {share}");
    }
    // The box's middle is at 0: the layers cut at -0.3, -0.1, 0.1 and 0.3 mm.
    let beads = graded("40 + 100 z");
    for (layer, wanted) in (3..7).zip([0.1, 0.3, 0.5, 0.7]) {
        let share = volume(&beads, -10.0, layer..layer + 1) / solid;
        assert!((share - wanted).abs() < 0.036, "{layer}: {share}");
    }
    let beads = graded("hypot(x, y) > 15 ? 40 : 0");
    assert!(beads.iter().all(|b| b.from.length().max(b.to.length()) > 14.9));
    assert!(beads.iter().map(Bead::length).sum::<f64>() > 100.0);
    // The sides are far, top and bottom 1 mm away.
    let beads = graded("d > -0.8 ? 50 : 10");
    let at = |layer: usize| volume(&beads, -10.0, layer..layer + 1) / solid;
    assert!((at(3) - 0.5).abs() < 0.036 && (at(4) - 0.1).abs() < 0.036, "{} {}", at(3), at(4));
}

#[test]
fn the_design_tells_its_density_and_the_settings_overrule_it() {
    let design = |density: &str| parse(&format!("density(\"{density}\") {{ {BOX} }}"));
    let volume = |design: &fgm::field::Design, change: &dyn Fn(&mut Settings)| -> f64 {
        let mut settings = settings(Strategy::Sectioned, 3);
        settings.purge.enabled = Some(false);
        (settings.skins.top, settings.skins.bottom) = (3, 3);
        settings.slice.last_layer = Some(7);
        change(&mut settings);
        let beads = deposit(&slice(design, "generic-mixing", &settings).1).beads;
        let beads = beads.iter().filter(|b| b.role == "Internal infill");
        beads.map(|b| b.volume).sum::<f64>() / (4.0 * inside() * 0.2)
    };
    let near = |share: f64, wanted: f64| {
        // What joins the lines comes on top.
        assert!((0.97..1.15).contains(&(share / wanted)), "{share}, not {wanted}");
    };
    near(volume(&parse(BOX), &|_| {}), 0.15);
    near(volume(&design("0.4"), &|_| {}), 0.4);
    near(volume(&design("0.4"), &|s| s.infill.pattern = Pattern::Honeycomb), 0.4);
    near(volume(&design("0.3 + x/200"), &|_| {}), 0.3);
    near(volume(&design("0.3 + x/200"), &|s| s.infill.density = 20.0.into()), 0.2);
}

/// A block of 40 mm with a roof: under it branches, which grow out of the walls and each other.
#[test]
fn lightning_holds_up_the_roof_and_little_else() {
    const BLOCK: &str =
        r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["a", "b"]) { rectprism(40, 40, 16); }"#;
    let filling = |pattern| -> Vec<Bead> {
        let mut settings = settings(Strategy::Sectioned, 3);
        settings.purge.enabled = Some(false);
        (settings.skins.top, settings.skins.bottom) = (3, 3);
        (settings.infill.pattern, settings.section.shortest) = (pattern, 0.0);
        let beads = deposit(&slice(&parse(BLOCK), "generic-mixing", &settings).1).beads;
        beads.into_iter().filter(|b| b.role == "Internal infill").collect()
    };
    let volume = |beads: &[Bead]| beads.iter().map(|b| b.volume).sum::<f64>();
    let (lightning, lines) = (filling(Pattern::Lightning), filling(Pattern::Rectilinear));
    let share = volume(&lightning) / volume(&lines);
    assert!(share < 0.45, "{share}");
    let of_layer = |layer: usize| lightning.iter().filter(move |b| b.layer == layer);
    let top: f64 = of_layer(76).map(|b| b.volume).sum();
    let side: f64 = 40.0 - 2.0 * (0.2 + 2.5 * bead::spacing(0.4, 0.2));
    let share = top / (side * side * 0.2);
    assert!((share - 0.15).abs() < 0.02, "{share}");
    // Every end of a bead lies on a bead of the layer below, or at a wall.
    let wall = 0.5 * side - 1.0;
    for layer in 60..77 {
        for p in of_layer(layer).flat_map(|b| [b.from, b.to]) {
            let off = |b: &Bead| {
                let along = b.to - b.from;
                let t = (p - b.from).dot(along) / along.length_squared().max(1e-12);
                p.distance(b.from + along * t.clamp(0.0, 1.0))
            };
            let below = of_layer(layer - 1).map(off).fold(f64::INFINITY, f64::min);
            // It begins two widths long.
            let held = below < 0.7 || p.abs().max_element() > wall;
            assert!(held, "layer {layer}, {p}: {below} mm");
        }
    }
}

#[test]
fn top_lines_of_a_colour_are_laid_one_beside_the_other() {
    const DISK: &str = r#"fgrade(["x/40 + 0.5", "0.5 - x/40"], ["a", "b"]) { cylinder(16, 2); }"#;
    let mut settings = settings(Strategy::Sectioned, 4);
    settings.purge.enabled = Some(false);
    settings.skins.monotonic = fgm::toolpath::Monotonic::All;
    settings.section.turns = 0.0;
    (settings.lead.volume, settings.compensation.enabled) = (Some(0.0), Some(false));
    let beads = deposit(&slice(&parse(DISK), "generic-mixing", &settings).1).beads;
    for (layer, direction) in [(0, 45.0_f64), (1, 135.0), (8, 45.0), (9, 135.0)] {
        let axis = fgm::core::Point2::from_angle(direction.to_radians());
        let skin = |b: &&Bead| b.layer == layer && b.role.to_lowercase().contains("solid infill");
        let lines = beads.iter().filter(skin).filter(|b| {
            b.length() > 0.5 && (b.to - b.from).normalize().perp_dot(axis).abs() < 1e-2
        });
        let across = |b: &Bead| axis.perp_dot(b.from.midpoint(b.to));
        let of_color = |color| lines.clone().filter(move |b| b.color == color);
        for color in 0..4 {
            let values: Vec<f64> = of_color(color).map(across).collect();
            assert!(values.len() > 10, "{layer} {color}: {}", values.len());
            assert!(values.is_sorted_by(|a, b| a < &(b + 0.1)), "{layer} {color}: {values:?}");
        }
    }
}

/// Patterns other than straight lines turn as a whole, and lightning stands as it is.
#[test]
fn every_pattern_takes_directions_by_layer() {
    let points = |pattern, angles: &[f64], layer: usize| -> Vec<fgm::core::Point2> {
        let beads = filling(|s| {
            (s.infill.pattern, s.infill.angles) = (pattern, angles.to_vec());
            s.infill.angle = 10.0;
        });
        let of_layer = beads.iter().filter(|b| b.layer == layer);
        of_layer.flat_map(|b| [b.from, b.to]).collect()
    };
    for pattern in Pattern::ALL {
        // The gyroid's waves change with the height, so a layer is compared with itself.
        let turned = points(pattern, &[10.0, 40.0], 5);
        let stays = matches!(pattern, Pattern::Concentric | Pattern::Lightning);
        assert!(!turned.is_empty(), "{pattern}");
        assert!(turned == points(pattern, &[40.0], 5), "{pattern}");
        assert_eq!(turned == points(pattern, &[10.0], 5), stays, "{pattern}");
    }
}

#[test]
fn a_density_that_cannot_be_followed_is_an_error() {
    let error = |text: &str, pattern| {
        let mut settings = settings(Strategy::Sectioned, 3);
        (settings.infill.density, settings.infill.pattern) = (text.parse().unwrap(), pattern);
        let machine = Machine::builtin("generic-mixing").unwrap();
        let design = parse(BOX);
        let error = Slicer::new(&design, &machine, &settings).slice(&mut Vec::new(), &Quiet);
        error.unwrap_err().to_string()
    };
    assert!(error("10 + x", Pattern::Gyroid).contains("by the design, and gyroid lines cannot"));
    let nan = error("20 + sqrt(x)", Pattern::Grid);
    assert!(nan.starts_with("the density of the infill is not a number at (-"), "{nan}");
}

#[test]
fn lines_run_as_their_layer_says() {
    let angles = [10.0, 70.0, -50.0];
    let beads = filling(|s| s.infill.angles = angles.to_vec());
    for layer in beads.chunk_by(|a, b| a.layer == b.layer) {
        let wanted = angles[layer[0].layer % 3].to_radians();
        let along: f64 = layer
            .iter()
            .filter(|b| {
                let way = b.to - b.from;
                way.normalize().perp_dot(fgm::core::Point2::from_angle(wanted)).abs() < 1e-2
            })
            .map(Bead::length)
            .sum();
        let all: f64 = layer.iter().map(Bead::length).sum();
        assert!(along > 0.9 * all, "{along} of {all} mm");
    }
}
