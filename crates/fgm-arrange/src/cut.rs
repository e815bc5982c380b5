use crate::piece::{self, Piece, for_pairs};
use crate::predicate::orient_any;
use crate::topology::{NONE, Topology};
use crate::{Arrangement, FaceId};
use fgm_core::{Point2, Span, point_at};

/// A side of a contact whose face is not known.
const VAGUE: u32 = NONE - 1;

/// Stretches shorter than this many lattice steps are joined to the next: rounding of the path's
/// coordinates has put two contacts apart that are one, or in the wrong order.
const SHORT: f64 = 1e-3;

/// Cuts open paths by the faces of an arrangement, and keeps its memory from path to path.
#[derive(Debug)]
pub struct Cutter<'a, L> {
    arrangement: &'a Arrangement<L>,
    points: Vec<Point2>,
    pieces: Vec<Piece>,
    found: Found,
}

#[derive(Debug, Default)]
struct Found {
    contacts: Vec<Contact>,
    /// Stretches along an edge: from, to, face.
    along: Vec<(f64, f64, u32)>,
}

/// A place where the path meets an edge.
#[derive(Clone, Copy, Debug)]
struct Contact {
    at: f64,
    /// The face that the path comes from, or [`VAGUE`].
    before: u32,
    /// The face that the path goes into, or [`VAGUE`].
    after: u32,
}

impl<'a, L> Cutter<'a, L> {
    pub(crate) fn new(arrangement: &'a Arrangement<L>) -> Self {
        Self { arrangement, points: Vec::new(), pieces: Vec::new(), found: Found::default() }
    }

    /// Replaces `spans` by the stretches of an open path and the bounded faces they lie in; `None`
    /// outside every bounded face.
    ///
    /// The spans follow each other from 0 to `path.len() - 1` without gap or overlap, neighbours
    /// are different; there are none for a path of fewer than two points. A stretch along an edge
    /// counts to the face on its left, or to the other one where that is not bounded. Faces less
    /// than 1/1000 of a lattice step across may be passed over. A path with a point that is not
    /// finite is taken to lie outside.
    pub fn cut(&mut self, path: &[Point2], spans: &mut Vec<Span<Option<FaceId>>>) {
        spans.clear();
        if path.len() < 2 {
            return;
        }
        let end = (path.len() - 1) as f64;
        if !path.iter().all(|p| p.is_finite()) {
            spans.push(Span { from: 0.0, to: end, label: None });
            return;
        }
        let topology = &self.arrangement.topology;
        let lattice = &self.arrangement.lattice;
        self.points.clear();
        self.points.extend(path.iter().map(|&p| lattice.scaled(p)));
        self.find(topology);
        let points = &self.points[..];
        let last = Contact { at: end, before: VAGUE, after: VAGUE };
        let mut open = Contact { at: 0.0, ..last };
        let mut along = self.found.along.iter().peekable();
        for &contact in self.found.contacts.iter().chain([&last]) {
            if !is_short(points, open.at, contact.at) {
                let middle = 0.5 * (open.at + contact.at);
                while along.next_if(|run| run.1 <= middle).is_some() {}
                let face = match along.peek() {
                    Some(run) if run.0 <= middle => run.2,
                    _ if open.after == contact.before && open.after != VAGUE => open.after,
                    _ => topology.face_at(point_at(points, middle)),
                };
                let label = FaceId::bounded(face);
                match spans.last_mut() {
                    Some(span) if span.label == label => span.to = contact.at,
                    Some(&mut Span { to: from, .. }) => {
                        spans.push(Span { from, to: contact.at, label });
                    }
                    None => spans.push(Span { from: 0.0, to: contact.at, label }),
                }
            }
            open = contact;
        }
        match spans.last_mut() {
            Some(span) => span.to = end,
            None => {
                let label = FaceId::bounded(topology.face_at(points[0]));
                spans.push(Span { from: 0.0, to: end, label });
            }
        }
    }

