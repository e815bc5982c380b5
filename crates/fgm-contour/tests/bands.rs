//! Regions between levels: of grids, masks and fields.

mod common;

use common::{area, assert_valid};
use fgm_contour::{Band, ContourError, ContourOptions, Contourer, Grid, GridContourer, isobands};
use fgm_core::{Bounds2, Point2, Polygon, Ring};
use proptest::prelude::*;
use std::collections::BTreeMap;

fn grid<T>(columns: usize, values: &[T]) -> Grid<'_, T> {
    let (origin, step) = (Point2::new(-2.0, 1.0), Point2::new(0.5, 0.25));
    Grid { origin, step, columns, rows: values.len() / columns, values }
}

/// The area of the cells with four numbers.
fn whole_area(grid: &Grid<'_, f64>) -> f64 {
    let whole = |c: &(usize, usize)| {
        [(0, 0), (1, 0), (0, 1), (1, 1)]
            .iter()
            .all(|d| !grid.values[(c.1 + d.1) * grid.columns + c.0 + d.0].is_nan())
    };
    let cells = (0..grid.rows - 1).flat_map(|j| (0..grid.columns - 1).map(move |i| (i, j)));
    cells.filter(whole).count() as f64 * grid.step.x * grid.step.y
}

fn total(bands: &[Band]) -> f64 {
    bands.iter().map(|b| area(&b.polygons)).sum()
}

/// Every edge is either that of one neighbour too, in the other direction, or on the border.
fn assert_shared(bands: &[Band], on_border: impl Fn(Point2, Point2) -> bool) {
    let key = |p: Point2| (p.x.to_bits(), p.y.to_bits());
    let mut edges = BTreeMap::new();
    for (k, band) in bands.iter().enumerate() {
        for (a, b) in band.polygons.iter().flat_map(Polygon::rings).flat_map(Ring::edges) {
            assert!(edges.insert((key(a), key(b)), k).is_none(), "{a} to {b} twice");
        }
    }
    for (k, band) in bands.iter().enumerate() {
        for (a, b) in band.polygons.iter().flat_map(Polygon::rings).flat_map(Ring::edges) {
            let across = edges.get(&(key(b), key(a)));
            let beside = across.is_some_and(|other| other.abs_diff(k) == 1);
            assert!(beside || (across.is_none() && on_border(a, b)), "band {k}: {a} to {b}");
        }
    }
}

/// Every sample lies in the band of its value, and in no other. Not asked of those at a level,
/// within rounding of which the border passes.
fn assert_holds_samples(grid: &Grid<'_, f64>, bands: &[Band]) {
    for (k, &value) in grid.values.iter().enumerate() {
        let (i, j) = (k % grid.columns, k / grid.columns);
        let inner = (1..grid.columns - 1).contains(&i) && (1..grid.rows - 1).contains(&j);
        let p = grid.origin + Point2::new(i as f64, j as f64) * grid.step;
        let at_level = bands.iter().any(|b| b.lower == value);
        for band in bands.iter().filter(|_| inner && !at_level) {
            let expected = band.lower <= value && value < band.upper;
            let found = band.polygons.iter().any(|q| q.contains(p));
            assert_eq!(found, expected, "{value} at {p} in {} to {}", band.lower, band.upper);
        }
    }
}

/// Whether an edge runs along a row or a column of samples.
fn along_lattice(grid: &Grid<'_, f64>, a: Point2, b: Point2) -> bool {
    let on = |v: f64, start: f64, step: f64| ((v - start) / step).fract() == 0.0;
    (a.x == b.x && on(a.x, grid.origin.x, grid.step.x))
        || (a.y == b.y && on(a.y, grid.origin.y, grid.step.y))
}

