//! The look-ahead against a slow and plain way to find the same places.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use fgm_core::{ColorId, Motion, Point2, Role, bead};
use fgm_gcode::{Lead, Step};
use proptest::prelude::*;

const WIDTH: f64 = 0.4;

fn line(x: f64, y: f64) -> Motion {
    Motion::Extrude { to: Point2::new(x, y), width: WIDTH, role: Role::Infill }
}

/// Volume extruded before each step, from the beginning; the last is the total.
fn volumes(steps: &[Step]) -> Vec<f64> {
    let (mut at, mut height, mut total) = (Point2::ZERO, 0.0, 0.0);
    let mut volumes = vec![0.0];
    for step in steps {
        match *step {
            Step::Motion(Motion::Layer { height: h, .. }) => height = h,
            Step::Motion(Motion::Travel { to }) => at = to,
            Step::Motion(Motion::Extrude { to, width, .. }) => {
                total += at.distance(to) * bead::area(width, height);
                at = to;
            }
            _ => {}
        }
        volumes.push(total);
    }
    volumes
}

/// Whether the steps are the print, with nothing but beads cut in pieces.
fn agrees(print: &[Motion], steps: &[Step]) -> Result<(), TestCaseError> {
    let (mut at, mut next) = (Point2::ZERO, 0);
    for step in steps {
        let Step::Motion(motion) = *step else { continue };
        if matches!(motion, Motion::Command(_)) {
            continue;
        }
        prop_assert!(next < print.len());
        if motion == print[next] {
            next += 1;
        } else {
            let Motion::Extrude { to: end, width, role } = print[next] else {
                return Err(TestCaseError::fail(format!("{motion:?} for {:?}", print[next])));
            };
            let Motion::Extrude { to: cut, .. } = motion else {
                return Err(TestCaseError::fail(format!("{motion:?} inside a bead")));
            };
            prop_assert_eq!(motion, Motion::Extrude { to: cut, width, role });
            let detour = at.distance(cut) + cut.distance(end) - at.distance(end);
            prop_assert!(detour.abs() < 1e-9, "{} off the bead", detour);
        }
        if let Motion::Extrude { to, .. } | Motion::Travel { to } = motion {
            at = to;
        }
    }
    prop_assert_eq!(next, print.len());
    Ok(())
}

fn run(lead: Lead, print: &[Motion]) -> Vec<Step> {
    lead.over(print.iter().copied()).collect()
}

/// Where each command stands and where its colour begins, mm³; in order.
fn leads(steps: &[Step]) -> Vec<(ColorId, f64, f64)> {
    let volumes = volumes(steps);
    let at = |wanted: fn(Motion) -> Option<ColorId>| {
        let mut found: Vec<(ColorId, f64)> = Vec::new();
        for (step, volume) in steps.iter().zip(&volumes) {
            if let Step::Motion(motion) = *step
                && let Some(color) = wanted(motion)
                && found.last().is_none_or(|(last, _)| *last != color)
            {
                found.push((color, *volume));
            }
        }
        found
    };
    let commands = at(|m| if let Motion::Command(c) = m { Some(c) } else { None });
    let colors = at(|m| if let Motion::Color(c) = m { Some(c) } else { None });
    assert_eq!(commands.len(), colors.len());
    commands
        .iter()
        .zip(&colors)
        .map(|(command, color)| {
            assert_eq!(command.0, color.0, "commands keep their order");
            (color.0, command.1, color.1)
        })
        .collect()
}

#[test]
fn the_plate_of_figure_14() {
    // Hatched along y, one change at mid x, dead volume 68.6 mm³.
    let mut print =
        vec![Motion::Layer { index: 0, z: 0.2, height: 0.2 }, Motion::Color(ColorId(0))];
    print.push(Motion::Travel { to: Point2::ZERO });
    for i in 0..200 {
        if i == 100 {
            print.push(Motion::Color(ColorId(1)));
        }
        let x = f64::from(i) * 0.357;
        let (from, to) = if i % 2 == 0 { (0.0, 60.0) } else { (60.0, 0.0) };
        print.extend([Motion::Travel { to: Point2::new(x, from) }, line(x, to)]);
    }
    let steps = run(Lead::new(68.6), &print);
    let leads = leads(&steps);
    assert_eq!(leads[0].1, 0.0);
    assert!((leads[1].2 - leads[1].1 - 68.6).abs() < 1e-3, "{leads:?}");
}

