//! The program as a user meets it: exit status, messages, files that appear whole or not at all.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use std::{
    fs,
    process::{Command, Output},
};

use tempfile::TempDir;

const BOX: &str = r#"fgrade(["x/10 + 0.5", "0.5 - x/10"], ["a", "b"]) { cube(10); }"#;

/// A folder with the files of one test, in which the program runs.
struct Place(TempDir);

impl Place {
    fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in files {
            fs::write(folder.path().join(name), bytes).unwrap();
        }
        Self(folder)
    }

    fn run(&self, line: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_fgm")).args(line).current_dir(&self.0).output().unwrap()
    }

    fn files(&self) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(&self.0)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.path().join(name)).unwrap()
    }
}

/// Slices what is wrong: the status, words of the message, and nothing left behind.
fn refused(files: &[(&str, &[u8])], line: &[&str], status: i32, words: &[&str]) {
    let place = Place::new(files);
    let before = place.files();
    let output = place.run(&[&["slice", "-o", "out.gcode"], line].concat());
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(status), "{line:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{line:?}: no `{word}` in {message}");
    }
    assert_eq!(place.files(), before, "{line:?}");
}

#[test]
fn wrong_designs_are_pointed_at() {
    let design = |text: &str, place: &str, words: &str| {
        refused(
            &[("d.vcad", text.as_bytes())],
            &["d.vcad"],
            2,
            &[&format!("d.vcad:{place}:"), words],
        );
    };
    design("union() {\n  cilinder(1, 2);\n}", "2:3", "did you mean `cylinder`");
    design("cylinder(1);", "1:9", "(radius, height)");
    design("union() { cube(1);", "1:9", "never closed");
    let graded = |e: &str| format!("fgrade([\"{e}\", \"1\"], [\"a\", \"b\"]) {{ cube(1); }}");
    design(&graded("x + q"), "1:14", "unknown variable `q`");
    design(&graded("x/(y-y)"), "1:10", "division by zero");
    design("fgrade([\"x\", \"1-x\"], [\"a\", \"b\"]) { mesh(\"no.stl\"); }", "1:41", "no.stl");
    let zero = "fgrade([\"0*x\", \"0*x\"], [\"a\", \"b\"]) { cube(1); }";
    refused(&[("d.vcad", zero.as_bytes())], &["d.vcad"], 2, &["all fractions are zero", "("]);
}

