use fgm_core::Point2;
use proptest::prelude::*;

use super::*;

fn piece(from: f64, to: f64, color: u16, role: Role) -> Piece {
    let points = vec![Point2::new(from, 0.0), Point2::new(to, 0.0)];
    Piece::new(points, role, 0.4, ColorId(color))
}

/// A print of colours 0 and 1, side by side, whose dead volume is `volume` mm³.
fn purge(volume: f64, transition: bool, hidden: bool, layout: PurgeLayout) -> Purge {
    let mut machine = Machine::builtin("generic-mixing").unwrap();
    if transition {
        machine.transition.delay = Some(1.0);
        machine.transition.change = Some(volume);
    }
    purge_on(&machine, volume, hidden, layout)
}

fn purge_on(machine: &Machine, volume: f64, hidden: bool, layout: PurgeLayout) -> Purge {
    let mut settings = Settings::default();
    settings.purge.layout = Some(layout);
    settings.purge.volume = Some(volume);
    if hidden {
        settings.purge.into = PurgeInto::Infill;
    }
    settings.purge.enabled = Some(true);
    let palette = [0.25, 0.75].map(|share| fgm_core::Mixture::from_weights(&[share, 1.0 - share]));
    let palette: Vec<_> = palette.into_iter().map(Result::unwrap).collect();
    let needs = Needs::new(machine, &settings, volume, palette);
    let demand = Demand::of(&needs, std::iter::repeat_n(vec![true; 2], 9));
    let part = Bounds3 { min: Point3::splat(-20.0), max: Point3::splat(20.0) };
    Purge::new(machine, &settings, needs, &demand, (&part, Point3::splat(100.0))).unwrap()
}

const HEIGHT: f64 = 0.2;

/// What a layer becomes: a letter for tower, hidden purge, infill, wall, then the colour and the
/// volume.
fn told(purge: &mut Purge, pieces: &[Piece], color: Option<u16>, count: usize) -> String {
    let color = color.map(ColorId);
    let told = purge.lay(pieces.to_vec(), color, count, HEIGHT).into_iter().map(|piece| {
        let letter = match piece.role {
            Role::PurgeTower => 'T',
            Role::PurgeInfill => 'H',
            Role::Infill => 'i',
            _ => 'w',
        };
        let volume = piece.length() * bead::area(piece.width, HEIGHT);
        format!("{letter}{}:{volume:.1}", piece.color.0)
    });
    told.collect::<Vec<_>>().join(" ")
}

/// Length that holds a volume, mm.
fn mm(volume: f64) -> f64 {
    volume / bead::area(0.4, HEIGHT)
}

fn layer(infill: f64) -> [Piece; 3] {
    [
        piece(0.0, mm(20.0), 0, Role::OuterWall),
        piece(0.0, mm(infill), 1, Role::Infill),
        piece(0.0, mm(7.0), 1, Role::OuterWall),
    ]
}

#[test]
fn a_purge_is_of_the_old_colour_up_to_its_end() {
    let mut purge = purge(30.0, false, false, PurgeLayout::One);
    // A sharp change may come anywhere in the dead volume.
    let got = told(&mut purge, &layer(50.0), Some(0), 3);
    assert!(got.starts_with("w0:20.0 T0:3") && got.ends_with("i1:50.0 w1:7.0"), "{got}");
    let report = purge.finish();
    assert_eq!((report.changes, report.purged, report.infill_mm3), (1, 1, 0.0));
    assert_eq!(report.layout, Some(PurgeLayout::One));
}

#[test]
fn a_known_transition_has_its_middle_in_the_middle() {
    let mut purge = purge(30.0, true, true, PurgeLayout::One);
    let got = told(&mut purge, &layer(50.0), Some(0), 3);
    let tower = got.split(' ').next().unwrap();
    assert!(tower.starts_with("T0:"), "it has to grow: {got}");
    let rest = got.strip_prefix(tower).unwrap();
    assert_eq!(rest, " w0:20.0 H0:15.0 H1:15.0 i1:20.0 w1:7.0");
}

/// Once the head that was put away was purged, not the one taken up.
#[test]
fn a_head_is_purged_of_its_own_colour() {
    let machine = Machine::builtin("prusa-xl-5t").unwrap();
    let mut tower = purge_on(&machine, 30.0, false, PurgeLayout::One);
    let got = told(&mut tower, &layer(50.0), Some(0), 3);
    assert!(got.starts_with("w0:20.0 T1:3") && got.ends_with("i1:50.0 w1:7.0"), "{got}");
    let mut infill = purge_on(&machine, 30.0, true, PurgeLayout::One);
    let got = told(&mut infill, &layer(50.0), Some(0), 3);
    assert!(got.ends_with(" w0:20.0 H1:30.0 i1:20.0 w1:7.0"), "{got}");
}

#[test]
fn hidden_filling_takes_what_it_can() {
    for (infill, want) in [
        (50.0, "w0:20.0 H0:30.0 i1:20.0 w1:7.0"),
        (30.0, "w0:20.0 H0:30.0 w1:7.0"),
        (29.95, "w0:20.0 H0:29.9 w1:7.0"),
    ] {
        let mut purge = purge(30.0, false, true, PurgeLayout::One);
        let got = told(&mut purge, &layer(infill), Some(0), 3);
        let rest = got.split_once(' ').unwrap().1;
        assert_eq!(rest, want, "{infill}");
        let report = purge.finish();
        assert!((report.infill_mm3 - infill.min(30.0)).abs() < 1e-9);
        assert!((report.saved.total.g - report.infill_mm3 * 1.24e-3).abs() < 1e-9);
    }
    // The tower takes the rest, before it.
    let mut purge = purge(30.0, false, true, PurgeLayout::Spots);
    let got = told(&mut purge, &layer(20.0), Some(0), 3);
    let mut parts = got.split(' ');
    assert!(parts.next().unwrap().starts_with("T0:"), "the other spot grows: {got}");
    assert_eq!(parts.next(), Some("w0:20.0"));
    assert!(parts.next().unwrap().starts_with("T0:1"), "{got}");
    assert!(got.ends_with("H0:20.0 w1:7.0"), "{got}");
}

