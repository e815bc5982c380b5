use crate::contact::{Contacts, Segment, side};
use crate::nest;
use crate::nest::{assemble, containing};
use clipper2_rust::core::{FillRule, Path64, Point64};
use clipper2_rust::engine::ClipType;
use fgm_core::{Point2, Polygon, Ring};

/// Lattice of the union of rings that meet, steps a mm. Rings that do not meet are not rounded.
const STEPS: f64 = 1e6;

/// The region around which the rings wind other than zero times, as polygons.
///
/// Rings that do not meet keep their vertices to the bit; if any do, all are united on a lattice
/// of 1e-6 mm.
pub(crate) fn unite(rings: Vec<Ring>, scratch: &mut Meeting) -> Vec<Polygon> {
    if scratch.any(&rings) {
        return nest(unite_crossing(&rings));
    }
    let around = containing(&rings);
    let turn = |r: &Ring| if r.area() > 0.0 { 1 } else { -1 };
    let border = |k: usize| {
        let outside: i32 = around[k].iter().map(|&o| turn(&rings[o as usize])).sum();
        let inside = outside + turn(&rings[k]);
        match (outside == 0, inside == 0) {
            (true, false) => Some(false),
            (false, true) => Some(true),
            _ => None,
        }
    };
    let holes: Vec<_> = (0..rings.len()).map(border).collect();
    assemble(rings, &around, &holes)
}

/// Scratch memory for finding whether rings meet.
#[derive(Debug, Default)]
pub(crate) struct Meeting {
    segments: Vec<Segment>,
    contacts: Contacts,
}

impl Meeting {
    /// Whether any two edges of the rings cross or touch, other than at a vertex of both; or
    /// rings cross at one.
    fn any(&mut self, rings: &[Ring]) -> bool {
        self.segments.clear();
        // The tag leads to the edge that follows.
        for ring in rings {
            let first = self.segments.len() as u32;
            let last = first + ring.points.len() as u32 - 1;
            let tag = |k: u32| if first + k == last { first } else { first + k + 1 };
            let edges = ring.edges().zip(0..).map(|((a, b), k)| Segment { a, b, tag: tag(k) });
            self.segments.extend(edges);
        }
        let segments = &self.segments;
        let meets = |k: usize, l: usize| {
            let (s, t) = (&segments[k], &segments[l]);
            s.meets(t) || (s.b == t.b && cross_at_end(segments, s, t))
        };
        let mut any = false;
        self.contacts.find_by(segments, meets, |_, _| any = true);
        any
    }
}

/// Whether two lines that go on from the common end of two of their segments cross there.
fn cross_at_end(segments: &[Segment], s: &Segment, t: &Segment) -> bool {
    let at = s.b;
    let [s_next, t_next] = [s, t].map(|s| segments[s.tag as usize].b);
    let between = |p: Point2| lies_between(at, s.a, s_next, p);
    between(t.a) != between(t_next)
}

/// Whether `p` lies in the angle around `at` from `from` anticlockwise to `to`.
fn lies_between(at: Point2, from: Point2, to: Point2, p: Point2) -> bool {
    let turn = side(at, from, to);
    if turn < 0.0 {
        return !(side(at, to, p) >= 0.0 && side(at, p, from) >= 0.0);
    }
    side(at, from, p) > 0.0 && (turn == 0.0 || side(at, p, to) > 0.0)
}

fn unite_crossing(rings: &[Ring]) -> Vec<Ring> {
    let step = |v: f64| (v * STEPS).round() as i64;
    let paths: Vec<Path64> = rings
        .iter()
        .map(|r| r.points.iter().map(|p| Point64::new(step(p.x), step(p.y))).collect())
        .collect();
    let none = Vec::new();
    let united = clipper2_rust::boolean_op_64(ClipType::Union, FillRule::NonZero, &paths, &none);
    let back = |p: &Point64| Point2::new(p.x as f64 / STEPS, p.y as f64 / STEPS);
    united.iter().map(|path| Ring::new(path.iter().map(back).collect())).collect()
}