#[test]
fn wrong_meshes_are_refused() {
    let mut short = vec![b' '; 80];
    short.extend(9_u32.to_le_bytes());
    short.extend([0; 50]);
    let line = ["m.stl", "--fraction", "x"];
    refused(&[("m.stl", &short)], &line, 2, &["m.stl", "1 of 9 triangles"]);
    short[80..84].copy_from_slice(&1_u32.to_le_bytes());
    short[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(&[("m.stl", &short)], &line, 2, &["m.stl"]);
    refused(&[], &line, 2, &["m.stl"]);
    refused(&[("m.xyz", b"")], &["m.xyz"], 2, &[".vcad, .stl, .obj or .3mf"]);
}

#[test]
fn wrong_settings_are_named() {
    let files: &[(&str, &[u8])] = &[
        ("d.vcad", BOX.as_bytes()),
        ("open.toml", b"name = 'm'\n[bed\n"),
        ("typo.toml", b"[layer]\nhieght = 3\n"),
        ("machine.toml", b"name = 'm'\n[bed]\nsise = 3\n"),
    ];
    let slice = |line: &[&str], status, words: &[&str]| {
        refused(files, &[&["d.vcad"], line].concat(), status, words);
    };
    slice(&["--printer", "nope"], 2, &["nope", "generic-mixing"]);
    slice(&["--printer", "open.toml"], 2, &["open.toml:2:5"]);
    slice(&["--printer", "machine.toml"], 2, &["machine.toml:3:1", "sise"]);
    slice(&["--settings", "typo.toml"], 2, &["typo.toml:2:1", "hieght"]);
    slice(&["--set", "layer.hite=3"], 2, &["hite"]);
    slice(&["--set", "machine.bed.sise=3"], 2, &["sise"]);
    slice(&["--set", "layer"], 2, &["SECTION.KEY=VALUE"]);
    slice(&["--layer-height", "0"], 2, &["layer.height is 0"]);
    slice(&["--printer", "prusa-xl-5t", "--colors", "6"], 2, &["6 colours on 5 heads"]);
    slice(&["--zipper", "0.07"], 2, &["0.07", "0.0625"]);
    slice(&["--layers", "0..3"], 2, &["counted from 1"]);
    slice(&["--layers", "51..60"], 1, &["nothing to print", "50"]);
    slice(&["--size", "300,300,300"], 1, &["too large by 50.00 mm"]);
    slice(&["--layer-height", "1"], 2, &["layer.height is 1", "layer.bead_width"]);
    slice(&["--set", "walls.count=x"], 2, &["--set walls.count=x"]);
    slice(&["--lead", "-5"], 2, &["--lead -5"]);
    slice(&["--threads", "100000"], 2, &["--threads 100000"]);
    slice(&["--purge", "perhaps"], 2, &["perhaps"]);
    slice(&["--report", "no/report.json"], 1, &["report.json"]);
    let against = ["--spiral", "--strategy", "against"];
    slice(&against, 2, &["walls.spiral", "sectioned"]);
    let heads = ["--spiral", "--printer", "prusa-xl-5t"];
    slice(&heads, 2, &["layer 5", "z = -4.100 mm", "prusa-xl-5t"]);
}

#[test]
fn nothing_that_is_read_is_written_over() {
    let files: &[(&str, &[u8])] = &[("d.vcad", BOX.as_bytes()), ("s.toml", b"")];
    let place = Place::new(files);
    for line in [
        "slice d.vcad -o d.vcad",
        "slice d.vcad -o ./d.vcad",
        "slice d.vcad -o s.toml --settings s.toml",
        "slice d.vcad -o o.gcode --report d.vcad",
        "slice d.vcad -o o.gcode --report ./o.gcode",
    ] {
        let output = place.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert_eq!((place.files().len(), place.read("d.vcad").as_str()), (2, BOX), "{line}");
    }
}

#[test]
fn output_that_cannot_be_written_is_told() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    let output = place.run(&["slice", "d.vcad", "-o", "no/such/folder.gcode"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no/such/folder.gcode"));
}

#[test]
fn a_slice_writes_its_file_its_report_and_its_head() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    let line = "slice d.vcad -o out.gcode --report r.json --colors 4 --layers 1..3 --quiet \
                --set infill.pattern=gyroid";
    let output = place.run(&line.split_whitespace().collect::<Vec<_>>());
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    assert_eq!(place.files(), ["d.vcad", "out.gcode", "r.json"]);
    let gcode = place.read("out.gcode");
    for line in [
        "; fgm 0.1.0",
        "; infill.pattern = \"gyroid\"",
        "; palette.colors = 4",
        "; design_offset = 125 125 5",
        ";LAYER_CHANGE",
        ";Z:0.6",
        ";HEIGHT:0.2",
        ";WIDTH:0.4",
        ";TYPE:External perimeter",
    ] {
        assert!(gcode.lines().any(|l| l == line), "{line}");
    }
    assert!(gcode.lines().any(|l| l.starts_with("; command: ") && l.contains("--colors 4")));
    let report: serde_json::Value = serde_json::from_str(&place.read("r.json")).unwrap();
    for key in "version design printer strategy layers colors faces moves extruded_mm3 model_mm3 \
                purge_mm3 travel_mm state_changes short_pieces bytes print_time_s warnings seconds"
        .split_whitespace()
    {
        assert!(report.get(key).is_some(), "{key}");
    }
    assert_eq!(report["layers"], 3);
    assert_eq!(report["bytes"], gcode.len());
}

#[test]
fn progress_is_filled_in_wherever_the_gcode_goes() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    let slice = |to: &str| {
        let foaming = ["slice", "d.vcad", "--printer", "prusa-mk4s-lw-pla", "-q", "-o", to];
        let output = place.run(&foaming);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let told = |gcode: &str| -> Vec<String> {
        gcode.lines().filter(|l| l.contains("M73")).map(str::to_owned).collect()
    };
    let stream = told(&slice("-"));
    slice("o.gcode");
    assert_eq!(told(&place.read("o.gcode")), stream);
    assert!(stream.len() > 2 && stream[0].starts_with("M73 P000 R0"), "{stream:?}");
    assert_eq!(stream.last().map(String::as_str), Some("M73 P100 R00000"));
    assert!(stream.iter().all(|l| l.starts_with("M73 P")), "{stream:?}");
    assert_eq!(place.files(), ["d.vcad", "o.gcode"]);
}

#[test]
fn standard_output_takes_the_gcode() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    let output = place.run(&["slice", "d.vcad", "-o", "-", "-q", "--layers", "1"]);
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stdout).contains(";LAYER_CHANGE"));
    assert_eq!(place.files(), ["d.vcad"]);
}

#[test]
fn lists_and_help_are_there() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    for (line, words) in [
        ("--help", "fgm slice designs/vase.vcad -o vase.gcode"),
        ("slice --help", "Examples:"),
        ("inspect --help", "Examples:"),
        ("printers --help", "Examples:"),
        ("settings --help", "Examples:"),
        ("completions --help", "Examples:"),
        ("printers", "geeetech-mizar-m"),
        ("printers show snmf-4", "name = \"snmf-4\""),
        ("settings", "bead_width = 0.4"),
        ("settings infill", "density = \"design\""),
        ("completions bash", "_fgm"),
        ("inspect d.vcad", "50 of 0.2 mm"),
        ("inspect d.vcad --json", "\"layers\": 50"),
    ] {
        let output = place.run(&line.split_whitespace().collect::<Vec<_>>());
        assert!(output.status.success(), "{line}: {output:?}");
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(words), "{line}: no `{words}` in {text}");
    }
    assert_eq!(place.run(&["printers", "show", "nope"]).status.code(), Some(2));
}

#[test]
fn the_printed_settings_and_printers_are_read_back() {
    let place = Place::new(&[("d.vcad", BOX.as_bytes())]);
    let settings = place.run(&["settings", "--toml"]).stdout;
    let printer = place.run(&["printers", "show", "geeetech-a20m"]).stdout;
    fs::write(place.0.path().join("s.toml"), settings).unwrap();
    fs::write(place.0.path().join("p.toml"), printer).unwrap();
    let line = "slice d.vcad -o o.gcode --settings s.toml --printer p.toml --layers 1 -q";
    let output = place.run(&line.split_whitespace().collect::<Vec<_>>());
    assert!(output.status.success(), "{output:?}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_slice_leaves_nothing() {
    let place = Place::new(&[("d.vcad", BOX.replace("cube(10)", "cube(100)").as_bytes())]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_fgm"))
        .args([
            "slice",
            "d.vcad",
            "-o",
            "out.gcode",
            "--infill",
            "100",
            "--layer-height",
            "0.02",
            "--purge",
            "off",
        ])
        .current_dir(&place.0)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Once its temporary file is there, the slice is under way.
    while place.files().len() < 2 {
        assert_eq!(child.try_wait().unwrap(), None, "ended before it could be interrupted");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    assert_eq!(place.files(), ["d.vcad"]);
}
