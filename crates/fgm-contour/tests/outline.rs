//! Regions of fields.

// Helpers outside of test functions may fail tests too.
#![allow(clippy::unwrap_used)]

mod common;

use common::{area, assert_valid, turned_box};
use fgm_contour::{ContourError, ContourOptions, Contourer, isolines, outline};
use fgm_core::{Bounds2, Interval, PlanarField, Point2, Polygon};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

fn window(half: f64) -> Bounds2 {
    Bounds2::new(Point2::splat(-half), Point2::splat(half))
}

fn region(field: &dyn PlanarField, half: f64) -> Vec<Polygon> {
    let polygons = outline(field, &window(half), &ContourOptions::default()).unwrap();
    assert_valid(&polygons);
    polygons
}

/// The distance of the nearest vertex.
fn nearest(polygons: &[Polygon], p: Point2) -> f64 {
    let points = polygons.iter().flat_map(Polygon::rings).flat_map(|r| &r.points);
    points.map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
}

/// A regular star: the distance by sign is exact, its size only near the border.
fn star(p: Point2, tips: f64, outer: f64, inner: f64, turn: f64) -> f64 {
    let sector = TAU / tips;
    let folded = (p.to_angle() - turn).rem_euclid(sector);
    let angle = folded.min(sector - folded);
    let q = Point2::from_angle(angle) * p.length();
    let (a, b) = (Point2::new(outer, 0.0), Point2::from_angle(sector / 2.0) * inner);
    -(b - a).perp_dot(q - a) / (b - a).length()
}

#[test]
fn areas_of_plain_shapes() {
    let circle = region(&|p: Point2| p.length() - 10.0, 12.0);
    assert_eq!(circle.len(), 1);
    // A chord with its ends on the circle and 0.01 mm of sag loses up to that much.
    assert!((area(&circle) - PI * 100.0).abs() < TAU * 10.0 * 0.01);
    let ring = region(&|p: Point2| (p.length() - 7.0).abs() - 2.0, 12.0);
    assert_eq!((ring.len(), ring[0].holes.len()), (1, 1));
    assert!((area(&ring) - PI * (81.0 - 25.0)).abs() < TAU * 14.0 * 0.01);
    let nothing = region(&|_: Point2| 1.0, 12.0);
    assert!(nothing.is_empty());
}

#[test]
fn a_region_that_fills_the_window_is_the_window() {
    let all = region(&|_: Point2| -1.0, 12.3);
    assert_eq!(all.len(), 1);
    assert_eq!(all[0].outer.points.len(), 4);
    assert!((area(&all) - 24.6 * 24.6).abs() < 1e-9);
    // Half of it, cut off by the edge exactly.
    let half = region(&|p: Point2| p.x + 0.3 * p.y - 0.2, 12.3);
    assert!(half[0].outer.points.iter().all(|p| {
        let at_edge = p.abs().max_element() == 12.3;
        at_edge || (p.x + 0.3 * p.y - 0.2).abs() < 1e-5
    }));
    assert_eq!(half[0].outer.points.len(), 4);
    assert!((area(&half) - 24.6 * (12.3 + 0.2)).abs() < 1e-3);
}

#[test]
fn vertices_lie_on_the_curve_and_chords_near_it() {
    let flower = |p: Point2| p.length() - 30.0 - 2.0 * (9.0 * p.to_angle()).sin();
    let polygons = region(&flower, 40.0);
    for (a, b) in polygons[0].outer.edges() {
        assert!(flower(a).abs() < 2e-6, "{}", flower(a));
        for t in [0.25, 0.5, 0.75] {
            assert!(flower(a.lerp(b, t)).abs() < 0.012, "{}", flower(a.lerp(b, t)));
        }
    }
}

