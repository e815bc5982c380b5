//! Hard input from the generators: every arrangement is valid, near its input, stable, and the
//! same whatever the order of the input.
//!
//! `FGM_LONG_TESTS=<cases>` sets the number of cases of each property.

#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.
use fgm_arrange::generators::{self, Drawn, STEP, chains};
use fgm_arrange::{ArrangeError, ArrangeOptions, Arrangement, Location};
use fgm_core::{Point2, point_at, slice_path};
use proptest::prelude::*;

fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var("FGM_LONG_TESTS").ok().and_then(|n| n.parse().ok());
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(long.unwrap_or(cases))
    }
}

fn arrange(lines: &[Drawn], keep: bool) -> Arrangement<u32> {
    Arrangement::new(&chains(lines), &ArrangeOptions::default().with_dangling(keep)).unwrap()
}

/// Everything there is, edge by edge and face by face.
fn all(arrangement: &Arrangement<u32>) -> String {
    let edges = arrangement.edges().map(|e| {
        (e.points().collect::<Vec<_>>(), e.labels().to_vec(), e.left(), e.right(), e.ends())
    });
    let faces = arrangement.faces().map(|f| (f.polygon(), f.area(), f.inside_point()));
    format!("{:?} {:?}", edges.collect::<Vec<_>>(), faces.collect::<Vec<_>>())
}

fn unlabelled(lines: &[Drawn]) -> String {
    let mut chains = chains(lines);
    chains.iter_mut().for_each(|chain| chain.label = 0);
    let arrangement = Arrangement::new(&chains, &ArrangeOptions::default()).unwrap();
    let faces = arrangement.faces().map(|f| (f.polygon(), f.area(), f.inside_point()));
    format!("{:?}", faces.collect::<Vec<_>>())
}

/// The greatest distance in x or y, in steps, from points of `a` to the segments of `b`.
fn distance(a: &[Point2], b: &[(Point2, Point2)]) -> f64 {
    let to = |p: Point2, (c, d): (Point2, Point2)| {
        // The distance in x or y is convex along the segment: search by thirds.
        let at = |t: f64| (c + (d - c) * t - p).abs().max_element();
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..120 {
            let third = (hi - lo) / 3.0;
            if at(lo + third) < at(hi - third) { hi -= third } else { lo += third }
        }
        at(lo).min(at(hi)).min(at(0.0)).min(at(1.0))
    };
    let nearest = |p: &Point2| b.iter().map(|s| to(*p, *s)).fold(f64::INFINITY, f64::min);
    a.iter().map(nearest).fold(0.0, f64::max) / STEP
}