#[test]
fn a_colour_that_nobody_sees_needs_no_purge() {
    let mut purge = purge(30.0, true, true, PurgeLayout::One);
    let unseen = [piece(0.0, mm(20.0), 0, Role::OuterWall), piece(0.0, mm(25.0), 1, Role::Infill)];
    let got = told(&mut purge, &unseen, Some(0), 3);
    assert_eq!(got.split_once(' ').unwrap().1, "w0:20.0 H0:25.0");
    // The nozzle still has the old colour.
    let got = told(&mut purge, &layer(50.0)[..1], Some(0), 4);
    assert!(got.ends_with(" w0:20.0"), "{got}");
    let report = purge.finish();
    assert_eq!((report.changes, report.purged), (1, 1));
    assert!((report.infill_mm3 - 25.0).abs() < 1e-9);
    assert_eq!(report.saved.infill.mm3, 30.0);
}

#[test]
fn the_order_of_layers_saves_a_change() {
    let mut purge = purge(30.0, false, false, PurgeLayout::One);
    let forth = [piece(0.0, 9.0, 0, Role::OuterWall), piece(0.0, 9.0, 1, Role::OuterWall)];
    let back = [forth[1].clone(), forth[0].clone()];
    let _ = purge.lay(forth.to_vec(), None, 0, HEIGHT);
    let _ = purge.lay(back.to_vec(), Some(ColorId(1)), 1, HEIGHT);
    let _ = purge.lay(forth.to_vec(), Some(ColorId(0)), 2, HEIGHT);
    let report = purge.finish();
    assert_eq!((report.changes, report.purged), (3, 3));
    assert_eq!(report.saved.order.mm3, 60.0);
    assert_eq!(report.every_change_mm3, 6.0 * 30.0);
}

#[test]
fn demand_is_by_layer() {
    let machine = Machine::builtin("generic-mixing").unwrap();
    let mixture = |i: i32| fgm_core::Mixture::from_weights(&[f64::from(i), f64::from(4 - i)]);
    let palette: Vec<_> = (0..5).map(|i| mixture(i).unwrap()).collect();
    let needs = Needs::new(&machine, &Settings::default(), 10.0, palette);
    let layers = |rows: &[&str]| -> Demand {
        let row = |row: &&str| row.chars().map(|c| c == 'x').collect::<Vec<bool>>();
        Demand::of(&needs, rows.iter().map(row))
    };
    // One change into each layer; the first has none before it but what is in the nozzle.
    let upwards = layers(&["x....", ".x...", "..xx.", "...x.", "...x."]);
    assert_eq!(upwards.most, 20.0);
    assert_eq!(upwards.last, [Some(0), Some(1), Some(2), Some(4), None]);
    assert_eq!(upwards.last_change, Some(3));
    assert_eq!(layers(&["xxxxx", "xxxxx"]).most, 50.0);
    let one = layers(&["x....", "x....", "x...."]);
    assert_eq!((one.most, one.last_change), (10.0, None));
}

proptest! {
    #[test]
    fn a_purge_adds_nothing_but_towers_and_keeps_every_bead(
        runs in prop::collection::vec(prop::collection::vec((0.0..60.0f64, any::<bool>()), 1..5), 1..4),
        volume in 1.0..60.0f64, transition: bool, hidden: bool, spots: bool,
        begun: Option<bool>, count in 0..4usize,
    ) {
        let layout = if spots { PurgeLayout::Spots } else { PurgeLayout::One };
        let mut purge = purge(volume, transition, hidden, layout);
        let mut pieces = Vec::new();
        for (i, run) in runs.iter().enumerate() {
            let color = (i % 2) as u16;
            let role = |infill| if infill { Role::Infill } else { Role::InnerWall };
            pieces.extend(run.iter().map(|&(v, infill)| piece(0.0, mm(v), color, role(infill))));
        }
        let laid = purge.lay(pieces.clone(), begun.map(|b| ColorId(b.into())), count, HEIGHT);
        let volume_of = |pieces: &[Piece], which: &dyn Fn(&Piece) -> bool| -> f64 {
            let length: f64 = pieces.iter().filter(|p| which(p)).map(Piece::length).sum();
            length * bead::area(0.4, HEIGHT)
        };
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
        // The walls as they were; the infill in all.
        let walls = |pieces: &[Piece]| -> Vec<Piece> {
            pieces.iter().filter(|p| p.role == Role::InnerWall).cloned().collect()
        };
        prop_assert_eq!(walls(&laid), walls(&pieces));
        let part = |p: &Piece| p.role.is_part();
        prop_assert!(close(volume_of(&laid, &part), volume_of(&pieces, &part)));
        let report = purge.finish();
        let infill = volume_of(&laid, &|p| p.role == Role::PurgeInfill);
        prop_assert!(close(infill, report.infill_mm3));
        prop_assert!(hidden || infill == 0.0);
        // What a tower takes besides the purges.
        let tower = volume_of(&laid, &|p| p.role == Role::PurgeTower);
        prop_assert!(tower >= report.standing_mm3 - 1e-6, "{} {:?}", tower, report);
        prop_assert!(report.purged <= report.changes && report.unpurged == 0);
    }
}
