use super::*;
use fgm_core::{ColorId, Role, Span};
use proptest::prelude::*;

/// Stripes across x: `bands[i]` lies between `edges[i - 1]` and `edges[i]`.
struct Stripes {
    edges: Vec<f64>,
    bands: Vec<Band>,
}

impl Stripes {
    fn at(&self, x: f64) -> Band {
        self.bands[self.edges.iter().filter(|&&e| e < x).count()]
    }
}

impl Sectioner<Band> for Stripes {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        spans.clear();
        let mut cuts: Vec<f64> = vec![0.0];
        for (i, w) in path.windows(2).enumerate() {
            let (a, b) = (w[0].x, w[1].x);
            cuts.extend(
                self.edges
                    .iter()
                    .filter(|&&e| (a < e) != (b < e))
                    .map(|e| i as f64 + ((e - a) / (b - a)).clamp(0.0, 1.0)),
            );
            cuts.push((i + 1) as f64);
        }
        cuts.sort_by(f64::total_cmp);
        for w in cuts.windows(2).filter(|w| w[0] < w[1]) {
            let middle = fgm_core::point_at(path, (w[0] + w[1]) * 0.5);
            let label = self.at(middle.x);
            match spans.last_mut() {
                Some(last) if last.label == label => last.to = w[1],
                _ => spans.push(Span { from: w[0], to: w[1], label }),
            }
        }
    }
}

/// Colours 0, 1, 2 with zipper overlaps between them.
fn zipped(edges: [f64; 4]) -> Stripes {
    let color = ColorId;
    let bands = vec![
        Band::pure(color(0)),
        Band::overlap(color(0), color(1)),
        Band::pure(color(1)),
        Band::overlap(color(1), color(2)),
        Band::pure(color(2)),
    ];
    Stripes { edges: edges.into(), bands }
}

fn path(points: &[(f64, f64)], closed: bool, turn: u32) -> Path {
    let points = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
    Path { points, closed, role: Role::InnerWall, width: 0.4, turn, turns: Vec::new() }
}

fn cut(paths: &[Path], stripes: &Stripes, min_piece: f64) -> Vec<Piece> {
    let mut out = Vec::new();
    section(paths, stripes, &SectionOptions { min_piece, shift: 0 }, &mut out);
    out
}

/// Pieces as text: `color:x,y x,y`.
fn told(pieces: &[Piece]) -> String {
    let piece = |p: &Piece| {
        let points: Vec<_> = p.points.iter().map(|q| format!("{},{}", q.x, q.y)).collect();
        format!("{}:{}", p.color.0, points.join(" "))
    };
    pieces.iter().map(piece).collect::<Vec<_>>().join(" | ")
}

const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];

#[test]
fn paths_are_cut_where_the_colour_changes() {
    let bands = zipped([1.0, 2.0, 5.0, 6.0]);
    let line = [(0.0, 0.0), (4.0, 0.0), (8.0, 0.0)];
    for (points, closed, turn, want) in [
        (&line[..], false, 0, "0:0,0 2,0 | 1:2,0 4,0 6,0 | 2:6,0 8,0"),
        (&line, false, 1, "0:0,0 1,0 | 1:1,0 4,0 5,0 | 2:5,0 8,0"),
        // The first and the last piece of a closed path are one piece over the first vertex.
        (&SQUARE, true, 0, "1:2,0 6,0 | 2:6,0 8,0 8,8 6,8 | 1:6,8 2,8 | 0:2,8 0,8 0,0 2,0"),
        (&[(0.0, 0.0), (0.5, 0.0), (0.5, 1.0)], true, 0, "0:0,0 0.5,0 0.5,1 0,0"),
        (&[(3.0, 3.0)], true, 0, ""),
        (&[(3.0, 3.0), (3.0, 3.0)], true, 0, ""),
        (&[], false, 0, ""),
    ] {
        assert_eq!(told(&cut(&[path(points, closed, turn)], &bands, 0.0)), want);
    }
}

