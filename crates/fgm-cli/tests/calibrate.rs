//! Calibration as a user does it: print, measure what comes out (here by the model of the
//! machine), solve, and slice with the profile that comes of it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use std::{fs, path::PathBuf, process::Command};

use fgm::{
    gcode::{Machine, Reader},
    sim::{Deposit, Model, Piece, Replay, ReplayOptions, Transition},
};
use tempfile::TempDir;

struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs a line of words; gives the status and all that was said.
    fn run(&self, line: &str) -> (i32, String) {
        let program = env!("CARGO_BIN_EXE_fgm");
        let output =
            Command::new(program).args(line.split(' ')).current_dir(&self.0).output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        (output.status.code().unwrap(), String::from_utf8(said).unwrap())
    }

    fn done(&self, line: &str) -> String {
        let (status, said) = self.run(line);
        assert_eq!(status, 0, "{line}: {said}");
        said
    }

    fn machine(&self, name: &str) -> Machine {
        Machine::from_toml(&fs::read_to_string(self.path(name)).unwrap()).unwrap()
    }

    /// What a machine that behaves like this lays down.
    fn printed(&self, gcode: &str, machine: &Machine, transition: Transition) -> Vec<Piece> {
        let text = fs::read(self.path(gcode)).unwrap();
        let model = Model::ideal(machine).with_transition(transition);
        let options = ReplayOptions { machine: Some(machine.clone()), ..ReplayOptions::default() };
        let (mut deposit, mut pieces) = (Deposit::new(&model), Vec::new());
        for event in Replay::new(Reader::new(&text[..]), &options) {
            deposit.push(&event.unwrap(), &mut |piece| {
                if piece.is_part() {
                    pieces.push(*piece);
                }
            });
        }
        pieces
    }
}

/// Where the deposit changes over to the other material, x on the bed.
fn change(pieces: &[Piece]) -> f64 {
    let first = |piece: &Piece| piece.deposited[1].fractions()[0] > 0.5;
    pieces.iter().find(|piece| first(piece) != first(&pieces[0])).unwrap().from.x
}

#[test]
fn the_plate_gives_the_dead_volume_and_the_sharp_change_lies_in_the_middle() {
    let place = Place::new();
    let truth = Transition { delay: 31.0, length: 0.0 };
    let said = place.done("calibrate lead --printer generic-mixing --size 60,40 -o plate.gcode");
    assert!(said.contains(" --printer generic-mixing -o mine.toml"), "{said}");
    // The file says what printer it is for.
    let checked = place.done("check plate.gcode");
    assert!(checked.contains("printer   generic-mixing") && checked.contains("faults    none"));
    let machine = Machine::builtin("generic-mixing").unwrap();
    let pieces = place.printed("plate.gcode", &machine, truth);
    let middle = machine.bed.bounds().center().x;
    let late = change(&pieces) - middle;
    place.done(&format!(
        "calibrate solve lead --late {late:.3} --line 40 --printer generic-mixing -o mine.toml"
    ));
    let mine = place.machine("mine.toml");
    // Half a line is what can be told apart by the ruler.
    assert!(
        (mine.dead_volume() - truth.delay).abs() < 0.5 * 40.0 * 0.0715 + 0.1,
        "{late} {mine:?}"
    );

    // Figure 14: with the lead the change is in the middle, without off by the dead volume.
    let design =
        "fgrade([\"x < 0\", \"x >= 0\"], [\"white\", \"blue\"]) { rectprism(60, 40, 0.2); }";
    fs::write(place.path("plate.vcad"), design).unwrap();
    for (lead, expected) in [("31", 0.0), ("0", 31.0 / 40.0 / 0.2)] {
        place.done(&format!(
            "slice plate.vcad --printer mine.toml --dead-volume {lead} --walls 0 --infill 100 \
             --set infill.angle=90 --purge off --colors 2 -q -o out.gcode"
        ));
        let pieces = place.printed("out.gcode", &mine, truth);
        let off = (change(&pieces) - middle).abs();
        assert!((off - expected).abs() < 0.2, "{lead}: {off} {expected}");
    }
}

