//! What is laid down: nothing lost, nothing in two places, the mixture that was commanded before.

#![allow(clippy::unwrap_used, reason = "tests")]

use fgm_core::{Mixture, Point3};
use fgm_gcode::Machine;
use fgm_sim::{Bead, Deposit, Event, Heat, Model, Piece, Thermal, Transition};
use proptest::prelude::*;

fn bead(from: f64, to: f64, fed: f64, share: f64, celsius: f64) -> Bead {
    Bead {
        line: 1,
        layer: Some(0),
        from: Point3::new(from, 0.0, 0.2),
        to: Point3::new(to, 0.0, 0.2),
        fed,
        height: 0.2,
        width: 0.4,
        role: None,
        head: 0,
        mixture: Mixture::from_weights(&[1.0 - share, share]).unwrap(),
        celsius: Some(celsius),
        seconds: fed / 2.0,
    }
}

fn lay(model: &Model, beads: &[Bead]) -> Vec<Piece> {
    let mut deposit = Deposit::new(model);
    let mut pieces = Vec::new();
    for bead in beads {
        deposit.push(&Event::Bead(*bead), &mut |piece| pieces.push(*piece));
    }
    pieces
}

fn second(mixture: &Mixture) -> f64 {
    mixture.fractions()[1]
}

fn foaming() -> Model {
    Model::ideal(&Machine::builtin("prusa-mk4s-lw-pla").unwrap())
}

/// Beads one after the other, each with a volume and a share of the second material.
fn beads() -> impl Strategy<Value = Vec<Bead>> {
    prop::collection::vec((1e-5..8.0f64, 0.0..1.0f64), 1..60).prop_map(|beads| {
        let mut at = 0.0;
        let made = beads.into_iter().map(|(fed, share)| {
            let from = at;
            at += 12.0 * fed;
            bead(from, at, fed, share, 190.0 + (35.0 * share).round())
        });
        made.collect()
    })
}

fn transitions() -> impl Strategy<Value = Transition> {
    let volume = || prop_oneof![Just(0.0), 0.1..40.0f64];
    (volume(), volume()).prop_map(|(delay, length)| Transition { delay, length })
}

proptest! {
    #[test]
    fn nothing_is_lost_and_pieces_join(beads in beads(), transition in transitions(), foam: bool) {
        let usual = Model::of(&Machine::default());
        let model = if foam { foaming() } else { usual }.with_transition(transition);
        let pieces = lay(&model, &beads);
        let fed: f64 = beads.iter().map(|b| b.fed).sum();
        let found: f64 = pieces.iter().map(|p| p.fed).sum();
        prop_assert!((fed - found).abs() < 1e-6 * fed, "{} {}", fed, found);
        prop_assert_eq!(pieces[0].from, beads[0].from);
        prop_assert_eq!(pieces[pieces.len() - 1].to, beads[beads.len() - 1].to);
        for pair in pieces.windows(2) {
            prop_assert_eq!(pair[0].to, pair[1].from);
        }
        for piece in &pieces {
            prop_assert!(piece.length() >= 0.0 && piece.volume >= 0.0 && piece.fed >= 0.0);
            if !foam {
                prop_assert_eq!(piece.volume, piece.fed);
            }
        }
    }

    /// The deposit at a volume is the mean of what was commanded before, whatever the beads.
    #[test]
    fn the_deposit_is_the_mean_of_the_commands(beads in beads(), transition in transitions()) {
        let model = Model::of(&Machine::default()).with_transition(transition);
        let mut at = 0.0;
        let commands: Vec<(f64, f64)> = beads
            .iter()
            .map(|b| {
                let command = (at, second(&b.mixture));
                at += b.fed;
                command
            })
            .collect();
        // The integral of the commands up to a volume.
        let upto = |volume: f64| -> f64 {
            let ends = commands.iter().skip(1).map(|c| c.0).chain([at]);
            let inside: f64 = commands
                .iter()
                .zip(ends)
                .map(|(c, end)| c.1 * (end.min(volume) - c.0).max(0.0))
                .sum();
            inside + commands[0].1 * volume.min(0.0)
        };
        let mut volume = 0.0;
        for piece in lay(&model, &beads) {
            let middle = volume + 0.5 * piece.volume;
            volume += piece.volume;
            let length = transition.length.max(1e-7);
            let to = middle - transition.delay;
            let expected = (upto(to) - upto(to - length)) / length;
            // Slivers of 1e-4 mm³ are not split off, and go with their neighbour.
            if piece.volume > 1e-3 {
                let found = second(&piece.mixture_at(0.5));
                let slack = 1e-4 + if transition.length > 0.0 { 2e-4 / length } else { 0.0 };
                prop_assert!((found - expected).abs() < slack, "{} {} {}", middle, found, expected);
            }
        }
    }

    #[test]
    fn foam_fills_what_its_temperature_makes_of_it(beads in beads(), transition in transitions()) {
        let model = foaming().with_transition(transition);
        let foaming = model.foaming.clone().unwrap();
        for piece in lay(&model, &beads) {
            let flow = foaming.flow_at(piece.celsius.unwrap());
            // Where the temperature changes along a piece, that is by 1 °C at most, of which the
            // flow changes by less than 2 %.
            let [a, b] = piece.deposited.map(|m| 35.0 * second(&m));
            let sliver = 40.0 * 2e-4 / transition.length.max(1e-3);
            prop_assert!((a - b).abs() < 1.0 + sliver, "{} {}", a, b);
            let slack = 1e-9 + 2e-3 * (a - b).abs();
            let off = (piece.fed - piece.volume * flow).abs();
            prop_assert!(off <= slack * piece.volume + 1e-4, "{:?}", piece);
        }
    }
}

