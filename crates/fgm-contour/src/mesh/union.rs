use crate::contact::{Contacts, Segment};
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
    /// Whether any two edges of the rings cross or touch, other than neighbours at their joint.
    fn any(&mut self, rings: &[Ring]) -> bool {
        self.segments.clear();
        for ring in rings {
            self.segments.extend(ring.edges().map(|(a, b)| Segment { a, b, tag: 0 }));
        }
        self.contacts.any(&self.segments)
    }
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