#[test]
fn a_hill_gives_rings_within_rings() {
    let values: Vec<f64> =
        (0..81).map(|k| f64::from(4 - (k % 9 - 4_i32).abs().max((k / 9 - 4).abs()))).collect();
    let grid = grid(9, &values);
    let bands = grid.isobands(&[2.5, 0.5, 1.5, 2.5]).unwrap();
    let ranges: Vec<(f64, f64)> = bands.iter().map(|b| (b.lower, b.upper)).collect();
    let infinite = f64::INFINITY;
    assert_eq!(ranges, [(-infinite, 0.5), (0.5, 1.5), (1.5, 2.5), (2.5, infinite)]);
    let holes: Vec<usize> = bands.iter().map(|b| b.polygons[0].holes.len()).collect();
    assert_eq!(holes, [1, 1, 1, 0]);
    bands.iter().for_each(|b| assert_valid(&b.polygons));
    assert!((total(&bands) - 8.0).abs() < 1e-12);
    // Asked for in another order, and twice.
    let below = grid.below(&[1.5, 0.5, 1.5]).unwrap();
    assert_eq!(below.iter().map(|b| b.upper).collect::<Vec<_>>(), [1.5, 0.5, 1.5]);
    assert!((area(&below[0].polygons) - total(&bands[..2])).abs() < 1e-12);
    assert_eq!(below[0], below[2]);
}

#[test]
fn one_band_is_all_there_is() {
    let values = [3.0; 12];
    for (levels, which) in [(vec![], 0), (vec![3.0], 1), (vec![4.0, 5.0], 0)] {
        let bands = grid(4, &values).isobands(&levels).unwrap();
        assert_eq!(bands.len(), levels.len() + 1);
        assert_eq!(bands[which].polygons[0].outer.points.len(), 4);
        assert!((total(&bands) - 0.75).abs() < 1e-12);
    }
}

#[test]
fn data_with_holes_end_at_their_cells() {
    // A frame of cells around one sample that is not a number, high on the right.
    let mut values: Vec<f64> = (0..49).map(|k| f64::from(k % 7)).collect();
    values[24] = f64::NAN;
    let grid = grid(7, &values);
    let lines = grid.isolines(&[3.5, 0.5]).unwrap();
    assert_eq!((lines[0].lines.len(), lines[0].rings.len()), (2, 0));
    assert_eq!(lines[1].lines.len(), 1);
    let bands = grid.isobands(&[3.5]).unwrap();
    assert!((total(&bands) - 32.0 * 0.125).abs() < 1e-12);
    assert_shared(&bands, |a, b| along_lattice(&grid, a, b));
    let all = grid.isobands(&[]).unwrap();
    assert_eq!((all[0].polygons.len(), all[0].polygons[0].holes.len()), (1, 1));
    // Nothing but holes: no cell, no region.
    let nothing = [f64::NAN; 9];
    let bands = self::grid(3, &nothing).isobands(&[1.0]).unwrap();
    assert!(bands.iter().all(|b| b.polygons.is_empty()));
    assert!(self::grid(3, &nothing).isolines(&[1.0]).unwrap()[0].lines.is_empty());
}

/// Whole cells that meet in a corner only: each keeps to itself.
#[test]
fn cells_that_meet_in_a_corner_are_apart() {
    let n = f64::NAN;
    let values = [1.0, 1.0, n, 1.0, 1.0, 1.0, n, 1.0, 1.0];
    let bands = grid(3, &values).isobands(&[]).unwrap();
    let areas: Vec<f64> = bands[0].polygons.iter().map(Polygon::area).collect();
    assert_eq!(areas, [0.125, 0.125]);
}

#[test]
fn masks_are_outlined_half_way() {
    let picture = ["#.......", "........", "..###...", "..#.#..#", "..###..#", "........"];
    let mask: Vec<bool> = picture.concat().bytes().map(|b| b == b'#').collect();
    let found =
        Grid { origin: Point2::ZERO, step: Point2::ONE, columns: 8, rows: 6, values: &mask }
            .outline()
            .unwrap();
    assert_valid(&found);
    let areas: Vec<f64> = found.iter().map(Polygon::area).collect();
    // Two samples on the edge, one in a corner, a ring with a hole.
    assert_eq!(areas, [0.75, 0.125, 8.0]);
    assert_eq!(found[2].holes.len(), 1);
}

