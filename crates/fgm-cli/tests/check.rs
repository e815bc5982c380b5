//! `fgm check` as a user meets it, and against what `fgm slice` reports.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use serde_json::Value;
use tempfile::TempDir;

/// Wide enough that each of four colours holds more than any printer's look-ahead but one.
const PLATE: &str = r#"fgrade(["x/30 + 0.5", "0.5 - x/30"], ["blue", "yellow"]) {
    rectprism(30, 16, 1.2);
}"#;

struct Place(TempDir);

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("d.vcad"), PLATE).unwrap();
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn run(&self, line: &str) -> Output {
        let words = line.split_whitespace();
        Command::new(env!("CARGO_BIN_EXE_fgm")).args(words).current_dir(&self.0).output().unwrap()
    }

    /// Runs what has to end well, and gives what it prints.
    fn text(&self, line: &str) -> String {
        let output = self.run(line);
        assert!(output.status.success(), "{line}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path().join(name)).unwrap()).unwrap()
    }
}

fn printers() -> Vec<String> {
    let list = Place::new().text("printers");
    list.lines().map(|l| l.split_whitespace().next().unwrap().to_owned()).collect()
}

/// Whether two numbers agree to six digits.
fn same(a: &Value, b: &Value) -> bool {
    let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

#[test]
fn the_reader_agrees_with_the_writer() {
    let place = Place::new();
    for printer in printers() {
        for strategy in ["sectioned", "against"] {
            let what = format!("{printer} {strategy}");
            let beads = match printer.as_str() {
                "snmf-4" => "--layer-height 0.5 --bead-width 1.5 --colors 4",
                "prusa-xl-5t" | "klipper-toolchanger" => "",
                _ => "--colors 4",
            };
            place.text(&format!(
                "slice d.vcad -o o.gcode --printer {printer} --strategy {strategy} {beads} \
                 --infill 60 --report r.json -q"
            ));
            place.text("check o.gcode --json c.json");
            let (report, found) = (place.json("r.json"), place.json("c.json"));
            let totals = &found["totals"];
            assert_eq!(found["fault_count"], 0, "{what}: {}", found["faults"]);
            assert_eq!(found["state_changes"], report["state_changes"], "{what}");
            assert_eq!(totals["layers"], report["layers"], "{what}");
            for key in ["extruded_mm3", "purge_mm3", "travel_mm"] {
                let (a, b) = (&totals[key], &report[key]);
                assert!(same(a, b), "{what}: {key} {a} {b}");
            }
            for (input, material) in report["materials"].as_array().unwrap().iter().enumerate() {
                let (a, b) = (&totals["filament_mm3"][input], &material["volume_mm3"]);
                // A change is rounded to a hundred thousandth of a mm of filament.
                let near = (a.as_f64().unwrap() / b.as_f64().unwrap() - 1.0).abs() < 2e-6;
                assert!(near, "{what}: input {input} {a} {b}");
            }
        }
    }
}

#[test]
fn the_deposit_is_as_good_as_the_look_ahead() {
    let place = Place::new();
    place.text("slice d.vcad -o o.gcode --strategy against --colors 6 -q");
    let rms = |options: &str| {
        // In the first layer changes would have had to be commanded before the print began.
        place.text(&format!(
            "check o.gcode --design d.vcad --cell 0 --layers 2.. --json c.json {options}"
        ));
        let fidelity = place.json("c.json")["fidelity"].clone();
        ["commanded", "deposited"].map(|key| fidelity[key]["rms"].as_f64().unwrap())
    };
    let [commanded, deposited] = rms("");
    // Six even bands: a band is 1/6 wide, so that its rms about the middle is 1/6 / sqrt(12).
    assert!((deposited - 1.0 / 6.0 / 12.0_f64.sqrt()).abs() < 5e-3, "{deposited}");
    assert!(commanded > 2.0 * deposited, "{commanded} {deposited}");
    // Without the delay that the commands were moved for, they come out too early.
    let ideal = rms("--transition ideal");
    assert!((ideal[1] - commanded).abs() < 1e-9 && (ideal[0] - commanded).abs() < 1e-9);
    let [_, smeared] = rms("--transition linear:54.56,28");
    assert!(smeared > deposited && smeared < commanded, "{smeared}");
}

#[test]
fn coverage_and_pictures() {
    let place = Place::new();
    place.text("slice d.vcad -o o.gcode --strategy against --colors 4 -q");
    let text = place.text(
        "check o.gcode --design d.vcad --layers 2..3 --pictures out --picture-layers 2,3,99 \
         --material-colors ff0000,00ff00 --json c.json",
    );
    assert!(text.contains("of the design's area covered"), "{text}");
    let found = place.json("c.json");
    let coverage = &found["coverage"];
    assert_eq!((&found["layers"][0]["layer"], &coverage["layers"]), (&2.into(), &2.into()));
    assert!(coverage["coverage"].as_f64().unwrap() > 0.99, "{coverage}");
    assert!((coverage["filled"].as_f64().unwrap() - 1.0).abs() < 0.01, "{coverage}");
    assert!((coverage["design_mm3"].as_f64().unwrap() - 2.0 * 0.2 * 480.0).abs() < 0.1);
    let mut names: Vec<_> = fs::read_dir(place.path().join("out"))
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let kinds = ["commanded", "deposited", "designed", "error"];
    let expected: Vec<_> =
        (2..=3).flat_map(|l| kinds.map(|k| format!("layer-{l:04}-{k}.png"))).collect();
    assert_eq!(names, expected);
    let png = fs::read(place.path().join("out/layer-0002-error.png")).unwrap();
    assert_eq!(&png[1..4], b"PNG");
}

#[test]
fn faults_are_told_and_end_with_1() {
    let place = Place::new();
    let gcode = "M83\nM104 S100\nG28\nG1 X10 Y10 Z0.2 F3000\nG1 X300 E1\nHELLO\nG1 Xnan\n";
    fs::write(place.path().join("bad.gcode"), gcode).unwrap();
    let output = place.run("check bad.gcode --printer generic-mixing");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "outside the bed: 1",
        "line 5: X = 300.000, 50.000 mm beyond 250.000",
        "extruded too cold: 1",
        "unknown command: 1",
        "line 6: `HELLO`",
        "bad number: 1",
    ] {
        assert!(text.contains(words), "no `{words}` in {text}");
    }
    assert!(String::from_utf8(output.stderr).unwrap().contains("bad.gcode: 4 faults"));
    // Figures come out all the same.
    let output = place.run("check bad.gcode --printer generic-mixing --json -");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), &found["fault_count"]), (Some(1), &4.into()));
}

