//! Whole parts: layers, walls where they belong, every machine, errors.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, builtin, deposit, model, parse, settings, slice};
use fgm::{ColorCount, Progress, Quiet, Settings, SliceError, Slicer, Strategy, gcode::Machine};

const BOX: &str = r#"fgrade(["z/10 + 0.5", "0.5 - z/10"], ["a", "b"]) { cube(10); }"#;

fn error(source: &str, settings: &Settings) -> SliceError {
    let machine = Machine::builtin("generic-mixing").unwrap();
    Slicer::new(&parse(source), &machine, settings).slice(&mut Vec::new(), &Quiet).unwrap_err()
}

#[test]
fn a_box_has_all_its_layers_and_its_size() {
    let mut settings = settings(Strategy::Sectioned, 4);
    settings.purge.enabled = Some(false);
    let (report, gcode) = slice(&parse(BOX), "generic-mixing", &settings);
    assert_eq!(report.layers, 50);
    let beads = deposit(&gcode).beads;
    assert_eq!(beads.last().unwrap().layer, 49);
    assert!((beads[0].z - -4.8).abs() < 1e-9 && (beads.last().unwrap().z - 5.0).abs() < 1e-9);
    for layer in [0, 24, 49] {
        let reach = beads
            .iter()
            .filter(|b| b.layer == layer)
            .flat_map(|b| [b.from, b.to])
            .fold(0.0_f64, |reach, p| reach.max(p.abs().max_element()));
        assert!((reach + 0.2 - 5.0).abs() < 0.002, "layer {layer} reaches {reach}");
    }
}

#[test]
fn a_bore_has_walls() {
    let mut settings = settings(Strategy::Sectioned, 2);
    settings.purge.enabled = Some(false);
    settings.slice.last_layer = Some(3);
    let tube = r#"fgrade(["x/20 + 0.5", "0.5 - x/20"], ["a", "b"]) {
        difference() { cylinder(10, 2); cylinder(4, 2); } }"#;
    let beads = deposit(&slice(&parse(tube), "generic-mixing", &settings).1).beads;
    let bore = |b: &&Bead| b.role == "External perimeter" && b.from.length() < 6.0;
    let length: f64 = beads.iter().filter(bore).map(Bead::length).sum();
    assert!((length - 3.0 * std::f64::consts::TAU * 4.2).abs() < 0.3, "{length}");
    assert!(beads.iter().filter(bore).all(|b| (b.from.length() - 4.2).abs() < 0.012));
}

#[test]
fn every_machine_takes_a_part() {
    for name in Machine::builtin_names() {
        for strategy in [Strategy::Sectioned, Strategy::Against] {
            let mut settings = settings(strategy, 4);
            settings.slice.last_layer = Some(3);
            let (report, gcode) = slice(&parse(&BOX.replace('z', "x")), name, &settings);
            let fed: f64 = deposit(&gcode).beads.iter().map(|b| b.volume).sum();
            assert!(fed > 0.0 && report.state_changes >= 1, "{name}");
        }
    }
}

#[test]
fn three_materials_and_one_head_a_material() {
    let design = builtin("three-materials");
    for (printer, colors) in [("snmf-4", 9), ("prusa-xl-5t", 3)] {
        let mut settings = settings(Strategy::Sectioned, colors);
        settings.slice.last_layer = Some(2);
        let (report, gcode) = slice(&design, printer, &settings);
        assert!(report.faces >= 2 * colors.min(3), "{printer}: {} faces", report.faces);
        let used: std::collections::BTreeSet<_> =
            deposit(&gcode).beads.iter().map(|b| b.color).collect();
        assert!(used.len() >= 3, "{printer}: {used:?}");
    }
}

#[test]
fn auto_takes_fewer_colors_where_pieces_get_short() {
    let mut settings = settings(Strategy::Sectioned, 1);
    settings.palette.colors = Some(ColorCount::Auto);
    settings.purge.enabled = Some(false);
    settings.infill.density = 100.0.into();
    let wide = r#"fgrade(["x/80 + 0.5", "0.5 - x/80"], ["a", "b"]) { rectprism(80, 40, 0.4); }"#;
    let narrow = r#"fgrade(["x/20 + 0.5", "0.5 - x/20"], ["a", "b"]) { rectprism(20, 10, 0.4); }"#;
    let colors = |source| slice(&parse(source), "generic-mixing", &settings).0.colors;
    let (wide, narrow) = (colors(wide), colors(narrow));
    assert!(wide > narrow && narrow >= 1, "{wide} {narrow}");
}

