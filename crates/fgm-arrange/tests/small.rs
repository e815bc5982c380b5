//! Small cases, drawn by hand: what faces come out.

#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.

use fgm_arrange::{ArrangeError, ArrangeOptions, Arrangement, Chain, Location};
use fgm_core::Point2;

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// Lines as text, separated by `;`: points `x,y`, and `o` at the end of a closed one.
fn parse(text: &str) -> Vec<(Vec<Point2>, bool)> {
    let number = |s: &str| s.parse::<f64>().unwrap();
    let line = |line: &str| {
        let words: Vec<_> = line.split_whitespace().collect();
        let closed = words.last() == Some(&"o");
        let points = words.iter().filter(|w| **w != "o").map(|w| {
            let (x, y) = w.split_once(',').unwrap();
            p(number(x), number(y))
        });
        (points.collect(), closed)
    };
    text.split(';').map(line).collect()
}

fn arrange(text: &str, options: &ArrangeOptions) -> Arrangement<u32> {
    let lines = parse(text);
    let chains: Vec<_> = lines
        .iter()
        .zip(0..)
        .map(|((points, closed), label)| Chain { points, closed: *closed, label })
        .collect();
    let arrangement = Arrangement::new(&chains, options).unwrap();
    arrangement.validate().unwrap();
    arrangement
}

/// Areas of faces, in order of size, each with the number of its holes.
fn summary(arrangement: &Arrangement<u32>) -> String {
    let mut faces: Vec<_> =
        arrangement.faces().map(|f| (f.area(), f.polygon().holes.len())).collect();
    faces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let words: Vec<_> = faces
        .iter()
        .map(
            |(area, holes)| if *holes == 0 { format!("{area}") } else { format!("{area}-{holes}") },
        )
        .collect();
    words.join(" ")
}

#[test]
fn faces_of_small_drawings() {
    let cases = [
        ("nothing", "", ""),
        ("a point", "1,1", ""),
        ("a point, closed", "1,1 1,1 o", ""),
        ("an open line", "0,0 1,0 1,1", ""),
        ("there and back", "0,0 1,0 o", ""),
        ("a square", "0,0 2,0 2,2 0,2 o", "4"),
        ("a square with its end repeated", "0,0 2,0 2,2 0,2 0,0 o", "4"),
        ("an open line that comes back", "0,0 2,0 2,2 0,2 0,0", "4"),
        ("clockwise", "0,0 0,2 2,2 2,0 o", "4"),
        ("doubled", "0,0 2,0 2,2 0,2 o; 2,2 2,0 0,0 0,2 o", "4"),
        ("a cross", "0,0 2,2; 0,2 2,0", ""),
        ("a bow tie", "0,0 2,2 2,0 0,2 o", "1 1"),
        ("a hole", "0,0 4,0 4,4 0,4 o; 1,1 2,1 2,2 1,2 o", "1 15-1"),
        ("a hole that touches in a vertex", "0,0 4,0 4,4 0,4 o; 0,0 2,1 1,2 o", "1.5 14.5-1"),
        ("a hole that touches an edge", "0,0 4,0 4,4 0,4 o; 2,0 3,1 1,1 o", "1 15-1"),
        (
            "two holes that touch",
            "0,0 9,0 9,9 0,9 o; 1,1 2,1 2,2 1,2 o; 2,2 3,2 3,3 2,3 o",
            "1 1 79-2",
        ),
        ("three deep", "0,0 9,0 9,9 0,9 o; 1,1 8,1 8,8 1,8 o; 2,2 7,2 7,7 2,7 o", "24-1 25 32-1"),
        ("side by side", "0,0 2,0 2,2 0,2 o; 2,0 4,0 4,2 2,2 o", "4 4"),
        ("an edge shared in part", "0,0 2,0 2,2 0,2 o; 2,1 4,1 4,3 2,3 o", "4 4"),
        ("overlapping", "0,0 2,0 2,2 0,2 o; 1,1 3,1 3,3 1,3 o", "1 3 3"),
        ("a dangling end", "0,0 2,0 2,2 0,2 o; 1,1 3,1", "4"),
        ("a cut", "0,0 2,0 2,2 0,2 o; 0,1 2,1", "2 2"),
        ("a cut made of pieces", "0,0 2,0 2,2 0,2 o; 0,1 1.5,1; 2,1 0.5,1", "2 2"),
        (
            "a bridge between ring and hole",
            "0,0 9,0 9,9 0,9 o; 1,1 2,1 2,2 1,2 o; 0,0 1,1",
            "1 80-1",
        ),
        ("a hash", "0,1 3,1; 0,2 3,2; 1,0 1,3; 2,0 2,3", "1"),
        ("a spike", "0,0 2,0 2,2 5,2 2,2 0,2 o", "4"),
        ("a spike that folds past", "0,0 3,0 1,0 1,2 0,2 o", "2"),
        ("two apart", "0,0 1,0 1,1 0,1 o; 3,0 4,0 4,1 3,1 o", "1 1"),
        (
            "far apart sizes",
            "0,0 1e6,0 1e6,1e6 0,1e6 o; 1,1 1.001,1 1.001,1.001 1,1.001 o",
            "0.000001 999999999999.999999-1",
        ),
    ];
    for (name, text, expected) in cases {
        for keep in [false, true] {
            let options = ArrangeOptions::default().with_dangling(keep);
            let found =
                if text.is_empty() { String::new() } else { summary(&arrange(text, &options)) };
            let near = found.split_whitespace().zip(expected.split_whitespace()).all(|(a, b)| {
                let area = |s: &str| s.split('-').next().unwrap().parse::<f64>().unwrap();
                let holes = |s: &str| s.split('-').nth(1).map(str::to_owned);
                (area(a) - area(b)).abs() <= 1e-12 * area(b) && holes(a) == holes(b)
            });
            let same = found.split_whitespace().count() == expected.split_whitespace().count();
            assert!(near && same, "{name}, kept {keep}: {found}, not {expected}");
        }
    }
}

