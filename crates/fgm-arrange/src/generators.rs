//! Lines that are hard to arrange, as proptest strategies, and a layer as slicing makes them.
//!
//! With the feature `generators`. All strategies are for a lattice of 1e-6 mm; lines of one case
//! are of one kind or of a mix of kinds.

use crate::Chain;
use fgm_core::Point2;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The lattice step that the near misses are made for, mm.
pub const STEP: f64 = 1e-6;

/// A line of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The points, mm.
    pub points: Vec<Point2>,
    /// Whether the last joins the first.
    pub closed: bool,
}

impl Drawn {
    fn new(points: Vec<Point2>, closed: bool) -> Self {
        Self { points, closed }
    }
}

/// The lines as chains, labelled by index.
pub fn chains(lines: &[Drawn]) -> Vec<Chain<'_, u32>> {
    let chain = |(line, label): (_, u32)| {
        let Drawn { points, closed }: &Drawn = line;
        Chain { points, closed: *closed, label }
    };
    lines.iter().zip(0..).map(chain).collect()
}

fn steps(x: i64, y: i64) -> Point2 {
    Point2::new(x as f64 * STEP, y as f64 * STEP)
}

/// Lines through few lattice points, `reach` steps about the origin: all coincidences happen.
pub fn lattice_lines(reach: i64) -> impl Strategy<Value = Vec<Drawn>> {
    let point = (-reach..=reach, -reach..=reach).prop_map(|(x, y)| steps(x, y));
    let line = (prop::collection::vec(point, 1..8), any::<bool>());
    prop::collection::vec(line.prop_map(|(p, closed)| Drawn::new(p, closed)), 1..8)
}

/// Straight lines between random points of a square of 20 mm.
pub fn random_lines() -> impl Strategy<Value = Vec<Drawn>> {
    let point = || (-10.0..10.0, -10.0..10.0).prop_map(|(x, y)| Point2::new(x, y));
    let line = (point(), point()).prop_map(|(a, b)| Drawn::new(vec![a, b], false));
    prop::collection::vec(line, 1..40)
}

/// Many straight lines in a small place: more crossings than lines, and many of them in one pixel
/// or near one.
pub fn thickets() -> impl Strategy<Value = Vec<Drawn>> {
    let reach = prop::sample::select(vec![20i64, 300, 10_000]);
    let end = || (-1000..=1000i64, -1000..=1000i64);
    (prop::collection::vec((end(), end()), 12..50), reach).prop_map(|(lines, reach)| {
        let place = |(x, y): (i64, i64)| steps(x * reach / 1000, y * reach / 1000);
        lines.into_iter().map(|(a, b)| Drawn::new(vec![place(a), place(b)], false)).collect()
    })
}

/// Points a step or two beside one long line, joined in any order.
pub fn almost_collinear() -> impl Strategy<Value = Vec<Drawn>> {
    let point = (-1000..1000i64, -2..=2i64, prop::sample::select(vec![1i64, 1_000, 5_000_000]));
    let points = prop::collection::vec(point, 2..10);
    let slope = (-3..=3i64, 1..5i64);
    (prop::collection::vec((points, any::<bool>()), 1..6), slope).prop_map(|(lines, (dy, dx))| {
        let place = |(t, off, far): (i64, i64, i64)| steps(t * dx * far, t * dy * far + off);
        let line = |(points, closed): (Vec<_>, bool)| {
            Drawn::new(points.into_iter().map(place).collect(), closed)
        };
        lines.into_iter().map(line).collect()
    })
}

/// Copies of one line, shifted by a few steps or fractions of a step.
pub fn almost_coincident() -> impl Strategy<Value = Vec<Drawn>> {
    let point = (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Point2::new(x, y));
    let shift = (-6..=6i64, -6..=6i64).prop_map(|(x, y)| steps(x, y) * 0.5);
    let line = prop::collection::vec(point, 2..8);
    (line, any::<bool>(), prop::collection::vec((shift, any::<bool>()), 2..6)).prop_map(
        |(line, closed, shifts)| {
            let copy = |(shift, back): (Point2, bool)| {
                let mut points: Vec<_> = line.iter().map(|p| *p + shift).collect();
                if back {
                    points.reverse();
                }
                Drawn::new(points, closed)
            };
            shifts.into_iter().map(copy).collect()
        },
    )
}