#[test]
fn across_layers_and_several_colours_at_once() {
    let mut print = Vec::new();
    for index in 0..20_u32 {
        let height = if index % 2 == 0 { 0.2 } else { 0.3 };
        print.push(Motion::Layer { index, z: f64::from(index + 1) * 0.25, height });
        print.push(Motion::Color(ColorId((index % 5) as u16)));
        print.push(Motion::Travel { to: Point2::ZERO });
        print.push(line(30.0, 0.0));
    }
    let volume = 8.0;
    let steps = run(Lead::new(volume), &print);
    for (color, command, boundary) in leads(&steps) {
        assert!((command - (boundary - volume).max(0.0)).abs() < 1e-4, "{color:?}");
    }
}

#[test]
fn no_volume_no_change_of_the_order() {
    let print = [
        Motion::Color(ColorId(2)),
        Motion::Layer { index: 0, z: 0.2, height: 0.2 },
        Motion::Travel { to: Point2::ZERO },
        line(1.0, 0.0),
        Motion::Color(ColorId(1)),
        Motion::Color(ColorId(1)),
        line(2.0, 0.0),
    ];
    let steps: Vec<Motion> = Lead::new(0.0).motions(print).collect();
    assert_eq!(steps[..2], [Motion::Command(ColorId(2)), print[0]]);
    assert_eq!(steps[2..5], print[1..4]);
    assert_eq!(steps[5..8], [Motion::Command(ColorId(1)), print[4], print[5]]);
    for volume in [f64::NAN, -1.0] {
        assert_eq!(Lead::new(volume).motions(print).collect::<Vec<_>>(), steps);
    }
}

#[test]
fn notices_come_early_and_commands_stay() {
    let print = [
        Motion::Layer { index: 0, z: 0.2, height: 0.2 },
        Motion::Color(ColorId(0)),
        Motion::Travel { to: Point2::ZERO },
        line(100.0, 0.0),
        Motion::Color(ColorId(1)),
        line(100.0, 50.0),
    ];
    let steps = run(Lead::notice(20.0 * bead::area(WIDTH, 0.2)), &print);
    let kinds: Vec<String> = steps
        .iter()
        .map(|step| match step {
            Step::Notice(c) => format!("notice {}", c.0),
            Step::Motion(Motion::Command(c)) => format!("command {}", c.0),
            Step::Motion(Motion::Color(c)) => format!("colour {}", c.0),
            Step::Motion(Motion::Extrude { to, .. }) => format!("{:.0},{:.0}", to.x, to.y),
            Step::Motion(_) | Step::Tell { .. } | Step::Flow(_) => "-".into(),
        })
        .collect();
    let expected = "command 0 - colour 0 - 80,0 notice 1 100,0 command 1 colour 1 100,50";
    assert_eq!(kinds.join(" "), expected);
}

#[test]
fn the_flow_of_a_role_counts() {
    let print = [
        Motion::Color(ColorId(0)),
        Motion::Layer { index: 0, z: 0.2, height: 0.2 },
        Motion::Travel { to: Point2::ZERO },
        line(100.0, 0.0),
        Motion::Color(ColorId(1)),
        line(200.0, 0.0),
    ];
    let lead = Lead::new(20.0 * bead::area(WIDTH, 0.2)).with_flow(Role::Infill, 2.0);
    let split = lead.motions(print).find_map(|m| match m {
        Motion::Extrude { to, .. } => Some(to.x),
        _ => None,
    });
    assert!((split.unwrap() - 90.0).abs() < 1e-9);
}