#[test]
fn labels_of_overlaps_are_kept_with_their_directions() {
    let arrangement =
        arrange("0,0 2,0; 3,0 1,0; 1,0 2,0", &ArrangeOptions::default().with_dangling(true));
    let labels: Vec<Vec<_>> = arrangement
        .edges()
        .map(|e| e.labels().iter().map(|l| (l.label, l.forward)).collect())
        .collect();
    let expected = [vec![(0, true)], vec![(0, true), (1, false), (2, true)], vec![(1, false)]];
    assert_eq!(labels, expected);
}

#[test]
fn borders_tell_the_neighbour_and_the_label() {
    let arrangement = arrange("0,0 2,0 2,2 0,2 o; 1,-1 1,3", &ArrangeOptions::default());
    let left = arrangement.locate(p(0.5, 1.0)).face().unwrap();
    let right = arrangement.locate(p(1.5, 1.0)).face().unwrap();
    let mut seen: Vec<_> = arrangement
        .face(left)
        .neighbours()
        .flat_map(|b| {
            b.labels().map(move |l| (l.label, l.forward, b.neighbour())).collect::<Vec<_>>()
        })
        .collect();
    seen.sort();
    assert_eq!(seen, [(0, true, None), (1, true, Some(right))]);
}

#[test]
fn places_are_told_apart() {
    let arrangement =
        arrange("0,0 4,0 4,4 0,4 o; 1,1 3,1 3,3 1,3 o; 0,0 4,4", &ArrangeOptions::default());
    let at = |x, y| arrangement.locate(p(x, y));
    assert!(matches!(at(0.0, 0.0), Location::Vertex(_)));
    assert!(matches!(at(2.0, 0.0), Location::Edge(_)));
    assert!(matches!(at(0.5, 0.5), Location::Edge(_)));
    assert_eq!(at(5.0, 1.0), Location::Unbounded);
    assert_eq!(at(-1.0, 0.0), Location::Unbounded);
    assert_eq!(at(f64::NAN, 0.0), Location::Unbounded);
    assert_eq!(at(2.0, 0.5), at(3.5, 3.0));
    assert_ne!(at(2.0, 0.5), at(0.5, 3.0));
    assert_ne!(at(2.0, 1.5), at(1.5, 2.0));
    assert!(at(2.0, 1.5).face().is_some());
}

#[test]
fn squares_nest_to_any_depth() {
    let depth = 500;
    let square = |i: i32| {
        let r = f64::from(depth - i);
        vec![p(-r, -r), p(r, -r), p(r, r), p(-r, r)]
    };
    let squares: Vec<_> = (0..depth).map(square).collect();
    let chains: Vec<_> = squares.iter().map(|points| Chain::closed(points, 0)).collect();
    let arrangement = Arrangement::new(&chains, &ArrangeOptions::default()).unwrap();
    arrangement.validate().unwrap();
    assert_eq!(arrangement.face_count(), depth as usize);
    assert_eq!(arrangement.component_count(), depth as usize);
    for i in 0..depth {
        let r = f64::from(depth - i);
        let face = arrangement.locate(p(r - 0.5, 0.0)).face().unwrap();
        let last = i + 1 == depth;
        assert_eq!(arrangement.face(face).area(), if last { 4.0 } else { 8.0 * r - 4.0 });
        assert_eq!(arrangement.face(face).holes().len(), usize::from(!last));
        let beyond: Vec<_> = arrangement.face(face).neighbours().map(|b| b.neighbour()).collect();
        let out = (i > 0).then(|| arrangement.locate(p(r + 0.5, 0.0)).face().unwrap());
        assert_eq!(beyond[0], out);
    }
}