#[test]
fn lines_give_delay_and_change() {
    let place = Place::new();
    let truth = Transition { delay: 9.0, length: 18.0 };
    place.done(
        "calibrate transition --printer snmf-4 --bead-width 2 --layer-height 0.8 --room 80 -o lines.gcode",
    );
    let machine = Machine::builtin("snmf-4").unwrap();
    let pieces = place.printed("lines.gcode", &machine, truth);
    // From the first command on, along the bead.
    let told = pieces.iter().position(|p| p.commanded.fractions()[0] == 0.0).unwrap();
    let until = |end: usize, share: f64| -> f64 {
        let seen = pieces.iter().position(|p| p.deposited[end].fractions()[0] < share).unwrap();
        pieces[told..seen].iter().map(Piece::length).sum()
    };
    let (begins, ends) = (until(1, 1.0 - 1e-9), until(0, 1e-9));
    let said = place.done(&format!(
        "calibrate solve transition --begins {begins:.3} --ends {ends:.3} --bead-width 2 \
         --layer-height 0.8 --printer snmf-4 -o mine.toml"
    ));
    assert!(said.contains("L1 = "), "{said}");
    let mine = place.machine("mine.toml");
    let found = Transition::of(&mine).unwrap();
    assert!((found.delay - 9.0).abs() < 0.05 && (found.length - 18.0).abs() < 0.05, "{found:?}");
    assert!((mine.dead_volume() - 18.0).abs() < 0.05);
    // All else stays, comments too.
    let text = fs::read_to_string(place.path("mine.toml")).unwrap();
    for line in Machine::builtin_toml("snmf-4").unwrap().lines() {
        assert!(line.starts_with("volume = ") || text.contains(line), "{line}");
    }
}

#[test]
fn the_ladder_gives_the_flow() {
    let place = Place::new();
    let said = place.done("calibrate foaming --printer prusa-mk4s-lw-pla --step 7 -o ladder.gcode");
    assert!(said.contains("190, 197, 204, 211, 218, 225 °C"), "{said}");
    let ladder = fs::read_to_string(place.path("ladder.gcode")).unwrap();
    for celsius in [190, 197, 204, 211, 218, 225] {
        assert!(ladder.contains(&format!("S{celsius}\n")), "{celsius}");
    }
    let machine = Machine::builtin("prusa-mk4s-lw-pla").unwrap();
    // The wall grows by what the flow would take back.
    let section = fgm::core::bead::area(0.4, 0.2);
    let round = std::f64::consts::FRAC_PI_4 * 0.04;
    let walls: Vec<String> = (0..6)
        .map(|i| 190.0 + 7.0 * f64::from(i))
        .map(|t| (t, (section / machine.foaming.flow_at(t) - round) / 0.2 + 0.2))
        .map(|(t, wall)| format!("--wall {t}={wall:.5}"))
        .collect();
    let walls = walls.join(" ");
    place.done(&format!(
        "calibrate solve foaming {walls} --printer prusa-mk4s-varioshore-tpu -o mine.toml"
    ));
    let mine = place.machine("mine.toml");
    for celsius in [190.0, 200.0, 215.0, 225.0] {
        let (found, expected) = (mine.foaming.flow_at(celsius), machine.foaming.flow_at(celsius));
        assert!((found - expected).abs() < 1e-3, "{celsius}: {found} {expected}");
    }
}

#[test]
fn a_known_volume_is_a_lead() {
    let place = Place::new();
    let said = place.done(
        "calibrate solve volume --mm3 68.56 --bead-width 0.4 --layer-height 0.2 -o mine.toml",
    );
    assert!(said.contains("960.0 mm of 0.4 x 0.2 mm"), "{said}");
    assert_eq!(place.machine("mine.toml").dead_volume(), 68.56);
}

#[test]
fn what_cannot_be_is_told_and_leaves_nothing() {
    let place = Place::new();
    fs::write(place.path("bad.toml"), "name = 'mine'\n[lead]\nvolum = 3\n").unwrap();
    for (line, status, words) in [
        ("calibrate lead --printer none -o a.gcode", 2, "no printer is named"),
        ("calibrate lead --to 5 -o a.gcode", 2, "--to 5"),
        ("calibrate lead --size 400,40 -o a.gcode", 1, "outside the machine"),
        ("calibrate lead --layer-height 0.9 -o a.gcode", 2, "--layer-height 0.9"),
        ("calibrate lead --size 40 -o a.gcode", 2, "two lengths"),
        ("calibrate foaming -o a.gcode", 2, "foaming"),
        ("calibrate solve lead --late -5 --line 40 -o a.toml", 2, "--lead-volume"),
        ("calibrate solve transition --begins 20 --ends 10 -o a.toml", 2, "--begins"),
        ("calibrate solve volume --mm3 3 --printer bad.toml -o a.toml", 2, "bad.toml:3:1"),
        (
            "calibrate solve foaming --wall 190=0.4 --printer prusa-mk4s-lw-pla -o a.toml",
            2,
            "at 4 temperatures",
        ),
        (
            "calibrate solve foaming --flow 190=1 --flow 225=-1 --printer prusa-mk4s-lw-pla",
            2,
            "not above 0",
        ),
        ("calibrate solve volume --mm3 3 -o no/a.toml", 1, "no folder"),
    ] {
        let (found, said) = place.run(line);
        assert_eq!(found, status, "{line}: {said}");
        assert!(said.contains(words), "{line}: no `{words}` in {said}");
    }
    let left: Vec<_> = fs::read_dir(&place.0).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(left, ["bad.toml"]);
}