#[test]
fn tight_bends_get_vertices_of_their_own() {
    // A slot with ends of 0.6 mm radius, at 0.5 mm cells.
    let slot = |p: Point2| Point2::new((p.x.abs() - 4.0).max(0.0), p.y - 0.1).length() - 0.6;
    let exact = PI * 0.36 + 8.0 * 1.2;
    assert!((area(&region(&slot, 6.0)) - exact).abs() < (TAU * 0.6 + 16.0) * 0.01);
    let dull = ContourOptions { sag: 0.0, simplify: 0.0, ..ContourOptions::default() };
    let dull = outline(&slot, &window(6.0), &dull).unwrap();
    assert!((area(&dull) - exact).abs() > 0.02, "the case shows nothing");
}

#[test]
fn corners_of_boxes_stars_and_their_combinations_are_sharp() {
    for step in 0..24 {
        let angle = f64::from(step) * 0.131;
        let center = Point2::new(0.37, -0.21) * f64::from(step);
        let half = Point2::new(5.0, 3.3);
        let field = |p: Point2| turned_box(p, center, half, angle);
        let found = region(&field, 20.0);
        assert_eq!(found[0].outer.points.len(), 4, "turned by {angle}");
        for corner in [half, -half, Point2::new(half.x, -half.y), Point2::new(-half.x, half.y)] {
            let corner = center + Point2::from_angle(angle).rotate(corner);
            assert!(nearest(&found, corner) < 0.01, "turned by {angle}");
        }
        let field = |p: Point2| star(p, 5.0, 12.0, 5.0, angle);
        let found = region(&field, 20.0);
        assert_eq!(found.len(), 1, "star turned by {angle}");
        for tip in 0..5 {
            let at = angle + f64::from(tip) * TAU / 5.0;
            let (tip, notch) =
                (Point2::from_angle(at) * 12.0, Point2::from_angle(at + PI / 5.0) * 5.0);
            assert!(
                nearest(&found, tip) < 0.01,
                "tip, turned by {angle}: {}",
                nearest(&found, tip)
            );
            assert!(nearest(&found, notch) < 0.01, "notch, turned by {angle}");
        }
        let cut = |p: Point2| {
            let body = turned_box(p, Point2::ZERO, Point2::new(9.0, 7.0), angle);
            body.max(-turned_box(p, Point2::new(2.0, 1.0), Point2::new(3.0, 2.0), 0.5 - angle))
        };
        let found = region(&cut, 20.0);
        assert!((area(&found) - (18.0 * 14.0 - 24.0)).abs() < 1e-3, "turned by {angle}");
        assert_eq!(found[0].outer.points.len() + found[0].holes[0].points.len(), 8);
    }
}

/// A row of samples passes 0.004 mm beside the axis of a narrow tip: one of its sides is 0.02 mm
/// long, and what lies beside that is soon beyond the other side.
#[test]
fn a_tip_with_one_very_short_side_is_found() {
    let at = Point2::new(0.0, -0.003_884_178_303_496_089_7);
    let (outer, depth) = (6.255_749_087_484_714, 0.334_598_982_859_764_8);
    let found = region(&|p: Point2| star(p - at, 8.0, outer, outer * depth, 0.0), 10.0);
    assert!(nearest(&found, at + Point2::new(outer, 0.0)) < 0.01);
}

/// Tips that end 0.01 mm beyond a row of samples: the chords around them are nearer to the curve
/// than the sag all the way, but not the tips.
#[test]
fn tips_that_barely_pass_a_row_of_samples_are_found() {
    let cases = [
        (0.431_675_802_262_028_4, 0.782_242_349_730_519, 8.121_744_327_473_337),
        (0.005_655_109_622_022_683, 4.375_313_321_278_718, 8.972_309_127_587_753),
    ];
    for (y, turn, outer) in cases {
        let at = Point2::new(0.0, y);
        let found = region(&|p: Point2| star(p - at, 7.0, outer, outer * 0.3, turn), 10.0);
        for tip in 0..7 {
            let tip = at + Point2::from_angle(turn + f64::from(tip) * TAU / 7.0) * outer;
            assert!(nearest(&found, tip) < 0.01, "{tip}: {}", nearest(&found, tip));
        }
    }
}

