use fgm_core::{Point2, Ring};

use super::*;
use crate::ClipperInset;

const WALLS: f64 = 1.2;

fn options() -> BridgeOptions {
    BridgeOptions { width: 0.4, anchor: 1.0, reach: WALLS, ledge: 0.0, shortest: 0.0, least: 0.0 }
}

fn rectangle(x: (f64, f64), y: (f64, f64)) -> Polygon {
    let corners = [(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1)];
    Polygon::simple(Ring::new(corners.iter().map(|&(x, y)| Point2::new(x, y)).collect()))
}

fn hole(mut polygon: Polygon, inner: Polygon) -> Polygon {
    let mut ring = inner.outer;
    ring.reverse();
    polygon.holes.push(ring);
    polygon
}

fn turned(region: &[Polygon], angle: f64) -> Vec<Polygon> {
    let turn = Point2::from_angle(angle);
    let ring = |r: &Ring| Ring::new(r.points.iter().map(|&p| turn.rotate(p)).collect());
    let polygon =
        |p: &Polygon| Polygon { outer: ring(&p.outer), holes: p.holes.iter().map(ring).collect() };
    region.iter().map(polygon).collect()
}

/// The bridges of a whole layer, without walls, over one of that outline.
fn bare(outline: &[Polygon], below: &[Polygon], ledge: f64, least: f64) -> Vec<Bridge> {
    let options = BridgeOptions { reach: 0.4, ledge, least, ..options() };
    bridges(outline, below, &Support::new(below), &options, &ClipperInset::default())
}

/// The bridges of a layer of this outline over one of that outline.
fn found(outline: &[Polygon], below: &[Polygon]) -> Vec<Bridge> {
    let inset = ClipperInset::default();
    let here = inset.inset(outline, WALLS);
    bridges(&here, below, &Support::new(below), &options(), &inset)
}

fn degrees(bridge: &Bridge) -> f64 {
    bridge.angle.to_degrees().rem_euclid(180.0)
}

#[test]
fn between_two_sides_straight_across() {
    // A beam 30 mm long over pillars at its ends, in many directions; then on pillars that are
    // thinner than the walls.
    let beam = [rectangle((0.0, 30.0), (0.0, 10.0))];
    for thick in [5.0, 0.8] {
        let pillars =
            [rectangle((0.0, thick), (0.0, 10.0)), rectangle((30.0 - thick, 30.0), (0.0, 10.0))];
        for angle in [0.0, 17.3, 90.0, 133.0] {
            let turn = |r: &[Polygon]| turned(r, f64::to_radians(angle));
            let bridges = found(&turn(&beam), &turn(&pillars));
            assert_eq!(bridges.len(), 1, "{thick} {angle}");
            assert!((degrees(&bridges[0]) - angle).abs() < 1e-3, "{}", degrees(&bridges[0]));
            let over = 30.0 - 2.0 * thick.max(WALLS);
            let on = 2.0 * (thick - WALLS).clamp(0.0, 1.0);
            let area = region::area(&bridges[0].region);
            assert!((area - (over + on) * (10.0 - 2.0 * WALLS)).abs() < 0.1, "{area}");
        }
    }
}

#[test]
fn over_a_hole_the_short_way() {
    let plate = [rectangle((0.0, 40.0), (0.0, 40.0))];
    let slot = |x, y| [hole(plate[0].clone(), rectangle(x, y))];
    for (x, y, want) in [((10.0, 30.0), (18.0, 22.0), 90.0), ((18.0, 22.0), (10.0, 30.0), 0.0)] {
        let bridges = found(&plate, &slot(x, y));
        assert_eq!(bridges.len(), 1);
        assert!((degrees(&bridges[0]) - want).abs() < 1e-3, "{}", degrees(&bridges[0]));
        let area = region::area(&bridges[0].region);
        assert!((area - 22.0 * 6.0).abs() < 0.1, "{area}");
    }
    // Two holes are two bridges, each its own way.
    let two = [hole(slot((5.0, 8.0), (5.0, 30.0))[0].clone(), rectangle((15.0, 35.0), (5.0, 8.0)))];
    let mut ways: Vec<f64> = found(&plate, &two).iter().map(degrees).collect();
    ways.sort_by(f64::total_cmp);
    assert!(ways.len() == 2 && ways[0].abs() < 1e-3 && (ways[1] - 90.0).abs() < 1e-3, "{ways:?}");
}

