use super::*;
use crate::{
    ClipperInset, InfillOptions, Monotonic, OrderOptions, SectionOptions, infill, order_with,
    section,
};
use fgm_core::{Band, ColorId, Polygon, Ring, Role, Sectioner, Span, bead};
use proptest::prelude::*;

/// Stripes of `colors` colours in turn, across a direction, `width` mm wide, and waves in them.
struct Stripes {
    colors: u16,
    direction: f64,
    width: f64,
}

impl Sectioner<Band> for Stripes {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        const STEPS: usize = 400;
        let across = Point2::from_angle(self.direction);
        spans.clear();
        let end = (path.len() - 1) as f64;
        for i in 0..STEPS {
            let (from, to) = (end * i as f64 / STEPS as f64, end * (i + 1) as f64 / STEPS as f64);
            let p = fgm_core::point_at(path, 0.5 * (from + to));
            let wave = p.dot(across) + 2.0 * (0.7 * across.perp_dot(p)).sin();
            let color = ((wave / self.width).floor() as i64).rem_euclid(i64::from(self.colors));
            let label = Band::pure(ColorId(color as u16));
            match spans.last_mut() {
                Some(last) if last.label == label => last.to = to,
                _ => spans.push(Span { from, to, label }),
            }
        }
    }
}

/// A disk of radius 12 mm with some holes, and a square beside it.
fn region(holes: &[(f64, f64, f64)]) -> Vec<Polygon> {
    let circle = |x: f64, y: f64, r: f64| {
        let at = |i: i32| Point2::new(x, y) + r * Point2::from_angle(f64::from(i) * 0.25);
        Ring::new((0..25).map(at).collect())
    };
    let disk = |x, y, r| Polygon { outer: circle(x, y, r), holes: Vec::new() };
    let whole = vec![disk(0.0, 0.0, 12.0), disk(19.0, 3.0, 5.0)];
    let holes: Vec<Polygon> = holes.iter().map(|&(x, y, r)| disk(x, y, r)).collect();
    crate::region::difference(&whole, &holes)
}

/// The level segments of pieces in order: colour, from, to and across.
fn lines(pieces: &[Piece], direction: f64) -> Vec<(ColorId, f64, f64, f64)> {
    let axis = Point2::from_angle(direction);
    let segments = pieces
        .iter()
        .flat_map(|piece| piece.points.windows(2).map(move |w| (piece.color, w[0], w[1])));
    let turned = |p: Point2| Point2::new(p.dot(axis), axis.perp_dot(p));
    segments
        .map(|(color, a, b)| (color, turned(a), turned(b)))
        .filter(|(_, a, b)| (a.y - b.y).abs() < LEVEL)
        .map(|(color, a, b)| (color, a.x.min(b.x), a.x.max(b.x), a.y))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn of_lines_beside_each_other_the_lower_one_comes_first(
        holes in prop::collection::vec((-9.0..9.0f64, -9.0..9.0f64, 0.8..4.0f64), 0..4),
        direction in 0.0..3.0f64,
        stripes in 0.0..3.0f64,
        colors in 1..4u16,
        width in 1.5..9.0f64,
    ) {
        let options = InfillOptions {
            role: Role::TopSkin,
            angle: direction,
            ..InfillOptions::new(0.4, 0.2)
        };
        let paths = infill(&region(&holes), &options, &ClipperInset::default());
        let mut pieces = Vec::new();
        let stripes = Stripes { colors, direction: stripes, width };
        section(&paths, &stripes, &SectionOptions::default(), &mut pieces);
        let length: f64 = pieces.iter().map(Piece::length).sum();
        let colors: Vec<ColorId> = (0..colors).map(ColorId).collect();
        let order = OrderOptions {
            monotonic: Monotonic::Top,
            direction: options.solid_direction(),
            ..OrderOptions::default()
        };
        let ordered = order_with(pieces, &colors, Point2::ZERO, &order);
        let after: f64 = ordered.iter().map(Piece::length).sum();
        prop_assert!((length - after).abs() < 1e-6 * length, "{length} to {after}");

        let spacing = bead::spacing(0.4, 0.2);
        let lines = lines(&ordered, order.direction);
        for (i, line) in lines.iter().enumerate() {
            for later in &lines[i + 1..] {
                let meets = line.2.min(later.2) - line.1.max(later.1) > 1e-6;
                let below = line.3 - later.3;
                let beside = (0.5 * spacing..1.5 * spacing).contains(&below);
                prop_assert!(line.0 != later.0 || !meets || !beside, "{later:?} after {line:?}");
            }
        }
    }
}

fn skin(points: &[(f64, f64)]) -> Piece {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Piece::new(points, Role::TopSkin, 0.4, ColorId(0))
}

/// What pieces come to, as text.
fn told(mut pieces: Vec<Piece>) -> String {
    let mut out = Vec::new();
    order(&mut pieces, Point2::ZERO, 0.0, &mut out);
    let piece = |p: &Piece| {
        let points: Vec<_> = p.points.iter().map(|q| format!("{},{}", q.x, q.y)).collect();
        points.join(" ")
    };
    out.iter().map(piece).collect::<Vec<_>>().join(" | ")
}

#[test]
fn joined_lines_are_parted_where_they_must() {
    // A serpentine that goes upwards stays whole, whichever way it was drawn.
    let up = [(0.0, 0.0), (9.0, 0.0), (9.0, 0.4), (0.0, 0.4)];
    let down: Vec<_> = up.iter().rev().copied().collect();
    let whole = "0,0 9,0 9,0.4 0,0.4";
    assert_eq!(told(vec![skin(&up)]), whole);
    assert_eq!(told(vec![skin(&down)]), whole);
    // Two legs up to one line: its join stays with the leg that was there first.
    let left = [(0.0, 0.0), (4.0, 0.0)];
    let right = [(9.0, 0.4), (0.0, 0.4), (9.0, 0.0), (5.0, 0.0)];
    let arch = [(5.0, 0.0), (9.0, 0.0), (9.0, 0.4), (0.0, 0.4)];
    assert_eq!(told(vec![skin(&arch), skin(&left)]), "0,0 4,0 | 5,0 9,0 9,0.4 0,0.4");
    // What has no line of the direction stays one piece.
    assert_eq!(told(vec![skin(&[(3.0, 0.0), (4.0, 1.0)]), skin(&left)]), "0,0 4,0 | 3,0 4,1");
    assert_eq!(told(vec![skin(&right)]), "0,0.4 9,0 5,0 | 9,0.4 0,0.4");
    assert_eq!(told(vec![skin(&[])]), "");
}