/// Many rays that meet in one point, or miss it by a step, cut by rings.
pub fn fans() -> impl Strategy<Value = Vec<Drawn>> {
    (3..40usize, -2..=2i64, 0.01..20.0, 0.0..TAU).prop_map(|(rays, miss, radius, turn)| {
        let at = |i: usize, r: f64| Point2::from_angle(turn + TAU * i as f64 / rays as f64) * r;
        let ray =
            |i| Drawn::new(vec![at(i, radius), steps(miss, 0), at(i + rays / 2, radius)], false);
        let ring = |r: f64| Drawn::new((0..rays).map(|i| at(i, r)).collect(), true);
        (0..rays).map(ray).chain([ring(radius), ring(radius * 0.5)]).collect()
    })
}

/// Teeth that touch, miss by a step or pierce a back, some of them doubled.
pub fn combs() -> impl Strategy<Value = Vec<Drawn>> {
    let tooth = (0..400i64, -3..=3i64, 1..300i64);
    let back = prop::sample::select(vec![0i64, 1, 7, 30]);
    (prop::collection::vec(tooth, 1..40), back).prop_map(|(teeth, slope)| {
        let far = 10_000;
        let back = vec![steps(0, 0), steps(400 * far, 400 * slope)];
        let mut line = vec![];
        let mut lines = vec![Drawn::new(back, false)];
        for (x, miss, length) in teeth {
            let foot = steps(x * far, x * slope + miss);
            line.extend([foot, foot + Point2::new(0.0, length as f64 * 0.01)]);
            lines.push(Drawn::new(vec![foot, steps(x * far, length * far)], false));
        }
        lines.push(Drawn::new(line, true));
        lines
    })
}

/// A spiral, cut by a star.
pub fn spirals() -> impl Strategy<Value = Vec<Drawn>> {
    (10..300usize, 0.001..0.5, 0.05..0.6, 1..6usize).prop_map(|(n, pitch, turn, rays)| {
        let at = |i: usize| -> Point2 {
            Point2::from_angle(turn * i as f64) * (pitch * turn * i as f64)
        };
        let spiral: Vec<_> = (0..n).map(at).collect();
        let reach = at(n).length();
        let ray = |i: usize| {
            let end = Point2::from_angle(TAU * i as f64 / rays as f64) * reach;
            Drawn::new(vec![-end, Point2::ZERO, end], false)
        };
        let rays: Vec<_> = (0..rays).map(ray).collect();
        std::iter::once(Drawn::new(spiral, false)).chain(rays).collect()
    })
}

/// Two families of parallel lines, some of them a step off, slanted by a few steps or not at all,
/// with their ends on the grid, short of it or beyond.
pub fn grids() -> impl Strategy<Value = Vec<Drawn>> {
    let line = (0..12i64, -1..=1i64, -3..=3i64, -1..=1i64, any::<bool>());
    let pitch = prop::sample::select(vec![2i64, 50, 1_000_000]);
    (prop::collection::vec(line, 2..40), pitch).prop_map(|(lines, pitch)| {
        let line = |(at, miss, slant, over, upright): (i64, i64, i64, i64, bool)| {
            let (at, end) = (at * pitch + miss, 12 * pitch + over);
            let (a, b) = ((-over, at), (end, at + slant));
            let turn = |(x, y)| if upright { steps(y, x) } else { steps(x, y) };
            Drawn::new(vec![turn(a), turn(b)], false)
        };
        lines.into_iter().map(line).collect()
    })
}

/// The same lines as many times larger.
#[must_use]
pub fn scaled(lines: &[Drawn], by: f64) -> Vec<Drawn> {
    let points = |line: &Drawn| line.points.iter().map(|p| *p * by).collect();
    lines.iter().map(|line| Drawn::new(points(line), line.closed)).collect()
}

/// Squares in squares, and beside each other, some of them touching.
pub fn nested() -> impl Strategy<Value = Vec<Drawn>> {
    let square = (0..12i64, 0..12i64, 1..12i64);
    prop::collection::vec(square, 1..14).prop_map(|squares| {
        let square = |(x, y, size): (i64, i64, i64)| {
            let at = |dx, dy| Point2::new((x + dx) as f64, (y + dy) as f64);
            Drawn::new(vec![at(0, 0), at(size, 0), at(size, size), at(0, size)], true)
        };
        squares.into_iter().map(square).collect()
    })
}

