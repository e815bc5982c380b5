//! Zippers: how far colours overlap, and how much longer that makes the seam.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{parse, settings, slice};
use fgm::{Report, Strategy};

const LAYERS: f64 = 4.0;

/// A block of 60 x 60 mm of two colours, the fraction of the first 0.5 at x = 0.
fn sliced(fraction: &str, colors: usize, zipper: &str) -> (Report, Vec<u8>) {
    let source = format!(
        r#"fgrade(["{fraction}", "1 - ({fraction})"], ["a", "b"]) {{ rectprism(60, 60, 0.8); }}"#
    );
    let mut settings = settings(Strategy::Sectioned, colors);
    settings.infill.density = 100.0.into();
    settings.infill.angle = 0.0;
    settings.purge.enabled = Some(false);
    // The file's colours are then those of its beads.
    settings.lead.volume = Some(0.0);
    settings.palette.zipper = zipper.parse().unwrap();
    slice(&parse(&source), "generic-mixing", &settings)
}

#[test]
fn the_seam_is_longer_by_the_sides_of_the_teeth() {
    let zipper = |text| sliced("x/60 + 0.5", 2, text).0.zipper;
    assert_eq!(zipper("0"), None);
    for text in ["6mm", "0.1"] {
        let report = zipper(text).unwrap();
        // Lines along x have teeth of 6 mm, those along y alternate over 6 mm: both touch over
        // about 60 / 0.357 * 6 mm.
        let (seam, straight) = (report.seam_mm / LAYERS, report.straight_mm / LAYERS);
        assert!((straight / 60.0 - 1.0).abs() < 0.1, "{text}: {straight}");
        assert!((seam / 1008.0 - 1.0).abs() < 0.12, "{text}: {seam}");
        assert_eq!(report.gained_mm, report.seam_mm - report.straight_mm);
    }
}

#[test]
fn an_overlap_in_mm_holds_where_the_gradient_is_steeper() {
    // The bands' boundaries lie at x = -15, 0 and 7.5; at the first it is half as steep.
    let fraction = "if(x < 0, 0.5 + x/60, 0.5 + x/30)";
    let reach = |colour: usize, from: f64, to: f64| {
        let beads = common::deposit(&sliced(fraction, 4, "4mm").1).beads;
        let own = beads.iter().filter(|b| b.color == colour && b.length() > 0.05);
        let xs = own.flat_map(|b| [b.from.x, b.to.x]).filter(|x| (from..to).contains(x));
        xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    // Colour 0 has the least of the first material.
    let gentle = (reach(1, -25.0, -5.0).0, reach(0, -25.0, -5.0).1);
    let steep = (reach(3, 2.0, 14.0).0, reach(2, 2.0, 14.0).1);
    for (low, high) in [gentle, steep] {
        assert!((high - low - 4.0).abs() < 0.5, "{gentle:?} {steep:?}");
    }
}

#[test]
fn a_zipper_wider_than_a_band_is_narrowed_and_told() {
    let (report, _) = sliced("x/60 + 0.5", 4, "20mm");
    let told = report.warnings.iter().find(|warning| warning.contains("zipper")).unwrap();
    assert!(told.contains("100 % of the part"), "{told}");
    let (report, _) = sliced("x/60 + 0.5", 4, "10mm");
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
}
