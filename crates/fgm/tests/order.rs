//! Where walls start and which come first, in written G-code.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{Bead, deposit, parse, settings, slice};
use fgm::{
    Settings, Strategy,
    core::Point2,
    toolpath::{RoleOrder, Seam},
};

/// Colours change with height only, so that walls are whole loops.
const BOX: &str = r#"fgrade(["z/10 + 0.5", "0.5 - z/10"], ["a", "b"]) { cube(10); }"#;

fn beads(change: impl Fn(&mut Settings)) -> Vec<Bead> {
    let mut settings = settings(Strategy::Sectioned, 4);
    settings.purge.enabled = Some(false);
    settings.slice.last_layer = Some(12);
    change(&mut settings);
    deposit(&slice(&parse(BOX), "generic-mixing", &settings).1).beads
}

fn is_outer(bead: &Bead) -> bool {
    bead.role == "External perimeter"
}

/// Where the outer wall starts, layer by layer.
fn seams(beads: &[Bead]) -> Vec<Point2> {
    beads
        .chunk_by(|a, b| a.layer == b.layer)
        .map(|l| l.iter().find(|b| is_outer(b)).unwrap().from)
        .collect()
}

#[test]
fn seams_are_where_they_are_asked_for() {
    let corner = |x: f64, y: f64| Point2::new(4.8 * x, 4.8 * y);
    let at = |seam, point: Option<[f64; 2]>| {
        seams(&beads(|s| (s.order.seam, s.order.seam_point) = (seam, point)))
    };
    for (seam, point, want) in [
        (Seam::Aligned, None, corner(1.0, 1.0)),
        (Seam::Aligned, Some([-50.0, 40.0]), corner(-1.0, 1.0)),
    ] {
        let seams = at(seam, point);
        assert_eq!(seams.len(), 12);
        assert!(seams.iter().all(|p| p.distance(want) < 0.01), "{seam:?}: {seams:?}");
    }
    let rear = at(Seam::Rear, None);
    assert!(rear.iter().all(|p| (p.y - 4.8).abs() < 0.01), "{rear:?}");
    let random = at(Seam::Random, None);
    let apart = random.windows(2).filter(|w| w[0].distance(w[1]) > 1.0).count();
    assert!(apart >= 8, "{random:?}");
}

#[test]
fn walls_come_in_the_order_asked_for() {
    for (walls, outer_first) in [(RoleOrder::OuterFirst, true), (RoleOrder::InnerFirst, false)] {
        let beads = beads(|s| s.order.walls = walls);
        for layer in beads.chunk_by(|a, b| a.layer == b.layer) {
            let mut walls = layer.iter().filter(|b| is_outer(b) || b.role == "Perimeter");
            assert_eq!(is_outer(walls.next().unwrap()), outer_first, "{walls:?}");
            let fill = layer.iter().position(|b| !is_outer(b) && b.role != "Perimeter").unwrap();
            assert!(layer[fill..].iter().all(|b| !is_outer(b)), "{walls:?}");
        }
    }
}

/// Two blocks 20 mm long, on either side of the middle and so far from it, each graded outwards.
fn two_blocks(at: i32) -> String {
    let inner = f64::from(at - 10) / 20.0;
    let outer = inner + 1.0;
    format!(
        r#"fgrade(["abs(x)/20 - {inner}", "{outer} - abs(x)/20"], ["a", "b"]) {{
            translate(-{at}, 0, 1) {{ rectprism(20, 10, 2); }}
            translate({at}, 0, 1) {{ rectprism(20, 10, 2); }}
        }}"#
    )
}

/// Two blocks beside each other, both graded from left to right: each colour is printed once a layer,
/// wherever it is.
#[test]
fn islands_are_one_plate() {
    let source = two_blocks(15);
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mut settings = settings(strategy, 6);
        settings.purge.enabled = Some(false);
        (settings.lead.volume, settings.compensation.enabled) = (Some(0.0), Some(false));
        let beads = deposit(&slice(&parse(&source), "generic-mixing", &settings).1).beads;
        for layer in beads.chunk_by(|a, b| a.layer == b.layer) {
            let runs = layer.chunk_by(|a, b| a.color == b.color);
            let sides =
                runs.map(|run| [-1.0, 1.0].map(|side| run.iter().any(|b| b.from.x * side > 0.0)));
            let sides: Vec<_> = sides.collect();
            assert_eq!(sides, vec![[true, true]; 6], "{strategy}, layer {}", layer[0].layer);
        }
    }
}

