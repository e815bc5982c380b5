//! The one module that knows `clipper2-rust`.
//!
//! Its inputs are simplified, finite and have area: it makes a blob of a ring of two points.

use clipper2_rust::{
    Clipper64, ClipperOffset, EndType, FillRule, JoinType, Path64, Paths64, Point64,
};
use fgm_core::{Bounds2, Point2, Polygon, Ring};

use super::simplify;

pub(crate) use clipper2_rust::ClipType as Operation;

/// Clipper's units to the millimetre: 1e-5 mm keeps its cross products exact at print sizes.
const UNITS: f64 = 1e5;
/// A corner is cut where its mitre would be longer than this times the distance.
const MITRE_LIMIT: f64 = 2.0;
/// How far two borders may lie apart and still be taken as one in a boolean, mm.
const MERGE: f64 = 1e-4;

/// The region grown by `delta` mm; shrunk where negative.
pub(crate) fn offset(region: &[Polygon], delta: f64) -> Vec<Polygon> {
    let turn = Turn::of(region, &[]);
    let paths = turn.paths(region);
    if paths.is_empty() {
        return Vec::new();
    }
    let mut offsetter = ClipperOffset::new(MITRE_LIMIT, 0.0, false, false);
    offsetter.add_paths(&paths, JoinType::Miter, EndType::Polygon);
    let mut out = Paths64::new();
    offsetter.execute(delta * UNITS, &mut out);
    turn.polygons(&out)
}

/// A boolean of two regions by the non-zero rule.
pub(crate) fn boolean(a: &[Polygon], b: &[Polygon], operation: Operation) -> Vec<Polygon> {
    let (a, b) = (simplify::region(a, MERGE), simplify::region(b, MERGE));
    let turn = Turn::of(&a, &b);
    let mut clipper = Clipper64::new();
    clipper.add_subject(&turn.paths(&a));
    clipper.add_clip(&turn.paths(&b));
    let mut out = Paths64::new();
    if !clipper.execute(operation, FillRule::NonZero, &mut out, None) {
        return Vec::new();
    }
    turn.polygons(&out)
}

/// Clipper sweeps along y and works through every edge that a sweep line meets: a region wider
/// than high is turned by a quarter, which makes long bands several times cheaper.
#[derive(Clone, Copy)]
struct Turn(bool);

impl Turn {
    fn of(a: &[Polygon], b: &[Polygon]) -> Self {
        let all = a.iter().chain(b);
        let bounds = all.fold(Bounds2::EMPTY, |bounds, p| bounds.union(&p.bounds()));
        Self(bounds.size().x > bounds.size().y)
    }

    fn paths(self, region: &[Polygon]) -> Paths64 {
        region.iter().flat_map(Polygon::rings).map(|r| self.path(r)).collect()
    }

    fn path(self, ring: &Ring) -> Path64 {
        let units = |v: f64| (v * UNITS).round() as i64;
        let point = |p: &Point2| {
            let p = if self.0 { -p.perp() } else { *p };
            Point64::new(units(p.x), units(p.y))
        };
        ring.points.iter().map(point).collect()
    }

    fn polygons(self, paths: &Paths64) -> Vec<Polygon> {
        let point = |p: &Point64| {
            let p = Point2::new(p.x as f64, p.y as f64) / UNITS;
            if self.0 { p.perp() } else { p }
        };
        nest(paths.iter().map(|path| Ring::new(path.iter().map(point).collect())))
    }
}

/// Rings sorted into outer ones and the holes of each.
pub(crate) fn nest(rings: impl Iterator<Item = Ring>) -> Vec<Polygon> {
    let mut out: Vec<Polygon> = Vec::new();
    let mut boxes: Vec<Bounds2> = Vec::new();
    let mut areas: Vec<f64> = Vec::new();
    let mut holes = Vec::new();
    for ring in rings {
        let area = ring.area();
        if ring.points.len() < 3 || area.abs() < 1e-6 {
            continue;
        }
        if area > 0.0 {
            boxes.push(ring.bounds());
            areas.push(area);
            out.push(Polygon::simple(ring));
        } else {
            holes.push(ring);
        }
    }
    for hole in holes {
        let bounds = hole.bounds();
        let around = |i: &usize| {
            let b = &boxes[*i];
            b.contains(bounds.min) && b.contains(bounds.max)
        };
        let candidates: Vec<usize> = (0..out.len()).filter(around).collect();
        // The midpoint of an edge: corners of a hole may touch the border around it.
        let inner = (hole.points[0] + hole.points[1]) * 0.5;
        let owner = match candidates[..] {
            [only] => Some(only),
            _ => candidates
                .into_iter()
                .filter(|&i| out[i].outer.contains(inner))
                .min_by(|&a, &b| areas[a].total_cmp(&areas[b])),
        };
        if let Some(owner) = owner {
            out[owner].holes.push(hole);
        }
    }
    out
}
