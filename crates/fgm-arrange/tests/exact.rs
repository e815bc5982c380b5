//! Counts against a plain arrangement in fractions: all pairs of segments, no rounding.

#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.

use fgm_arrange::generators::{Drawn, chains};
use fgm_arrange::{ArrangeOptions, Arrangement};
use fgm_core::Point2;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

type Whole = (i64, i64);

/// A point with a common denominator, reduced: x, y, denominator above 0.
type Place = (i64, i64, i64);

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

fn place(x: i64, y: i64, by: i64) -> Place {
    let common = gcd(gcd(x, y), by) * by.signum();
    (x / common, y / common, by / common)
}

fn minus(a: Whole, b: Whole) -> Whole {
    (a.0 - b.0, a.1 - b.1)
}

fn cross(a: Whole, b: Whole) -> i64 {
    a.0 * b.1 - a.1 * b.0
}

/// Whether a place lies on a segment.
fn holds((a, b): (Whole, Whole), (x, y, by): Place) -> bool {
    let (d, e) = (minus(b, a), (x - a.0 * by, y - a.1 * by));
    let along = d.0 * e.0 + d.1 * e.1;
    cross(d, e) == 0 && along >= 0 && along <= (d.0 * d.0 + d.1 * d.1) * by
}

/// Where two segments that are not parallel meet, if they do.
fn meeting(s: (Whole, Whole), t: (Whole, Whole)) -> Option<Place> {
    let (u, v) = (minus(s.1, s.0), minus(t.1, t.0));
    let by = cross(u, v);
    if by == 0 {
        return None;
    }
    let at = cross(minus(t.0, s.0), v);
    let p = place(s.0.0 * by + u.0 * at, s.0.1 * by + u.1 * at, by);
    (holds(s, p) && holds(t, p)).then_some(p)
}

/// Numbers of vertices, edges and bounded faces.
fn count(segments: &[(Whole, Whole)]) -> [usize; 3] {
    let mut edges = BTreeSet::new();
    for &s in segments {
        let ends = segments.iter().flat_map(|t| [t.0, t.1]).map(|p| place(p.0, p.1, 1));
        let ends = ends.filter(|&p| holds(s, p));
        let mut on: Vec<Place> =
            ends.chain(segments.iter().filter_map(|&t| meeting(s, t))).collect();
        // Along the segment: by the projection, as fractions.
        let d = minus(s.1, s.0);
        let along = |p: &Place| (d.0 * p.0 + d.1 * p.1, p.2);
        on.sort_by(|a, b| {
            let ((a, by), (b, other)) = (along(a), along(b));
            (a * other).cmp(&(b * by))
        });
        on.dedup();
        edges.extend(on.windows(2).map(|w| (w[0].min(w[1]), w[0].max(w[1]))));
    }
    // Components, by joining names until nothing changes.
    let mut names: BTreeMap<Place, usize> = BTreeMap::new();
    for (i, &(a, b)) in edges.iter().enumerate() {
        names.entry(a).or_insert(2 * i);
        names.entry(b).or_insert(2 * i + 1);
    }
    loop {
        let mut changed = false;
        for (a, b) in &edges {
            let least = names[a].min(names[b]);
            for p in [a, b] {
                changed |= names.insert(*p, least) != Some(least);
            }
        }
        if !changed {
            break;
        }
    }
    let components = names.values().collect::<BTreeSet<_>>().len();
    [names.len(), edges.len(), edges.len() + components - names.len()]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn counts_are_those_of_exact_arithmetic(
        lines in prop::collection::vec(prop::collection::vec((-12..=12i64, -12..=12i64), 2..6), 1..9),
    ) {
        let mut segments: Vec<_> =
            lines.iter().flat_map(|line| line.windows(2).map(|w| (w[0], w[1]))).collect();
        segments.retain(|(a, b)| a != b);
        let point = |&(x, y): &Whole| Point2::new(x as f64, y as f64);
        let drawn: Vec<_> = lines
            .iter()
            .map(|line| Drawn { points: line.iter().map(point).collect(), closed: false })
            .collect();
        // So fine that no two places share a pixel, and nothing passes by one.
        let options = ArrangeOptions::default().with_lattice(1e-9).with_dangling(true);
        let arrangement = Arrangement::new(&chains(&drawn), &options).unwrap();
        let inner: usize = arrangement.edges().map(|edge| edge.points().len() - 2).sum();
        let found = [
            arrangement.vertex_count() + inner,
            arrangement.edge_count() + inner,
            arrangement.face_count(),
        ];
        prop_assert_eq!(found, count(&segments));
    }
}
