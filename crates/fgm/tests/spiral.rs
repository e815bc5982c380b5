//! The spiral wall, read back from the G-code.

#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "tests")]

mod common;

use std::collections::BTreeSet;

use common::{Bead, builtin, deposit, parse, settings, slice};
use fgm::{
    ColorCount, Density, Quiet, Settings, SliceError, Slicer, Strategy,
    core::bead,
    field::Design,
    gcode::{Machine, Reader},
    sim::{CheckDesign, CheckOptions, Reference, check},
};

/// A cone cut off, its radius from 12 to 16 mm over 10 mm, graded along x and up.
const CONE: &str = r#"fgrade(["x/60 + z/20 + 0.25", "0.75 - x/60 - z/20"], ["a", "b"]) {
    function((-17, -17, 0), (17, 17, 10), "max(hypot(x, y) - 12 - 0.4 z, max(-z, z - 10))");
}"#;

fn spiral() -> Settings {
    let mut settings = settings(Strategy::Sectioned, 8);
    settings.walls.spiral = true;
    settings
}

/// A line of the file: where the nozzle is after it, filament fed, and the layer from 0.
#[derive(Clone, Copy, Debug)]
struct Move {
    at: [f64; 3],
    moved: bool,
    e: f64,
    layer: usize,
}

fn moves(gcode: &[u8]) -> Vec<Move> {
    let (mut at, mut layers, mut moves) = ([0.0; 3], 0, Vec::new());
    let mut reader = Reader::new(gcode);
    while let Some(line) = reader.next_line().unwrap() {
        layers += usize::from(line.comment == Some(b"LAYER_CHANGE"));
        let Some(command) = line.command.filter(|c| c.is(b'G', 0) || c.is(b'G', 1)) else {
            continue;
        };
        let before = at;
        for (axis, letter) in at.iter_mut().zip(*b"XYZ") {
            *axis = command.value(letter).unwrap_or(*axis);
        }
        let e = command.value(b'E').unwrap_or(0.0);
        if layers > 0 {
            moves.push(Move { at, moved: at != before, e, layer: layers - 1 });
        }
    }
    moves
}

/// The moves from the first bead of the spiral's first layer to the last bead.
fn winding(moves: &[Move], first: usize) -> &[Move] {
    let lays = |m: &Move| m.moved && m.e > 0.0;
    let begin = moves.iter().position(|m| m.layer >= first && lays(m)).unwrap();
    let end = moves.iter().rposition(lays).unwrap();
    &moves[begin..=end]
}

/// Moves without a bead; the filament of a bead no longer than a hair may round to nothing.
fn travels(moves: &[Move]) -> usize {
    let hair = |w: &&[Move]| {
        let by = |axis: usize| w[1].at[axis] - w[0].at[axis];
        w[1].e == 0.0 && by(0).hypot(by(1)) < 0.005
    };
    moves.windows(2).filter(|w| w[1].e <= 0.0 && !hair(w)).count()
}

fn volume<'a>(beads: impl IntoIterator<Item = &'a Bead>) -> f64 {
    beads.into_iter().map(|b| b.volume).sum()
}

#[test]
fn a_graded_cone_is_one_line_that_rises() {
    for printer in ["generic-mixing", "duet-mixing", "kalico-mixing", "prusa-mk4s-lw-pla"] {
        let (report, gcode) = slice(&parse(CONE), printer, &spiral());
        assert_eq!(report.layers, 50);
        let moves = moves(&gcode);
        let winding = winding(&moves, 4);
        // Every move lays a bead, and none goes down or rises by more than its share.
        assert_eq!(travels(winding), 0, "{printer}");
        for pair in winding.windows(2) {
            let by = pair[1].at[2] - pair[0].at[2];
            assert!((0.0..=0.05).contains(&by), "{printer}: {pair:?}");
        }
        let top = winding[winding.len() - 1].at[2];
        assert!((top - 10.0).abs() < 1e-9, "{printer}: {top}");
    }
}