#[test]
fn gear_teeth_have_their_corners() {
    // Teeth between two radii with straight, radial flanks: curved and straight sides meet.
    let (inner, outer, teeth) = (14.0, 17.0, 20.0);
    let pitch = TAU / teeth;
    let gear = |p: Point2| {
        let folded = p.to_angle().rem_euclid(pitch) - pitch / 2.0;
        let q = Point2::from_angle(folded) * p.length();
        let flank = Point2::from_angle(pitch / 4.0);
        let tooth = flank.perp_dot(Point2::new(q.x, q.y.abs())).max(q.length() - outer);
        tooth.min(q.length() - inner)
    };
    let found = region(&gear, 20.0);
    for tooth in 0..20 {
        let middle = (f64::from(tooth) + 0.5) * pitch;
        for at in [middle - pitch / 4.0, middle + pitch / 4.0] {
            for radius in [inner, outer] {
                let off = nearest(&found, Point2::from_angle(at) * radius);
                assert!(off < 0.01, "tooth {tooth}, radius {radius}: {off}");
            }
        }
    }
    let exact = PI * inner * inner + PI * (outer * outer - inner * inner) / 2.0;
    assert!((area(&found) - exact).abs() < 2.0);
}

#[test]
fn jumps_are_contoured_where_they_are() {
    let disc = |p: Point2| if p.length() < 8.0 { -1e-7 } else { 3.0 };
    let found = region(&disc, 10.0);
    assert!((area(&found) - PI * 64.0).abs() < TAU * 8.0 * 0.01);
    let infinite = |p: Point2| if p.length() < 8.0 { -1.0 } else { f64::INFINITY };
    assert!((area(&region(&infinite, 10.0)) - PI * 64.0).abs() < TAU * 8.0 * 0.01);
}

#[test]
fn touching_at_samples_leaves_rings_apart() {
    // Two squares that meet in a lattice point at which the field is exactly 0.
    let field = |p: Point2| -(p.x * p.y).min(4.0 - p.abs().max_element());
    let found = region(&field, 5.0);
    assert!((area(&found) - 32.0).abs() < 1e-3, "{found:?}");
    // A single point at the level is nothing.
    assert!(region(&|p: Point2| p.length(), 5.0).is_empty());
    assert!(region(&|p: Point2| -p.length(), 5.0)[0].holes.is_empty());
}

struct Bounded<F>(F);
impl<F: Fn(Point2) -> f64 + Sync> PlanarField for Bounded<F> {
    fn eval(&self, p: Point2) -> f64 {
        self.0(p)
    }
    /// For a field that changes by at most 1 a mm.
    fn bounds(&self, cell: &Bounds2) -> Interval {
        let (middle, reach) = (self.0(cell.center()), cell.size().length() / 2.0);
        Interval::new(middle - reach, middle + reach)
    }
}

/// Counts how often it is asked.
struct Counted<F>(F, AtomicUsize);
impl<F: PlanarField> PlanarField for Counted<F> {
    fn eval(&self, p: Point2) -> f64 {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.eval(p)
    }
    fn bounds(&self, cell: &Bounds2) -> Interval {
        self.0.bounds(cell)
    }
}

/// Halving the cells doubles the evaluations where there are bounds, and quadruples them at most
/// where there are none.
#[test]
fn the_cost_follows_the_length_of_the_line() {
    let flower = |p: Point2| 0.4 * (p.length() - 30.0 - 2.0 * (9.0 * p.to_angle()).sin());
    let count = |field: &dyn Fn(&ContourOptions) -> usize, cell: f64| {
        let options = ContourOptions { cell, sag: 0.0, ..ContourOptions::default() };
        field(&options) as f64
    };
    let bounded = |options: &ContourOptions| {
        let counted = Counted(Bounded(flower), AtomicUsize::new(0));
        outline(&counted, &window(40.0), options).unwrap();
        counted.1.into_inner()
    };
    let unbounded = |options: &ContourOptions| {
        let counted = Counted(flower, AtomicUsize::new(0));
        outline(&counted, &window(40.0), options).unwrap();
        counted.1.into_inner()
    };
    for cell in [0.25, 0.125, 0.0625] {
        let growth = count(&bounded, cell) / count(&bounded, 2.0 * cell);
        assert!((1.7..2.4).contains(&growth), "{growth} at {cell}");
        let growth = count(&unbounded, cell) / count(&unbounded, 2.0 * cell);
        assert!((3.0..4.1).contains(&growth), "{growth} at {cell}");
    }
}