#[test]
fn a_nozzle_that_follows_slowly_lays_down_what_it_is() {
    // 0.5 °C a second: after 10 s of printing the nozzle is at 195 °C.
    let thermal = Thermal { heating: 0.5, cooling: 0.5, time_constant: 0.0 };
    let model = Model { thermal: Some(thermal), ..foaming() };
    let mut deposit = Deposit::new(&model);
    let mut pieces: Vec<Piece> = Vec::new();
    let told = |celsius, wait| Event::Heat(Heat { head: 0, celsius, wait });
    let mut push = |event: &Event| deposit.push(event, &mut |p| pieces.push(*p));
    push(&told(190.0, true));
    push(&Event::Bead(bead(0.0, 10.0, 2.0, 0.0, 190.0)));
    push(&told(225.0, false));
    push(&Event::Bead(bead(10.0, 110.0, 20.0, 1.0, 225.0)));
    push(&Event::Pause { seconds: 100.0, filament: 0.0 });
    push(&Event::Bead(bead(110.0, 120.0, 2.0, 1.0, 225.0)));
    assert_eq!(pieces[0].celsius, Some(190.0));
    let warming: Vec<_> = pieces.iter().filter(|p| p.from.x >= 10.0 && p.to.x <= 110.0).collect();
    assert!(warming.len() >= 10, "{}", warming.len());
    for piece in &warming {
        let seconds = 10.0 * ((0.5 * (piece.from.x + piece.to.x)) - 10.0) / 100.0;
        let celsius = piece.celsius.unwrap();
        assert!((celsius - 190.0 - 0.5 * seconds).abs() <= 0.26, "{celsius} after {seconds} s");
    }
    assert_eq!(pieces.last().unwrap().celsius, Some(225.0));
}

#[test]
fn each_head_of_a_tool_changer_has_its_own_nozzle() {
    let model =
        Model::ideal(&Machine::default()).with_transition(Transition { delay: 1.0, length: 0.0 });
    let on = |head, share, x: f64| Bead { head, ..bead(x, x + 5.0, 2.0, share, 210.0) };
    let pieces = lay(&model, &[on(0, 0.0, 0.0), on(1, 1.0, 5.0), on(0, 0.0, 10.0)]);
    let seen: Vec<_> = pieces.iter().map(|p| (p.head, second(&p.deposited[0]))).collect();
    assert_eq!(seen, [(0, 0.0), (1, 1.0), (0, 0.0)]);
}
