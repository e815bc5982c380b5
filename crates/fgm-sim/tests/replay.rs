//! G-code followed: what it makes the machine do, as text.

#![allow(clippy::unwrap_used, reason = "tests")]

use fgm_gcode::{Machine, Reader};
use fgm_sim::{Event, FaultKind, Replay, ReplayOptions};
use proptest::prelude::*;

/// Section of 1.75 mm filament, mm².
const AREA: f64 = 2.405281875404685;

fn options(machine: Option<&str>) -> ReplayOptions {
    let machine = machine.map(|name| Machine::builtin(name).unwrap());
    ReplayOptions { machine, ..ReplayOptions::default() }
}

/// Every event in short, and the faults.
fn show(machine: Option<&str>, gcode: &str) -> String {
    let mut replay = Replay::new(Reader::new(gcode.as_bytes()), &options(machine));
    let mut text = Vec::new();
    while let Some(event) = replay.next_event().unwrap() {
        text.push(match event {
            Event::Layer(l) => format!("layer {}", l.index),
            Event::Bead(b) if b.length() == 0.0 => format!("push {:.2}", b.fed / AREA),
            Event::Bead(b) => {
                let mix: Vec<_> = b.mixture.fractions().iter().map(|f| format!("{f:.2}")).collect();
                format!(
                    "bead {:.2} e {:.2} h{} {}",
                    b.length(),
                    b.fed / AREA,
                    b.head,
                    mix.join(":")
                )
            }
            Event::Travel(t) => format!("go {:.2}", t.length()),
            Event::Pause { seconds, .. } => format!("wait {seconds:.2}"),
            Event::Heat(h) => {
                format!("heat{} {} {}", h.head, h.celsius, if h.wait { "wait" } else { "go" })
            }
        });
    }
    for fault in replay.faults().kept() {
        text.push(format!("{}@{}", fault.kind, fault.line));
    }
    text.join("; ")
}

#[test]
fn moves() {
    for (gcode, expected) in [
        // The first move goes from where nobody knows.
        ("G1 X3 Y4\nG1 X6 Y8", "go 0.00; go 5.00"),
        (
            "M83\nG1 X3 Y0\nG1 X6 E1\nG1 X9 E1",
            "go 0.00; layer 0; bead 3.00 e 1.00 h0 1.00; bead 3.00 e 1.00 h0 1.00",
        ),
        (
            "G1 X0 Y0\nG1 X3 E1\nG1 X6 E2",
            "layer 0; bead 3.00 e 1.00 h0 1.00; bead 3.00 e 1.00 h0 1.00",
        ),
        (
            "G1 X0 Y0\nG1 X3 E1\nG92 E0\nG1 X6 E1",
            "layer 0; bead 3.00 e 1.00 h0 1.00; bead 3.00 e 1.00 h0 1.00",
        ),
        // G90 makes E absolute again on Marlin.
        (
            "M83\nG90\nG1 X0 Y0\nG1 X3 E1\nG1 X6 E2",
            "layer 0; bead 3.00 e 1.00 h0 1.00; bead 3.00 e 1.00 h0 1.00",
        ),
        (
            "G1 X5 Y5\nG91\nM83\nG1 X1\nG1 X1 E1",
            "go 0.00; go 1.00; layer 0; bead 1.00 e 1.00 h0 1.00",
        ),
        ("G20\nG1 X0 Y0\nG1 X1 E0.1", "layer 0; bead 25.40 e 2.54 h0 1.00"),
        ("M83\nG1 X0 Y0\nG92 X10\nG1 X12 E1", "layer 0; bead 2.00 e 1.00 h0 1.00"),
        ("M83\nM221 S50\nG1 X0 Y0\nG1 X2 E1", "layer 0; bead 2.00 e 0.50 h0 1.00"),
        // 1 mm back, 1 mm again: nothing came out; what is more comes out in place.
        ("M83\nG1 E-1 F60\nG1 E1\nG1 E2", "wait 1.00; wait 1.00; push 2.00"),
        (
            "M83\nG1 X0 Y0\nG1 E-1 F60\nG1 X5 E2",
            "wait 1.00; layer 0; bead 5.00 e 1.00 h0 1.00; printed while retracted@4",
        ),
        (
            "M83\nG1 X0 Y0\nG10\nG1 X5 E2\n",
            "wait 0.03; layer 0; bead 5.00 e 1.00 h0 1.00; printed while retracted@4",
        ),
        (
            "M83\nG1 X0 Y0\nG10\nG11\nG1 X5 E2\n",
            "wait 0.03; wait 0.03; layer 0; bead 5.00 e 2.00 h0 1.00",
        ),
        // A wipe: the filament goes back on the way.
        (
            "M83\nG1 X0 Y0\nG1 X5 E-1\nG1 E1\nG1 X9 E1",
            "go 5.00; wait 0.04; layer 0; bead 4.00 e 1.00 h0 1.00",
        ),
        (
            "M200 D1.75\nM83\nG1 X0 Y0\nG1 X5 E2.405281875404685",
            "layer 0; bead 5.00 e 1.00 h0 1.00",
        ),
        ("G4 P500\nG4 S2", "wait 0.50; wait 2.00"),
        ("M104 S200\nM109 T1 R210\nM568 P1 S205", "heat0 200 go; heat1 210 wait; heat1 205 go"),
    ] {
        assert_eq!(show(None, gcode), expected, "{gcode}");
    }
}