#[test]
fn its_volume_is_the_wall_and_its_place_the_cone() {
    let (_, gcode) = slice(&parse(CONE), "generic-mixing", &spiral());
    let beads = deposit(&gcode).beads;
    let wall: Vec<&Bead> = beads.iter().filter(|b| b.layer >= 4).collect();
    // The middle of the wall at z = 0.8 and 10 lies half a bead inside the cone.
    let around = |z: f64| std::f64::consts::TAU * (12.0 + 0.4 * z - 0.2 / 0.4_f64.atan().cos());
    let length = 0.5 * (around(0.8) + around(10.0)) * 9.2 / 0.2;
    let wanted = length * bead::area(0.4, 0.2);
    let found = volume(wall.iter().copied());
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
    // The first turn grows out of nothing, the rim dwindles to it.
    let first = volume(wall.iter().filter(|b| b.layer == 4).copied());
    let second = volume(wall.iter().filter(|b| b.layer == 5).copied());
    let last = volume(wall.iter().filter(|b| b.layer == 49).copied());
    assert!((first / second - 0.5).abs() < 0.01, "{first} {second}");
    assert!((last / second - 1.5 * 15.8 / 12.2).abs() < 0.05, "{last} {second}");
    for bead in wall.iter().filter(|b| b.layer > 4 && b.z < 9.999) {
        // As the design is in the middle of the bead's height.
        let radius = 12.0 + 0.4 * (bead.z - 0.1) - 0.2;
        assert!((bead.to.length() - radius).abs() < 0.02, "{bead:?}");
    }
}

#[test]
fn every_place_has_its_colour() {
    let mut settings = spiral();
    settings.section.shortest = 0.0;
    settings.lead.volume = Some(0.0);
    let (report, gcode) = slice(&parse(CONE), "generic-mixing", &settings);
    assert_eq!(report.colors, 8);
    let beads = deposit(&gcode).beads;
    let wall: Vec<&Bead> = beads.iter().filter(|b| b.layer >= 4).collect();
    let colors: BTreeSet<usize> = wall.iter().map(|b| b.color).collect();
    assert!(colors.len() >= 6, "{colors:?}");
    for bead in wall {
        let middle = 0.5 * (bead.from + bead.to);
        let wanted = middle.x / 60.0 + (bead.z - 0.1) / 20.0 + 0.25;
        // Half a band, what a bead and a step of the height add.
        let off = (bead.fraction - wanted.clamp(0.0, 1.0)).abs();
        assert!(off < 0.5 / 8.0 + 0.5 * bead.length() / 60.0 + 0.002, "{off} {bead:?}");
    }
}