fn segments(line: &Drawn) -> Vec<(Point2, Point2)> {
    let mut list: Vec<_> = line.points.windows(2).map(|w| (w[0], w[1])).collect();
    if line.closed && line.points.len() > 1 {
        list.push((line.points[line.points.len() - 1], line.points[0]));
    }
    list
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn valid_whatever_comes(lines in generators::lines(), keep in any::<bool>()) {
        let arrangement = arrange(&lines, keep);
        prop_assert_eq!(arrangement.validate(), Ok(()));
        prop_assert!(keep || arrangement.edges().all(|e| !e.is_dangling() && e.left() != e.right()));
    }

    #[test]
    fn valid_at_any_size(
        lines in generators::lines(),
        size in prop::sample::select(vec![1e-6, 1e-3, 40.0]),
        step in prop::sample::select(vec![1e-6, 1e-9, 2.0f64.powi(-13)]),
    ) {
        // Up to 8e5 mm; on the fine lattice up to 1.1e3 mm, beyond which there is an error.
        let lines = generators::scaled(&lines, size);
        let options = ArrangeOptions::default().with_dangling(true).with_lattice(step);
        let limit = step * (1u64 << 40) as f64;
        let fits = lines.iter().flat_map(|l| &l.points).all(|p| p.abs().max_element() <= limit);
        match Arrangement::new(&chains(&lines), &options) {
            Ok(arrangement) => {
                prop_assert!(fits);
                prop_assert_eq!(arrangement.validate(), Ok(()));
            }
            Err(error) => {
                let far = matches!(error, ArrangeError::OutOfRange { .. });
                prop_assert!(!fits && far, "{}", error);
            }
        }
    }

    #[test]
    fn both_sides_of_a_border_know_each_other(lines in generators::lines(), keep in any::<bool>()) {
        let arrangement = arrange(&lines, keep);
        let mut seen = vec![0; 2 * arrangement.edge_count()];
        let outlines = arrangement.outlines().flatten();
        for border in arrangement.faces().flat_map(|face| face.neighbours()).chain(outlines) {
            let edge = border.edge();
            let (with, sides) = (border.is_forward(), [edge.left(), edge.right()]);
            prop_assert_eq!(edge.is_dangling(), edge.left() == edge.right());
            let [near, far] = if with { sides } else { [sides[1], sides[0]] };
            prop_assert_eq!((border.face(), border.neighbour()), (near, far));
            let labels: Vec<_> = border.labels().map(|l| (l.label, l.forward == with)).collect();
            let plain: Vec<_> = edge.labels().iter().map(|l| (l.label, l.forward)).collect();
            prop_assert!(!plain.is_empty());
            prop_assert_eq!(labels, plain);
            seen[2 * edge.id().0 as usize + usize::from(with)] += 1;
        }
        prop_assert!(seen.iter().all(|&times| times == 1), "{:?}", seen);
    }

    #[test]
    fn arranging_the_result_changes_nothing(lines in generators::lines()) {
        let first = arrange(&lines, true);
        let edges: Vec<_> =
            first.edges().map(|e| Drawn { points: e.points().collect(), closed: false }).collect();
        let second = arrange(&edges, true);
        // Labels differ, so edges may be joined in the one and not in the other.
        let points = |a: &Arrangement<u32>| {
            let mut list: Vec<_> = a
                .edges()
                .flat_map(|e| {
                    let points: Vec<_> = e.points().collect();
                    points.windows(2).map(|w| format!("{:?}", if w[0].x < w[1].x
                        || (w[0].x == w[1].x && w[0].y < w[1].y) { [w[0], w[1]] } else { [w[1], w[0]] }))
                        .collect::<Vec<_>>()
                })
                .collect();
            list.sort();
            list
        };
        prop_assert_eq!(points(&first), points(&second));
        prop_assert_eq!(first.face_count(), second.face_count());
    }

    #[test]
    fn order_direction_and_copies_do_not_matter(
        lines in generators::lines(),
        shuffle in any::<u64>(),
    ) {
        let mut other = lines.clone();
        let mut random = shuffle | 1;
        for i in (1..other.len()).rev() {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            other.swap(i, (random >> 33) as usize % (i + 1));
        }
        prop_assert_eq!(unlabelled(&lines), unlabelled(&other), "shuffled");
        for line in &mut other {
            line.points.reverse();
            if line.closed && !line.points.is_empty() {
                let half = line.points.len() / 2;
                line.points.rotate_left(half);
            }
        }
        prop_assert_eq!(unlabelled(&lines), unlabelled(&other), "reversed");
        other.extend(lines.clone());
        prop_assert_eq!(unlabelled(&lines), unlabelled(&other), "doubled");
        let a = arrange(&lines, true);
        let b = arrange(&lines, true);
        prop_assert_eq!(all(&a), all(&b), "again");
    }

    #[test]
    fn images_stay_within_a_step_of_their_chains(lines in generators::lines()) {
        let arrangement = arrange(&lines, true);
        for (line, label) in lines.iter().zip(0u32..) {
            let image: Vec<_> = arrangement
                .edges()
                .filter(|e| e.labels().iter().any(|l| l.label == label))
                .flat_map(|e| {
                    let points: Vec<_> = e.points().collect();
                    points.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>()
                })
                .collect();
            let segments = segments(line);
            if image.is_empty() || segments.len() * image.len() > 4000 {
                continue;
            }
            let ends: Vec<_> = image.iter().flat_map(|s| [s.0, s.1]).collect();
            // 1 + the rounding of coordinates to f64.
            prop_assert!(distance(&ends, &segments) < 1.001, "image from chain");
            let points: Vec<_> = segments.iter().flat_map(|s| [s.0, s.0.midpoint(s.1)]).collect();
            prop_assert!(distance(&points, &image) < 1.001, "chain from image");
        }
    }

    #[test]
    fn places_agree_with_polygons(
        lines in generators::lines(),
        places in prop::collection::vec((-12.0..12.0, -12.0..12.0), 10),
    ) {
        let arrangement = arrange(&lines, false);
        let polygons: Vec<_> = arrangement.faces().map(|f| f.polygon()).collect();
        for (x, y) in places {
            let p = Point2::new(x, y);
            let found = arrangement.locate(p);
            let plain: Vec<_> =
                polygons.iter().enumerate().filter(|(_, g)| g.contains(p)).map(|(i, _)| i).collect();
            match found {
                Location::Face(id) => prop_assert_eq!(plain, vec![id.index()]),
                Location::Unbounded => prop_assert!(plain.is_empty()),
                _ => {}
            }
        }
    }

    #[test]
    fn spans_cover_the_path_and_lie_in_their_faces(
        lines in generators::lines(),
        path in prop::collection::vec((-6.0..6.0, -6.0..6.0), 2..6),
        follow in any::<bool>(),
    ) {
        let arrangement = arrange(&lines, false);
        // Some paths run along what was arranged.
        let mut path: Vec<_> = path.into_iter().map(|(x, y)| Point2::new(x, y)).collect();
        if follow {
            path.extend(lines.iter().flat_map(|line| line.points.iter().take(6)));
        }
        let mut spans = Vec::new();
        arrangement.cut(&path, &mut spans);
        prop_assert_eq!(spans.first().unwrap().from, 0.0);
        prop_assert_eq!(spans.last().unwrap().to, (path.len() - 1) as f64);
        for pair in spans.windows(2) {
            prop_assert_eq!(pair[0].to, pair[1].from);
            prop_assert!(pair[0].label != pair[1].label && pair[0].from < pair[0].to);
        }
        let length = |path: &[Point2]| path.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let mut part = Vec::new();
        let parts: f64 = spans
            .iter()
            .map(|span| {
                part.clear();
                slice_path(&path, span.from, span.to, &mut part);
                length(&part)
            })
            .sum();
        prop_assert!((parts - length(&path)).abs() <= 1e-12 * length(&path), "length");
        for span in &spans {
            // In the middle of a straight part of the span.
            let end = span.to.min(span.from.floor() + 1.0);
            let (a, b) = (point_at(&path, span.from), point_at(&path, end));
            if a.distance(b) < 1e-6 {
                continue;
            }
            let p = a.midpoint(b);
            match arrangement.locate(p) {
                Location::Face(id) if span.label != Some(id) => {
                    prop_assert!(touches(&arrangement, p), "{:?} at {} is in {:?}", span, p, id);
                }
                Location::Unbounded if span.label.is_some() => {
                    prop_assert!(touches(&arrangement, p), "{:?} at {} is outside", span, p);
                }
                _ => {}
            }
        }
    }
}

/// Whether an edge comes within a thousandth of a step.
fn touches(arrangement: &Arrangement<u32>, p: Point2) -> bool {
    arrangement.edges().any(|e| {
        let points: Vec<_> = e.points().collect();
        points.windows(2).any(|w| {
            let (d, f) = (w[1] - w[0], p - w[0]);
            let t = (f.dot(d) / d.length_squared()).clamp(0.0, 1.0);
            (w[0] + d * t).distance(p) < 2e-3 * STEP
        })
    })
}