#[test]
fn fields_are_divided_without_rest() {
    let window = Bounds2::new(Point2::new(-7.3, -5.1), Point2::new(8.4, 6.2));
    let field = |p: Point2| (p.x * 0.7).sin() * (p.y * 0.8).cos() + 0.1 * p.x;
    let levels = [0.5, -0.4, 0.0, 0.5, 9.0];
    let bands = isobands(&field, &window, &levels, &ContourOptions::default()).unwrap();
    assert_eq!(bands.len(), 5);
    assert!(bands[4].polygons.is_empty());
    bands.iter().for_each(|b| assert_valid(&b.polygons));
    let size = window.size();
    assert!((total(&bands) / (size.x * size.y) - 1.0).abs() < 1e-12);
    // Nothing crosses the window: all of it is one band, known from its corner.
    let bands = isobands(&|_: Point2| 2.0, &window, &[1.0], &ContourOptions::default()).unwrap();
    assert_eq!((bands[0].polygons.len(), bands[1].polygons.len()), (0, 1));
    let nan = |p: Point2| if p.x < 0.0 { f64::NAN } else { 1.0 };
    let options = ContourOptions { skip_nan: true, ..ContourOptions::default() };
    let error = isobands(&nan, &window, &[0.5], &options);
    assert!(matches!(error, Err(ContourError::NotANumber { .. })), "holes have no border");
}

/// All levels of a jump lie in one place, on the window's edge too: bands without width.
#[test]
fn bands_have_no_width_at_a_jump() {
    let window = Bounds2::new(Point2::splat(-3.1), Point2::splat(3.2));
    let field = |p: Point2| if p.x + 0.3 * p.y < 0.234 { 0.0 } else { 1.0 };
    let levels = [0.25, 0.5, 0.75];
    let bands = isobands(&field, &window, &levels, &ContourOptions::default()).unwrap();
    assert!((total(&bands) - 6.3 * 6.3).abs() < 1e-9);
    assert!(area(&bands[1].polygons).abs() < 1e-4);
    let left = area(&bands[0].polygons);
    assert!((left - 6.3 * (3.1 + 0.234 - 0.3 * 0.05)).abs() < 1e-4, "{left}");
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    // Small integers: values at the level, plateaus and saddles without end.
    let whole = prop::collection::vec((-3..4i32).prop_map(f64::from), 42);
    let any = prop::collection::vec(-3.0..3.0f64, 42);
    // Whole chunks of samples, one more and one less, and several; hills and hollows all over.
    let wide = prop::sample::select(vec![15, 16, 17, 33, 40]);
    let wide = wide.prop_flat_map(|columns| prop::collection::vec(-3.0..3.0f64, columns * 5));
    prop_oneof![whole, any, wide]
}

fn columns(values: &[f64]) -> usize {
    if values.len() == 42 { 7 } else { values.len() / 5 }
}

fn many_levels() -> impl Strategy<Value = Vec<f64>> {
    let level = prop_oneof![(-3..4i32).prop_map(f64::from), -3.0..3.0f64];
    prop::collection::vec(level, 0..5)
}

fn assert_partition(grid: &Grid<'_, f64>, bands: &[Band]) {
    let whole = whole_area(grid);
    assert!((total(bands) - whole).abs() < 1e-7 * whole.max(1e-3), "{} {whole}", total(bands));
    for polygon in bands.iter().flat_map(|b| &b.polygons) {
        assert!(polygon.outer.area() > 0.0, "{polygon:?}");
        assert!(polygon.holes.iter().all(|h| h.area() < 0.0 && h.points.len() > 2));
        let inside = |p: &Point2| polygon.outer.contains(*p) || near_border(polygon, *p);
        assert!(polygon.holes.iter().all(|h| h.points.iter().all(inside)));
    }
}