#[test]
fn paths_are_cut_at_the_borders() {
    let arrangement = arrange("0,0 2,0 2,2 0,2 o; 2,0 4,0 4,2 2,2 o", &ArrangeOptions::default());
    let [a, b] = [p(1.0, 1.0), p(3.0, 1.0)].map(|q| arrangement.locate(q).face());
    let cases = [
        (
            "through both",
            "-1,1 5,1",
            vec![(0.0, None), (1.0 / 6.0, a), (0.5, b), (5.0 / 6.0, None)],
        ),
        ("inside", "0.5,0.5 1,1.5 1.5,0.5", vec![(0.0, a)]),
        ("outside", "5,5 6,6", vec![(0.0, None)]),
        ("from border to border", "0,1 4,1", vec![(0.0, a), (0.5, b)]),
        ("a vertex on the border", "1,1 2,1 1,1.5", vec![(0.0, a)]),
        ("along the border between", "2,0 2,2", vec![(0.0, a)]),
        ("along it downwards", "2,2 2,0", vec![(0.0, b)]),
        ("along the outside, clockwise", "0,0 0,2", vec![(0.0, a)]),
        (
            "on along the outside",
            "-1,0 5,0",
            vec![(0.0, None), (1.0 / 6.0, a), (0.5, b), (5.0 / 6.0, None)],
        ),
        ("through vertices", "1,-1 3,1", vec![(0.0, None), (0.5, b)]),
        ("touching a corner", "-1,1 1,-1", vec![(0.0, None)]),
        ("a repeated point", "1,1 1,1 3,1", vec![(0.0, a), (1.5, b)]),
        ("standing still", "1,1 1,1", vec![(0.0, a)]),
        ("standing on the border", "2,1 2,1", vec![(0.0, a)]),
        ("a single point", "1,1", vec![]),
    ];
    for (name, text, expected) in cases {
        let path = parse(text).remove(0).0;
        let mut spans = Vec::new();
        arrangement.cut(&path, &mut spans);
        let found: Vec<_> = spans.iter().map(|s| (s.from, s.label)).collect();
        let near = found.len() == expected.len()
            && found.iter().zip(&expected).all(|(a, b)| (a.0 - b.0).abs() < 1e-12);
        let labels = |list: &[(f64, _)]| list.iter().map(|s| s.1).collect::<Vec<_>>();
        // Standing still on a border, either side will do.
        let either =
            name == "standing on the border" && (labels(&found) == [a] || labels(&found) == [b]);
        assert!(near && (either || labels(&found) == labels(&expected)), "{name}: {found:?}");
        assert!(spans.windows(2).all(|w| w[0].to == w[1].from));
        assert!(spans.last().is_none_or(|s| s.to == (path.len() - 1) as f64));
    }
}

#[test]
fn bad_input_is_named() {
    let good = [p(0.0, 0.0), p(1.0, 0.0)];
    let nan = [p(0.0, 0.0), p(f64::NAN, 0.0)];
    let far = [p(0.0, 2e6), p(1.0, 0.0)];
    let one = |points: &[Point2], options: &ArrangeOptions| {
        Arrangement::new(&[Chain::open(&good, 0), Chain::open(points, 1)], options).unwrap_err()
    };
    let plain = ArrangeOptions::default();
    assert!(matches!(one(&nan, &plain), ArrangeError::NotFinite { chain: 1, point: 1, .. }));
    let error = one(&far, &plain);
    assert!(matches!(error, ArrangeError::OutOfRange { chain: 1, point: 0, y: 2e6, .. }));
    assert_eq!(
        error.to_string(),
        "chain 1, point 0: (0, 2000000) lies outside +-1099511.627776 mm, the range of a lattice of 0.000001 mm"
    );
    assert!(matches!(one(&good, &plain.with_lattice(0.0)), ArrangeError::Lattice { .. }));
    assert!(Arrangement::new(&[Chain::open(&far, 1)], &plain.with_lattice(1e-5)).is_ok());
}
