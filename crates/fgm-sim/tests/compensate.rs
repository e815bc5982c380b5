//! Commands chosen, and what comes of them.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::convert::Infallible;

use fgm_core::{ColorId, Mixture, Motion, Point2, Role};
use fgm_gcode::{Lead, State, Step};
use fgm_sim::{Compensate, CompensateOptions, Compensated, Transition};
use proptest::prelude::*;

/// A bead of 1 mm³ a mm.
const WIDTH: f64 = 1.0 + (1.0 - std::f64::consts::FRAC_PI_4);

fn options(transition: Transition) -> CompensateOptions {
    CompensateOptions {
        enabled: true,
        transition,
        lead: transition.lead(),
        uncertainty: 0.2,
        shortest: 0.2,
        min_fraction: 0.01,
        decimals: 4,
    }
}

fn palette(colors: usize) -> Vec<Mixture> {
    let share = |i: usize| (i as f64 + 0.5) / colors as f64;
    (0..colors).map(|i| Mixture::from_weights(&[share(i), 1.0 - share(i)]).unwrap()).collect()
}

/// Pieces along a line, as many mm long as they have mm³.
fn motions(pieces: &[(u16, f64, Role)]) -> impl Iterator<Item = Motion> {
    let begin =
        [Motion::Layer { index: 0, z: 1.0, height: 1.0 }, Motion::Travel { to: Point2::ZERO }];
    let mut x = 0.0;
    begin.into_iter().chain(pieces.iter().flat_map(move |&(color, volume, role)| {
        x += volume;
        let bead = Motion::Extrude { to: Point2::new(x, 0.0), width: WIDTH, role };
        [Motion::Color(ColorId(color)), bead]
    }))
}

fn run(
    options: &CompensateOptions,
    palette: &[Mixture],
    pieces: &[(u16, f64, Role)],
) -> (Vec<Step>, Compensated) {
    let states: Vec<State> = palette.iter().map(|m| State::plain(*m)).collect();
    let mut compensate = Compensate::new(options, palette, &states);
    let mut steps = Vec::new();
    let mut emit = |step| {
        steps.push(step);
        Ok::<(), Infallible>(())
    };
    motions(pieces).for_each(|motion| compensate.push(motion, &mut emit).unwrap());
    let done = compensate.finish(&mut emit).unwrap();
    (steps, done)
}

/// A layer's colours there and back, as strategy 2 prints them.
fn snake(volumes: &[f64], layers: usize) -> Vec<(u16, f64, Role)> {
    let one: Vec<_> = (0..).zip(volumes).map(|(c, v)| (c, *v, Role::Infill)).collect();
    let turned: Vec<_> = one.iter().rev().copied().collect();
    (0..layers).flat_map(|i| if i % 2 == 0 { one.clone() } else { turned.clone() }).collect()
}

/// The slab of 16 colours in the volumes of strategy 2, and the measured transition of a machine:
/// L1 = 9 mm and L2 = 18 mm of a bead of 2 x 0.8 mm.
const SLAB: [f64; 16] = [
    201.8, 134.5, 161.5, 182.9, 199.3, 219.3, 257.2, 370.2, 370.2, 257.2, 219.3, 199.2, 182.9,
    161.6, 134.5, 249.5,
];
const MEASURED: Transition = Transition { delay: 13.164, length: 26.328 };

fn shares(done: &Compensated) -> Vec<f64> {
    done.fits.iter().map(|fit| fit.told / fit.plain).collect()
}

#[test]
fn without_towers_three_fifths_of_the_error_are_left() {
    let (_, done) = run(&options(MEASURED), &palette(16), &snake(&SLAB, 6));
    let shares = shares(&done);
    assert!(shares[0] <= 0.6, "{shares:?}");
    assert!(shares.iter().all(|share| *share <= 1.0), "{shares:?}");
}

#[test]
fn with_towers_next_to_nothing_is_left() {
    let mut print: Vec<(u16, f64, Role)> = Vec::new();
    for (color, volume, role) in snake(&SLAB, 2) {
        // The tower takes what comes before the new colour.
        let before = print.last().map_or(color, |(color, ..)| *color);
        print.push((before, MEASURED.purge(1.0 / 16.0, 0.01), Role::PurgeTower));
        print.push((color, volume, role));
    }
    let (_, done) = run(&options(MEASURED), &palette(16), &print);
    let shares = shares(&done);
    assert!(shares[0] <= 0.2, "{shares:?}");
    assert!(shares.iter().all(|share| *share <= 1.0), "{shares:?}");
}

/// As a snake, but each bead is to be what a gradient over all of it is there.
fn toward_gradient(volumes: &[f64], layers: usize, parts: usize) -> Compensated {
    let (options, palette) = (options(MEASURED), palette(16));
    let states: Vec<State> = palette.iter().map(|m| State::plain(*m)).collect();
    let mut compensate = Compensate::new(&options, &palette, &states);
    let emit = |_| Ok::<(), Infallible>(());
    let mut x = 0.0;
    let begin =
        [Motion::Layer { index: 0, z: 1.0, height: 1.0 }, Motion::Travel { to: Point2::ZERO }];
    begin.iter().for_each(|motion| compensate.push(*motion, emit).unwrap());
    for (i, (color, volume, role)) in snake(volumes, layers).into_iter().enumerate() {
        compensate.push(Motion::Color(ColorId(color)), emit).unwrap();
        // Odd layers come back.
        let back = (i / volumes.len()) % 2 == 1;
        for part in 0..parts {
            let wanted: Vec<Mixture> = (0..160 / parts)
                .map(|j| {
                    let along = ((part * (160 / parts) + j) as f64 + 0.5) / 160.0;
                    let along = if back { 1.0 - along } else { along };
                    let share = (f64::from(color) + along) / 16.0;
                    Mixture::from_weights(&[share, 1.0 - share]).unwrap()
                })
                .collect();
            x += volume / parts as f64;
            let bead = Motion::Extrude { to: Point2::new(x, 0.0), width: WIDTH, role };
            compensate.push_toward(bead, &wanted, emit).unwrap();
        }
    }
    compensate.finish(emit).unwrap()
}

