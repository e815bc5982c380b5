//! Every case of a cell, with both answers of a saddle, in all four rotations and both directions,
//! checked against each other and drawn to `docs/contour-cases.svg`. Set `FGM_BLESS` to write the
//! drawing instead of comparing it.

// Helpers outside of test functions may fail tests too.
#![allow(clippy::unwrap_used, clippy::panic)]

use fgm_contour::Grid;
use fgm_core::{Point2, Polygon};
use std::fmt::Write;

/// A segment from one point of the cell's border to another.
type Segment = (Point2, Point2);

/// One picture: the values at the corners, anticlockwise from the lower left, and what is found.
struct Cell {
    values: [f64; 4],
    segments: Vec<Segment>,
    below: Vec<Polygon>,
}

impl Cell {
    fn new(values: [f64; 4]) -> Self {
        let rows = [values[0], values[1], values[3], values[2]];
        let (origin, step) = (Point2::ZERO, Point2::ONE);
        let grid = Grid { origin, step, columns: 2, rows: 2, values: &rows };
        let lines = grid.isolines(&[0.0]).unwrap().remove(0);
        assert!(lines.rings.is_empty());
        let segments = lines.lines.iter().map(|l| match l.points[..] {
            [a, b] => (a, b),
            _ => panic!("{l:?}"),
        });
        let mut bands = grid.isobands(&[0.0]).unwrap();
        let area = |polygons: &[Polygon]| polygons.iter().map(Polygon::area).sum::<f64>();
        assert!((area(&bands[0].polygons) + area(&bands[1].polygons) - 1.0).abs() < 1e-12);
        let below = grid.below(&[0.0]).unwrap().remove(0);
        assert_eq!(area(&below.polygons), area(&bands[0].polygons));
        Self { values, segments: segments.collect(), below: bands.swap_remove(0).polygons }
    }

    /// The segments as they are in every picture of the same: in order, to 1e-12.
    fn key(&self, place: impl Fn(Point2) -> Point2, reversed: bool) -> Vec<[i64; 4]> {
        let units = |v: f64| (v * 1e12).round() as i64;
        let mut key: Vec<[i64; 4]> = self
            .segments
            .iter()
            .map(|&(a, b)| if reversed { (b, a) } else { (a, b) })
            .map(|(a, b)| (place(a), place(b)))
            .map(|(a, b)| [units(a.x), units(a.y), units(b.x), units(b.y)])
            .collect();
        key.sort_unstable();
        key
    }

    /// Low corners lie to the left of the segments next to them, high ones to the right.
    fn assert_low_is_left(&self) {
        let corners = [Point2::ZERO, Point2::X, Point2::ONE, Point2::Y];
        for &(a, b) in &self.segments {
            for end in [a, b] {
                for (corner, value) in corners.iter().zip(self.values) {
                    let beside = (corner.x == end.x) != (corner.y == end.y);
                    let side = (b - a).perp_dot(corner - a);
                    let next_to = beside && corner.distance(end) < 1.0;
                    assert!(!next_to || (side > 0.0) == (value < 0.0), "{:?}", self.values);
                }
            }
        }
    }
}

/// The corners of a case; where it is a saddle, with its centre above or below the level.
fn values(case: u8, above: bool) -> [f64; 4] {
    let (high, low) = match (is_saddle(case), above) {
        (false, _) => (1.0, -1.0),
        (true, true) => (1.5, -1.0),
        (true, false) => (1.0, -1.5),
    };
    std::array::from_fn(|corner| if case >> corner & 1 == 1 { high } else { low })
}

fn is_saddle(case: u8) -> bool {
    case == 5 || case == 10
}

/// A quarter turn anticlockwise.
fn turned(values: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|corner| values[(corner + 3) % 4])
}

fn turn(p: Point2) -> Point2 {
    Point2::new(1.0 - p.y, p.x)
}

/// All pictures, a row for each case and answer: four rotations, then the same with above and
/// below swapped.
fn atlas() -> Vec<(String, Vec<Cell>)> {
    let mut rows = Vec::new();
    for case in 0..16_u8 {
        for above in [false, true] {
            if !is_saddle(case) && above {
                continue;
            }
            let mut name = format!("{case}");
            if is_saddle(case) {
                name.push_str(if above { " above" } else { " below" });
            }
            let mut row = Vec::new();
            for sign in [1.0, -1.0] {
                let mut values = values(case, above).map(|v| v * sign);
                for _ in 0..4 {
                    row.push(Cell::new(values));
                    values = turned(values);
                }
            }
            rows.push((name, row));
        }
    }
    rows
}