#[test]
fn false_bounds_are_told() {
    struct Liar;
    impl PlanarField for Liar {
        fn eval(&self, p: Point2) -> f64 {
            p.length() - 8.0
        }
        fn bounds(&self, cell: &Bounds2) -> Interval {
            if cell.max.x < 0.0 { Interval::new(5.0, 6.0) } else { Interval::EVERYTHING }
        }
    }
    let error = outline(&Liar, &window(11.0), &ContourOptions::default());
    assert!(matches!(error, Err(ContourError::FalseBounds { .. })), "{error:?}");
}

#[test]
fn bad_input_is_refused() {
    let circle = |p: Point2| p.length() - 1.0;
    let good = ContourOptions::default();
    let check = |half: f64, options: ContourOptions, told: &str| {
        let error = outline(&circle, &window(half), &options).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    };
    check(0.0, good, "the window");
    check(-1.0, good, "the window");
    check(f64::NAN, good, "the window");
    check(f64::INFINITY, good, "the window");
    check(f64::MAX, good, "the window");
    check(2.0, ContourOptions { cell: 0.0, ..good }, "cell is 0");
    check(2.0, ContourOptions { cell: f64::NAN, ..good }, "cell is NaN");
    check(2.0, ContourOptions { root_tolerance: -1.0, ..good }, "root_tolerance is -1");
    check(2.0, ContourOptions { sag: f64::INFINITY, ..good }, "sag is inf");
    check(2.0, ContourOptions { simplify: f64::NAN, ..good }, "simplify is NaN");
    check(1e6, good, "at most 131072 a side");
    let error = outline(&|p: Point2| (p.x - 1.2).sqrt(), &window(2.0), &good);
    assert!(matches!(error, Err(ContourError::NotANumber { .. })));
}

#[derive(Clone, Debug)]
struct Scene {
    circles: Vec<(f64, f64, f64)>,
    boxes: Vec<(f64, f64, f64, f64, f64)>,
    holes: Vec<(f64, f64, f64)>,
}

impl Scene {
    fn eval(&self, p: Point2) -> f64 {
        let circle = |&(x, y, r): &(f64, f64, f64)| p.distance(Point2::new(x, y)) - r;
        let solid = self.circles.iter().map(circle);
        let boxes = self
            .boxes
            .iter()
            .map(|&(x, y, a, b, turn)| turned_box(p, Point2::new(x, y), Point2::new(a, b), turn));
        let solid = solid.chain(boxes).fold(f64::INFINITY, f64::min);
        self.holes.iter().map(circle).fold(solid, |d, hole| d.max(-hole))
    }
}

