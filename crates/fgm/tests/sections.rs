//! Sections straight from the field against sections by faces: the same but for the tolerance to
//! which boundaries are traced.

mod common;

use common::{Bead, builtin, deposit, parse, settings, slice};
use fgm::{SectionBy, Strategy, field::Design};

fn beads(design: &Design, colors: usize, printer: &str, by: SectionBy) -> Vec<Bead> {
    let mut settings = settings(Strategy::Sectioned, colors);
    settings.section.by = by;
    settings.lead.volume = Some(0.0);
    settings.purge.enabled = Some(false);
    settings.infill.density = 100.0.into();
    settings.slice.first_layer = 5;
    settings.slice.last_layer = Some(6);
    deposit(&slice(design, printer, &settings).1).beads
}

/// Length and volume by colour.
fn by_color(beads: &[Bead]) -> Vec<(f64, f64)> {
    let colors = beads.iter().map(|b| b.color + 1).max().unwrap_or(0);
    let mut out = vec![(0.0, 0.0); colors];
    for bead in beads {
        out[bead.color].0 += bead.length();
        out[bead.color].1 += bead.volume;
    }
    out
}

#[test]
fn field_and_faces_cut_alike() {
    let stripes = parse(
        "fgrade([\"x < 0 ? 0.2 : 0.9\", \"x < 0 ? 0.8 : 0.1\"], [\"a\", \"b\"]) { cube(20); }",
    );
    let cases = [
        ("slab", builtin("slab"), 16, "generic-mixing"),
        ("three materials", builtin("three-materials"), 9, "snmf-4"),
        ("cube-eq2", builtin("cube-eq2"), 8, "generic-mixing"),
        ("stripes", stripes, 4, "generic-mixing"),
    ];
    for (name, design, colors, printer) in cases {
        let field = beads(&design, colors, printer, SectionBy::Field);
        let faces = beads(&design, colors, printer, SectionBy::Faces);
        let (a, b) = (by_color(&field), by_color(&faces));
        assert_eq!(a.len(), b.len(), "{name}");
        let sum = |side: &[(f64, f64)]| side.iter().fold((0.0, 0.0), |s, c| (s.0 + c.0, s.1 + c.1));
        assert!((sum(&a).0 / sum(&b).0 - 1.0).abs() < 1e-3, "{name}: length");
        assert!((sum(&a).1 / sum(&b).1 - 1.0).abs() < 1e-3, "{name}: volume");
        for (color, (one, other)) in a.iter().zip(&b).enumerate() {
            // A boundary lies within the tolerance of 0.01 mm; paths may run along it.
            let most = 2e-3 * sum(&a).0 + 1.0;
            assert!((one.0 - other.0).abs() < most, "{name}, colour {color}: {one:?} {other:?}");
        }
    }
}