#[test]
fn what_is_held_on_one_side_is_no_bridge() {
    let beam = [rectangle((0.0, 30.0), (0.0, 10.0))];
    assert_eq!(found(&beam, &[rectangle((0.0, 15.0), (0.0, 10.0))]), []);
    // A cap on a stem, and a step all round.
    assert_eq!(found(&beam, &[rectangle((12.0, 18.0), (3.0, 7.0))]), []);
    assert_eq!(found(&beam, &[rectangle((2.5, 27.5), (2.5, 7.5))]), []);
    // Nothing over air, nothing below, and a gap narrower than a bead.
    assert_eq!(found(&beam, &beam), []);
    assert_eq!(found(&beam, &[]), []);
    let gap = [rectangle((0.0, 15.0), (0.0, 10.0)), rectangle((15.3, 30.0), (0.0, 10.0))];
    assert_eq!(found(&beam, &gap), []);
}

#[test]
fn bridges_of_one_layer_are_disjoint() {
    let plate = [rectangle((0.0, 40.0), (0.0, 40.0))];
    // A thin rib between two slots: the anchors of both would lie on all of it.
    let slots = hole(plate[0].clone(), rectangle((10.0, 15.0), (10.0, 30.0)));
    let below = [hole(slots, rectangle((15.8, 21.0), (10.0, 30.0)))];
    let bridges = found(&plate, &below);
    assert_eq!(bridges.len(), 2);
    let both = region::intersection(&bridges[0].region, &bridges[1].region);
    assert!(region::area(&both) < 1e-3);
}

#[test]
fn what_loops_may_span_is_no_bridge() {
    let plate = [rectangle((0.0, 40.0), (0.0, 20.0))];
    for (gap, count) in [(4.0, 0), (6.0, 1)] {
        let pillars =
            [rectangle((0.0, 15.0), (0.0, 20.0)), rectangle((15.0 + gap, 40.0), (0.0, 20.0))];
        let options = BridgeOptions { reach: 0.4, shortest: 4.8, ..options() };
        let support = Support::new(&pillars);
        let found = bridges(&plate, &pillars, &support, &options, &ClipperInset::default());
        assert_eq!(found.len(), count, "{gap}");
    }
}

#[test]
fn a_ledge_is_no_bridge() {
    let plate = [rectangle((0.0, 40.0), (0.0, 20.0))];
    let slot = |x, y| hole(plate[0].clone(), rectangle(x, y));
    // The layer reaches into a slot by so much all round; then over all of it, and over the middle
    // of a gap between two pillars.
    let below = [slot((5.0, 35.0), (5.0, 15.0))];
    for (step, count) in [(0.5, 0), (1.0, 0), (2.0, 1)] {
        let here = [slot((5.0 + step, 35.0 - step), (5.0 + step, 15.0 - step))];
        assert_eq!(bare(&here, &below, 1.2, 0.0).len(), count, "{step}");
        assert_eq!(bare(&here, &below, 0.0, 0.0).len(), 1, "{step}: all are, but for that");
    }
    assert_eq!(bare(&plate, &below, 1.2, 0.0).len(), 1);
    // Short lines, of which not all are held: a step into a small bore.
    let bore = [slot((18.0, 22.0), (8.0, 11.0))];
    assert_eq!(bare(&[slot((18.5, 21.5), (8.5, 10.5))], &bore, 1.2, 0.0), []);
    assert_eq!(bare(&plate, &bore, 1.2, 0.0).len(), 1);
    assert_eq!(bare(&plate, &[slot((5.0, 35.0), (9.0, 11.0))], 1.2, 0.0).len(), 1);
    let pillars = [rectangle((0.0, 19.0), (0.0, 20.0)), rectangle((21.0, 40.0), (0.0, 20.0))];
    assert_eq!(bare(&plate, &pillars, 1.2, 0.0).len(), 1);
}

#[test]
fn what_is_too_narrow_beside_a_bridge_goes_with_it() {
    let beam = [rectangle((0.0, 30.0), (0.0, 10.0))];
    for (thick, least, length) in
        [(1.2, 0.0, 29.6), (1.2, 0.24, 30.0), (1.2, 0.1, 29.6), (2.0, 0.24, 28.0)]
    {
        let pillars =
            [rectangle((0.0, thick), (0.0, 10.0)), rectangle((30.0 - thick, 30.0), (0.0, 10.0))];
        let bridges = bare(&beam, &pillars, 1.2, least);
        assert_eq!(bridges.len(), 1);
        let area = region::area(&bridges[0].region);
        assert!((area - 10.0 * length).abs() < 0.01, "{thick} {least}: {area}");
    }
}
