//! Temperatures in time, seen through the model of the nozzle.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::convert::Infallible;

use fgm_core::{ColorId, Mixture, Motion, Point2, Point3, Role, bead};
use fgm_gcode::{Lead, Machine, Reader, State, Step, Writer, WriterOptions};
use fgm_sim::{Deposit, Model, Piece, Preheat, Replay, ReplayOptions};
use proptest::prelude::*;

const LEAD: f64 = 4.0;

fn machine() -> Machine {
    let mut machine = Machine::builtin("prusa-mk4s-lw-pla").unwrap();
    machine.foaming.heating = Some(1.5);
    machine.foaming.cooling = Some(1.0);
    machine.lead.volume = Some(LEAD);
    machine
}

fn states(machine: &Machine) -> Vec<State> {
    let share = |i: usize| i as f64 / 3.0;
    let mixtures: Vec<Mixture> =
        (0..4).map(|i| Mixture::from_weights(&[1.0 - share(i), share(i)]).unwrap()).collect();
    machine.states(&mixtures).unwrap()
}

/// Lines of 100 mm, `lines` of each colour.
fn print(colors: &[u16], lines: usize, role: Role) -> Vec<Motion> {
    let mut print =
        vec![Motion::Layer { index: 0, z: 0.2, height: 0.2 }, Motion::Travel { to: Point2::ZERO }];
    let mut line = 0;
    for color in colors {
        print.push(Motion::Color(ColorId(*color)));
        for _ in 0..lines {
            let (y, x) = (0.4 * f64::from(line), if line % 2 == 0 { 100.0 } else { 0.0 });
            print.push(Motion::Extrude { to: Point2::new(100.0 - x, y), width: 0.4, role });
            print.push(Motion::Extrude { to: Point2::new(x, y), width: 0.4, role });
            line += 1;
        }
    }
    print
}

fn steps(machine: &Machine, print: &[Motion], early: bool) -> Vec<Step> {
    let states = states(machine);
    let lead = machine.dead_volume();
    let mut steps = Vec::new();
    if !early {
        return Lead::new(lead).over(print.iter().copied()).collect();
    }
    let mut preheat = Preheat::of(machine, lead, &states).unwrap();
    let mut emit = |step| {
        steps.push(step);
        Ok::<(), Infallible>(())
    };
    print.iter().for_each(|m| preheat.push(*m, &mut emit).unwrap());
    preheat.finish(&mut emit).unwrap();
    steps
}

fn pieces(machine: &Machine, steps: &[Step]) -> Vec<Piece> {
    let mut gcode = Vec::new();
    let options =
        WriterOptions { offset: Point3::new(50.0, 50.0, 0.0), ..WriterOptions::of(machine) };
    let mut writer = Writer::new(&mut gcode, machine, &states(machine), &options).unwrap();
    steps.iter().for_each(|step| writer.push(*step).unwrap());
    writer.finish().unwrap();
    let options = ReplayOptions { machine: Some(machine.clone()), ..ReplayOptions::default() };
    let (mut deposit, mut pieces) = (Deposit::new(&Model::of(machine)), Vec::new());
    for event in Replay::new(Reader::new(&gcode[..]), &options) {
        deposit.push(&event.unwrap(), &mut |piece| {
            // The start template's purge line lies before the print.
            if piece.is_part() && piece.from.y > 49.0 {
                pieces.push(*piece);
            }
        });
    }
    pieces
}

/// Mean errors of the temperature, °C, and of the volume, as a share.
fn errors(pieces: &[Piece], colors: &[u16], lines: usize) -> (f64, f64) {
    let (mut celsius, mut volume, mut length) = (0.0, 0.0, 0.0);
    for piece in pieces {
        let line = ((piece.at(0.5).y - 50.0) / 0.4 + 0.5).max(0.0) as usize;
        let share = f64::from(colors[(line / lines).min(colors.len() - 1)]) / 3.0;
        let wanted = (190.0 + 35.0 * share).round();
        celsius += piece.length() * (piece.celsius.unwrap() - wanted).abs();
        volume += (piece.volume - piece.length() * bead::area(0.4, 0.2)).abs();
        length += piece.length();
    }
    (celsius / length, volume / length / bead::area(0.4, 0.2))
}

#[test]
fn temperatures_are_nearer_and_the_flow_fits_them() {
    let machine = machine();
    let colors = [0, 3, 1, 2, 0];
    let print = print(&colors, 6, Role::Infill);
    let of = |early| errors(&pieces(&machine, &steps(&machine, &print, early)), &colors, 6);
    let ((late_c, late_v), (early_c, early_v)) = (of(false), of(true));
    assert!(early_c < 0.6 * late_c, "{early_c} {late_c}");
    assert!(early_v < 0.25 * late_v && early_v < 0.01, "{early_v} {late_v}");
}

#[test]
fn after_a_tower_the_change_is_over() {
    let machine = machine();
    let mut print = print(&[0], 8, Role::PurgeTower);
    print.push(Motion::Color(ColorId(3)));
    let at = Point2::new(100.0, 3.0);
    print.push(Motion::Extrude { to: at, width: 0.4, role: Role::Infill });
    let pieces = pieces(&machine, &steps(&machine, &print, true));
    let worst = pieces.iter().map(|p| (p.celsius.unwrap() - 225.0).abs()).fold(0.0, f64::max);
    assert!(!pieces.is_empty() && worst < 1.5, "{worst}");
}

proptest! {
    #[test]
    fn beads_stay_as_they_are(
        colors in prop::collection::vec(0u16..4, 1..12),
        lines in 1usize..5,
        heating in 0.2..20.0f64,
        lead in 0.0..20.0f64,
    ) {
        let mut machine = machine();
        machine.foaming.heating = Some(heating);
        machine.lead.volume = Some(lead);
        let print = print(&colors, lines, Role::Infill);
        let steps = steps(&machine, &print, true);
        let length = |motions: &mut dyn Iterator<Item = Motion>| {
            let (mut at, mut sum) = (Point2::ZERO, 0.0);
            for motion in motions {
                if let Motion::Extrude { to, .. } = motion {
                    sum += at.distance(to);
                    at = to;
                }
            }
            sum
        };
        let before = length(&mut print.iter().copied());
        let after = length(&mut steps.iter().filter_map(|step| match step {
            Step::Motion(motion) => Some(*motion),
            _ => None,
        }));
        prop_assert!((before - after).abs() < 1e-6, "{} {}", before, after);
        // Every change is told, and flows are those of temperatures in between.
        let changes = colors.windows(2).filter(|w| w[0] != w[1]).count();
        let told = steps.iter().filter(|s| matches!(s, Step::Motion(Motion::Command(_)))).count();
        prop_assert_eq!(told, changes + 1);
        for step in &steps {
            if let Step::Flow(flow) = step {
                prop_assert!((0.5..1.05).contains(flow), "{}", flow);
            }
        }
    }
}