fn near_border(polygon: &Polygon, p: Point2) -> bool {
    let off = |(a, b): (Point2, Point2)| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + (b - a) * t)
    };
    polygon.outer.edges().map(off).any(|d| d < 1e-7)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn bands_of_grids_are_a_partition(values in numbers(), levels in many_levels()) {
        let grid = grid(columns(&values), &values);
        let bands = grid.isobands(&levels).unwrap();
        assert_partition(&grid, &bands);
        let end = grid.origin + grid.step * Point2::new(grid.columns as f64 - 1.0, grid.rows as f64 - 1.0);
        assert_shared(&bands, |a, b| {
            let along = |a: f64, b: f64, lo: f64, hi: f64| a == b && (a == lo || a == hi);
            along(a.x, b.x, grid.origin.x, end.x) || along(a.y, b.y, grid.origin.y, end.y)
        });
        assert_holds_samples(&grid, &bands);
        for (k, region) in grid.below(&levels).unwrap().iter().enumerate() {
            let expected: f64 =
                bands.iter().filter(|b| b.upper <= levels[k]).map(|b| area(&b.polygons)).sum();
            prop_assert!((area(&region.polygons) - expected).abs() < 1e-7);
        }
    }

    #[test]
    fn bands_around_holes_are_a_partition(
        values in numbers(), holes in prop::collection::vec(0..200usize, 0..30),
        levels in many_levels()
    ) {
        let mut values = values;
        let count = values.len();
        holes.iter().filter(|k| **k < count).for_each(|&k| values[k] = f64::NAN);
        let grid = grid(columns(&values), &values);
        let bands = grid.isobands(&levels).unwrap();
        assert_partition(&grid, &bands);
        assert_shared(&bands, |a, b| along_lattice(&grid, a, b));
    }

    /// Levels off the samples: no two borders touch.
    #[test]
    fn bands_of_plain_numbers_are_valid(values in numbers(), level in -2.9..2.9f64) {
        prop_assume!(values.iter().all(|v| (v - level).abs() > 1e-3 && (v - level - 0.4).abs() > 1e-3));
        let grid = grid(columns(&values), &values);
        for band in grid.isobands(&[level, level + 0.4]).unwrap() {
            assert_valid(&band.polygons);
        }
    }

    #[test]
    fn singles_and_masks_are_as_their_numbers(values in numbers(), level in -3.0..3.0f64) {
        let singles: Vec<f32> = values.iter().map(|&v| v as f32).collect();
        let doubles: Vec<f64> = singles.iter().map(|&v| f64::from(v)).collect();
        let mask: Vec<bool> = values.iter().map(|&v| v >= level).collect();
        let numbers: Vec<f64> = mask.iter().map(|&b| f64::from(u8::from(b))).collect();
        let columns = columns(&values);
        let mut contourer = GridContourer::default();
        let levels = [level, 1.5];
        prop_assert_eq!(
            contourer.isobands(&grid(columns, &singles), &levels).unwrap(),
            grid(columns, &doubles).isobands(&levels).unwrap()
        );
        prop_assert_eq!(
            contourer.isolines(&grid(columns, &mask), &[0.5]).unwrap(),
            grid(columns, &numbers).isolines(&[0.5]).unwrap()
        );
        let bands = grid(columns, &numbers).isobands(&[0.5]).unwrap();
        prop_assert_eq!(&grid(columns, &mask).outline().unwrap(), &bands[1].polygons);
    }

    #[test]
    fn bands_of_fields_are_a_partition(
        waves in prop::collection::vec((0.2..1.0f64, -1.5..1.5f64, -1.5..1.5f64, 0.0..6.3f64), 1..4),
        first in -0.8..0.8f64, apart in 0.1..0.5f64,
    ) {
        let window = Bounds2::new(Point2::new(-7.3, -5.1), Point2::new(8.4, 6.2));
        let field =
            |p: Point2| waves.iter().map(|w| w.0 * (w.1 * p.x + w.2 * p.y + w.3).sin()).sum::<f64>();
        let levels: Vec<f64> = (0..4).map(|k| first + f64::from(k) * apart).collect();
        let options = ContourOptions::default();
        let mut contourer = Contourer::default();
        let bands = contourer.isobands(&field, &window, &levels, &options).unwrap();
        let size = window.size();
        prop_assert!((total(&bands) - size.x * size.y).abs() < 1e-9 * size.x * size.y);
        assert_shared(&bands, |a, b| {
            let along = |a: f64, b: f64, lo: f64, hi: f64| a == b && (a == lo || a == hi);
            along(a.x, b.x, window.min.x, window.max.x) || along(a.y, b.y, window.min.y, window.max.y)
        });
        bands.iter().for_each(|b| assert_valid(&b.polygons));
        let below = contourer.below(&field, &window, &levels, &options).unwrap();
        for (k, region) in below.iter().enumerate() {
            assert_valid(&region.polygons);
            let expected = total(&bands[..=k]);
            prop_assert!((area(&region.polygons) - expected).abs() < 1e-9);
        }
    }
}
