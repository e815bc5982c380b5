use fgm_core::{Mixture, Point2, Point3, Ring};
use proptest::prelude::*;

use super::*;

/// A piece in a layer 0.2 mm high whose rectangular section is `width` wide.
fn piece(from: [f64; 2], to: [f64; 2], width: f64) -> Piece {
    let point = |p: [f64; 2]| Point3::new(p[0], p[1], 0.2);
    let (from, to) = (point(from), point(to));
    let mixture = Mixture::pure(0, 2).unwrap();
    let volume = from.distance(to) * 0.2 * width;
    Piece {
        line: 1,
        layer: Some(0),
        from,
        to,
        volume,
        fed: volume,
        height: 0.2,
        width: width + 0.043,
        role: None,
        head: 0,
        commanded: mixture,
        deposited: [mixture; 2],
        celsius: None,
    }
}

fn figures(pieces: &[Piece], region: Option<&[Polygon]>, cell: f64) -> LayerFigures {
    let mut coverage = Coverage::new(cell).unwrap();
    pieces.iter().for_each(|p| coverage.piece(p));
    coverage.finish(region).unwrap().unwrap()
}

fn rectangle(width: f64, height: f64) -> Polygon {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    Polygon::simple(Ring::new(corners.map(|(x, y)| Point2::new(x, y)).into()))
}

#[test]
fn lines_at_their_spacing_cover_once() {
    let rows = (0..25).map(|i| 0.2 + 0.4 * f64::from(i));
    let lines: Vec<_> = rows.map(|y| piece([0.0, y], [20.0, y], 0.4)).collect();
    let found = figures(&lines, Some(&[rectangle(20.0, 10.0)]), 0.05);
    assert!((found.covered_mm2 - 200.0).abs() < 1.0, "{found:?}");
    assert!(found.coverage.unwrap() > 0.999 && found.overlap < 0.01, "{found:?}");
    assert!((found.filled.unwrap() - 1.0).abs() < 1e-9, "{found:?}");
    assert!(found.layer == 1 && (found.height - 0.2).abs() < 1e-12, "{found:?}");
}

#[test]
fn gaps_and_overlaps_are_seen() {
    let lines = |pitch: f64| -> Vec<_> {
        let count = (10.0 / pitch) as u32;
        let rows = (0..count).map(|i| (f64::from(i) + 0.5) * pitch);
        rows.map(|y| piece([0.0, y], [20.0, y], 0.4)).collect()
    };
    let region = [rectangle(20.0, 10.0)];
    let sparse = figures(&lines(0.5), Some(&region), 0.02);
    assert!((sparse.coverage.unwrap() - 0.8).abs() < 0.01, "{sparse:?}");
    let dense = figures(&lines(0.25), Some(&region), 0.02);
    // 40 lines of 0.4 mm over 10.15 mm: 5.85 of it twice.
    assert!((dense.overlap - 5.85 / 10.15).abs() < 0.02, "{dense:?}");
    let alone = figures(&lines(0.5), None, 0.02);
    assert_eq!((alone.coverage, alone.filled), (None, None));
}

#[test]
fn a_corner_is_no_overlap_but_a_crossing_is() {
    let corner = [piece([0.0, 0.0], [5.0, 0.0], 0.4), piece([5.0, 0.0], [5.0, 5.0], 0.4)];
    assert_eq!(figures(&corner, None, 0.02).overlap, 0.0);
    let wave: Vec<_> = (0..100).map(|i| f64::from(i) * 0.05).map(|x| [x, x.sin()]).collect();
    let fine: Vec<_> = wave.windows(2).map(|w| piece(w[0], w[1], 0.4)).collect();
    assert_eq!(figures(&fine, None, 0.02).overlap, 0.0);
    let cross = [piece([0.0, 2.0], [4.0, 2.0], 0.4), piece([2.0, 0.0], [2.0, 4.0], 0.4)];
    let found = figures(&cross, None, 0.01);
    assert!((found.overlap - 0.16 / 3.04).abs() < 2e-3, "{found:?}");
}

#[test]
fn too_many_cells_are_refused() {
    let mut coverage = Coverage::new(0.01).unwrap();
    coverage.piece(&piece([0.0, 0.0], [1000.0, 1000.0], 0.4));
    assert!(matches!(coverage.finish(None), Err(SimError::Raster { layer: 1, .. })));
    assert!(Coverage::new(0.0).is_err() && Coverage::new(f64::NAN).is_err());
}

proptest! {
    /// The cells of a bead in any direction add up to its area.
    #[test]
    fn area_of_a_bead(angle in 0.0..6.3f64, length in 1.0..20.0f64, width in 0.3..1.5f64) {
        let to = Point2::from_angle(angle) * length;
        let found = figures(&[piece([0.0, 0.0], to.to_array(), width)], None, 0.02);
        let rim = 2.0 * (length + width) * 0.02;
        prop_assert!((found.covered_mm2 - length * width).abs() < rim);
    }

    /// So do those of a polygon.
    #[test]
    fn area_of_a_region(points in prop::collection::vec(1.0..10.0f64, 3..20)) {
        let turn = std::f64::consts::TAU / points.len() as f64;
        let star: Vec<_> = (0..).zip(&points)
            .map(|(i, r)| Point2::from_angle(turn * f64::from(i)) * *r)
            .collect();
        let region = [Polygon::simple(Ring::new(star))];
        let grid = Grid::over(&region[0].bounds(), 0.02, 0).unwrap();
        let mut cells = 0;
        fill_region(&grid, &region, |_, columns| cells += columns.len());
        let rim = region[0].outer.length() * 0.02;
        prop_assert!((cells as f64 * 0.0004 - region[0].area()).abs() < rim);
    }
}