/// Two blocks far from each other: a machine that mixes does not go back and forth for every colour,
/// unless it is asked to, or purges, or a change takes time.
#[test]
fn far_parts_are_printed_one_after_the_other() {
    let source = two_blocks(55);
    let crossings = |printer: &str, strategy, purge, change| {
        let mut settings = settings(strategy, 4);
        settings.purge.enabled = Some(purge);
        settings.order.change = change;
        (settings.lead.volume, settings.compensation.enabled) = (Some(0.0), Some(false));
        settings.slice.last_layer = Some(2);
        let gcode = slice(&parse(&source), printer, &settings).1;
        let beads = deposit(&gcode).beads;
        assert!(beads.iter().any(|b| b.from.x < -40.0) && beads.iter().any(|b| b.from.x > 40.0));
        let part = beads.iter().filter(|b| !b.is_tower()).collect::<Vec<_>>();
        part.windows(2).filter(|w| w[0].from.x * w[1].from.x < 0.0).count()
    };
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let mixing = |purge, change| crossings("generic-mixing", strategy, purge, change);
        // There and back, twice.
        assert!(mixing(false, 50.0) <= 4, "{strategy}: {}", mixing(false, 50.0));
        assert!(mixing(false, 1e6) >= 7, "{strategy}: {}", mixing(false, 1e6));
    }
    let purging = crossings("generic-mixing", Strategy::Sectioned, true, 50.0);
    assert!(purging >= 7, "{purging}");
    for printer in ["prusa-mk4s-lw-pla", "prusa-xl-5t"] {
        let count = crossings(printer, Strategy::Against, false, 50.0);
        assert!(count >= 7, "{printer}: {count}");
    }
}

/// How near to the z axis travels come inside layers, mm, and how many there are.
fn nearest_travel(gcode: &str) -> (f64, usize) {
    let offset = gcode.lines().find_map(|l| l.strip_prefix("; design_offset = ")).unwrap();
    let offset: Vec<f64> = offset.split(' ').map(|v| v.parse().unwrap()).collect();
    // Where it starts from is not known.
    let (mut at, mut least, mut count) = (Point2::NAN, f64::INFINITY, 0);
    let after_first = gcode.split(";LAYER_CHANGE").skip(2).flat_map(str::lines);
    // Up to the end template.
    let inside = after_first.take_while(|l| *l != "M104 S0");
    for line in inside.filter(|l| l.starts_with("G1 ")) {
        let word = |letter| {
            let word = line.split(' ').find_map(|w| w.strip_prefix(letter));
            word.map(|v| v.parse::<f64>().unwrap())
        };
        let to = Point2::new(
            word('X').map_or(at.x, |x| x - offset[0]),
            word('Y').map_or(at.y, |y| y - offset[1]),
        );
        if word('E').is_none() && to != at && at.is_finite() {
            let share = (-at.dot(to - at) / (to - at).length_squared()).clamp(0.0, 1.0);
            least = least.min(at.lerp(to, share).length());
            count += 1;
        }
        at = to;
    }
    (least, count)
}

#[test]
fn travels_go_round_a_bore() {
    let tube = r#"fgrade(["x/20 + 0.5", "0.5 - x/20"], ["a", "b"]) {
        difference() { cylinder(10, 2); cylinder(6, 3); } }"#;
    for strategy in [Strategy::Sectioned, Strategy::Against] {
        let travels = |avoid| {
            let mut settings = settings(strategy, 6);
            settings.purge.enabled = Some(false);
            settings.travel.avoid_crossing = avoid;
            let gcode = slice(&parse(tube), "generic-mixing", &settings).1;
            nearest_travel(std::str::from_utf8(&gcode).unwrap())
        };
        let (straight, round) = (travels(false), travels(true));
        assert!(straight.0 < 5.9, "{strategy}: {straight:?}");
        assert!(round.0 > 6.0 && round.1 > straight.1, "{strategy}: {round:?}");
    }
}
