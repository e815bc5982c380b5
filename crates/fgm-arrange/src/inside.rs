use crate::lattice::Lattice;
use crate::predicate::orient_any;
use fgm_core::{Bounds2, Point2};

/// Shares of the height at which level lines are drawn; the first that gives a good chord is taken.
const LEVELS: [f64; 7] = [0.5, 0.31, 0.69, 0.19, 0.81, 0.07, 0.93];

/// A point strictly inside the region of these rings, in mm; the rings are in lattice steps.
pub(crate) fn point(rings: &[Vec<Point2>], lattice: &Lattice) -> Point2 {
    let bounds = Bounds2::of(rings.first().into_iter().flatten().copied());
    let good = breadth(rings);
    let mut crossings = Vec::new();
    let mut best: Option<(f64, Point2)> = None;
    // Level lines along x and along y in turn.
    for (share, turned) in LEVELS.into_iter().flat_map(|share| [(share, false), (share, true)]) {
        let candidate = chord(rings, turned, share, &bounds, &mut crossings);
        let Some((width, middle)) = candidate else { continue };
        if best.is_none_or(|(w, _)| width > w) && holds(rings, lattice, middle) {
            best = Some((width, middle));
            if width >= good {
                break;
            }
        }
    }
    let found = best.map(|(_, p)| p).or_else(|| thin(rings, lattice, &mut crossings));
    lattice.unscaled(found.unwrap_or(bounds.center()))
}

/// How broad the region is on the whole: its area by half its border's length (in x and in y), so
/// for a band its breadth or a little less, for a disc or a square about half of it.
fn breadth(rings: &[Vec<Point2>]) -> f64 {
    let (mut area, mut length) = (0.0, 0.0);
    for ring in rings {
        let origin = ring.first().copied().unwrap_or_default();
        for (a, b) in edges(ring) {
            area += (a - origin).perp_dot(b - origin);
            let d = (b - a).abs();
            length += d.x + d.y;
        }
    }
    area / length
}

fn turn(p: Point2, turned: bool) -> Point2 {
    if turned { Point2::new(p.y, p.x) } else { p }
}

fn edges(ring: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> + '_ {
    ring.iter().copied().zip(ring.iter().copied().cycle().skip(1))
}

/// The widest chord of a level line halfway between two vertices near a share of the height, and
/// its middle.
fn chord(
    rings: &[Vec<Point2>],
    turned: bool,
    share: f64,
    bounds: &Bounds2,
    crossings: &mut Vec<f64>,
) -> Option<(f64, Point2)> {
    let (min, max) = (turn(bounds.min, turned), turn(bounds.max, turned));
    let wanted = min.y + share * (max.y - min.y);
    let (mut below, mut above) = (min.y, max.y);
    for p in rings.iter().flatten() {
        let y = turn(*p, turned).y;
        if y <= wanted {
            below = below.max(y);
        } else {
            above = above.min(y);
        }
    }
    widest(rings, turned, 0.5 * (below + above), crossings)
}

/// The widest chord of the level line at `y`.
fn widest(
    rings: &[Vec<Point2>],
    turned: bool,
    y: f64,
    crossings: &mut Vec<f64>,
) -> Option<(f64, Point2)> {
    crossings.clear();
    for (a, b) in rings.iter().flat_map(|ring| edges(ring)) {
        let (a, b) = (turn(a, turned), turn(b, turned));
        if (a.y > y) != (b.y > y) {
            crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
        }
    }
    crossings.sort_unstable_by(f64::total_cmp);
    crossings
        .chunks_exact(2)
        .map(|chord| (chord[1] - chord[0], 0.5 * (chord[0] + chord[1])))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(width, x)| (width, turn(Point2::new(x, y), turned)))
}

/// For slivers: a level line between every two heights of vertices.
fn thin(rings: &[Vec<Point2>], lattice: &Lattice, crossings: &mut Vec<f64>) -> Option<Point2> {
    let mut heights = Vec::new();
    for turned in [false, true] {
        heights.clear();
        heights.extend(rings.iter().flatten().map(|p| turn(*p, turned).y));
        heights.sort_unstable_by(f64::total_cmp);
        heights.dedup();
        for pair in heights.windows(2).take(64) {
            for share in [0.5, 0.25, 0.75, 0.05, 0.95] {
                let y = pair[0] + share * (pair[1] - pair[0]);
                let chord = widest(rings, turned, y, crossings);
                if let Some((_, p)) = chord.filter(|(_, p)| holds(rings, lattice, *p)) {
                    return Some(p);
                }
            }
        }
    }
    None
}

/// Whether the point that `p` becomes in mm and back is strictly inside, exactly.
fn holds(rings: &[Vec<Point2>], lattice: &Lattice, p: Point2) -> bool {
    let p = lattice.scaled(lattice.unscaled(p));
    let mut inside = false;
    for (a, b) in rings.iter().flat_map(|ring| edges(ring)) {
        if a.y.max(b.y) < p.y || a.y.min(b.y) > p.y || a.x.max(b.x) < p.x {
            continue;
        }
        let side = orient_any(a, b, p);
        if side == 0.0 && p.x >= a.x.min(b.x) {
            return false;
        }
        if (a.y > p.y) != (b.y > p.y) && (side > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    inside
}