/// Any of the above, or two of them over each other.
pub fn lines() -> impl Strategy<Value = Vec<Drawn>> {
    let one = || {
        prop_oneof![
            lattice_lines(2),
            lattice_lines(6),
            lattice_lines(40),
            random_lines(),
            thickets(),
            almost_collinear(),
            almost_coincident(),
            fans(),
            combs(),
            spirals(),
            grids(),
            nested(),
        ]
    };
    prop_oneof![
        3 => one(),
        1 => (one(), one()).prop_map(|(mut a, b)| { a.extend(b); a }),
    ]
}

/// The outline of a fluted vase of about 135 x 135 mm and the isolines of a mixture that varies
/// over it, as marching squares gives them on a grid of `step` mm. The outline comes first.
///
/// Step 0.5 with 15 isolines makes about 17,000 segments.
pub fn layer(step: f64, isolines: usize) -> Vec<Drawn> {
    let outline = |p: Point2| p.length() - 62.0 - 4.0 * (12.0 * p.y.atan2(p.x)).cos();
    let mixture =
        |p: Point2| 0.5 + 0.5 * (0.05 * p.x + 0.075 * p.y).sin() * (0.075 * p.x - 0.05 * p.y).cos();
    let mut lines = isoline(&outline, 0.0, step);
    for i in 1..=isolines {
        lines.extend(isoline(&mixture, i as f64 / (isolines + 1) as f64, step));
    }
    lines
}

/// An edge of the grid: its least corner, and whether it is upright.
type Joint = (i64, i64, bool);

/// Plain marching squares over a square of 140 mm.
fn isoline(f: &dyn Fn(Point2) -> f64, level: f64, step: f64) -> Vec<Drawn> {
    let n = (140.0 / step).ceil() as i64;
    let corner = |i: i64, j: i64| Point2::new(i as f64 * step - 70.0, j as f64 * step - 70.0);
    let values: Vec<Vec<f64>> =
        (0..=n).map(|j| (0..=n).map(|i| f(corner(i, j)) - level).collect()).collect();
    let value = |i: i64, j: i64| values[j as usize][i as usize];
    // Each crossed edge of the grid: its neighbours along the line.
    let mut joints: BTreeMap<Joint, Vec<Joint>> = BTreeMap::new();
    for j in 0..n {
        for i in 0..n {
            let sides = [
                ((i, j, false), value(i, j), value(i + 1, j)),
                ((i + 1, j, true), value(i + 1, j), value(i + 1, j + 1)),
                ((i, j + 1, false), value(i + 1, j + 1), value(i, j + 1)),
                ((i, j, true), value(i, j + 1), value(i, j)),
            ];
            let crossed = |sides: &[(Joint, f64, f64)], up: bool| -> Vec<_> {
                let goes = |s: &&(_, f64, f64)| (s.1 < 0.0) != (s.2 < 0.0) && (s.1 < 0.0) == up;
                sides.iter().filter(goes).map(|s| s.0).collect()
            };
            for (&a, &b) in crossed(&sides, true).iter().zip(&crossed(&sides, false)) {
                joints.entry(a).or_default().push(b);
                joints.entry(b).or_default().push(a);
            }
        }
    }
    let place = |(i, j, upright): Joint| {
        let (a, b) = if upright { ((i, j), (i, j + 1)) } else { ((i, j), (i + 1, j)) };
        let (u, v) = (value(a.0, a.1), value(b.0, b.1));
        corner(a.0, a.1).lerp(corner(b.0, b.1), u / (u - v))
    };
    let mut lines = Vec::new();
    while let Some(&start) = joints
        .iter()
        .find(|(_, to)| to.len() == 1)
        .or_else(|| joints.iter().next())
        .map(|(edge, _)| edge)
    {
        let closed = joints.get(&start).is_some_and(|to| to.len() == 2);
        let mut points = Vec::new();
        let mut at = Some(start);
        while let Some((edge, to)) = at.and_then(|edge| joints.remove_entry(&edge)) {
            points.push(place(edge));
            at = to.into_iter().find(|edge| joints.contains_key(edge));
        }
        lines.push(Drawn::new(points, closed));
    }
    lines
}