/// The dead volume is counted along the turns as along anything else.
#[test]
fn commands_go_ahead_of_their_boundaries() {
    let cut = |lead| {
        let mut settings = spiral();
        settings.lead.volume = Some(lead);
        settings.purge.enabled = Some(false);
        deposit(&slice(&parse(CONE), "generic-mixing", &settings).1).commands
    };
    let (at, ahead) = (cut(0.0), cut(6.0));
    assert_eq!(at.len(), ahead.len());
    let wall = at.iter().zip(&ahead).filter(|(at, _)| at.1 > 400.0);
    let mut seen = 0;
    for (at, ahead) in wall {
        assert_eq!(at.0, ahead.0);
        assert!((at.1 - ahead.1 - 6.0).abs() < 1e-2, "{at:?} {ahead:?}");
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}

#[test]
fn the_bottom_is_solid_and_has_what_belongs_on_it() {
    let mut settings = spiral();
    (settings.skirt.loops, settings.skins.bottom) = (1, 3);
    settings.brim.width = 2.0;
    let (_, gcode) = slice(&parse(CONE), "generic-mixing", &settings);
    let beads = deposit(&gcode).beads;
    assert!(beads.iter().any(|b| b.layer == 0 && b.role.starts_with("Skirt")));
    assert!(beads.iter().any(Bead::is_tower));
    assert!(beads.iter().all(|b| b.layer < 3 || !b.is_tower()));
    for layer in 0..3 {
        let part = |b: &&Bead| b.layer == layer && !b.is_tower() && !b.role.starts_with("Skirt");
        let radius = 12.0 + 0.4 * 0.2 * (layer as f64 + 0.5);
        let solid = std::f64::consts::PI * radius * radius * 0.2;
        let found = volume(beads.iter().filter(part));
        assert!((found / solid - 1.0).abs() < 0.02, "{layer}: {found} {solid}");
    }
    // Without a bottom one wall stands on the bed.
    settings.skins.bottom = 0;
    settings.skirt.loops = 0;
    settings.brim.width = 0.0;
    settings.purge.enabled = Some(false);
    let beads = deposit(&slice(&parse(CONE), "generic-mixing", &settings).1).beads;
    let first = beads.iter().filter(|b| b.layer == 0);
    let wanted = std::f64::consts::TAU * 11.84 * bead::area(0.4, 0.2);
    assert!((volume(first) / wanted - 1.0).abs() < 0.01);
    assert!(beads.iter().filter(|b| b.layer == 0).all(|b| b.z == 0.2));
}

/// What the spiral stands for is what the settings come to, whatever they say.
#[test]
fn it_overrules_walls_infill_and_top() {
    let mut other = spiral();
    other.walls.count = 4;
    other.infill.density = Density::Percent(60.0);
    other.infill.pattern = fgm::Pattern::Lightning;
    other.skins.top = 9;
    let (plain, overruled) = (
        slice(&parse(CONE), "generic-mixing", &spiral()).1,
        slice(&parse(CONE), "generic-mixing", &other).1,
    );
    assert_eq!(plain, overruled);
    let head = String::from_utf8(plain).unwrap();
    for line in ["walls.count = 1", "infill.density = 0.0", "skins.top = 0"] {
        assert!(head.contains(line), "{line}");
    }
}

#[test]
fn threads_and_layers_asked_for_change_nothing() {
    let machine = Machine::builtin("generic-mixing").unwrap();
    let design = parse(CONE);
    let write = |settings: &Settings, threads| {
        let mut gcode = Vec::new();
        let slicer = Slicer::new(&design, &machine, settings).threads(threads);
        slicer.slice(&mut gcode, &Quiet).unwrap();
        gcode
    };
    assert_eq!(write(&spiral(), 1), write(&spiral(), 3));
    // A part of it begins and ends as the whole does.
    let mut settings = spiral();
    (settings.slice.first_layer, settings.slice.last_layer) = (21, Some(24));
    let beads = deposit(&write(&settings, 2)).beads;
    let of = |layer: usize| volume(beads.iter().filter(|b| b.layer == layer));
    assert!((of(0) / of(1) - 0.5).abs() < 0.01 && (of(3) / of(2) - 1.5).abs() < 0.02);
    assert!(beads[0].z > 4.0 && beads[0].z < 4.05, "{:?}", beads[0]);
}

fn refused(design: &str, printer: &str, settings: &Settings) -> SliceError {
    let machine = Machine::builtin(printer).unwrap();
    Slicer::new(&parse(design), &machine, settings).slice(&mut Vec::new(), &Quiet).unwrap_err()
}

#[test]
fn what_no_spiral_can_be_is_told() {
    let grade = |geometry: &str| {
        format!("fgrade([\"x/40 + 0.5\", \"0.5 - x/40\"], [\"a\", \"b\"]) {{ {geometry} }}")
    };
    // Two towers on a plate of 2 mm: the first layer of two is the eleventh.
    let towers = grade(
        "union() { translate(0, 0, 1) { rectprism(30, 10, 2); } \
         translate(-8, 0, 0) { cylinder(4, 10); } translate(8, 0, 0) { cylinder(4, 10); } }",
    );
    let error = refused(&towers, "generic-mixing", &spiral());
    assert!(
        matches!(error, SliceError::SpiralOutlines { layer: 11, outlines: 2, z } if (z - 2.1).abs() < 1e-9),
        "{error}"
    );
    assert!(error.is_bad_input() && error.to_string().contains("--layers 1..10"), "{error}");
    // A neck thinner than a bead.
    let neck = grade(
        "union() { cylinder(5, 4); \
        translate(0, 0, 3) { cylinder(0.1, 4); } translate(0, 0, 6) { cylinder(5, 4); } }",
    );
    let error = refused(&neck, "generic-mixing", &spiral());
    assert!(matches!(error, SliceError::SpiralGap { layer: 31, .. }), "{error}");
    // Heads cannot be changed on the way; a part of one colour needs none.
    let error = refused(CONE, "prusa-xl-5t", &Settings { palette: Default::default(), ..spiral() });
    assert!(matches!(error, SliceError::SpiralHeads { .. }), "{error}");
    let mut one = spiral();
    one.palette.colors = Some(ColorCount::Count(1));
    slice(&parse(CONE), "prusa-xl-5t", &one);
    let mut against = spiral();
    against.slice.strategy = Strategy::Against;
    assert!(matches!(refused(CONE, "generic-mixing", &against), SliceError::SpiralStrategy));
}

/// A bead hangs over the turn below it by as much all the way round, not by what it has been led over
/// to its own loop.
#[test]
fn a_leaning_wall_hangs_over_all_the_way_round() {
    let lean = |by: f64| CONE.replace("0.4 z", &format!("{by} z")).replace("17", "24");
    // A share of 0.15 and of 0.35 of the bead's width over air.
    for (by, share) in [(0.3, 0.0), (0.7, 1.0)] {
        let beads = deposit(&slice(&parse(&lean(by)), "generic-mixing", &spiral()).1).beads;
        let length = |hangs: bool| -> f64 {
            let turns = beads.iter().filter(|b| (6..49).contains(&b.layer));
            let over = |b: &&Bead| !hangs || b.role == "Overhang perimeter";
            turns.filter(over).map(Bead::length).sum()
        };
        let found = length(true) / length(false);
        assert!((found - share).abs() < 0.01, "{by}: {found}");
    }
}

fn colored(geometry: &str) -> String {
    format!("fgrade([\"x/40 + 0.5\", \"0.5 - x/40\"], [\"a\", \"b\"]) {{ {geometry} }}")
}

fn told<'r>(report: &'r fgm::Report, words: &str) -> Option<&'r str> {
    let mut found = report.warnings.iter().filter(|warning| warning.contains(words));
    let one = found.next().map(String::as_str);
    assert!(found.next().is_none(), "{:?}", report.warnings);
    one
}

