//! G-code that this project did not write: totals as those slicers tell them.

#![allow(clippy::unwrap_used, reason = "tests")]

use fgm_core::Role;
use fgm_gcode::Reader;
use fgm_sim::{CheckOptions, Event, Head, Replay, ReplayOptions, check};

/// Section of 1.75 mm filament, mm².
const AREA: f64 = 2.405281875404685;

const FILES: [(&str, &str, u32); 3] = [
    ("PrusaSlicer, absolute E", include_str!("data/prusa-slicer-absolute.gcode"), 9),
    ("PrusaSlicer, relative E", include_str!("data/prusa-slicer-relative.gcode"), 9),
    ("Cura, absolute E", include_str!("data/cura-absolute.gcode"), 10),
];

/// Filament used by the file's own comment, mm.
fn told(gcode: &str) -> f64 {
    let comment = |start: &str| gcode.lines().find_map(|l| l.strip_prefix(start));
    let millimetres = comment("; filament used [mm] = ").map(|n| n.parse().unwrap());
    let metres = comment(";Filament used: ").map(|n| n.trim_end_matches('m').parse().unwrap());
    millimetres.or(metres.map(|m: f64| 1000.0 * m)).unwrap()
}

fn options(head: &Head) -> ReplayOptions {
    ReplayOptions { tagged_layers: head.tagged_layers, ..ReplayOptions::default() }
}

#[test]
fn filament_as_they_tell_it() {
    for (name, gcode, layers) in FILES {
        let mut reader = Reader::new(gcode.as_bytes());
        let head = Head::read(&mut reader).unwrap();
        assert!(head.tagged_layers && head.machine.is_none(), "{name}");
        let options = CheckOptions { replay: options(&head), ..CheckOptions::of(None) };
        let report = check(reader, &options, None, &mut |_| Ok(())).unwrap();
        let found = report.totals.fed_mm3 / AREA;
        assert!((found / told(gcode) - 1.0).abs() < 1e-3, "{name}: {found} {}", told(gcode));
        assert_eq!((report.fault_count, report.faults), (0, vec![]), "{name}");
        assert_eq!(report.totals.layers, layers, "{name}");
        assert_eq!(report.bytes, gcode.len() as u64, "{name}");
        // The purge line of the second is none of the print.
        let purge = if name.contains("relative") { 9.0 } else { 0.0 };
        assert!((report.totals.start_mm3 / AREA - purge).abs() < 1e-6, "{name}");
    }
}

#[test]
fn roles_heights_and_widths() {
    for (name, gcode, _) in FILES {
        let mut reader = Reader::new(gcode.as_bytes());
        let head = Head::read(&mut reader).unwrap();
        let mut seen = Vec::new();
        for event in Replay::new(reader, &options(&head)) {
            let Event::Bead(bead) = event.unwrap() else { continue };
            if bead.layer.is_none_or(|layer| layer == 0) || bead.length() < 1.0 {
                continue;
            }
            let near = (bead.height - 0.2).abs() < 1e-6;
            assert!(near, "{name}, line {}: {} high", bead.line, bead.height);
            let usual = (0.2..0.8).contains(&bead.width);
            assert!(usual, "{name}, line {}: {} wide", bead.line, bead.width);
            seen.extend(bead.role);
        }
        for role in [Role::OuterWall, Role::InnerWall, Role::SolidInfill] {
            assert!(seen.contains(&role), "{name}: {role:?}");
        }
    }
}