#[test]
fn a_volume_at_the_end_of_a_bead_splits_nothing() {
    let area = bead::area(WIDTH, 0.2);
    for (volume, beads) in [(10.0 * area, 3), ((10.0 + 5e-5) * area, 3), (9.0 * area, 4)] {
        let print = [
            Motion::Color(ColorId(0)),
            Motion::Layer { index: 0, z: 0.2, height: 0.2 },
            Motion::Travel { to: Point2::ZERO },
            line(10.0, 0.0),
            line(20.0, 0.0),
            Motion::Color(ColorId(1)),
            line(30.0, 0.0),
        ];
        let extrusions = Lead::new(volume).motions(print);
        assert_eq!(extrusions.filter(|m| matches!(m, Motion::Extrude { .. })).count(), beads);
    }
}

fn prints() -> impl Strategy<Value = Vec<Motion>> {
    let point = (0.0..50.0f64, 0.0..50.0f64).prop_map(|(x, y)| Point2::new(x, y));
    let short = (0.0..1e-3f64).prop_map(|d| Point2::new(25.0 + d, 25.0));
    let to = prop_oneof![4 => point.clone(), 1 => short];
    let role = prop::sample::select(Role::ALL.to_vec());
    let motion = prop_oneof![
        8 => (to, 0.3..0.9f64, role).prop_map(|(to, width, role)| Motion::Extrude { to, width, role }),
        2 => point.prop_map(|to| Motion::Travel { to }),
        2 => (0u16..4).prop_map(|c| Motion::Color(ColorId(c))),
        1 => (0.1..0.4f64).prop_map(|height| Motion::Layer { index: 0, z: 1.0, height }),
    ];
    prop::collection::vec(motion, 0..80).prop_map(|mut print| {
        print.insert(0, Motion::Layer { index: 0, z: 0.2, height: 0.2 });
        print.insert(1, Motion::Travel { to: Point2::ZERO });
        print
    })
}

/// Where the commands belong: for every change, the whole print is added up again.
fn oracle(print: &[Motion], volume: f64) -> Vec<f64> {
    let steps: Vec<Step> = print.iter().map(|m| Step::Motion(*m)).collect();
    let mut last = None;
    let mut places = Vec::new();
    for (i, motion) in print.iter().enumerate() {
        if let Motion::Color(color) = motion
            && last.replace(*color) != Some(*color)
        {
            places.push((volumes(&steps[..i]).last().unwrap() - volume).max(0.0));
        }
    }
    places
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn as_the_oracle_says(
        print in prints(),
        volume in prop_oneof![Just(0.0), 0.0..1.0f64, 0.0..60.0f64],
    ) {
        let steps = run(Lead::new(volume), &print);
        agrees(&print, &steps)?;
        // 0.0001 mm of the largest bead here.
        let near = 1e-4 * bead::area(0.9, 0.4) + 1e-9;
        let places = oracle(&print, volume);
        let leads = leads(&steps);
        prop_assert_eq!(places.len(), leads.len());
        for (place, (_, command, _)) in places.iter().zip(leads) {
            prop_assert!((place - command).abs() <= near, "{} {}", place, command);
        }
        // Splitting changes no length.
        let total = |steps: &[Step]| *volumes(steps).last().unwrap();
        let whole: Vec<Step> = print.iter().map(|m| Step::Motion(*m)).collect();
        prop_assert!((total(&steps) - total(&whole)).abs() < 1e-9);
    }

    #[test]
    fn notices_stand_where_commands_would(print in prints(), volume in 0.0..20.0f64) {
        let early = run(Lead::new(volume), &print);
        let notices = run(Lead::notice(volume), &print);
        agrees(&print, &notices)?;
        let places = |steps: &[Step], wanted: fn(&Step) -> bool| -> Vec<f64> {
            let volumes = volumes(steps);
            steps.iter().zip(volumes).filter(|(s, _)| wanted(s)).map(|(_, v)| v).collect()
        };
        let commands = places(&early, |s| matches!(s, Step::Motion(Motion::Command(_))));
        let noticed = places(&notices, |s| matches!(s, Step::Notice(_)));
        prop_assert_eq!(&commands[1.min(commands.len())..], &noticed[..]);
    }
}