#[test]
fn no_bead_goes_through_the_air_to_an_island() {
    let stacked =
        |x: f64| colored(&format!("cylinder(5, 5); translate({x}, 0, 5) {{ cylinder(5, 5); }}"));
    for x in [20.0, 10.1] {
        let error = refused(&stacked(x), "generic-mixing", &spiral());
        assert!(
            matches!(error, SliceError::SpiralIsland { layer: 26, z } if (z - 5.1).abs() < 1e-9),
            "{x}: {error}"
        );
        assert!(error.is_bad_input() && error.to_string().contains("--layers 1..25"), "{error}");
    }
    // A bar across a bar lies on it, though neither holds a corner of the other.
    let bars = colored(
        "translate(0, 0, 2.5) { rectprism(30, 4, 5); } translate(0, 0, 7.5) { rectprism(4, 30, 5); }",
    );
    for design in [stacked(9.0), bars] {
        let (report, _) = slice(&parse(&design), "generic-mixing", &spiral());
        let warning = told(&report, "leans outward").unwrap();
        assert!(warning.contains("in 1 layers, from layer 26 on"), "{warning}");
    }
}

#[test]
fn a_wall_that_leans_by_more_than_a_bead_is_told() {
    let lean = |by: f64| CONE.replace("0.4 z", &format!("{by} z")).replace("17", "36");
    // By 0.36 and 0.44 mm a layer; all but those where the wall stands on the bottom's edge.
    for (by, layers) in [(1.8, None), (2.2, Some("in 46 layers, from layer 5 on"))] {
        let (report, _) = slice(&parse(&lean(by)), "generic-mixing", &spiral());
        let found = told(&report, "leans outward");
        let fits = |words| found.is_some_and(|warning| warning.contains(words));
        assert!(layers.map_or(found.is_none(), fits), "{by}: {found:?}");
    }
}