#[test]
fn bad_input_ends_with_2() {
    let place = Place::new();
    fs::write(place.path().join("plain.gcode"), "G28\n").unwrap();
    fs::write(place.path().join("odd.gcode"), "; machine.inputs = 99\nG28\n").unwrap();
    for (line, words) in [
        ("check no.gcode", "no.gcode"),
        ("check .", "folder"),
        ("check plain.gcode --printer nope", "nope"),
        ("check plain.gcode --design no.vcad", "no.vcad"),
        ("check plain.gcode --design d.vcad", "--offset"),
        ("check plain.gcode --transition slow", "linear:13,26"),
        ("check plain.gcode --thermal 1,2", "2.0,1.0,8"),
        ("check plain.gcode --offset 1,2,3", "--design"),
        ("check plain.gcode --picture-layers 1", "--pictures"),
        ("check plain.gcode --layers 0..1", "counted from 1"),
        ("check odd.gcode", "--printer"),
    ] {
        let output = place.run(line);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains(words), "{line}: no `{words}` in {message}");
    }
    let output = place.run("check plain.gcode --json no/c.json");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(place.text("check --help").contains("Examples:"));
}

#[test]
fn a_file_that_prints_nothing_is_told() {
    let place = Place::new();
    fs::write(place.path().join("empty.gcode"), "").unwrap();
    let output = place.run("check empty.gcode");
    let (said, warned) = (String::from_utf8(output.stdout), String::from_utf8(output.stderr));
    assert!(output.status.success() && said.unwrap().contains("filament  0.0 mm"));
    assert!(warned.unwrap().contains("nothing is printed"));
}

#[cfg(unix)]
#[test]
fn standard_input_is_read() {
    let place = Place::new();
    let pipe = "printf 'G28\\nM83\\nG1 X1 Y1\\nG1 X3 E1\\n' | $0 check - --printer generic-mixing";
    let mut shell = Command::new("sh");
    let output = shell.args(["-c", pipe, env!("CARGO_BIN_EXE_fgm")]).current_dir(place.path());
    let output = output.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.contains("2.0 mm extruding"), "{text}");
}
