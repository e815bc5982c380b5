use fgm_core::{Point2, Polygon, Ring, point_at};
use proptest::prelude::*;

use super::*;

fn ring(points: &[(f64, f64)]) -> Ring {
    Ring::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect())
}

/// A star with a triangular hole.
fn star(spikes: u32, deep: f64) -> Polygon {
    let corner = |i: u32| {
        let radius = if i.is_multiple_of(2) { 10.0 } else { 10.0 * deep };
        Point2::from_angle(f64::from(i) * std::f64::consts::PI / f64::from(spikes)) * radius
    };
    let outer = Ring::new((0..2 * spikes).map(corner).collect());
    Polygon { outer, holes: vec![ring(&[(-1.0, -1.0), (0.0, 2.0), (1.0, -1.0)])] }
}

/// From the nearest edge, mm.
fn distance(region: &Polygon, p: Point2) -> f64 {
    let to = |(a, b): (Point2, Point2)| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, t))
    };
    region.rings().flat_map(Ring::edges).map(to).fold(f64::INFINITY, f64::min)
}

proptest! {
    #[test]
    fn inside_as_the_polygon_says(
        spikes in 2..40u32,
        deep in 0.2..1.0f64,
        at in prop::collection::vec((-13.0..13.0f64, -13.0..13.0f64), 1..50),
    ) {
        let region = star(spikes, deep);
        let support = Support::new(std::slice::from_ref(&region));
        for (x, y) in at {
            let p = Point2::new(x, y);
            prop_assert_eq!(support.contains(p), region.contains(p), "{}", p);
        }
    }

    #[test]
    fn stretches_are_as_far_from_the_border_as_they_say(
        spikes in 2..40u32,
        deep in 0.2..1.0f64,
        line in prop::collection::vec((-13.0..13.0f64, -13.0..13.0f64), 2..8),
        share in 0.0..0.5f64,
    ) {
        let region = star(spikes, deep);
        let support = Support::new(std::slice::from_ref(&region));
        let line: Vec<Point2> = line.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        let mut stretches = Vec::new();
        support.stretches(&line, 0.4, share, &mut Scratch::default(), &mut stretches);
        let band = (0.5 - share) * 0.4;
        prop_assert_eq!(stretches[0].from, 0.0);
        prop_assert_eq!(stretches[stretches.len() - 1].to, (line.len() - 1) as f64);
        for (i, stretch) in stretches.iter().enumerate() {
            if i > 0 {
                prop_assert_eq!(stretches[i - 1].to, stretch.from);
                prop_assert_ne!(stretches[i - 1].hold, stretch.hold);
            }
            for k in 1..20 {
                let at = stretch.from + (stretch.to - stretch.from) * f64::from(k) / 20.0;
                let p = point_at(&line, at);
                let (inside, far) = (region.contains(p), distance(&region, p));
                if far < 1e-6 || (far - band).abs() < 1e-6 {
                    continue;
                }
                let want = match (inside, far < band) {
                    (true, false) => Hold::Held,
                    (true, true) => Hold::Slight,
                    (false, true) => Hold::Half,
                    (false, false) => Hold::Air,
                };
                prop_assert_eq!(stretch.hold, want, "{} {} {}", p, far, band);
            }
        }
    }
}

#[test]
fn far_away_and_empty() {
    let support = Support::new(&[]);
    assert!(!support.contains(Point2::ZERO));
    let square = [Polygon::simple(ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]))];
    let support = Support::new(&square);
    for p in [(-1e9, 0.5), (1e9, 0.5), (0.5, 1e9), (0.5, -1e9), (f64::NAN, 0.5)] {
        assert!(!support.contains(Point2::new(p.0, p.1)), "{p:?}");
    }
    let mut stretches = Vec::new();
    let line = [Point2::new(-1e6, 0.5), Point2::new(1e6, 0.5)];
    support.stretches(&line, 0.4, 0.25, &mut Scratch::default(), &mut stretches);
    let far: Vec<Hold> = stretches.iter().map(|s| s.hold).collect();
    assert_eq!(
        far,
        [Hold::Air, Hold::Half, Hold::Slight, Hold::Held, Hold::Slight, Hold::Half, Hold::Air]
    );
    support.stretches(&line[..1], 0.4, 0.25, &mut Scratch::default(), &mut stretches);
    assert!(stretches.is_empty());
}