/// What the first dead volume lays down cannot be commanded, where no tower comes before it.
#[test]
fn a_start_without_its_colours_is_told_and_a_skirt_mends_it() {
    let rod = |formula: &str| {
        let (a, b) = (formula, format!("1 - ({formula})"));
        format!("fgrade([\"{a}\", \"{b}\"], [\"a\", \"b\"]) {{ cylinder(3, 20); }}")
    };
    let words = "at the start of the print";
    let run = |source: &str, change: &dyn Fn(&mut Settings)| {
        let mut settings = spiral();
        settings.palette.colors = Some(ColorCount::Count(16));
        change(&mut settings);
        slice(&parse(source), "generic-mixing", &settings)
    };
    let graded = rod("z/20");
    let (report, _) = run(&graded, &|_| ());
    let warning = told(&report, words).unwrap();
    let (_, loops) = warning.split_once("skirt.loops=").unwrap();
    let loops: usize = loops.parse().unwrap();
    // As many as it takes, and no more.
    for (loops, warns) in [(loops - 1, true), (loops, false)] {
        let (report, gcode) = run(&graded, &|settings| settings.skirt.loops = loops);
        assert_eq!(told(&report, words).is_some(), warns, "{loops}");
        let commands = deposit(&gcode).commands;
        assert_eq!(commands.iter().filter(|command| command.1 <= 1e-9).count() == 1, !warns);
    }
    // Without a layer on the bed there is no skirt.
    let (report, _) = run(&graded, &|settings| settings.slice.first_layer = 10);
    assert!(told(&report, words).unwrap().contains("mm3 printed before would take it"));
    type Case = (&'static str, String, fn(&mut Settings));
    let silent: [Case; 3] = [
        ("one colour", graded.clone(), |s| s.palette.colors = Some(ColorCount::Count(1))),
        ("slow", rod("z/2000"), |_| ()),
        ("no dead volume", graded.clone(), |s| s.lead.volume = Some(0.0)),
    ];
    for (name, source, change) in silent {
        assert_eq!(told(&run(&source, &change).0, words), None, "{name}");
    }
}

#[test]
fn a_print_without_a_spiral_is_told() {
    let sliced = |change: &dyn Fn(&mut Settings)| {
        let mut settings = spiral();
        change(&mut settings);
        slice(&parse(CONE), "generic-mixing", &settings).0
    };
    let words = "no spiral is printed";
    assert_eq!(told(&sliced(&|_| ()), words), None);
    let high = sliced(&|settings| settings.skins.bottom = 200);
    assert!(told(&high, words).unwrap().ends_with("the part has 50 layers"));
    let low = sliced(&|settings| settings.slice.last_layer = Some(4));
    assert!(told(&low, words).unwrap().ends_with("the layers asked for end with 4"));
    assert_eq!(told(&sliced(&|settings| settings.slice.last_layer = Some(5)), words), None);
}

/// The first colour is no change, and those along the spiral are counted apart.
#[test]
fn changes_are_those_of_the_bottom_and_those_of_the_spiral() {
    let (report, _) = slice(&parse(CONE), "generic-mixing", &spiral());
    let purge = report.purge.unwrap();
    assert!(purge.changes > 0 && purge.purged == purge.changes, "{purge:?}");
    assert_eq!((purge.changes + purge.spiral_changes) as u64, report.state_changes);
    let mut one = spiral();
    one.palette.colors = Some(ColorCount::Count(1));
    let purge = slice(&parse(CONE), "generic-mixing", &one).0.purge.unwrap();
    assert_eq!((purge.changes, purge.purged, purge.spiral_changes), (0, 0, 0));
}

/// Of a hollow part the outer wall is printed, and the user is told.
#[test]
fn holes_are_left_out() {
    let tube = r#"fgrade(["x/40 + 0.5", "0.5 - x/40"], ["a", "b"]) {
        difference() { cylinder(10, 4); translate(0, 0, 1) { cylinder(6, 4); } cylinder(0.5, 9); }
    }"#;
    let (report, gcode) = slice(&parse(tube), "generic-mixing", &spiral());
    let told = |w: &String| w.contains("outer wall only") && w.contains("16 layers");
    assert!(report.warnings.iter().any(told), "{:?}", report.warnings);
    let beads = deposit(&gcode).beads;
    let wall = beads.iter().filter(|b| b.layer >= 4);
    assert!(wall.clone().all(|b| (b.to.length() - 9.8).abs() < 0.02));
    assert!(wall.count() > 100);
}

