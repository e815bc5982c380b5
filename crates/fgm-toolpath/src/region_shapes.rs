//! Shapes and measures for tests.

use fgm_core::{Bounds2, Point2, Polygon, Ring, bead};
use std::f64::consts::TAU;

use crate::Path;

pub(crate) const WIDTH: f64 = 0.4;
pub(crate) const HEIGHT: f64 = 0.2;

pub(crate) fn ring(points: &[(f64, f64)]) -> Ring {
    Ring::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect())
}

pub(crate) fn simple(points: &[(f64, f64)]) -> Polygon {
    Polygon::simple(ring(points))
}

pub(crate) fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
    simple(&[(x, y), (x + w, y), (x + w, y + h), (x, y + h)])
}

/// A closed curve by its radius at every angle.
pub(crate) fn radial(center: Point2, n: usize, radius: impl Fn(f64) -> f64) -> Ring {
    let at = |i| TAU * i as f64 / n as f64;
    Ring::new((0..n).map(|i| center + Point2::from_angle(at(i)) * radius(at(i))).collect())
}

/// A disc of radius `outer` with a bore of radius `inner`.
pub(crate) fn tube(outer: f64, inner: f64) -> Polygon {
    let mut hole = radial(Point2::ZERO, 180, |_| inner);
    hole.reverse();
    Polygon { outer: radial(Point2::ZERO, 240, |_| outer), holes: vec![hole] }
}

pub(crate) fn star(points: usize, outer: f64, inner: f64) -> Polygon {
    let n = 2 * points;
    let at = |i: usize| {
        let r = if i.is_multiple_of(2) { outer } else { inner };
        Point2::from_angle(TAU * i as f64 / n as f64) * r
    };
    Polygon::simple(Ring::new((0..n).map(at).collect()))
}

/// A band along x between two curves.
pub(crate) fn band(length: f64, low: impl Fn(f64) -> f64, high: impl Fn(f64) -> f64) -> Polygon {
    let n = (length / 0.8).ceil() as usize;
    let x = |i: usize| length * i as f64 / n as f64;
    let bottom = (0..=n).map(|i| Point2::new(x(i), low(x(i))));
    let top = (0..=n).rev().map(|i| Point2::new(x(i), high(x(i))));
    Polygon::simple(Ring::new(bottom.chain(top).collect()))
}

pub(crate) fn l_shape() -> Polygon {
    simple(&[(0.0, 0.0), (30.0, 0.0), (30.0, 12.0), (11.0, 12.0), (11.0, 25.0), (0.0, 25.0)])
}

/// Extruded volume, mm³.
pub(crate) fn volume(paths: &[Path]) -> f64 {
    paths.iter().map(|p| p.length() * bead::area(p.width, HEIGHT)).sum()
}

pub(crate) fn segments(path: &Path) -> impl Iterator<Item = (Point2, Point2)> + '_ {
    let closing = path.closed.then(|| (path.points[path.points.len() - 1], path.points[0]));
    path.points.windows(2).map(|w| (w[0], w[1])).chain(closing)
}

/// What beads do to a region, by points on a square grid.
#[derive(Debug)]
pub(crate) struct Cover {
    /// Share of the region under beads.
    pub(crate) covered: f64,
    /// Share of the region under beads' cores (the width that carries the volume, without the
    /// ends) twice or more.
    pub(crate) doubled: f64,
    /// Area outside the region under beads' cores, by the region's.
    pub(crate) outside: f64,
}

pub(crate) fn cover(region: &[Polygon], paths: &[Path], cell: f64) -> Cover {
    let bounds = region.iter().fold(Bounds2::EMPTY, |b, p| b.union(&p.bounds())).grown(1.0);
    let size = (bounds.size() / cell).ceil();
    let (columns, rows) = (size.x as usize, size.y as usize);
    let (mut under, mut cores) = (vec![false; columns * rows], vec![0u8; columns * rows]);
    let mut beyond = under.clone();
    let round = WIDTH - bead::spacing(WIDTH, HEIGHT);
    for path in paths {
        let mut own = std::collections::BTreeSet::new();
        for (a, b) in segments(path) {
            let low = ((a.min(b) - path.width - bounds.min) / cell).floor();
            let high = ((a.max(b) + path.width - bounds.min) / cell).ceil();
            for row in low.y as usize..=(high.y as usize).min(rows - 1) {
                for column in low.x as usize..=(high.x as usize).min(columns - 1) {
                    let p = bounds.min + (Point2::new(column as f64, row as f64) + 0.5) * cell;
                    let at = (p - a).dot(b - a) / (b - a).length_squared();
                    let distance = p.distance(a + (b - a) * at.clamp(0.0, 1.0));
                    let index = row * columns + column;
                    under[index] |= distance <= 0.5 * path.width;
                    let core = 0.5 * (path.width - round);
                    beyond[index] |= distance < core - 0.5 * cell;
                    if distance < core - cell && (0.0..=1.0).contains(&at) {
                        own.insert(index);
                    }
                }
            }
        }
        own.into_iter().for_each(|i| cores[i] = cores[i].saturating_add(1));
    }
    let (mut inside, mut covered, mut doubled, mut outside) = (0.0, 0.0, 0.0, 0.0);
    for row in 0..rows {
        for column in 0..columns {
            let p = bounds.min + (Point2::new(column as f64, row as f64) + 0.5) * cell;
            let index = row * columns + column;
            if region.iter().any(|r| r.contains(p)) {
                inside += 1.0;
                covered += f64::from(u8::from(under[index]));
                doubled += f64::from(u8::from(cores[index] > 1));
            } else {
                outside += f64::from(u8::from(beyond[index]));
            }
        }
    }
    Cover { covered: covered / inside, doubled: doubled / inside, outside: outside / inside }
}
