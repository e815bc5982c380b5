//! Lines of a field at many levels.

mod common;

use common::assert_apart;
use fgm_contour::{ContourError, ContourOptions, Grid, LevelLines, isolines};
use fgm_core::{Bounds2, Point2};
use proptest::prelude::*;

fn window() -> Bounds2 {
    Bounds2::new(Point2::new(-7.3, -5.1), Point2::new(8.4, 6.2))
}

fn points(lines: &[LevelLines]) -> impl Iterator<Item = (f64, &[Point2], bool)> {
    lines.iter().flat_map(|l| {
        let rings = l.rings.iter().map(|r| (l.level, r.points.as_slice(), true));
        rings.chain(l.lines.iter().map(|r| (l.level, r.points.as_slice(), false)))
    })
}

fn at_edge(p: Point2, window: &Bounds2) -> bool {
    p.x == window.min.x || p.x == window.max.x || p.y == window.min.y || p.y == window.max.y
}

/// Everything that holds for any field: ends on the edge, lower values on the left, no contact.
fn assert_sound(lines: &[LevelLines], field: &dyn Fn(Point2) -> f64, window: &Bounds2) {
    for (level, points, closed) in points(lines) {
        assert!(points.iter().all(|&p| window.contains(p)));
        if !closed {
            let ends = [points[0], points[points.len() - 1]];
            assert!(ends.iter().all(|&p| at_edge(p, window)), "{ends:?}");
        }
        // At vertices, which lie on the curve; the direction there is that of the chord past them.
        let (mut right, mut wrong) = (0, 0);
        for w in points.windows(3) {
            let step = (w[2] - w[0]).perp().normalize_or_zero() * 1e-5;
            let rises = field(w[1] + step) < field(w[1] - step);
            *(if rises { &mut right } else { &mut wrong }) += 1;
        }
        assert!(right >= wrong, "level {level}: {right} vertices run rightly, {wrong} wrongly");
    }
    assert_apart(points(lines).map(|l| (l.1, l.2)));
}

#[test]
fn a_slope_gives_straight_lines_between_the_edges() {
    let field = |p: Point2| p.x + 0.25 * p.y;
    let levels = [3.0, -2.0, 0.0, 3.0, 100.0];
    let found = isolines(&field, &window(), &levels, &ContourOptions::default()).unwrap();
    let asked: Vec<f64> = found.iter().map(|l| l.level).collect();
    assert_eq!(asked, levels, "in the order asked for");
    for lines in &found[..4] {
        assert_eq!((lines.rings.len(), lines.lines.len()), (0, 1));
        let line = &lines.lines[0].points;
        assert_eq!(line.len(), 2);
        assert!(line[0].y < line[1].y, "lower values, at smaller x, on the left");
        assert!(line.iter().all(|&p| (field(p) - lines.level).abs() < 1e-6));
    }
    assert_eq!(found[0], found[3]);
    assert!(found[4].lines.is_empty());
    assert!(isolines(&field, &window(), &[], &ContourOptions::default()).unwrap().is_empty());
}

#[test]
fn lines_end_around_what_is_not_a_number() {
    let field = |p: Point2| if p.length() < 2.0 { f64::NAN } else { p.y };
    let options = ContourOptions::default();
    let error = isolines(&field, &window(), &[0.3], &options);
    assert!(matches!(error, Err(ContourError::NotANumber { .. })));
    let options = ContourOptions { skip_nan: true, ..options };
    let found = isolines(&field, &window(), &[0.3], &options).unwrap();
    assert_eq!(found[0].lines.len(), 2);
    let inner = found[0].lines.iter().flat_map(|l| &l.points).map(|p| p.x.abs());
    let nearest = inner.fold(f64::INFINITY, f64::min);
    assert!((1.9..2.6).contains(&nearest), "{nearest}");
}

#[test]
fn bad_levels_are_refused() {
    let field = |p: Point2| p.x;
    for bad in [f64::NAN, f64::INFINITY] {
        let error = isolines(&field, &window(), &[1.0, bad], &ContourOptions::default());
        assert!(matches!(error, Err(ContourError::Level { index: 1, .. })));
    }
    let many = vec![0.5; 5000];
    let error = isolines(&field, &window(), &many, &ContourOptions::default());
    assert!(matches!(error, Err(ContourError::TooManyLevels { count: 5000, .. })));
}

#[test]
fn all_levels_of_a_jump_lie_at_the_jump() {
    let field = |p: Point2| if p.x < 1.234_567_8 { 0.0 } else { 1.0 };
    let levels = [0.25, 0.5, 0.75];
    let found = isolines(&field, &window(), &levels, &ContourOptions::default()).unwrap();
    for (_, points, _) in points(&found) {
        assert!(points.iter().all(|p| (p.x - 1.234_567_8).abs() < 1e-6));
        assert_eq!(points.len(), 2);
    }
}