#[test]
fn auto_colors_count_the_turns() {
    let mut settings = spiral();
    settings.palette.colors = Some(ColorCount::Auto);
    // On most machines as many as there can be, were nothing counted.
    let (report, _) = slice(&parse(CONE), "generic-mixing", &settings);
    assert!((2..64).contains(&report.colors), "{}", report.colors);
}

/// `fgm check` follows it: no fault, the true composition, the layers' heights.
#[test]
fn the_check_follows_it() {
    let design: Design = parse(CONE);
    let machine = Machine::builtin("generic-mixing").unwrap();
    let (report, gcode) = slice(&design, "generic-mixing", &spiral());
    let mut options = CheckOptions::of(Some(&machine));
    options.cell = Some(0.1);
    options.replay.tagged_layers = true;
    let offset = machine.bed.centering(&design.bounds);
    let sections = fgm::Sections::new(&design, &Settings::default()).unwrap();
    let outline = |z: f64| sections.at(z).map_err(|e| e.to_string());
    let reference = Reference { materials: design.fractions.as_ref(), offset };
    let against = CheckDesign { reference, outline: &outline };
    let reader = Reader::new(gcode.as_slice());
    let found = check(reader, &options, Some(&against), &mut |_| Ok(())).unwrap();
    assert_eq!((found.fault_count, found.totals.layers), (0, 50), "{:?}", found.faults);
    assert!((found.totals.extruded_mm3 / report.extruded_mm3 - 1.0).abs() < 1e-4);
    assert!((found.totals.travel_mm - report.travel_mm).abs() < 0.1);
    assert!((found.totals.print_time_s / report.print_time_s - 1.0).abs() < 0.01);
    let deposited = found.fidelity.unwrap().deposited_seen;
    // A band is an eighth; evenly spread errors in it come to a quarter of that.
    assert!(deposited.mean < 0.26 / 8.0, "{deposited:?}");
    for layer in &found.layers {
        assert!((layer.z - 0.2 * f64::from(layer.layer)).abs() < 1e-6, "{layer:?}");
        let ring = std::f64::consts::TAU * (12.0 + 0.4 * layer.z) * 0.357;
        if (6..50).contains(&layer.layer) {
            assert!((layer.covered_mm2 / ring - 1.0).abs() < 0.05, "{layer:?} {ring}");
        }
    }
}

/// The vase of the paper, a part of it: 500 turns in all.
#[test]
fn the_vase_is_wound_in_sixteen_colours() {
    let mut settings = spiral();
    settings.palette.colors = Some(ColorCount::Count(16));
    (settings.slice.first_layer, settings.slice.last_layer) = (1, Some(40));
    let (report, gcode) = slice(&builtin("vase"), "geeetech-mizar-m", &settings);
    let moves = moves(&gcode);
    let winding = winding(&moves, 4);
    assert_eq!(travels(winding), 0);
    assert!(winding.windows(2).all(|w| w[1].at[2] >= w[0].at[2]));
    assert!(report.state_changes > 300, "{}", report.state_changes);
}
