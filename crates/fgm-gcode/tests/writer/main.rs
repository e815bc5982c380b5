//! What is written, read back.
#![cfg(feature = "serde")]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod spiral;

use fgm_core::{ColorId, Mixture, Motion, Point2, Point3, Role, bead};
use fgm_gcode::{
    Change, Dialect, GcodeError, Lead, Machine, MachineKind, State, Step, Summary, Text, Writer,
    WriterOptions, lines,
};
use proptest::prelude::*;

const AREA: f64 = 2.405281875404685; // of 1.75 mm filament

fn machine(name: &str) -> Machine {
    Machine::builtin(name).unwrap()
}

fn palette(machine: &Machine, colors: usize) -> Vec<State> {
    let share = |i: usize| (i as f64 + 0.5) / colors as f64;
    let mixtures: Vec<Mixture> =
        (0..colors).map(|i| Mixture::from_weights(&[1.0 - share(i), share(i)]).unwrap()).collect();
    machine.states(&mixtures).unwrap()
}

fn options(machine: &Machine) -> WriterOptions {
    WriterOptions { offset: Point3::new(100.0, 100.0, 0.0), ..WriterOptions::of(machine) }
}

fn write(
    machine: &Machine,
    options: &WriterOptions,
    print: impl IntoIterator<Item = Step>,
) -> Result<(String, Summary), GcodeError> {
    let mut out = Vec::new();
    let colors = machine.max_colors().unwrap_or(4).min(4);
    let mut writer = Writer::new(&mut out, machine, &palette(machine, colors), options)?;
    print.into_iter().try_for_each(|step| writer.push(step))?;
    let summary = writer.finish()?;
    Ok((String::from_utf8(out).unwrap(), summary))
}

fn line(x: f64, y: f64) -> Motion {
    Motion::Extrude { to: Point2::new(x, y), width: 0.4, role: Role::InnerWall }
}

fn travel(x: f64, y: f64) -> Motion {
    Motion::Travel { to: Point2::new(x, y) }
}

fn layer(index: u32) -> Motion {
    Motion::Layer { index, z: 0.2 * f64::from(index + 1), height: 0.2 }
}

fn color(c: u16) -> Motion {
    Motion::Color(ColorId(c))
}

fn steps(print: &[Motion]) -> Vec<Step> {
    print.iter().map(|m| Step::Motion(*m)).collect()
}

/// The text between the first layer and the end template, without the tags of beads.
fn body(text: &str) -> Vec<&str> {
    let tag = |l: &&str| !l.starts_with(";TYPE") && !l.starts_with(";WIDTH");
    let from = text.find(";LAYER_CHANGE").unwrap();
    text[from..].lines().filter(tag).collect()
}

/// Totals as a simulator would find them.
#[derive(Debug, Default)]
struct Totals {
    filament: f64,
    travel: f64,
    colors: u64,
    moves: u64,
}

fn totals(text: &str) -> Totals {
    let (mut t, mut at, mut begun) = (Totals::default(), [None::<f64>; 3], false);
    for line in lines(text.as_bytes()) {
        begun |= line.comment == Some(b"LAYER_CHANGE");
        if line.comment.is_some_and(|c| c.starts_with(b" filament used")) {
            break;
        }
        t.colors += u64::from(line.comment.is_some_and(|c| c.starts_with(b"COLOR:")));
        let Some(command) = line.command else { continue };
        if command.is(b'G', 28) {
            at = [None; 3];
        }
        // What follows the last retraction is the end template.
        if command.is(b'M', 107) && begun && t.moves > 0 {
            break;
        }
        if !command.is(b'G', 1) {
            continue;
        }
        let from = at;
        for (axis, letter) in [b'X', b'Y', b'Z'].into_iter().enumerate() {
            at[axis] = command.value(letter).or(at[axis]);
        }
        let e = command.value(b'E');
        let length = match (from, at) {
            ([Some(x0), Some(y0), _], [Some(x1), Some(y1), _]) => (x1 - x0).hypot(y1 - y0),
            _ => 0.0,
        };
        let plane = command.has(b'X') || command.has(b'Y');
        if begun && plane {
            t.moves += 1;
            match e {
                Some(e) => t.filament += e,
                None => t.travel += length,
            }
        }
    }
    t
}

