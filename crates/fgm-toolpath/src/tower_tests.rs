use super::*;
use crate::Side;
use proptest::prelude::*;

fn rect(x0: f64, y0: f64, x1: f64, y1: f64) -> Bounds2 {
    Bounds2::new(Point2::new(x0, y0), Point2::new(x1, y1))
}

const BED: Bounds2 = Bounds2::new(Point2::ZERO, Point2::new(250.0, 210.0));

/// Checks what every placement promises.
fn sound(towers: &Towers, part: &Bounds2, bed: &Bounds2, options: &TowerOptions) {
    let eps = 1e-6;
    let taken = part.grown(options.clearance - eps);
    for (i, a) in towers.spots.iter().enumerate() {
        assert!(bed.grown(eps).contains(a.min) && bed.grown(eps).contains(a.max), "{a:?}");
        assert!(!taken.intersects(a), "{a:?} at {part:?}");
        assert!(a.size().min_element() >= options.least_side - eps);
        for b in &towers.spots[i + 1..] {
            assert!(!a.grown(options.gap - eps).intersects(b), "{a:?} {b:?}");
        }
    }
    assert!(towers.spots.is_empty() || bed.grown(eps).contains(towers.bounds().min));
}

/// On which side of the part the spots lie, as letters, and in how many rows.
fn sides(towers: &Towers, part: &Bounds2) -> String {
    let mut sides: Vec<_> = towers
        .spots
        .iter()
        .map(|s| match () {
            () if s.min.x >= part.max.x => 'R',
            () if s.max.x <= part.min.x => 'L',
            () if s.min.y >= part.max.y => 'B',
            () => 'F',
        })
        .collect();
    sides.dedup();
    sides.into_iter().collect()
}

#[test]
fn placements() {
    let options = TowerOptions::default();
    for (part, colors, want) in [
        (rect(10.0, 10.0, 60.0, 200.0), 10, "R"),
        (rect(190.0, 10.0, 240.0, 200.0), 10, "L"),
        (rect(10.0, 10.0, 240.0, 120.0), 12, "B"),
        (rect(10.0, 90.0, 240.0, 200.0), 12, "F"),
        (rect(100.0, 100.0, 110.0, 110.0), 1, "R"),
        (rect(100.0, 100.0, 110.0, 110.0), 0, ""),
        // Longer spots where squares do not fit.
        (rect(15.0, 15.0, 235.0, 195.0), 4, "R"),
        // All around.
        (rect(25.0, 25.0, 225.0, 185.0), 16, "RB"),
        (rect(23.0, 23.0, 227.0, 187.0), 30, "RBL"),
        // The slab of the paper on a bed of 250 x 210.
        (rect(57.5, 17.5, 192.5, 192.5), 16, "R"),
    ] {
        let towers = Towers::place(&part, &BED, colors, &options).unwrap();
        assert_eq!(towers.spots.len(), colors);
        assert_eq!(sides(&towers, &part), want, "{part:?} {colors}");
        sound(&towers, &part, &BED, &options);
    }
}

#[test]
fn no_room() {
    let options = TowerOptions::default();
    let side = options.sides(1.0).x;
    // One square more than the strip holds.
    let part = rect(3.0, 3.0, 247.0, 207.0);
    let short = options.sides(4.0).y;
    let got = Towers::place(&part, &BED, 2, &options);
    let Err(ToolpathError::NoRoomForTowers { colors: 2, fit: 0, spot, missing, side: at }) = got
    else {
        panic!("{got:?}")
    };
    assert_eq!((spot, at), (side, Side::Right));
    assert!((missing - short).abs() < 1e-9, "{missing} {short}");
    let part = rect(13.0, 13.0, 237.0, 207.0);
    let got = Towers::place(&part, &BED, 90, &options);
    let Err(error @ ToolpathError::NoRoomForTowers { fit, missing, .. }) = got else {
        panic!("{got:?}")
    };
    assert!(fit > 0 && fit < 90 && missing > 0.0);
    let text = error.to_string();
    assert!(text.contains("90 purge towers") && text.contains("mm more"), "{text}");
    let large = TowerOptions { volume: 5000.0, ..options };
    let text = Towers::place(&part, &BED, 1, &large).unwrap_err().to_string();
    assert!(text.starts_with("no room for a purge tower of "), "{text}");
}

#[test]
fn bad_options_are_named() {
    let good = TowerOptions::default();
    let part = rect(0.0, 0.0, 10.0, 10.0);
    for (options, setting) in [
        (TowerOptions { volume: 0.0, ..good }, "volume"),
        (TowerOptions { width: f64::NAN, ..good }, "width"),
        (TowerOptions { height: -0.2, ..good }, "height"),
        (TowerOptions { lattice: 0.0, ..good }, "lattice"),
        (TowerOptions { clearance: -1.0, ..good }, "clearance"),
        (TowerOptions { gap: f64::INFINITY, ..good }, "gap"),
        (TowerOptions { least_side: -1.0, ..good }, "least_side"),
    ] {
        let got = Towers::place(&part, &BED, 2, &options);
        assert!(
            matches!(got, Err(ToolpathError::BadTower { setting: s, .. }) if s == setting),
            "{got:?}"
        );
    }
    let got = Towers::place(&Bounds2::EMPTY, &BED, 2, &good);
    assert_eq!(got, Err(ToolpathError::BadBounds { what: "part" }));
}

fn place(options: &TowerOptions, colors: usize) -> Towers {
    Towers::place(&rect(0.0, 0.0, 10.0, 10.0), &rect(0.0, 0.0, 900.0, 900.0), colors, options)
        .unwrap()
}