#[test]
fn arcs_keep_their_length_and_filament() {
    let gcode = "M83\nG1 X10 Y0\nG3 X0 Y10 I-10 J0 E3\nG2 X10 Y0 R10 E1\n";
    let mut replay = Replay::new(Reader::new(gcode.as_bytes()), &options(None));
    let (mut length, mut fed) = (0.0, 0.0);
    while let Some(event) = replay.next_event().unwrap() {
        if let Event::Bead(bead) = event {
            length += bead.length();
            fed += bead.fed;
        }
    }
    assert!((length / (10.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{length}");
    assert!((fed / AREA - 4.0).abs() < 1e-9);
    assert_eq!(replay.faults().total(), 0);
}

#[test]
fn layers_by_tags_or_by_height() {
    let tagged = ";LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\nG1 X0 Y0 Z0.2\n;TYPE:Perimeter\n\
                  ;WIDTH:0.4\nG1 X5 E1\n;LAYER_CHANGE\nG1 Z0.4\nG1 X0 E2\n";
    let plain = "G1 X0 Y0 Z0.3\nG1 X5 E1\nG1 Z0.5\nG1 X0 E2\nG1 Z0.3\nG1 X5 E3\n";
    for (gcode, expected) in [
        (tagged, vec![(0, 0.2, 0.4), (1, 0.2, 0.4)]),
        (plain, vec![(0, 0.3, 0.0), (1, 0.2, 0.0), (1, 0.2, 0.0)]),
    ] {
        let mut seen = Vec::new();
        for event in Replay::new(Reader::new(gcode.as_bytes()), &options(None)) {
            if let Event::Bead(b) = event.unwrap() {
                let width = if gcode == tagged { b.width } else { 0.0 };
                seen.push((b.layer.unwrap(), (b.height * 1e9).round() / 1e9, width));
            }
        }
        assert_eq!(seen, expected, "{gcode}");
    }
}

#[test]
fn mixtures_of_every_dialect() {
    let print = "\nM83\nG1 X50 Y50 Z0.2\nG1 X60 E1";
    for (machine, gcode, expected) in [
        ("generic-mixing", "M163 S0 P0.25\nM163 S1 P0.75\nM164 S0", "h0 0.25:0.75"),
        // Not stored: as it was.
        ("generic-mixing", "M163 S0 P0.25\nM163 S1 P0.75", "h0 1.00:0.00"),
        // Stored in a virtual tool that is not used.
        ("generic-mixing", "M163 S1 P1\nM164 S1", "h0 1.00:0.00"),
        ("generic-mixing", "M163 S0 P0\nM163 S1 P1\nM164 S1\nT1", "h0 0.00:1.00"),
        ("generic-mixing", "M163 S0 P1\nM163 S1 P3\nM164", "h0 0.25:0.75"),
        ("geeetech-mizar-m", "M165 A0.1 B0.9", "h0 0.10:0.90"),
        ("geeetech-mizar-m", "M165 B1", "h0 0.00:1.00"),
        (
            "snmf-4",
            "M163 S0 P1\nM163 S1 P0\nM163 S3 P0.5\nM163 S4 P0.5\nM164 S0",
            "h0 0.00:0.00:0.50:0.50",
        ),
        ("duet-mixing", "M567 P0 E0.25:0.75", "h0 0.25:0.75"),
        ("kalico-mixing", "M400\nSET_MIXING_EXTRUDER FACTORS=0.25:0.75", "h0 0.25:0.75"),
        ("klipper-toolchanger", "T2", "h2 0.00:0.00:1.00:0.00"),
        ("klipper-toolchanger", ";COLOR:1 0.25 0.75\nM109 T1 S210\nT1", "h1 0.25:0.75"),
        ("klipper-toolchanger", "ACTIVATE_EXTRUDER EXTRUDER=extruder1", "h1 0.00:1.00:0.00:0.00"),
        ("prusa-mk4s-lw-pla", "M104 S190\nM109 S225", "h0 0.00:1.00"),
    ] {
        let text = show(Some(machine), &format!("{gcode}{print}"));
        // Its firmware gives the auger half of what E says.
        let fed = if machine == "snmf-4" { "0.50" } else { "1.00" };
        assert!(text.contains(&format!("e {fed} {expected}")), "{machine} {gcode}: {text}");
        assert!(!text.contains('@'), "{machine} {gcode}: {text}");
    }
    let shown = show(None, &format!("M163 S0 P1\nM163 S1 P3\nM164 S0{print}"));
    assert!(shown.contains("h0 0.25:0.75"), "{shown}");
}

#[test]
fn faults() {
    let start = "M109 S210\nM83\nG1 X50 Y50 Z0.2\n";
    for (gcode, expected) in [
        ("G1 X251", "outside the bed@4"),
        ("G1 X60 Z-1", "outside the bed@4"),
        ("M104 S100\nG1 X60 E1", "extruded too cold@5"),
        ("M104 S100\nM302 P1\nG1 X60 E1", ""),
        ("G1 E-1\nG1 X60 E2", "printed while retracted@5"),
        ("G1 XNaN", "bad number@4"),
        ("G1 X E1", "bad number@4"),
        // What firmwares read: X1 and an E.
        ("G1 X60e9999999999", "bad number@4"),
        ("G1 X99999999999", "bad number@4"),
        ("M104 S", "bad number@4"),
        ("M163 S99 P1", "bad number@4"),
        ("M567 P0 Ea:b", "bad number@4"),
        ("G2 X60 Y60 R1 E1", "bad number@4"),
        ("M1234", "unknown command@4"),
        ("G5 X1", "unknown command@4"),
        ("BREAK_IT", "unknown command@4"),
        ("M163 S0 P0\nM163 S1 P0\nM164 S0\nG1 X60 E1", "no motor turns@7"),
        ("M117 Hello NaN\nM73 P3\n; G99\n()", "unknown command@7"),
    ] {
        let text = show(Some("generic-mixing"), &format!("{start}{gcode}"));
        let found: Vec<_> = text.split("; ").filter(|t| t.contains('@')).collect();
        assert_eq!(found.join("; "), expected, "{gcode}");
    }
    let kalico = show(Some("kalico-mixing"), &format!("{start}G1 X51 E1"));
    assert!(kalico.contains("bead too large@4"), "{kalico}");
}

#[test]
fn only_the_first_faults_are_kept() {
    let gcode = "M999999\n".repeat(50);
    let mut replay = Replay::new(Reader::new(gcode.as_bytes()), &options(None));
    assert_eq!(replay.next_event().unwrap(), None);
    assert_eq!(replay.faults().count(FaultKind::UnknownCommand), 50);
    assert_eq!(replay.faults().kept().len(), 10);
    assert_eq!((replay.lines(), replay.bytes()), (50, 400));
}

proptest! {
    /// Whatever is read, every number that comes out is one.
    #[test]
    fn any_bytes_are_followed(
        lines in prop::collection::vec(prop_oneof![
            "[GMT][0-9]{1,3}( [XYZEFSPRIJ]-?[0-9.]{0,9}){0,5}",
            "G[0-3] X[0-9]{1,3} Y[0-9]{1,3}( [IJR][0-9.-]{1,4}){0,2} E[0-9.]{1,3}",
            "[ -~]{0,40}",
            ";(LAYER|HEIGHT|WIDTH|TYPE|Z|COLOR|LAYER_CHANGE):?[0-9 .naif-]{0,9}",
        ], 0..60),
        machine in prop::sample::select(vec![
            None, Some("generic-mixing"), Some("prusa-xl-5t"), Some("prusa-mk4s-lw-pla"),
            Some("duet-mixing"), Some("kalico-mixing"),
        ]),
    ) {
        let text = lines.join("\n");
        let mut replay = Replay::new(Reader::new(text.as_bytes()), &options(machine));
        while let Some(event) = replay.next_event().unwrap() {
            match event {
                Event::Bead(b) => {
                    prop_assert!(b.from.is_finite() && b.to.is_finite() && b.fed >= 0.0);
                    prop_assert!(b.fed.is_finite() && b.seconds >= 0.0 && b.seconds.is_finite());
                    prop_assert!(b.width >= 0.0 && b.width.is_finite() && b.height >= 0.0);
                }
                Event::Travel(t) => {
                    prop_assert!(t.to.is_finite() && t.length().is_finite());
                    prop_assert!(t.seconds.is_finite());
                }
                Event::Pause { seconds, .. } => prop_assert!(seconds.is_finite() && seconds >= 0.0),
                Event::Heat(h) => prop_assert!(h.celsius.is_finite()),
                Event::Layer(_) => {}
            }
        }
    }
}