fn two_layers() -> Vec<Motion> {
    let mut print = Vec::new();
    for index in 0..3 {
        print.push(layer(index));
        for c in 0..2 {
            let x = 30.0 * f64::from(c);
            print.extend([color(c), travel(x, 0.0), line(x + 20.0, 0.3), line(x + 20.0, 40.0)]);
            print.extend([travel(x + 19.0, 40.0), line(x, 17.123_456), line(x + 3.0, 1.0)]);
        }
    }
    print
}

#[test]
fn the_reader_agrees_with_the_summary_on_every_machine() {
    for name in Machine::builtin_names() {
        let machine = machine(name);
        let lead = Lead::for_machine(&machine);
        let (text, summary) = write(&machine, &options(&machine), lead.over(two_layers())).unwrap();
        let seen = totals(&text);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs().max(1.0);
        let seen_mm3 = seen.filament * AREA / machine.feed_factor();
        assert!(near(seen_mm3, summary.fed_mm3), "{name}: {seen:?} {summary:?}");
        let in_all: f64 = summary.filament_mm3.iter().sum();
        assert!(near(in_all, summary.fed_mm3), "{name}");
        assert!((seen.travel - summary.travel_mm).abs() < 0.05, "{name}: {seen:?} {summary:?}");
        assert_eq!(seen.colors, summary.state_changes + 1, "{name}");
        assert_eq!(seen.moves, summary.moves, "{name}");
        assert!(summary.print_time_s > 10.0 && summary.print_time_s < 1000.0, "{name}");
    }
}

#[test]
fn what_is_outside_the_bed_is_told_apart() {
    let machine = machine("generic-mixing");
    let options = options(&machine);
    for (print, axis, over) in [
        (vec![layer(0), travel(0.0, 0.0), line(150.5, 0.0)], 'X', 0.5),
        (vec![layer(0), travel(0.0, -101.0)], 'Y', 1.0),
        (vec![Motion::Layer { index: 0, z: 251.0, height: 0.2 }, travel(0.0, 0.0)], 'Z', 1.0),
        (vec![Motion::Layer { index: 0, z: -0.25, height: 0.2 }, travel(0.0, 0.0)], 'Z', 0.25),
    ] {
        let error = write(&machine, &options, steps(&print)).unwrap_err();
        let GcodeError::OutsideBed { axis: a, over: o, .. } = error else { panic!("{error}") };
        assert!(a == axis && (o - over).abs() < 1e-9, "{a} {o}");
    }
    // The very edge is inside.
    let edge = [layer(0), travel(150.0, 150.0), line(-100.0, -100.0)];
    assert!(write(&machine, &options, steps(&edge)).is_ok());
}

