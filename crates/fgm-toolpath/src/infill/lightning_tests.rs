use super::*;
use crate::ClipperInset;
use fgm_core::{Ring, Role};
use proptest::prelude::*;

/// The depth below a roof, mm.
struct Above<F>(F);

impl<F: Fn(Point2) -> f64 + Sync> PlanarField for Above<F> {
    fn eval(&self, p: Point2) -> f64 {
        (self.0)(p)
    }
}

fn block(width: f64, depth: f64) -> Vec<Polygon> {
    let (x, y) = (0.5 * width, 0.5 * depth);
    let points = [(-x, -y), (x, -y), (x, y), (-x, y)];
    vec![Polygon {
        outer: Ring::new(points.map(|(x, y)| Point2::new(x, y)).into()),
        holes: Vec::new(),
    }]
}

fn options(density: f64) -> InfillOptions {
    InfillOptions { density, angle: 0.6, role: Role::Infill, ..InfillOptions::new(0.4, 0.2) }
}

fn lines(region: &[Polygon], depth: impl Fn(Point2) -> f64 + Sync, reach: f64) -> Vec<Path> {
    infill_lightning(region, &Above(depth), reach, &options(0.15), &ClipperInset::default())
}

fn length(paths: &[Path]) -> f64 {
    paths.iter().map(Path::length).sum()
}

/// How far a place is from the nearest line, or from the border.
fn distance(p: Point2, paths: &[Path], region: &[Polygon]) -> f64 {
    let to = |a: Point2, b: Point2| {
        let along = b - a;
        let t = ((p - a).dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        p.distance(a + along * t)
    };
    let of_lines = paths.iter().flat_map(|path| path.points.windows(2).map(|w| (w[0], w[1])));
    let rings = region.iter().flat_map(Polygon::rings);
    let walls = rings.flat_map(Ring::edges).map(|(a, b)| to(a, b) - 0.18);
    of_lines.map(|(a, b)| to(a, b)).chain(walls).fold(f64::INFINITY, f64::min)
}

#[test]
fn all_of_the_lattice_is_there_below_a_roof_and_less_and_less_of_it_deeper_down() {
    let region = block(80.0, 60.0);
    let roof = length(&lines(&region, |_| 0.0, 100.0)) * options(0.15).spacing();
    let share = roof / (80.0 * 60.0);
    assert!((0.14..0.16).contains(&share), "{share}");
    let mut last = roof;
    for depth in [1.0, 3.0, 6.0, 12.0, 24.0] {
        let now = length(&lines(&region, |_| depth, 100.0)) * options(0.15).spacing();
        assert!(now < 0.85 * last, "{depth}: {now} after {last}");
        last = now;
    }
    assert!(last < 0.08 * roof, "{last} of {roof}");
    assert!(lines(&region, |_| 150.0, 200.0).is_empty());
    // Below the reach nothing changes.
    assert_eq!(lines(&region, |_| 60.0, 5.0), lines(&region, |_| 5.0, 100.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    /// A roof with two steps: what is printed stands on what is printed one layer further down.
    #[test]
    fn every_line_stands_on_the_layer_below(
        width in 10.0..60.0f64,
        depth in 10.0..60.0f64,
        step in -20.0..20.0f64,
        rise in 0.0..8.0f64,
        below in 0.0..20.0f64,
        reach in 3.0..40.0f64,
    ) {
        const LAYER: f64 = 0.2;
        let region = block(width, depth);
        let roof = |below: f64| move |p: Point2| below + if p.x > step { rise } else { 0.0 };
        let here = lines(&region, roof(below), reach);
        let under = lines(&region, roof(below + LAYER), reach);
        for path in &here {
            let (a, b) = (path.points[0], path.points[1]);
            for i in 0..=20 {
                let p = a.lerp(b, f64::from(i) / 20.0);
                // A line that is just long enough to be printed begins in the air.
                let off = distance(p, &under, &region);
                let first = path.length() < 2.0 * (LAYER + SHORTEST * 0.4);
                prop_assert!(off < LAYER + 0.01 || first, "{p} is {off} mm from what is below");
            }
        }
    }
}

#[test]
fn only_what_has_a_roof_nearby_is_held_up() {
    let region = block(80.0, 80.0);
    let corner = |p: Point2| if p.min_element() > 20.0 { 0.0 } else { 100.0 };
    let here = lines(&region, corner, 100.0);
    // A sixteenth of the area, and the trunks that lead from there to the walls.
    let all = length(&lines(&region, |_| 0.0, 100.0));
    assert!(length(&here) < 0.2 * all, "{} of {all}", length(&here));
    for i in 0..100 {
        let p = Point2::new(21.0 + f64::from(i % 10) * 2.0, 21.0 + f64::from(i / 10) * 2.0);
        let off = distance(p, &here, &region);
        assert!(off <= 0.5 * 1.25 * options(0.15).pitch() + 1e-6, "{p}: {off}");
    }
}
