//! The palette slab of the paper, judged by its written G-code: volume, composition, coverage.

mod common;

use common::{Bead, builtin, deposit, eq1, settings, slice};
use fgm::{Density, Strategy, core::Point2};

/// Error of the commanded fraction against eq. 1 along the beads: mean and greatest.
fn composition_error(beads: &[Bead]) -> (f64, f64) {
    let (mut sum, mut length, mut greatest) = (0.0, 0.0, 0.0_f64);
    for bead in beads {
        for share in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let error = (eq1(bead.from.lerp(bead.to, share)) - bead.fraction).abs();
            sum += error * bead.length();
            length += bead.length();
            greatest = greatest.max(error);
        }
    }
    (sum / length, greatest)
}

/// The area under the beads of a layer, mm², from a raster of 0.1 mm.
fn covered(beads: &[&Bead]) -> f64 {
    const STEP: f64 = 0.1;
    const HALF: f64 = 100.0;
    let side = (2.0 * HALF / STEP) as usize;
    let mut raster = vec![false; side * side];
    for bead in beads {
        let radius = 0.5 * bead.width;
        let (lo, hi) = (bead.from.min(bead.to) - radius, bead.from.max(bead.to) + radius);
        let index = |v: f64| ((v + HALF) / STEP) as usize;
        let along = bead.to - bead.from;
        for j in index(lo.y)..=index(hi.y) {
            for i in index(lo.x)..=index(hi.x) {
                let p = (Point2::new(i as f64, j as f64) + 0.5) * STEP - HALF;
                let t = ((p - bead.from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                raster[j * side + i] |= p.distance(bead.from + along * t) <= radius;
            }
        }
    }
    raster.iter().filter(|hit| **hit).count() as f64 * STEP * STEP
}

#[test]
fn sectioned_holds_volume_composition_and_length() {
    let mut settings = settings(Strategy::Sectioned, 16);
    settings.infill.density = 100.0.into();
    settings.lead.volume = Some(0.0);
    let (report, gcode) = slice(&builtin("slab"), "geeetech-mizar-m", &settings);
    assert_eq!(report.layers, 10);
    assert_eq!(report.purge_mm3, 0.0, "nothing to purge without a dead volume");
    let beads = deposit(&gcode).beads;

    let volume: f64 = beads.iter().map(|b| b.volume).sum();
    assert!((volume / report.model_mm3 - 1.0).abs() < 0.01, "{volume} of {}", report.model_mm3);
    let (mean, greatest) = composition_error(&beads);
    assert!(mean < 0.0164, "{mean}");
    // A band, and what the G-code's digits round.
    assert!(greatest < 1.0 / 16.0 + 1e-4, "{greatest}");

    // The same paths in one colour: cutting them has lost and doubled nothing.
    settings.palette.colors = Some(fgm::ColorCount::Count(1));
    let (_, whole) = slice(&builtin("slab"), "geeetech-mizar-m", &settings);
    let length = |beads: &[Bead]| beads.iter().map(Bead::length).sum::<f64>();
    let (cut, whole) = (length(&beads), length(&deposit(&whole).beads));
    assert!((cut / whole - 1.0).abs() < 1e-5, "{cut} of {whole}");
}

#[test]
fn against_covers_and_fills() {
    let mut settings = settings(Strategy::Against, 48);
    settings.lead.volume = Some(0.0);
    settings.slice.last_layer = Some(2);
    let (report, gcode) = slice(&builtin("slab"), "geeetech-mizar-m", &settings);
    let beads = deposit(&gcode).beads;
    let volume: f64 = beads.iter().map(|b| b.volume).sum();
    assert!((volume / report.model_mm3 - 1.0).abs() < 0.01, "{volume} of {}", report.model_mm3);
    let (mean, greatest) = composition_error(&beads);
    assert!(mean < 0.25 / 48.0 + 0.001, "{mean}");
    assert!(greatest < 1.0 / 48.0, "{greatest}");
    let layer: Vec<&Bead> = beads.iter().filter(|b| b.layer == 1).collect();
    let area = report.model_mm3 / 2.0 / 0.2;
    let share = covered(&layer) / area;
    assert!((0.99..1.01).contains(&share), "{share} of the layer is under beads");
}

#[test]
fn little_is_travelled() {
    // Of all ten layers it is 2.0, 1.9 and 4.6 %; the way to the first one counts here for more.
    for (strategy, colors, most) in [
        (Strategy::Against, 12, 0.03),
        (Strategy::Against, 48, 0.03),
        (Strategy::Sectioned, 16, 0.05),
    ] {
        let mut settings = settings(strategy, colors);
        settings.infill.density = Density::Percent(100.0);
        settings.purge.enabled = Some(false);
        settings.lead.volume = Some(0.0);
        settings.slice.last_layer = Some(2);
        let (report, gcode) = slice(&builtin("slab"), "geeetech-mizar-m", &settings);
        let length: f64 = deposit(&gcode).beads.iter().map(Bead::length).sum();
        let share = report.travel_mm / length;
        assert!(share < most, "{strategy}, {colors} colours: {share}");
    }
}
