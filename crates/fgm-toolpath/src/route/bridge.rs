//! Joining loops that run beside each other.

use fgm_core::Point2;

use super::web::{NONE, Place, TRAVEL, Web};

/// How near and how far apart neighbouring lines may be, in spacings: beads of 0.6 to 1.6 widths.
const NEAR: f64 = 0.5;
const FAR: f64 = 1.5;
/// Loops shorter than this, in spacings, are not cut.
const SHORTEST: f64 = 4.0;
/// Of the vertices where a line runs on, one in this many is asked: lines that run side by side do
/// so for longer. Where it turns all are.
const STRIDE: u32 = 4;
/// The least share that what is cut out must have of its length in a straight line.
const STRAIGHT: f64 = 0.75;

/// Joins closed strands that lie side by side, all that can be.
pub(super) fn bridge(web: &mut Web) {
    let least = SHORTEST * web.spacing;
    let mut open: Vec<(u32, u32)> = (0..web.strands.len() as u32)
        .filter(|&s| web.strands[s as usize].closed && web.strands[s as usize].length > least)
        .map(|s| (s, web.strands[s as usize].first))
        .collect();
    let mut lines = open.len();
    // Every round leaves at most half as many lines that can be joined; no vertex is asked again
    // that had no other line beside it, since lines only become one.
    while lines > 1 && !open.is_empty() {
        open.retain_mut(|(strand, vertex)| {
            let end = web.strands[*strand as usize].end;
            while *vertex < end {
                let first = web.strands[*strand as usize].first;
                let ask = (*vertex - first).is_multiple_of(STRIDE) || turns(web, *vertex);
                if ask && lines > 1 && bridge_at(web, *vertex) {
                    lines -= 1;
                    return true;
                }
                *vertex += 1;
            }
            false
        });
    }
}

/// Whether a line turns by more than 45 degrees at a vertex, as at its tips.
fn turns(web: &Web, vertex: u32) -> bool {
    let p = web.at[vertex as usize];
    let [before, after] = [2 * vertex, 2 * vertex + 1].map(|side| web.next(side));
    if before == NONE || after == NONE {
        return false;
    }
    let (u, v) = (p - web.point(before), web.point(after) - p);
    let along = u.dot(v);
    along <= 0.0 || along * along < 0.5 * u.length_squared() * v.length_squared()
}

/// Joins the line of a vertex to another beside it.
fn bridge_at(web: &mut Web, vertex: u32) -> bool {
    let sides = [2 * vertex, 2 * vertex + 1];
    if sides.iter().any(|&s| web.next(s) == NONE) {
        return false;
    }
    let least = SHORTEST * web.spacing;
    let own = web.line(web.strand[vertex as usize]);
    let long = |strand: u32| {
        let part = web.strands[strand as usize];
        part.closed && part.length > least && web.line(strand) != own
    };
    let mut beside: Vec<(f64, Place)> = Vec::new();
    web.near(web.at[vertex as usize], FAR * web.spacing, long, |place, distance| {
        if distance >= NEAR * web.spacing {
            beside.push((distance, place));
        }
    });
    beside.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.side.cmp(&b.1.side)));
    for (_, place) in beside {
        let other = web.strand[place.side as usize / 2];
        for side in sides {
            if let Some(cuts) = cuts(web, side, place) {
                join(web, &cuts);
                web.unite(own, other);
                return true;
            }
        }
    }
    false
}

/// What is cut out of two lines.
struct Cuts {
    /// From this vertex, along this side of it, to the place.
    one: (u32, Place),
    /// From the first place to the other, whose side leads the same way.
    other: (Place, Place),
}

/// The cuts that join the line of `side`, from its vertex on, to the one at `place`.
fn cuts(web: &Web, side: u32, place: Place) -> Option<Cuts> {
    let gap = web.spacing;
    let straight = |a: Point2, b: Point2| a.distance(b) >= STRAIGHT * gap;
    let p = web.point(side);
    let end = along(web, Place { side, at: p }, gap)?;
    if !straight(p, end.at) {
        return None;
    }
    // The other way along the edge where that is the same direction.
    let to = web.next(place.side);
    let ahead = (web.point(to) - web.point(place.side)).dot(end.at - p) > 0.0;
    let from = if ahead { place } else { Place { side: to, at: place.at } };
    let until = along(web, from, gap)?;
    let apart = end.at.distance(until.at) / gap;
    (straight(place.at, until.at) && (NEAR..=FAR).contains(&apart))
        .then_some(Cuts { one: (side, end), other: (from, until) })
}

/// The place `length` mm on from a place; nothing where a travel or an end comes before.
fn along(web: &Web, from: Place, mut length: f64) -> Option<Place> {
    let Place { mut side, mut at } = from;
    // A gap has no more vertices than this; a backstop against going round.
    for _ in 0..64 {
        let next = web.next(side);
        if next == NONE || web.bead[side as usize] == TRAVEL {
            return None;
        }
        let to = web.point(next);
        let step = at.distance(to);
        if step >= length {
            let at = if step > 0.0 { at + (to - at) * (length / step) } else { to };
            return Some(Place { side, at });
        }
        length -= step;
        (side, at) = (next ^ 1, to);
    }
    None
}

/// Cuts both lines and joins begin to begin and end to end.
fn join(web: &mut Web, cuts: &Cuts) {
    let (begin, until) = cuts.one;
    let bead = web.bead[begin as usize];
    let end = cut(web, begin, until);
    let (from, until) = cuts.other;
    let other_bead = web.bead[from.side as usize];
    let vertex = web.add(from.at, web.strand[from.side as usize / 2]);
    // The new vertex stands on the edge; the rest of the edge is cut out from there.
    let same_edge = from.side == until.side;
    let to = web.next(from.side);
    web.join(from.side, vertex, other_bead);
    web.join(vertex + 1, to, other_bead);
    let until = if same_edge { Place { side: vertex + 1, ..until } } else { until };
    let other_end = cut(web, vertex + 1, until);
    web.join(begin, vertex + 1, bead);
    web.join(end, other_end, other_bead);
}

/// Takes out what lies from a side to a place further along; the free side of a new vertex there.
fn cut(web: &mut Web, begin: u32, until: Place) -> u32 {
    let to = web.next(until.side);
    let bead = web.bead[until.side as usize];
    let end = web.add(until.at, web.strand[until.side as usize / 2]);
    let mut side = begin;
    while side != until.side {
        let next = web.next(side);
        (web.twin[side as usize], web.twin[next as usize]) = (NONE, NONE);
        side = next ^ 1;
    }
    web.twin[until.side as usize] = NONE;
    web.join(end + 1, to, bead);
    end
}
