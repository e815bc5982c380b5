//! Putting the lines that cannot be joined into the longest one, where the detour is shortest.

use fgm_core::Point2;

use super::web::{NONE, Place, TRAVEL, Web};

/// How far around a line the others are looked for, in spacings; where none is left so near,
/// further.
const REACHES: [f64; 4] = [2.0, 8.0, 32.0, 128.0];
/// Vertices of a loop from which another line is looked for.
const MOST_PROBES: u32 = 64;

/// Makes one line of all that lie beside each other.
pub(super) fn insert(web: &mut Web) {
    let Some(main) = longest(web) else { return };
    let mut travels = Vec::new();
    if !web.strands[main as usize].closed {
        let (a, b) = ends(web, main);
        web.join(a, b, TRAVEL);
        travels.push(a);
    }
    let mut waiting: Vec<u32> =
        (0..web.strands.len() as u32).filter(|&s| web.line(s) == s && s != main).collect();
    for reach in REACHES.map(|reach| reach * web.spacing) {
        // What is put in leads to what lies beyond, in the order of the strands or against it.
        let mut before = waiting.len() + 1;
        while waiting.len() < before {
            before = waiting.len();
            waiting.retain(|&s| {
                let closed = web.strands[s as usize].closed;
                let put = if closed { insert_loop } else { insert_open };
                !put(web, s, main, reach, &mut travels)
            });
            waiting.reverse();
        }
    }
}

/// The longest line, closed if any is.
fn longest(web: &Web) -> Option<u32> {
    let lines: Vec<u32> = (0..web.strands.len() as u32).filter(|&s| web.line(s) == s).collect();
    let key = |s: u32| (web.strands[s as usize].closed, web.strands[s as usize].length);
    lines.into_iter().max_by(|&a, &b| {
        let ((c, l), (d, m)) = (key(a), key(b));
        c.cmp(&d).then(l.total_cmp(&m)).then(b.cmp(&a))
    })
}

/// The free sides of an open strand.
fn ends(web: &Web, s: u32) -> (u32, u32) {
    let part = web.strands[s as usize];
    (2 * part.first, 2 * part.end - 1)
}

/// A way from a line to another.
#[derive(Clone, Copy)]
struct Way {
    /// A side of the vertex it leaves from.
    from: u32,
    to: Place,
    detour: f64,
}

/// The nearest place of line `main` to the vertices of a loop.
fn nearest_to_loop(web: &Web, s: u32, main: u32, reach: f64) -> Option<Way> {
    let part = web.strands[s as usize];
    let stride = ((part.end - part.first) / MOST_PROBES).max(1);
    let mut best: Option<Way> = None;
    for vertex in (part.first..part.end).step_by(stride as usize) {
        if web.next(2 * vertex) == NONE || web.next(2 * vertex + 1) == NONE {
            continue;
        }
        if let Some(way) = nearest(web, 2 * vertex, main, reach)
            && best.is_none_or(|best| way.detour < best.detour)
        {
            best = Some(way);
        }
        // No other line lies nearer than the next bead.
        if best.is_some_and(|best| best.detour <= 1.1 * web.spacing) {
            break;
        }
    }
    best
}

/// The nearest place of line `main` to the vertex of a side.
fn nearest(web: &Web, from: u32, main: u32, reach: f64) -> Option<Way> {
    let mut best: Option<(f64, Place)> = None;
    web.near(
        web.point(from),
        reach,
        |strand| web.line(strand) == main,
        |place, distance| {
            let nearer = |(least, other): (f64, Place)| {
                distance.total_cmp(&least).then(place.side.cmp(&other.side)).is_lt()
            };
            if best.is_none_or(nearer) {
                best = Some((distance, place));
            }
        },
    );
    best.map(|(detour, to)| Way { from, to, detour })
}

/// The cheapest travel to replace by one through points `a` and `b`: its side, whether `a` comes
/// second, and the detour.
fn through(web: &Web, travels: &[u32], a: Point2, b: Point2) -> Option<(usize, bool, f64)> {
    let mut best: Option<(usize, bool, f64)> = None;
    for (i, &side) in travels.iter().enumerate() {
        let (p, q) = (web.point(side), web.point(web.next(side)));
        for turned in [false, true] {
            let (a, b) = if turned { (b, a) } else { (a, b) };
            let detour = p.distance(a) + b.distance(q) - p.distance(q);
            if best.is_none_or(|best| detour < best.2) {
                best = Some((i, turned, detour));
            }
        }
    }
    best
}

/// Puts an open strand into line `main` where that comes near: there and back from one of its
/// ends, or on the way of a travel. Whether it did.
fn insert_open(web: &mut Web, s: u32, main: u32, reach: f64, travels: &mut Vec<u32>) -> bool {
    let (a, b) = ends(web, s);
    let (p, q) = (web.point(a), web.point(b));
    let spur = [a, b].map(|side| {
        let way = nearest(web, side, main, reach)?;
        Some((way, way.detour + way.to.at.distance(if side == a { q } else { p })))
    });
    let spur = spur.into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((way, spur)) = spur else { return false };
    match through(web, travels, p, q) {
        Some((i, turned, detour)) if detour <= spur => {
            let (a, b) = if turned { (b, a) } else { (a, b) };
            replace(web, travels, i, a, b);
        }
        _ => {
            let back = if way.from == a { b } else { a };
            let (out, home) = open_at(web, way.to);
            web.join(out, way.from, TRAVEL);
            web.join(home, back, TRAVEL);
            travels.extend([out, home]);
        }
    }
    web.unite(main, s);
    true
}

/// Puts a loop into line `main` where that comes near, there and back, or on the way of a travel.
/// Whether it did.
fn insert_loop(web: &mut Web, s: u32, main: u32, reach: f64, travels: &mut Vec<u32>) -> bool {
    let Some(way) = nearest_to_loop(web, s, main, reach) else { return false };
    // The loop is cut at the vertex, which is then there twice.
    let side = way.from;
    let vertex = side / 2;
    let copy = web.add(web.at[vertex as usize], s);
    let (onward, bead) = (web.next(side), web.bead[side as usize]);
    web.join(copy, onward, bead);
    let (a, b) = (side, copy + 1);
    web.twin[a as usize] = NONE;
    let p = web.point(a);
    match through(web, travels, p, p) {
        Some((i, _, detour)) if detour <= 2.0 * way.detour => replace(web, travels, i, a, b),
        _ => {
            let (out, home) = open_at(web, way.to);
            web.join(out, a, TRAVEL);
            web.join(home, b, TRAVEL);
            travels.extend([out, home]);
        }
    }
    web.unite(main, s);
    true
}

/// Two free sides at a place of a line.
fn open_at(web: &mut Web, place: Place) -> (u32, u32) {
    let first = web.split(place);
    let copy = web.add(place.at, web.strand[place.side as usize / 2]);
    let (onward, bead) = (web.next(first + 1), web.bead[first as usize + 1]);
    web.join(copy + 1, onward, bead);
    web.twin[first as usize + 1] = NONE;
    (first + 1, copy)
}

/// Leads travel `i` by way of a line from side `a` to side `b`.
fn replace(web: &mut Web, travels: &mut Vec<u32>, i: usize, a: u32, b: u32) {
    let from = travels[i];
    let to = web.next(from);
    web.join(from, a, TRAVEL);
    web.join(b, to, TRAVEL);
    travels.push(b);
}