#[test]
fn walls_alternate_in_an_overlap() {
    let all = zipped([-1.0, 9.0, 10.0, 11.0]);
    let colors: Vec<_> = (0..4)
        .flat_map(|turn| cut(&[path(&SQUARE, true, turn)], &all, 0.05))
        .map(|piece| (piece.color.0, piece.is_loop(), piece.length()))
        .collect();
    assert_eq!(colors, [(0, true, 32.0), (1, true, 32.0), (0, true, 32.0), (1, true, 32.0)]);
}

#[test]
fn joined_lines_alternate_and_layers_may_shift_them() {
    let mut serpentine =
        path(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0), (0.0, 2.0), (4.0, 2.0)], false, 0);
    serpentine.turns = vec![0, 0, 1, 1, 2];
    let bands = zipped([2.0, 9.0, 10.0, 11.0]);
    let mut out = Vec::new();
    section(&[serpentine], &bands, &SectionOptions { min_piece: 0.0, shift: 1 }, &mut out);
    assert_eq!(told(&out), "0:0,0 2,0 | 1:2,0 4,0 4,1 | 0:4,1 0,1 0,2 2,2 | 1:2,2 4,2");
}

/// The cut before and the cut after the first vertex were told apart by a sum of parameters, which
/// moved the second by a rounding error.
#[test]
fn regression_pieces_over_the_first_vertex_meet_the_next() {
    let bands = zipped([4.163836983084276, 4.17, 9.0, 9.5]);
    let ring = [(0.5, 4.0), (9.7, 4.0017), (9.9, 7.0), (0.1, 7.0)];
    let pieces = cut(&[path(&ring, true, 1)], &bands, 0.0);
    for (piece, next) in pieces.iter().zip(pieces.iter().cycle().skip(1)) {
        assert_eq!(piece.points.last(), next.points.first());
    }
    assert!(pieces.len() > 2);
}

fn any_path() -> impl Strategy<Value = Path> {
    // Whole and half coordinates fall on edges and vertices often.
    let along = prop_oneof![(0..20i32).prop_map(|i| f64::from(i) * 0.5), 0.0..10.0f64];
    let points = prop::collection::vec((along.clone(), along), 0..12);
    (points, any::<bool>(), 0..3u32, any::<bool>()).prop_map(|(points, closed, turn, own)| {
        let mut path = path(&points, closed, turn);
        if own {
            path.turns = (0..path.points.len() as u32).map(|i| i / 2).collect();
        }
        path
    })
}

proptest! {
    #[test]
    fn no_length_is_lost_or_doubled(
        paths in prop::collection::vec(any_path(), 1..4),
        edges in prop::array::uniform4(0.0..10.0f64),
        min_piece in prop_oneof![Just(0.0), Just(0.05), 0.0..20.0f64],
    ) {
        let mut edges = edges;
        edges.sort_by(f64::total_cmp);
        let bands = zipped(edges);
        for path in &paths {
            let pieces = cut(std::slice::from_ref(path), &bands, min_piece);
            let sum: f64 = pieces.iter().map(Piece::length).sum();
            prop_assert!((sum - path.length()).abs() <= 1e-9 * path.length(), "{sum} {path:?}");
            for pair in pieces.windows(2) {
                prop_assert!(pair[0].color != pair[1].color);
                prop_assert_eq!(pair[0].points.last(), pair[1].points.first());
            }
            prop_assert!(pieces.iter().all(|p| p.points.len() > 1 && p.length() > 0.0));
            if pieces.len() > 1 {
                prop_assert!(pieces.iter().all(|p| p.length() >= min_piece * (1.0 - 1e-9)));
                if path.closed {
                    prop_assert!(pieces[0].color != pieces[pieces.len() - 1].color);
                }
            }
        }
    }

    #[test]
    fn every_piece_lies_in_bands_of_its_colour(
        path in any_path(),
        edges in prop::array::uniform4(0.0..10.0f64),
    ) {
        let mut edges = edges;
        edges.sort_by(f64::total_cmp);
        let bands = zipped(edges);
        for piece in cut(&[path], &bands, 0.0) {
            for w in piece.points.windows(2).filter(|w| w[0].distance(w[1]) > 1e-6) {
                let band = bands.at((w[0].x + w[1].x) * 0.5);
                prop_assert!(band.first == piece.color || band.second == piece.color);
            }
        }
    }
}