#[test]
fn a_gradient_within_the_colors_is_followed() {
    let done = toward_gradient(&SLAB, 4, 1);
    let shares = shares(&done);
    // The plain lead leaves the steps of 16 colours.
    assert!((done.fits[0].plain - 1.0 / 16.0 / 12.0_f64.sqrt()).abs() < 3e-3, "{:?}", done.fits);
    assert!(shares[0] < 0.1, "{shares:?}");
    assert!(shares.iter().all(|share| *share <= 1.0), "{shares:?}");
    // How the beads are cut does not matter.
    for (a, b) in toward_gradient(&SLAB, 4, 80).fits.iter().zip(&done.fits) {
        assert!((a.told - b.told).abs() < 1e-4 && (a.plain - b.plain).abs() < 1e-4, "{a:?} {b:?}");
    }
}

#[test]
fn a_transition_too_short_to_shape_gives_the_plain_lead() {
    let print = snake(&SLAB, 2);
    for (transition, enabled) in [
        (Transition { delay: 20.0, length: 0.0 }, true),
        (Transition { delay: 20.0, length: 0.5 }, true),
        (MEASURED, false),
    ] {
        let options = CompensateOptions { enabled, ..options(transition) };
        let (steps, _) = run(&options, &palette(16), &print);
        let plain: Vec<Step> = Lead::new(options.lead).over(motions(&print)).collect();
        assert_eq!(steps, plain, "{transition:?}");
    }
}

#[test]
fn little_is_held_back() {
    let options = options(Transition { delay: 2.0, length: 4.0 });
    let palette = palette(4);
    let states: Vec<State> = palette.iter().map(|m| State::plain(*m)).collect();
    let mut compensate = Compensate::new(&options, &palette, &states);
    let (mut taken, mut given) = (0, 0);
    for motion in motions(&snake(&[7.0, 9.0, 8.0, 6.0], 200)) {
        taken += usize::from(matches!(motion, Motion::Extrude { .. }));
        let emit = |step| {
            given += usize::from(matches!(step, Step::Motion(Motion::Extrude { .. })));
            Ok::<(), Infallible>(())
        };
        compensate.push(motion, emit).unwrap();
        // Twenty-odd transitions of 4 mm³, in beads of 6 mm³ and more.
        assert!(taken <= given + 20, "{taken} {given}");
    }
}

/// Volumes, colours and roles of a print, some of them tiny.
fn prints() -> impl Strategy<Value = Vec<(u16, f64, Role)>> {
    let volume = prop_oneof![0.5..60.0f64, 1e-3..0.5f64, Just(20.0)];
    let role = prop_oneof![4 => Just(Role::Infill), 1 => Just(Role::PurgeTower)];
    prop::collection::vec((0u16..5, volume, role), 1..60)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn commands_are_possible_and_the_deposit_is_no_worse(
        print in prints(),
        delay in prop_oneof![Just(0.0), 0.0..30.0f64],
        length in prop_oneof![0.0..3.0f64, 3.0..30.0f64],
        uncertainty in prop_oneof![Just(0.0), Just(0.2), 0.0..0.5f64],
        shortest in prop_oneof![Just(0.2), 0.05..4.0f64],
        materials in 1usize..5,
    ) {
        let weights = |i: usize| (0..materials).map(move |m| ((i * 7 + m * m * 3) % 5) as f64 + 0.01);
        let palette: Vec<Mixture> =
            (0..5).map(|i| Mixture::from_weights(&weights(i).collect::<Vec<_>>()).unwrap()).collect();
        let options =
            CompensateOptions { uncertainty, shortest, ..options(Transition { delay, length }) };
        let (steps, done) = run(&options, &palette, &print);
        for fit in &done.fits {
            prop_assert!(fit.told <= fit.plain * (1.0 + 1e-9) + 1e-9, "{:?}", fit);
        }
        // The beads are those that were given, in their order.
        let end = print.iter().map(|p| p.1).sum::<f64>();
        let (mut at, mut told_at, mut tells) = (0.0, f64::NEG_INFINITY, 0);
        for step in &steps {
            match step {
                Step::Motion(Motion::Extrude { to, .. }) => {
                    prop_assert!(to.x >= at);
                    at = to.x;
                }
                Step::Tell { state, .. } => {
                    let units: Vec<f64> = state.mixture.fractions().iter().map(|f| f * 1e4).collect();
                    prop_assert!(units.iter().all(|u| (u - u.round()).abs() < 1e-6), "{:?}", units);
                    prop_assert!(units.iter().all(|u| *u == 0.0 || *u > 99.9), "{:?}", units);
                    prop_assert!((units.iter().sum::<f64>() - 1e4).abs() < 1e-6);
                    prop_assert!(at - told_at >= shortest - 3e-4, "{} {}", told_at, at);
                    (told_at, tells) = (at, tells + 1);
                }
                Step::Motion(Motion::Command(_)) if tells > 0 => {
                    prop_assert!(at - told_at >= shortest - 3e-4, "{} {}", told_at, at);
                    told_at = at;
                }
                _ => {}
            }
        }
        prop_assert!((at - end).abs() < 1e-6, "{} {}", at, end);
    }
}
