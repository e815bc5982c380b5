//! Every profile that comes with the crate: it reads, it is as the documentation says, and the
//! whole G-code of a tiny print on it is as it was.
#![cfg(feature = "serde")]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use fgm_core::{Bounds3, ColorId, Mixture, Motion, Point2, Point3, Role};
use fgm_gcode::{Lead, Machine, MachineKind, Writer, WriterOptions, lines};

#[test]
fn every_profile_reads_and_has_its_name() {
    for name in Machine::builtin_names() {
        let text = Machine::builtin_toml(name).unwrap();
        let machine = Machine::from_toml(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(machine.name, name);
        assert!(!machine.title.is_empty() && !machine.notes.trim().is_empty(), "{name}");
        assert!(machine.dead_volume() > 0.0, "{name}");
    }
    assert_eq!(Machine::builtin_names().count(), 10);
}

#[test]
fn figures_of_the_documentation() {
    for (name, size, volume, colors) in [
        ("generic-mixing", [250.0, 250.0, 250.0], 68.559, None),
        ("geeetech-mizar-m", [255.0, 255.0, 260.0], 68.559, None),
        ("geeetech-a20m", [255.0, 255.0, 255.0], 68.559, None),
        ("prusa-xl-5t", [360.0, 360.0, 360.0], 32.137, Some(5)),
        ("prusa-mk4s-lw-pla", [250.0, 210.0, 220.0], 12.855, None),
        ("prusa-mk4s-varioshore-tpu", [250.0, 210.0, 220.0], 12.855, None),
        ("snmf-4", [300.0, 300.0, 300.0], 28.8, None),
    ] {
        let machine = Machine::builtin(name).unwrap();
        assert_eq!(machine.bed.size, size, "{name}");
        assert!((machine.dead_volume() - volume).abs() < 1e-3, "{name}");
        assert_eq!(machine.max_colors(), colors, "{name}");
    }
}

/// Two layers of a square, its left half in one colour and its right half in another.
fn square() -> Vec<Motion> {
    let at = |x: f64, y: f64| Point2::new(x, y);
    let mut print = Vec::new();
    for index in 0..2_u32 {
        print.push(Motion::Layer { index, z: 0.2 * f64::from(index + 1), height: 0.2 });
        let halves = [[at(2.5, 0.2), at(0.2, 0.2), at(0.2, 4.8), at(2.5, 4.8)], {
            [at(2.5, 4.8), at(4.8, 4.8), at(4.8, 0.2), at(2.5, 0.2)]
        }];
        let order = if index == 0 { [0, 1] } else { [1, 0] };
        for color in order {
            let half = halves[color];
            print.push(Motion::Color(ColorId(color as u16)));
            print.push(Motion::Travel { to: half[0] });
            let role = Role::OuterWall;
            print.extend(half[1..].iter().map(|&to| Motion::Extrude { to, width: 0.4, role }));
            let (x, role) = (half[1].x.clamp(1.0, 4.0), Role::SolidInfill);
            print.push(Motion::Travel { to: at(x, 1.0) });
            print.push(Motion::Extrude { to: at(x, 4.0), width: 0.45, role });
        }
    }
    print
}

fn write(machine: &Machine) -> String {
    let weights = |w: [f64; 2]| Mixture::from_weights(&w).unwrap();
    let palette = [weights([3.0, 1.0]), weights([1.0, 3.0])];
    let states = machine.states(&palette).unwrap();
    let part = Bounds3::new(Point3::ZERO, Point3::new(5.0, 5.0, 0.4));
    let options = WriterOptions {
        offset: machine.bed.centering(&part),
        comments: vec!["a square in two colours".into(), format!("printer {}", machine.name)],
        colors: vec![[0xff, 0xcc, 0x00], [0x00, 0x55, 0xff]],
        ..WriterOptions::of(machine)
    };
    let mut out = Vec::new();
    let mut writer = Writer::new(&mut out, machine, &states, &options).unwrap();
    // The dead volume of a real machine is more than the square: a small one shows more.
    let volume = machine.dead_volume().min(0.4);
    for step in Lead::with_volume(machine, volume).over(square()) {
        writer.push(step).unwrap();
    }
    let summary = writer.finish().unwrap();
    assert_eq!(summary.bytes, out.len() as u64);
    assert_eq!(summary.layers, 2);
    String::from_utf8(out).unwrap()
}

#[test]
fn golden() {
    for name in Machine::builtin_names() {
        let machine = Machine::builtin(name).unwrap();
        let text = write(&machine);
        let path = format!("{}/tests/golden/{name}.gcode", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("FGM_BLESS").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let golden = std::fs::read_to_string(&path).unwrap();
        for (i, (now, then)) in text.lines().zip(golden.lines()).enumerate() {
            assert_eq!(now, then, "{name}, line {} (FGM_BLESS=1 rewrites the files)", i + 1);
        }
        assert_eq!(text.len(), golden.len(), "{name}");
    }
}

#[test]
fn rules_for_every_firmware() {
    for name in Machine::builtin_names() {
        let machine = Machine::builtin(name).unwrap();
        let text = write(&machine);
        let parsed: Vec<_> = lines(text.as_bytes()).collect();
        let commands: Vec<_> = parsed.iter().filter_map(|l| l.command).collect();
        let mut hot = false;
        for (i, command) in commands.iter().enumerate() {
            if command.is(b'G', 90) {
                assert!(commands[i + 1].is(b'M', 83), "{name}: G90 without M83");
            }
            hot |= command.is(b'M', 109) || command.is(b'M', 116);
            if command.is(b'G', 1) && command.value(b'E').is_some() {
                assert!(hot, "{name}: cold extrusion");
            }
            assert!(!command.is(b'G', 10) && !command.is(b'G', 11) && !command.is(b'M', 82));
        }
        // Each colour's comment stands directly before its commands.
        for (i, line) in parsed.iter().enumerate() {
            if line.comment.is_some_and(|c| c.starts_with(b"COLOR:")) {
                assert!(parsed[i + 1].command.is_some(), "{name}");
            }
        }
        let changes = parsed.iter().filter(|l| l.comment.is_some_and(|c| c.starts_with(b"COLOR:")));
        assert_eq!(changes.count(), 3, "{name}");
        if machine.kind == MachineKind::ToolChanger {
            let notice = text.find(";COLOR:1").unwrap();
            assert!(text[..notice].contains("\nM104 T1 S"), "{name}: heated ahead");
        }
    }
}