#[test]
fn faults_of_the_print_and_the_settings() {
    let machine = machine("kalico-mixing");
    let good = options(&machine);
    let wide = Motion::Extrude { to: Point2::ONE, width: 4.0, role: Role::Infill };
    let thin = Motion::Extrude { to: Point2::ONE, width: 0.0, role: Role::Infill };
    let flat = Motion::Layer { index: 0, z: 0.2, height: 0.0 };
    for (print, expected) in [
        (vec![layer(0), travel(f64::NAN, 0.0)], "NaN"),
        (vec![layer(0), travel(0.0, 0.0), line(f64::INFINITY, 0.0)], "inf"),
        (vec![layer(0), color(9)], "colour 9 of a palette of 4"),
        (vec![layer(0), travel(0.0, 0.0), wide], "firmware allows"),
        (vec![layer(0), travel(0.0, 0.0), thin], "no section"),
        (vec![travel(0.0, 0.0), line(1.0, 0.0)], "no section"),
        (vec![flat, line(0.0, 0.0)], "layer height"),
    ] {
        let error = write(&machine, &good, steps(&print)).unwrap_err().to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
    let mut cold = good.clone();
    cold.temperatures.nozzle = 120.0;
    assert!(matches!(write(&machine, &cold, []), Err(GcodeError::Cold { .. })));
    let mut still = good.clone();
    still.speeds.travel = 0.0;
    assert!(matches!(write(&machine, &still, []), Err(GcodeError::Setting { .. })));
    let far = WriterOptions { offset: Point3::splat(f64::NAN), ..good };
    assert!(matches!(write(&machine, &far, []), Err(GcodeError::NotANumber { .. })));
}

#[test]
fn a_bead_before_any_position_is_refused() {
    let mut machine = machine("generic-mixing");
    machine.template.start = "G28\n".into();
    let error =
        write(&machine, &options(&machine), steps(&[layer(0), line(1.0, 1.0)])).unwrap_err();
    assert!(matches!(error, GcodeError::NoStart));
}

#[test]
fn a_template_that_does_not_heat_is_heated_for() {
    let mut machine = machine("generic-mixing");
    machine.template.start = "G28\n".into();
    let (text, _) = write(&machine, &options(&machine), steps(&two_layers())).unwrap();
    let head = "M140 S60\nM104 S210\nM190 S60\nM109 S210\nG28\nG21\nG90\nM83\n;COLOR:0 ";
    assert!(text.contains(head), "{text}");
}

#[test]
fn comments_stay_comments() {
    let machine = machine("generic-mixing");
    let comments = vec!["fgm slice 'a\nG28'".into(), "x\rG1 X9".into()];
    let options = WriterOptions { comments, ..options(&machine) };
    let (text, _) = write(&machine, &options, []).unwrap();
    let head: Vec<&str> = text.lines().take(4).collect();
    assert_eq!(head[..3], ["; fgm slice 'a", "; G28'", "; x G1 X9"]);
    assert_eq!(head[3], "; design_offset = 100 100 0");
}

#[test]
fn foam_is_heated_early_and_fed_at_the_boundary() {
    let machine = machine("prusa-mk4s-lw-pla");
    let print = [layer(0), color(0), travel(0.0, 0.0), line(40.0, 0.0), color(3), line(80.0, 0.0)];
    let lead = || Lead::new(10.0 * bead::area(0.4, 0.2)).over(print);
    let (text, summary) = write(&machine, &options(&machine), lead()).unwrap();
    let states = palette(&machine, 4);
    let e = |length: f64, flow: f64| length * bead::area(0.4, 0.2) * flow / AREA;
    let found: Vec<f64> = lines(&text.as_bytes()[text.find(";LAYER").unwrap()..])
        .filter_map(|l| l.command)
        .filter(|c| c.is(b'G', 1) && c.has(b'X'))
        .filter_map(|c| c.value(b'E'))
        .collect();
    let (low, high) = (states[0].flow, states[3].flow);
    for (a, b) in found.iter().zip([e(30.0, low), e(10.0, low), e(40.0, high)]) {
        assert!((a - b).abs() < 2e-5, "{a} {b}");
    }
    assert!((summary.fed_mm3 / AREA - e(40.0, low) - e(40.0, high)).abs() < 1e-9);
    assert!((summary.extruded_mm3 - 80.0 * bead::area(0.4, 0.2)).abs() < 1e-9);

    let mut told = machine.clone();
    told.foaming.flow_command = true;
    let (text, same) = write(&told, &options(&told), lead()).unwrap();
    let percent = |flow: f64| format!("M221 S{}", (flow * 100.0).round());
    let body = body(&text);
    let position = |words: &str| body.iter().position(|l| *l == words);
    assert!(text.contains(&percent(low)));
    assert!(position("M104 S221") < position(&percent(high)), "{text}");
    assert!(position(&percent(high)) < position("M221 S100"));
    assert!((same.fed_mm3 - summary.fed_mm3).abs() < 1e-9);
}

#[test]
fn heads_that_are_wanted_soon_stay_hot() {
    let machine = machine("prusa-xl-5t");
    let mut print = vec![layer(0), travel(0.0, 0.0)];
    for (i, c) in [0, 1, 0, 1].into_iter().enumerate() {
        print.extend([color(c), line(10.0 * i as f64 + 5.0, 0.0)]);
    }
    // Every change falls due at once: no head may cool that has another turn.
    let (text, summary) =
        write(&machine, &options(&machine), Lead::notice(1e6).over(print.clone())).unwrap();
    assert_eq!(summary.state_changes, 3);
    assert_eq!(text.matches("M104 T0 S150").count(), 1, "{text}");
    assert_eq!(text.matches("M104 T1 S150").count(), 0, "{text}");
    // With no lead at all a head is heated when it is needed, and waited for.
    let (text, _) = write(&machine, &options(&machine), steps(&print)).unwrap();
    assert_eq!(text.matches("S150").count(), 3);
    assert_eq!(text.matches("\nM109 T").count(), 4);
}

#[test]
fn a_path_goes_on_where_it_was_after_a_change_of_heads() {
    let machine = machine("prusa-xl-5t");
    let print = [layer(0), color(0), travel(0.0, 0.0), line(10.0, 5.0), color(1), line(20.0, 5.0)];
    let (text, summary) = write(&machine, &options(&machine), steps(&print)).unwrap();
    let picked = text.find("T1 S1 L0 D0").unwrap();
    let after: Vec<&str> = text[picked..].lines().skip(1).collect();
    let back = "G1 X110.000 Y105.000 F18000";
    assert!(after.iter().position(|l| *l == back) < after.iter().position(|l| l.contains("X120")));
    assert!(text.contains(back), "{text}");
    assert_eq!(summary.filament_mm3.len(), 5);
}

#[test]
fn beads_below_the_resolution_are_not_written_but_fed() {
    let machine = machine("generic-mixing");
    let mut print = vec![layer(0), color(0), travel(0.0, 0.0)];
    print.extend((1..=4000).map(|i| line(f64::from(i) * 0.0002, 0.0)));
    print.push(line(10.0, 0.0));
    let (text, summary) = write(&machine, &options(&machine), steps(&print)).unwrap();
    let written = body(&text).iter().filter(|l| l.starts_with("G1 X") && l.contains('E')).count();
    assert!((700..=801).contains(&written), "{written}");
    let exact = 10.0 * bead::area(0.4, 0.2);
    assert!((summary.extruded_mm3 - exact).abs() < 1e-9);
    assert!((totals(&text).filament - exact / AREA).abs() < 1e-5);
}

#[test]
fn progress_and_layers() {
    let machine = machine("generic-mixing");
    let options = WriterOptions { progress: true, ..options(&machine) };
    let mut print = two_layers();
    print.extend((0..100).map(|i| line(if i % 2 == 0 { 80.0 } else { 0.0 }, 0.0)));
    let (text, summary) = write(&machine, &options, steps(&print)).unwrap();
    assert!(!text.contains("\nM73"));

    let mut file = std::io::Cursor::new(text.clone().into_bytes());
    summary.progress.fill(&mut file).unwrap();
    let filled = String::from_utf8(file.into_inner()).unwrap();
    let told: Vec<&str> = filled.lines().filter(|l| l.starts_with("M73")).collect();
    assert_eq!(told.len(), summary.progress.len());
    let minutes = (summary.print_time_s / 60.0).ceil() as u32;
    assert_eq!(told[0], format!("M73 P000 R{minutes:05}"));
    assert_eq!(told.last(), Some(&"M73 P100 R00000"));
    assert!(told.len() as f64 > summary.print_time_s / 35.0, "{told:?}");
    assert!(told.windows(2).all(|w| w[0][..8] < w[1][..8] && w[0][9..] >= w[1][9..]), "{told:?}");
    let rest = |text: &str| -> Vec<String> {
        text.lines().filter(|l| !l.contains("M73")).map(str::to_owned).collect()
    };
    assert_eq!(rest(&filled), rest(&text));

    let silent = WriterOptions { progress: false, ..options };
    let (silent, summary) = write(&machine, &silent, steps(&print)).unwrap();
    assert!(summary.progress.is_empty() && !silent.contains("M73"));
    assert_eq!(summary.layers, 3);
    let heights: Vec<&str> = text.lines().filter(|l| l.starts_with(";Z:")).collect();
    assert_eq!(heights, [";Z:0.2", ";Z:0.4", ";Z:0.6"]);
}

#[test]
fn flows_stay_within_the_limits_of_the_machine_and_its_inputs() {
    // Feedrates of the beads in the palette's four colours: shares of 1/8, 3/8, 5/8 and 7/8.
    let feedrates = |most: Option<f64>, inputs: &[f64]| {
        let mut machine = machine("generic-mixing");
        (machine.max_flow, machine.max_input_flow) = (most, inputs.to_vec());
        let mut print = vec![layer(0), layer(1), travel(0.0, 0.0)];
        for c in 0..4 {
            print.extend([color(c), line(f64::from((c + 1) % 2) * 40.0, 10.0 * f64::from(c))]);
        }
        let (text, _) = write(&machine, &options(&machine), steps(&print)).unwrap();
        let mut feedrate = 0.0;
        let beads = lines(&text.as_bytes()[text.find(";LAYER_CHANGE").unwrap()..])
            .filter_map(|l| l.command)
            .filter_map(|c| {
                feedrate = c.value(b'F').unwrap_or(feedrate);
                (c.has(b'X') || c.has(b'Y')).then_some(())?;
                c.has(b'E').then_some(feedrate)
            });
        beads.collect::<Vec<f64>>()
    };
    let area = bead::area(0.4, 0.2);
    let at = |flow: f64| (60.0 * flow / area).round();
    for (most, inputs, want) in [
        (None, &[][..], [2700.0; 4]),
        (Some(2.0), &[], [at(2.0); 4]),
        // The second filament is the slow one: it lets the first colour pass, the last hardly.
        (None, &[10.0, 1.0], [2700.0, at(8.0 / 3.0), at(1.6), at(8.0 / 7.0)]),
        (Some(1.5), &[10.0, 1.0], [at(1.5), at(1.5), at(1.5), at(8.0 / 7.0)]),
        (None, &[1.0], [at(8.0 / 7.0), at(1.6), at(8.0 / 3.0), 2700.0]),
    ] {
        assert_eq!(feedrates(most, inputs), want, "{most:?} {inputs:?}");
    }
}

struct Laser;

impl Dialect for Laser {
    fn state(&mut self, change: &Change<'_>, out: &mut Text) -> Result<(), GcodeError> {
        let power = (255.0 * change.state.mixture.fractions()[0]).round();
        out.raw("M3").int('S', power as u32).end();
        Ok(())
    }
}

#[test]
fn a_dialect_of_your_own() {
    let machine = machine("generic-mixing");
    let (states, options) = (palette(&machine, 4), options(&machine));
    let mut out = Vec::new();
    let mut writer =
        Writer::with_dialect(&mut out, &machine, &states, &options, Box::new(Laser)).unwrap();
    two_layers().into_iter().try_for_each(|m| writer.push(m)).unwrap();
    writer.finish().unwrap();
    let text = String::from_utf8(out).unwrap();
    assert!(text.contains(";COLOR:1 0.625 0.375\nM3 S159\n"), "{text}");
}

fn paths() -> impl Strategy<Value = Vec<Motion>> {
    let near = prop_oneof![-50.0..50.0f64, -1e-3..1e-3f64, Just(0.0005), Just(0.0)];
    let motion = prop_oneof![
        6 => (near.clone(), near.clone(), 0.3..0.8f64).prop_map(|(x, y, width)| {
            Motion::Extrude { to: Point2::new(x, y), width, role: Role::Infill }
        }),
        2 => (near.clone(), near).prop_map(|(x, y)| travel(x, y)),
        1 => (0u16..4).prop_map(color),
    ];
    prop::collection::vec(motion, 1..60)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_filament_is_lost_to_rounding(paths in paths()) {
        let machine = machine("generic-mixing");
        let mut print = vec![layer(0), travel(0.0, 0.0)];
        print.extend(paths);
        // The last bead is long, so that nothing stays owed to beads too short to be written.
        print.push(line(90.0, 90.0));
        let (text, summary) = write(&machine, &options(&machine), steps(&print)).unwrap();
        let seen = totals(&text);
        prop_assert!((seen.filament - summary.extruded_mm3 / AREA).abs() <= 1.01e-5);
        prop_assert_eq!(seen.moves, summary.moves);
        // Each retraction is undone before the next bead.
        let mut retracted = 0.0;
        for command in lines(text.as_bytes()).filter_map(|l| l.command) {
            let plane = command.has(b'X') || command.has(b'Y');
            match command.value(b'E').filter(|_| command.is(b'G', 1)) {
                Some(e) if !plane => retracted += e,
                Some(_) => prop_assert!(retracted == 0.0, "printed while retracted"),
                None => {}
            }
        }
    }
}

#[test]
fn a_firmware_that_scales_the_weights_gets_its_filament_all_the_same() {
    let mut machine = machine("snmf-4");
    let print = steps(&[layer(0), travel(0.0, 0.0), color(0), line(20.0, 0.0), line(40.0, 0.0)]);
    let filament = |machine: &Machine| {
        let (text, summary) = write(machine, &options(machine), print.clone()).unwrap();
        (totals(&text).filament, summary.filament_mm3)
    };
    assert!(machine.dialect.normalises);
    let (scaled, fed) = filament(&machine);
    machine.dialect.normalises = false;
    let (plain, same) = filament(&machine);
    assert!((scaled - 2.0 * plain).abs() < 1e-4, "{scaled} {plain}");
    assert_eq!(fed, same);
}

#[test]
fn an_auger_with_a_speed_of_its_own_is_told_it() {
    let mut machine = machine("generic-mixing");
    machine.auger.flow = Some(2.0);
    machine.auger.command = "M3 S{rpm}".into();
    machine.auger.stop = "M5".into();
    machine.speed.first_layer = 30.0;
    machine.speed.inner_wall = 30.0;
    let wide = Motion::Extrude { to: Point2::new(60.0, 0.0), width: 0.8, role: Role::InnerWall };
    let print = [layer(0), travel(0.0, 0.0), line(20.0, 0.0), line(40.0, 0.0), wide];
    let (text, _) = write(&machine, &options(&machine), steps(&print)).unwrap();
    let told: Vec<&str> =
        text.lines().filter(|l| l.starts_with("M3 ") || l.starts_with("M5")).collect();
    // 60 Q / Q0, with Q the section times 30 mm/s.
    let turns = |width: f64| (60.0 * bead::area(width, 0.2) * 30.0 / 2.0).round();
    assert_eq!(told, [format!("M3 S{}", turns(0.4)), format!("M3 S{}", turns(0.8)), "M5".into()]);
}

#[test]
fn a_state_between_colours_is_told_and_counted() {
    let machine = machine("generic-mixing");
    let between = State::plain(Mixture::from_weights(&[0.4, 0.6]).unwrap());
    let mut print = steps(&[layer(0), travel(0.0, 0.0), color(0), line(20.0, 0.0)]);
    print.push(Step::Tell { color: ColorId(1), state: between });
    print.extend(steps(&[line(40.0, 0.0)]));
    print.push(Step::Motion(Motion::Command(ColorId(1))));
    print.extend(steps(&[line(60.0, 0.0)]));
    let (text, summary) = write(&machine, &options(&machine), print).unwrap();
    assert!(text.contains(";COLOR:1 0.4 0.6\nM163 S0 P0.4\nM163 S1 P0.6\nM164 S0\n"), "{text}");
    assert_eq!(summary.state_changes, 2);
    let third = 20.0 * bead::area(0.4, 0.2);
    let shares = [0.875, 0.4, 0.625].iter().sum::<f64>();
    assert!((summary.filament_mm3[0] - third * shares).abs() < 1e-9, "{summary:?}");
}

#[test]
fn travels_that_follow_each_other_are_one() {
    let machine = machine("generic-mixing");
    let moves = |to: &[(f64, f64)]| {
        let mut print = vec![layer(0), color(0), travel(0.0, 0.0), line(10.0, 0.0)];
        print.extend(to.iter().map(|&(x, y)| travel(x, y)));
        print.push(line(20.0, 0.0));
        let text = write(&machine, &options(&machine), steps(&print)).unwrap().0;
        let lines = body(&text).into_iter().filter(|l| l.starts_with("G1")).map(str::to_owned);
        lines.skip_while(|l| !l.starts_with("G1 X110.000 E")).skip(1).take(5).collect::<Vec<_>>()
    };
    // Each way shorter than the 2 mm that are worth pulling back for, together longer.
    let round = moves(&[(11.5, 0.0), (11.5, 1.5)]);
    assert_eq!(round[0], "G1 E-2.00000 F2100", "{round:?}");
    assert!(round[2].starts_with("G1 X111.500 F") && round[3] == "G1 Y101.500", "{round:?}");
    let short = moves(&[(10.5, 0.0), (10.5, 0.5)]);
    assert!(short[0].starts_with("G1 X110.500 F") && short[1] == "G1 Y100.500", "{short:?}");
}