    /// Finds all contacts, in order along the path.
    fn find(&mut self, topology: &Topology) {
        let Self { points, pieces, found, .. } = self;
        let points = &points[..];
        pieces.clear();
        piece::split(points, 0, points.len() - 1, 0, pieces);
        found.contacts.clear();
        found.along.clear();
        let index = topology.index();
        let tree = &index.tree;
        for piece in &*pieces {
            if piece.segments().len() == 1 {
                let i = piece.first as usize;
                tree.query(&tree.probe(points[i], points[i + 1]), |other| {
                    found.meet_all(points, i, topology, &index.pieces[other as usize]);
                });
            } else {
                tree.query(&tree.window(&piece.bounds(points)), |other| {
                    let other = &index.pieces[other as usize];
                    for_pairs((points, piece), (&topology.points, other), |i, j| {
                        found.meet(points, i, topology, j, other.owner);
                    });
                });
            }
        }
        found.contacts.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        found.along.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }
}

impl Found {
    /// Records the contacts of segment `i` of the path with all segments of a piece: those whose
    /// ends are not on one side of it.
    fn meet_all(&mut self, points: &[Point2], i: usize, topology: &Topology, piece: &Piece) {
        let (a, b) = (points[i], points[i + 1]);
        let mut before = orient_any(a, b, topology.points[piece.first as usize]);
        for j in piece.segments() {
            let after = orient_any(a, b, topology.points[j + 1]);
            let beside = (before > 0.0 && after > 0.0) || (before < 0.0 && after < 0.0);
            if !beside {
                self.meet(points, i, topology, j, piece.owner);
            }
            before = after;
        }
    }

    /// Records the contacts of segment `i` of the path with the segment at `j` of an edge.
    #[inline]
    fn meet(&mut self, points: &[Point2], i: usize, topology: &Topology, j: usize, edge: u32) {
        let (a, b) = (points[i], points[i + 1]);
        let (c, d) = (topology.points[j], topology.points[j + 1]);
        let (u, v) = (orient_any(a, b, c), orient_any(a, b, d));
        if (u > 0.0 && v > 0.0) || (u < 0.0 && v < 0.0) || a == b {
            return;
        }
        let (s, t) = (orient_any(c, d, a), orient_any(c, d, b));
        if (s > 0.0 && t > 0.0) || (s < 0.0 && t < 0.0) {
            return;
        }
        let sides = [topology.face[2 * edge as usize], topology.face[2 * edge as usize + 1]];
        let base = i as f64;
        if s != 0.0 && t != 0.0 && u != 0.0 && v != 0.0 {
            let [after, before] = if s < 0.0 { sides } else { [sides[1], sides[0]] };
            // The signs are exact, the sizes are not: they are taken relative to a point of the
            // edge, so that a far end of the path does not blur them.
            let (s, t) = ((d - c).perp_dot(a - c), (d - c).perp_dot(b - c));
            let share = s / (s - t);
            let at = base + if share.is_nan() { 0.5 } else { share.clamp(0.0, 1.0) };
            self.contacts.push(Contact { at, before, after });
            return;
        }
        // Where c or d lie on the path's segment, along its longer axis.
        let share = |p: Point2| {
            let (e, f) = (b - a, p - a);
            let share = if e.x.abs() > e.y.abs() { f.x / e.x } else { f.y / e.y };
            share.clamp(0.0, 1.0)
        };
        let mut vague = |share: f64| {
            self.contacts.push(Contact { at: base + share, before: VAGUE, after: VAGUE });
        };
        if s == 0.0 && t == 0.0 {
            let (from, to) = (share(c).min(share(d)), share(c).max(share(d)));
            vague(from);
            vague(to);
            let with = (b - a).dot(d - c) > 0.0;
            let [left, right] = if with { sides } else { [sides[1], sides[0]] };
            let face = if left == NONE { right } else { left };
            if from < to {
                self.along.push((base + from, base + to, face));
            }
        } else if s == 0.0 {
            vague(0.0);
        } else if t == 0.0 {
            vague(1.0);
        } else {
            vague(share(if u == 0.0 { c } else { d }));
        }
    }
}

/// Whether a stretch of the path is too short to be told from nothing.
fn is_short(points: &[Point2], from: f64, to: f64) -> bool {
    let mut length = 0.0;
    let mut at = from;
    while at < to {
        let segment = (at as usize).min(points.len() - 2);
        let end = ((segment + 1) as f64).min(to);
        length += (end - at) * points[segment].distance(points[segment + 1]);
        if length >= SHORT {
            return false;
        }
        at = end;
    }
    true
}