fn scenes() -> impl Strategy<Value = Scene> {
    let circle = || (-9.0..9.0f64, -9.0..9.0f64, 0.3..5.0f64);
    // Halves of mm put borders, corners and tangencies on samples.
    let snapped = || {
        (-18..18i32, -18..18i32, 1..10i32)
            .prop_map(|(x, y, r)| (f64::from(x) / 2.0, f64::from(y) / 2.0, f64::from(r) / 2.0))
    };
    let boxes = (-9.0..9.0f64, -9.0..9.0f64, 0.5..6.0f64, 0.5..6.0f64, 0.0..3.2f64);
    (
        prop::collection::vec(prop_oneof![circle(), snapped()], 0..4),
        prop::collection::vec(boxes, 0..3),
        prop::collection::vec(prop_oneof![circle(), snapped()], 0..3),
    )
        .prop_map(|(circles, boxes, holes)| Scene { circles, boxes, holes })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn outlines_are_closed_simple_and_nested(scene in scenes(), cell in 0.3..1.0f64) {
        let options = ContourOptions { cell, ..ContourOptions::default() };
        let found = outline(&|p: Point2| scene.eval(p), &window(10.0), &options).unwrap();
        assert_valid(&found);
    }

    #[test]
    fn pruning_changes_nothing(scene in scenes()) {
        let options = ContourOptions::default();
        let all = outline(&|p: Point2| scene.eval(p), &window(10.0), &options).unwrap();
        let pruned = outline(&Bounded(|p| scene.eval(p)), &window(10.0), &options).unwrap();
        prop_assert_eq!(all, pruned);
    }

    #[test]
    fn scratch_memory_changes_nothing(scenes in prop::collection::vec(scenes(), 3)) {
        let options = ContourOptions::default();
        let mut contourer = Contourer::default();
        for (k, scene) in scenes.iter().enumerate() {
            let field = |p: Point2| scene.eval(p);
            let window = window(7.0 + k as f64 * 2.3);
            let fresh = outline(&field, &window, &options).unwrap();
            prop_assert_eq!(contourer.outline(&field, &window, &options).unwrap(), fresh);
        }
    }

    #[test]
    fn stars_keep_their_tips(
        tips in 3..9u32, outer in 6.0..9.0f64, depth in 0.3..0.7f64, turn in 0.0..6.3f64,
        x in -0.5..0.5f64, y in -0.5..0.5f64,
    ) {
        let (tips, inner) = (f64::from(tips), outer * depth);
        let field = |p: Point2| star(p - Point2::new(x, y), tips, outer, inner, turn);
        let found = outline(&field, &window(10.0), &ContourOptions::default()).unwrap();
        assert_valid(&found);
        prop_assert_eq!(found.len(), 1);
        for tip in 0..tips as u32 {
            let at = turn + f64::from(tip) * TAU / tips;
            let tip = Point2::new(x, y) + Point2::from_angle(at) * outer;
            prop_assert!(nearest(&found, tip) < 0.01, "{} off", nearest(&found, tip));
        }
    }

    #[test]
    fn what_is_two_samples_wide_is_found(x in -9.0..9.0f64, y in -9.0..9.0f64, turn in 0.0..3.2f64) {
        // Any square of more than a cell's diagonal each way holds a sample.
        let options = ContourOptions::default();
        let half = Point2::splat(options.cell);
        let field = |p: Point2| turned_box(p, Point2::new(x, y), half, turn);
        let found = outline(&field, &window(10.0), &options).unwrap();
        prop_assert_eq!(found.len(), 1);
        prop_assert!((area(&found) - 1.0).abs() < 0.05, "{}", area(&found));
    }

    /// Without bounds: hills and hollows two samples wide, each in a place of its own.
    #[test]
    fn every_loop_two_samples_wide_is_found(
        places in prop::collection::btree_map((-4..5i32, -4..5i32), (any::<bool>(), 0.0..1.0f64, 0.0..1.0f64), 1..20),
        half in 0.5..0.9f64,
    ) {
        // Discs of two cells' diagonal and more hold a sample, the space between them too.
        let options = ContourOptions { sharp: false, ..ContourOptions::default() };
        let radius = half.max(2.0_f64.sqrt() * options.cell);
        let discs: Vec<(Point2, f64)> = places
            .iter()
            .map(|(&(i, j), &(hill, x, y))| {
                let at = Point2::new(f64::from(i) * 4.0 + x, f64::from(j) * 4.0 + y);
                (at, if hill { 1.0 } else { -1.0 })
            })
            .collect();
        let field = |p: Point2| {
            let one = |&(at, sign): &(Point2, f64)| sign * (radius - p.distance(at)).max(0.0);
            discs.iter().map(one).sum::<f64>()
        };
        let level = 0.25 * radius;
        let found = isolines(&field, &window(20.0), &[level, -level], &options).unwrap();
        let hills = discs.iter().filter(|d| d.1 > 0.0).count();
        prop_assert_eq!((found[0].rings.len(), found[1].rings.len()), (hills, discs.len() - hills));
        prop_assert!(found.iter().all(|l| l.lines.is_empty()));
    }
}