/// Every grid of four samples, in all 16 cases, with the saddle's centre below and above.
#[test]
fn every_case_of_a_cell_is_drawn_with_the_low_side_on_the_left() {
    for case in 0..16_u8 {
        for weight in [0.5, 2.0] {
            let value = |c: u8| if case >> c & 1 == 1 { weight } else { -1.0 };
            // Corners go round; rows go up.
            let values = [value(0), value(1), value(3), value(2)];
            let grid = Grid {
                origin: Point2::ZERO,
                step: Point2::ONE,
                columns: 2,
                rows: 2,
                values: &values,
            };
            let found = grid.isolines(&[0.0]).unwrap();
            let saddle = case == 5 || case == 10;
            let expected = if case == 0 || case == 15 { 0 } else { 1 + usize::from(saddle) };
            assert_eq!(found[0].lines.len(), expected, "case {case}");
            let bilinear = |p: Point2| {
                let (low, high) =
                    (values[0].lerp_to(values[1], p.x), values[2].lerp_to(values[3], p.x));
                low.lerp_to(high, p.y)
            };
            for line in &found[0].lines {
                let [a, b] = line.points[..] else { panic!("{line:?}") };
                let side = (b - a).perp().normalize() * 1e-3;
                assert!(bilinear(a + side) < bilinear(a - side), "case {case}");
                assert!(bilinear(b + side) < bilinear(b - side), "case {case}");
                // The saddle's two segments leave the right corners joined.
                let centre_above = weight > 1.0;
                let at_centre = (Point2::splat(0.5) - a).perp_dot(b - a) > 0.0;
                assert!(!saddle || at_centre == centre_above, "case {case}, saddle");
            }
        }
    }
}

trait LerpTo {
    fn lerp_to(self, other: f64, t: f64) -> f64;
}

impl LerpTo for f64 {
    fn lerp_to(self, other: f64, t: f64) -> f64 {
        self + (other - self) * t
    }
}

#[test]
fn bad_grids_are_refused() {
    let grid = Grid {
        origin: Point2::ZERO,
        step: Point2::ONE,
        columns: 2,
        rows: 2,
        values: &[0.0, 1.0, 2.0, 3.0],
    };
    assert!(grid.isolines(&[1.5]).is_ok());
    let bad = [
        (Grid { columns: 3, ..grid }, "4 values for 3 columns"),
        (Grid { columns: 4, rows: 1, ..grid }, "of two or more"),
        (Grid { rows: usize::MAX, ..grid }, "4 values"),
        (Grid { step: Point2::new(0.0, 1.0), ..grid }, "step.x is 0"),
        (Grid { origin: Point2::new(0.0, f64::NAN), ..grid }, "origin.y is NaN"),
    ];
    for (grid, told) in bad {
        let error = grid.isolines(&[1.5]).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
}

#[derive(Clone, Debug)]
struct Waves(Vec<(f64, f64, f64, f64)>);

impl Waves {
    fn eval(&self, p: Point2) -> f64 {
        self.0.iter().map(|w| w.0 * (w.1 * p.x + w.2 * p.y + w.3).sin()).sum()
    }
}

fn waves(greatest: f64) -> impl Strategy<Value = Waves> {
    let k = -greatest..greatest;
    prop::collection::vec((0.2..1.0f64, k.clone(), k, 0.0..6.3f64), 1..5).prop_map(Waves)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn vertices_of_smooth_fields_lie_on_their_level(w in waves(0.6), first in -0.5..0.5f64) {
        let field = |p: Point2| w.eval(p);
        let levels: Vec<f64> = (0..6).map(|k| first + f64::from(k) * 0.17).collect();
        let found = isolines(&field, &window(), &levels, &ContourOptions::default()).unwrap();
        for (level, points, _) in points(&found) {
            for &p in points {
                prop_assert!((field(p) - level).abs() < 2e-6, "{} {}", field(p), level);
            }
        }
        assert_sound(&found, &field, &window());
    }

    #[test]
    fn lines_of_wild_fields_do_not_cross(w in waves(9.0), first in -0.5..0.5f64) {
        // Wavelengths down to a cell: roots out of order, saddles, kinks everywhere.
        let field = |p: Point2| w.eval(p);
        let levels: Vec<f64> = (0..5).map(|k| first + f64::from(k) * 0.11).collect();
        let found = isolines(&field, &window(), &levels, &ContourOptions::default()).unwrap();
        assert_apart(points(&found).map(|l| (l.1, l.2)));
    }

    #[test]
    fn simplification_stays_within_its_tolerance(w in waves(1.0)) {
        let field = |p: Point2| w.eval(p);
        let options = ContourOptions::default();
        let raw = ContourOptions { simplify: 0.0, ..options };
        let raw = isolines(&field, &window(), &[0.1], &raw).unwrap();
        let found = isolines(&field, &window(), &[0.1], &options).unwrap();
        prop_assert_eq!(raw[0].lines.len(), found[0].lines.len());
        prop_assert_eq!(raw[0].rings.len(), found[0].rings.len());
        for (fine, coarse) in raw[0].lines.iter().zip(&found[0].lines) {
            prop_assert_eq!(fine.points.first(), coarse.points.first());
            prop_assert_eq!(fine.points.last(), coarse.points.last());
        }
    }

    #[test]
    fn grids_of_any_numbers_give_sound_lines(
        values in prop::collection::vec(-3..4i32, 42), levels in prop::collection::vec(-3..4i32, 1..4)
    ) {
        // Small integers: values at the level, plateaus and saddles without end.
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let (origin, step) = (Point2::new(-2.0, 1.0), Point2::new(0.5, 0.25));
        let grid = Grid { origin, step, columns: 7, rows: 6, values: &values };
        let mut levels: Vec<f64> = levels.into_iter().map(f64::from).collect();
        levels.dedup();
        let found = grid.isolines(&levels).unwrap();
        let bounds = Bounds2::new(origin, origin + step * Point2::new(6.0, 5.0));
        for (_, points, closed) in points(&found) {
            let least = if closed { 3 } else { 2 };
            prop_assert!(points.len() >= least);
            let near = bounds.grown(-1e-8);
            let ends = [points[0], points[points.len() - 1]];
            prop_assert!(closed || !ends.iter().any(|&p| near.contains(p)), "{ends:?}");
        }
        assert_apart(points(&found[..1]).map(|l| (l.1, l.2)));
    }
}