#[test]
fn real_meshes_keep_all_their_layers() {
    const EQ2: &str = "1/2 + 1/2 sin(2pi x/25) cos(2pi y/25) sin(2pi z/25)";
    for (file, layers, volume) in [("3DBenchy.3mf", 240, 15_550.5), ("vase.stl", 500, 1_122_953.0)]
    {
        let Some(design) = model(file, EQ2) else { continue };
        let found = fgm::inspect(&design, &Settings::default()).unwrap();
        assert_eq!(found.layers, layers, "{file}");
        assert!((found.volume_mm3 / volume - 1.0).abs() < 0.02, "{file}: {}", found.volume_mm3);
        assert_eq!(found.warnings, Vec::<String>::new(), "{file}");
        for first in [1, layers] {
            let mut settings = settings(Strategy::Against, 5);
            (settings.slice.first_layer, settings.slice.last_layer) = (first, Some(first));
            let (report, _) = slice(&design, "prusa-xl-5t", &settings);
            assert!(report.layers == 1 && report.extruded_mm3 > 0.0, "{file} layer {first}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let plain = settings(Strategy::Sectioned, 4);
    let part = |fraction: &str| {
        format!(r#"fgrade(["{fraction}", "1 - ({fraction})"], ["a", "b"]) {{ cube(10); }}"#)
    };
    let unknown = error(&part("sqrt(x - 4)"), &plain);
    assert!(matches!(unknown, SliceError::Material(_)), "{unknown}");

    let mut thin = plain.clone();
    (thin.layer.height, thin.layer.bead_width) = (30.0, 40.0);
    assert!(matches!(error(BOX, &thin), SliceError::NothingToPrint { .. }));

    let mut above = plain.clone();
    above.slice.first_layer = 51;
    assert!(matches!(error(BOX, &above), SliceError::NothingToPrint { .. }));

    let mut flat = plain.clone();
    flat.palette.zipper = "15mm".parse().unwrap();
    assert!(matches!(error(&part("0.5"), &flat), SliceError::FlatZipper { .. }));

    let mut wide = plain;
    wide.palette.zipper = "0.25".parse().unwrap();
    assert!(matches!(error(BOX, &wide), SliceError::Palette(_)));
}

#[test]
fn a_part_on_its_tip_stands_on_the_bed() {
    let tip = r#"fgrade(["x/10 + 0.5", "0.5 - x/10"], ["a", "b"]) {
        scale(1, 1, 5) { rotate(0, 45, 0) { rotate(35.264, 0, 0) { cube(3); } } } }"#;
    let (report, gcode) = slice(&parse(tip), "generic-mixing", &settings(Strategy::Sectioned, 4));
    let text = String::from_utf8(gcode).unwrap();
    let first = text.lines().find(|l| l.starts_with(";Z:")).unwrap();
    assert_eq!(first, ";Z:0.2");
    let extrudes = |l: &&str| l.starts_with("G1 X") && l.contains(" E");
    let layers: Vec<&str> = text.split(";LAYER_CHANGE").collect();
    assert!(layers[1].lines().any(|l| extrudes(&l)), "the first layer has beads");
    assert!(!report.warnings.is_empty(), "what was left out is told");
}

#[test]
fn towers_are_for_colors_that_occur() {
    let purge = |fraction: &str, height: f64| {
        let part = format!(
            r#"fgrade(["{fraction}", "1 - ({fraction})"], ["a", "b"]) {{ cylinder(5, {height}); }}"#
        );
        slice(&parse(&part), "generic-mixing", &settings(Strategy::Sectioned, 16)).0.purge_mm3
    };
    assert_eq!(purge("0.47", 4.0), 0.0, "one colour, nothing to purge");
    let upwards = purge("z/4", 4.0);
    assert!(upwards > 15.0 * 68.0 && upwards < 3500.0, "{upwards}");
}

#[test]
fn the_head_tells_every_setting() {
    let (_, gcode) = slice(&parse(BOX), "generic-mixing", &settings(Strategy::Sectioned, 2));
    let text = String::from_utf8(gcode).unwrap();
    for info in fgm::SETTINGS {
        let line = format!("; {}.{} = ", info.section, info.key);
        assert!(text.lines().any(|l| l.starts_with(&line)), "{line}");
    }
}

#[test]
fn a_stop_is_heard() {
    struct Stop;
    impl Progress for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let machine = Machine::builtin("generic-mixing").unwrap();
    let settings = Settings::default();
    let design = parse(BOX);
    let stopped = Slicer::new(&design, &machine, &settings).slice(&mut Vec::new(), &Stop);
    assert!(matches!(stopped, Err(SliceError::Cancelled)));
}

#[test]
fn bands_narrower_than_a_bead_are_taken_together() {
    // 48 bands in 3 mm, and nothing changes on either side.
    let steep = r#"fgrade(["min(1, max(0, x/3 + 0.5))", "1 - min(1, max(0, x/3 + 0.5))"], ["a", "b"])
        { cube(20); }"#;
    for (design, colors, warned) in [(steep, 48, true), (steep, 4, false)] {
        let mut settings = settings(Strategy::Against, colors);
        settings.lead.volume = Some(0.0);
        settings.slice.last_layer = Some(3);
        let (report, gcode) = slice(&parse(design), "generic-mixing", &settings);
        let share = report.extruded_mm3 / report.model_mm3;
        assert!((share - 1.0).abs() < 0.03, "{colors} colours: {share}");
        let told = report.warnings.iter().any(|w| w.contains("narrower than a bead of 0.24 mm"));
        assert_eq!(told, warned, "{:?}", report.warnings);
        for bead in deposit(&gcode).beads {
            let x = 0.5 * (bead.from.x + bead.to.x);
            let wanted = (x / 3.0 + 0.5).clamp(0.0, 1.0);
            // A bead may be half a millimetre from where its colour belongs.
            assert!((bead.fraction - wanted).abs() < 0.6 / 3.0 + 0.5 / colors as f64, "{bead:?}");
        }
    }
}