proptest! {
    #[test]
    fn placements_are_sound(
        x in 0.0..100.0f64, y in 0.0..100.0f64, dx in 1.0..200.0f64, dy in 1.0..200.0f64,
        colors in 0..24usize, volume in 1.0..200.0f64,
    ) {
        let part = rect(x, y, x + dx, y + dy);
        let options = TowerOptions { volume, ..TowerOptions::default() };
        match Towers::place(&part, &BED, colors, &options) {
            Ok(towers) => sound(&towers, &part, &BED, &options),
            Err(ToolpathError::NoRoomForTowers { fit, missing, .. }) => {
                prop_assert!(fit < colors && missing > 0.0);
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn purges_hold_their_volumes_one_after_the_other(
        volumes in prop::collection::vec(0.5..60.0f64, 1..6),
        width in 0.3..0.9f64, height in 0.1..0.3f64, thicker in 1.0..1.3f64,
        ratio in 1.0..4.0f64, layer in 0..3usize,
    ) {
        let volume = volumes.iter().sum();
        let options = TowerOptions { volume, width, height, ..TowerOptions::default() };
        let mut towers = place(&options, 1);
        towers.spots[0] = Bounds2::new(Point2::ZERO, options.sides(ratio));
        let purges: Vec<_> = volumes.iter().map(|v| (*v, ColorId(1))).collect();
        let height = (height * thicker).min(width);
        let out = towers.grow(0, &purges, ColorId(0), layer, height);
        prop_assert_eq!(out.len(), purges.len());
        let area = bead::area(width, height);
        for (i, (piece, volume)) in out.iter().zip(&volumes).enumerate() {
            let extruded = piece.length() * area;
            prop_assert!(extruded >= volume * (1.0 - 1e-9), "{} of {}", extruded, volume);
            if let Some(next) = out.get(i + 1) {
                prop_assert!(extruded <= volume * (1.0 + 1e-9));
                prop_assert_eq!(piece.points.last(), next.points.first());
            }
        }
        // Inside the spot, and no line nearer to the next than beads may lie.
        let inner = towers.spots[0].grown(1e-9 - width / 2.0);
        let line = towers.line(&towers.spots[0], 0.0, layer, height);
        prop_assert!(out.iter().flat_map(|piece| &piece.points).all(|p| inner.contains(*p)));
        let room = towers.line(&towers.spots[0], f64::INFINITY, layer, height);
        let step = room[6].distance(room[7]);
        prop_assert!(step >= bead::spacing(width, height) - 1e-9);
        prop_assert!(line.len() <= room.len());
        // No more than a line is left over above the first layer, or what it takes to stand.
        let whole: f64 = out.iter().map(Piece::length).sum();
        let needed: f64 = volumes.iter().sum::<f64>() / area;
        let longest = options.sides(ratio).max_element();
        let standing = Piece { points: line, ..out[0].clone() }.length();
        prop_assert!(layer == 0 || whole <= (needed + longest).max(standing + 1e-9));
    }
}

/// What is printed on each spot of a layer: its colour and whether it is a lattice (`l`) or holds
/// a purge (`P`).
fn told(towers: &Towers, purged: &[usize], layer: usize) -> String {
    let mut told = Vec::new();
    for spot in 0..towers.count() {
        let purges: Vec<_> =
            purged.iter().filter(|p| **p == spot).map(|_| (68.6, ColorId(7))).collect();
        for piece in towers.grow(spot, &purges, ColorId(1), layer, 0.2) {
            assert_eq!(piece.role, Role::PurgeTower);
            let whole = piece.length() >= towers.options.length() * (1.0 - 1e-9);
            told.push(format!("{spot}{}{}", if whole { 'P' } else { 'l' }, piece.color.0));
        }
    }
    told.join(" ")
}

#[test]
fn every_spot_grows_until_told_it_is_over() {
    let mut towers = place(&TowerOptions::default(), 3);
    assert_eq!(told(&towers, &[1, 2], 0), "0P1 1P7 2P7");
    assert_eq!(told(&towers, &[1], 1), "0l1 1P7 2l1");
    towers.finish(0, 0);
    towers.finish(2, 3);
    assert_eq!(told(&towers, &[], 3), "1l1 2l1");
    assert_eq!(told(&towers, &[1], 4), "1P7");
    assert!(towers.grow(3, &[], ColorId(0), 0, 0.2).is_empty());
}

#[test]
fn a_spot_is_a_frame_and_lines_across_it() {
    let towers = place(&TowerOptions::default(), 1);
    for layer in 1..3 {
        let line = &towers.grow(0, &[], ColorId(0), layer, 0.2)[0].points;
        let corners = Bounds2::new(line[0], line[2]);
        assert!((corners.size() + 0.4 - towers.spots[0].size()).length() < 1e-9);
        assert_eq!(line[4], line[0]);
        let across = if layer % 2 == 0 { line[6].y - line[5].y } else { line[6].x - line[5].x };
        assert_eq!(across, 0.0, "{line:?}");
        assert!(line[6].distance(line[7]) <= 4.0);
    }
}

#[test]
fn what_has_no_room_is_shared_out() {
    let towers = place(&TowerOptions::default(), 1);
    let purges = [(100.0, ColorId(1)), (300.0, ColorId(2))];
    let out = towers.grow(0, &purges, ColorId(0), 1, 0.2);
    assert!((3.0 * out[0].length() - out[1].length()).abs() < 1e-6);
}
