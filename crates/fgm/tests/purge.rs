//! Where the old colour goes: towers, hidden infill, or nowhere.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{parse, settings, slice};
use fgm::{
    PurgeInto, PurgeLayout, PurgeReport, Report, Settings, Strategy,
    gcode::{Machine, Reader},
    sim,
};

/// Four colours side by side, 18 layers of which 10 are hidden inside.
const BLOCK: &str =
    r#"fgrade(["x/60 + 0.5", "0.5 - x/60"], ["white", "blue"]) { rectprism(60, 60, 3.6); }"#;

fn sliced(change: impl Fn(&mut Settings)) -> (Report, Vec<u8>) {
    let mut settings = settings(Strategy::Sectioned, 4);
    settings.infill.density = 40.0.into();
    change(&mut settings);
    slice(&parse(BLOCK), "generic-mixing", &settings)
}

fn purge(report: &Report) -> &PurgeReport {
    report.purge.as_ref().unwrap()
}

/// What lies where a tower of this part may not be.
fn beside(gcode: &[u8]) -> usize {
    let beads = common::deposit(gcode).beads;
    let part = |bead: &common::Bead| bead.to.abs().max_element() < 30.0;
    beads.iter().filter(|bead| bead.is_tower() == part(bead)).count()
}

#[test]
fn one_tower_takes_less_than_spots() {
    let [one, spots] = [PurgeLayout::One, PurgeLayout::Spots].map(|layout| {
        let (report, gcode) = sliced(|settings| settings.purge.layout = Some(layout));
        assert_eq!(purge(&report).layout, Some(layout));
        assert_eq!(beside(&gcode), 0);
        // Three changes a layer, and a purge of what is in the nozzle at the start.
        assert_eq!((purge(&report).changes, purge(&report).purged), (54, 54));
        let purges = report.purge_mm3 - purge(&report).standing_mm3;
        assert!((purges - 55.0 * 68.56).abs() < 1.0, "{purges}");
        report
    });
    assert!(one.purge_mm3 < spots.purge_mm3 && one.travel_mm < spots.travel_mm);
    let saved = &purge(&one).saved;
    // A layer of the same order everywhere takes one change more.
    assert!((saved.order.mm3 / 68.56 - 17.0).abs() < 0.01, "{saved:?}");
    assert_eq!((saved.infill.mm3, saved.threshold.mm3), (0.0, 0.0));
    // Nor is anything left out where a colour has nothing but infill.
    let (solid, _) = sliced(|settings| {
        settings.infill.density = 100.0.into();
        settings.walls.count = 0;
    });
    assert_eq!((purge(&solid).purged, purge(&solid).saved.infill.mm3), (54, 0.0));
    assert_eq!(solid.state_changes, 54);
    assert_eq!(saved.total.g, saved.total.mm3 * 1.24 / 1000.0);
}

/// The greatest error of what comes out a dead volume after the command: where it is seen, and
/// anywhere.
fn worst(gcode: &[u8]) -> [f64; 2] {
    let design = parse(BLOCK);
    let machine = Machine::builtin("generic-mixing").unwrap();
    let mut reader = Reader::new(gcode);
    let head = sim::Head::read(&mut reader).unwrap();
    let mut options = sim::CheckOptions::of(Some(&machine));
    options.replay.tagged_layers = head.tagged_layers;
    options.model.transition = sim::Transition { delay: machine.dead_volume(), length: 0.0 };
    let reference =
        sim::Reference { materials: design.fractions.as_ref(), offset: head.offset.unwrap() };
    let outline = |_: f64| Ok(Vec::new());
    let compared = sim::CheckDesign { reference, outline: &outline };
    let report = sim::check(reader, &options, Some(&compared), &mut |_| Ok(())).unwrap();
    let figures = report.fidelity.unwrap();
    [figures.deposited_seen, figures.deposited].map(|figures| figures.worst.unwrap().error)
}

#[test]
fn hidden_infill_takes_the_old_colour_and_nothing_that_is_seen_does() {
    for density in [60.0, 100.0] {
        let into = |into: PurgeInto| {
            sliced(|settings| {
                settings.purge.into = into;
                settings.infill.density = density.into();
            })
        };
        let (tower, none) = into(PurgeInto::Tower);
        let (infill, some) = into(PurgeInto::Infill);
        let (tower, infill) = (tower.purge_mm3, purge(&infill));
        // Ten layers of three changes have filling enough.
        let hidden = 30.0 * 68.56;
        assert!((infill.infill_mm3 - hidden).abs() < 0.1, "{density} %: {infill:?}");
        assert!((infill.saved.infill.mm3 - hidden).abs() < 0.1);
        assert!(tower > hidden);
        // Half a band is off, and by what a short piece gives to its neighbours.
        let [seen, anywhere] = worst(&none);
        assert!(seen < 0.26 && anywhere < 0.26, "{density} %: {seen} {anywhere}");
        let [seen, anywhere] = worst(&some);
        assert!(seen < 0.26 && anywhere > 0.3, "{density} %: {seen} {anywhere}");
    }
}

#[test]
fn no_tower_where_steps_leave_little_that_is_wrong() {
    // A quarter of 68.56 mm³.
    for (threshold, purged, towers) in [(17.0, 54, true), (17.2, 0, false)] {
        let (report, gcode) = sliced(|settings| settings.purge.threshold = threshold);
        let purge = purge(&report);
        assert_eq!((purge.purged, purge.layout.is_some()), (purged, towers));
        assert_eq!(common::deposit(&gcode).beads.iter().any(common::Bead::is_tower), towers);
        assert_eq!(purge.unpurged, 0);
        let left_out = (54 - purged) as f64 * 68.56;
        assert!((purge.saved.threshold.mm3 - left_out).abs() < 70.0, "{purge:?}");
    }
}

#[test]
fn spots_go_around_a_part_that_leaves_no_room_for_one_tower() {
    let wide =
        r#"fgrade(["x/200 + 0.5", "0.5 - x/200"], ["a", "b"]) { rectprism(200, 200, 0.4); }"#;
    let mut settings = settings(Strategy::Sectioned, 16);
    (settings.skins.top, settings.skins.bottom) = (0, 0);
    settings.infill.density = 0.0.into();
    let (report, _) = slice(&parse(wide), "generic-mixing", &settings);
    assert_eq!(purge(&report).layout, Some(PurgeLayout::Spots));
    settings.purge.layout = Some(PurgeLayout::One);
    let machine = Machine::builtin("generic-mixing").unwrap();
    let error = fgm::Slicer::new(&parse(wide), &machine, &settings)
        .slice(&mut Vec::new(), &fgm::Quiet)
        .unwrap_err();
    assert!(error.to_string().contains("a purge tower of 74"), "{error}");
}
