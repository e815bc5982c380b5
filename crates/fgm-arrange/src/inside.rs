use crate::lattice::Lattice;
use crate::predicate::orient_any;
use fgm_core::{Bounds2, Point2};

/// Shares of the height at which level lines are drawn; the first that gives a good chord is taken.
const LEVELS: [f64; 7] = [0.5, 0.31, 0.69, 0.19, 0.81, 0.07, 0.93];

/// A point strictly inside the region between these lines, in mm. The lines, in lattice steps, are
/// all that border the region, in any order and direction; those with the region on both sides come
/// twice. `area` is the region's, in square steps.
pub(crate) fn point(lines: &[&[Point2]], area: f64, lattice: &Lattice) -> Point2 {
    let bounds = Bounds2::of(lines.iter().flat_map(|line| line.iter().copied()));
    // In whole numbers, as the sum must not depend on the order of the lines.
    let mut length = 0u64;
    for (a, b) in edges(lines) {
        let d = (b - a).abs();
        length += (d.x + d.y) as u64;
    }
    // How broad the region is on the whole: for a band its breadth or a little less, for a disc or
    // a square about half of it.
    let good = 2.0 * area / length as f64;
    let mut crossings = Vec::new();
    let mut best: Option<(f64, Point2)> = None;
    // Level lines along x and along y in turn.
    for (share, turned) in LEVELS.into_iter().flat_map(|share| [(share, false), (share, true)]) {
        let (min, max) = (turn(bounds.min, turned), turn(bounds.max, turned));
        // Between two rows of the lattice, so that it meets no vertex.
        let level = (min.y + share * (max.y - min.y)).floor() + 0.5;
        let Some((width, middle)) = widest(lines, turned, level, &mut crossings) else { continue };
        if best.is_none_or(|(w, _)| width > w) && holds(lines, lattice, middle) {
            best = Some((width, middle));
            if width >= good {
                break;
            }
        }
    }
    let found = best.map(|(_, p)| p).or_else(|| thin(lines, lattice, &mut crossings));
    lattice.unscaled(found.unwrap_or(bounds.center()))
}

fn turn(p: Point2, turned: bool) -> Point2 {
    if turned { Point2::new(p.y, p.x) } else { p }
}

fn edges<'a>(lines: &'a [&[Point2]]) -> impl Iterator<Item = (Point2, Point2)> + 'a {
    lines.iter().flat_map(|line| line.windows(2)).map(|w| (w[0], w[1]))
}

/// The widest chord of the level line at `y`, and its middle.
fn widest(
    lines: &[&[Point2]],
    turned: bool,
    y: f64,
    crossings: &mut Vec<f64>,
) -> Option<(f64, Point2)> {
    crossings.clear();
    for line in lines {
        let mut above = turn(line[0], turned).y > y;
        for w in line.windows(2) {
            let before = std::mem::replace(&mut above, turn(w[1], turned).y > y);
            if before != above {
                // Upwards: rounding must not depend on the line's direction.
                let (a, b) = if above { (w[0], w[1]) } else { (w[1], w[0]) };
                let (a, b) = (turn(a, turned), turn(b, turned));
                crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
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
fn thin(lines: &[&[Point2]], lattice: &Lattice, crossings: &mut Vec<f64>) -> Option<Point2> {
    let mut heights = Vec::new();
    for turned in [false, true] {
        heights.clear();
        heights.extend(edges(lines).map(|(a, _)| turn(a, turned).y));
        heights.sort_unstable_by(f64::total_cmp);
        heights.dedup();
        for pair in heights.windows(2).take(64) {
            for share in [0.5, 0.25, 0.75, 0.05, 0.95] {
                let y = pair[0] + share * (pair[1] - pair[0]);
                let chord = widest(lines, turned, y, crossings);
                if let Some((_, p)) = chord.filter(|(_, p)| holds(lines, lattice, *p)) {
                    return Some(p);
                }
            }
        }
    }
    None
}

/// Whether the point that `p` becomes in mm and back is strictly inside, exactly.
fn holds(lines: &[&[Point2]], lattice: &Lattice, p: Point2) -> bool {
    let p = lattice.scaled(lattice.unscaled(p));
    let mut inside = false;
    for (a, b) in edges(lines) {
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