#[test]
fn every_case_turns_and_reverses_with_its_values() {
    let rows = atlas();
    assert_eq!(rows.len(), 18);
    for (name, row) in &rows {
        for (k, cell) in row.iter().enumerate() {
            let high = cell.values.iter().filter(|v| **v > 0.0).count();
            let saddle = high == 2 && (cell.values[0] > 0.0) == (cell.values[2] > 0.0);
            let expected = if high % 4 == 0 { 0 } else { 1 + usize::from(saddle) };
            assert_eq!(cell.segments.len(), expected, "{name}");
            cell.assert_low_is_left();
            if k % 4 > 0 {
                let identity = |p| p;
                assert_eq!(cell.key(identity, false), row[k - 1].key(turn, false), "{name} turned");
            }
            // The corners that the centre is joined to.
            let centre = Point2::splat(0.5);
            for &(a, b) in cell.segments.iter().filter(|_| saddle) {
                let joined_to_high = (b - a).perp_dot(centre - a) < 0.0;
                let above = cell.values.iter().sum::<f64>() > 0.0;
                assert_eq!(joined_to_high, above, "{name}");
            }
        }
        for k in 0..4 {
            let identity = |p| p;
            assert_eq!(row[k].key(identity, false), row[k + 4].key(identity, true), "{name}");
        }
    }
}

const SIZE: f64 = 44.0;
const PITCH: f64 = 64.0;
const LEFT: f64 = 90.0;
const TOP: f64 = 70.0;

fn draw(rows: &[(String, Vec<Cell>)]) -> String {
    let (width, height) = (LEFT + 8.0 * PITCH + 10.0, TOP + rows.len() as f64 * PITCH);
    let mut svg = String::new();
    let mut line = |text: std::fmt::Arguments<'_>| writeln!(svg, "{text}").unwrap();
    line(format_args!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">"#
    ));
    line(format_args!(
        r##"<defs><marker id="a" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z" fill="#b02020"/></marker></defs>"##
    ));
    line(format_args!(r##"<rect width="{width}" height="{height}" fill="#fff"/>"##));
    line(format_args!(
        r#"<text x="10" y="18">The cases of a cell. Dots: corners at the level or above.</text>"#
    ));
    line(format_args!(
        r#"<text x="10" y="34">Shaded: the band below, which lines have on their left.</text>"#
    ));
    line(format_args!(r#"<text x="10" y="58">case</text>"#));
    for (k, head) in ["as it is", "above and below swapped"].iter().enumerate() {
        let x = LEFT + 4.0 * PITCH * k as f64;
        line(format_args!(r#"<text x="{x}" y="58">{head}, turned by quarters</text>"#));
    }
    for (r, (name, cells)) in rows.iter().enumerate() {
        let y = TOP + r as f64 * PITCH;
        line(format_args!(r#"<text x="10" y="{}">{name}</text>"#, y + 0.5 * SIZE));
        for (c, cell) in cells.iter().enumerate() {
            line(format_args!("{}", picture(cell, LEFT + c as f64 * PITCH, y)));
        }
    }
    line(format_args!("</svg>"));
    svg
}

fn picture(cell: &Cell, left: f64, top: f64) -> String {
    let place = |p: Point2| format!("{:.1} {:.1}", left + p.x * SIZE, top + (1.0 - p.y) * SIZE);
    let mut svg = String::new();
    for ring in cell.below.iter().flat_map(Polygon::rings) {
        let points: Vec<String> = ring.points.iter().map(|&p| place(p)).collect();
        write!(svg, r##"<path d="M{}z" fill="#cfe0f2"/>"##, points.join("L")).unwrap();
    }
    write!(
        svg,
        r##"<rect x="{left}" y="{top}" width="{SIZE}" height="{SIZE}" fill="none" stroke="#888"/>"##
    )
    .unwrap();
    let corners = [Point2::ZERO, Point2::X, Point2::ONE, Point2::Y];
    for (corner, _) in corners.iter().zip(cell.values).filter(|c| c.1 > 0.0) {
        let at = place(*corner);
        let (x, y) = at.split_once(' ').unwrap();
        write!(svg, r#"<circle cx="{x}" cy="{y}" r="4"/>"#).unwrap();
    }
    for &(a, b) in &cell.segments {
        let (a, b) = (place(a), place(b));
        write!(
            svg,
            r##"<path d="M{a}L{b}" stroke="#b02020" stroke-width="1.6" marker-end="url(#a)"/>"##
        )
        .unwrap();
    }
    svg
}

#[test]
fn the_drawing_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/contour-cases.svg");
    let drawn = draw(&atlas());
    if std::env::var_os("FGM_BLESS").is_some() {
        std::fs::write(path, &drawn).unwrap();
    }
    let kept = std::fs::read_to_string(path).unwrap();
    assert!(
        kept.replace("\r\n", "\n") == drawn,
        "run this test with FGM_BLESS=1 and look at {path}"
    );
}
