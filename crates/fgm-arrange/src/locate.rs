use crate::predicate::{in_box, orient, orient_any};
use crate::topology::{Index, Topology};
use crate::{EdgeId, FaceId, VertexId};
use fgm_core::{Bounds2, Point2};

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// Inside a bounded face.
    Face(FaceId),
    /// Outside every bounded face.
    Unbounded,
    /// On an edge, not at its ends.
    Edge(EdgeId),
    /// On a vertex.
    Vertex(VertexId),
}

impl Location {
    /// The bounded face that the point is inside of.
    pub fn face(self) -> Option<FaceId> {
        if let Self::Face(face) = self { Some(face) } else { None }
    }
}

/// A segment that a line upwards from below meets, drawn from left to right.
#[derive(Clone, Copy)]
struct Floor {
    left: Point2,
    right: Point2,
    /// The half-edge with its face above.
    half: u32,
}

impl Floor {
    /// Whether this one lies above the other, just right of an x that both span. Segments of an
    /// arrangement do not cross, so an end of one decides.
    fn is_above(&self, other: &Self) -> bool {
        let decide = |first: f64, second: f64| first > 0.0 || (first == 0.0 && second > 0.0);
        if self.left.x >= other.left.x {
            let side = |p| orient(other.left, other.right, p);
            decide(side(self.left), side(self.right))
        } else {
            let side = |p| -orient(self.left, self.right, p);
            decide(side(other.left), side(other.right))
        }
    }
}

impl Topology {
    /// The half-edge of the first edge straight below `p` (among those that count) with its face
    /// above. Where several meet below, the one just right of it; edges through `p` do not count.
    pub(crate) fn below(&self, p: Point2, counts: impl Fn(u32) -> bool) -> Option<u32> {
        let mut best: Option<Floor> = None;
        let Index { pieces, tree } = self.index();
        tree.query_down(p, |piece| {
            let piece = &pieces[piece as usize];
            if counts(piece.owner) {
                for i in piece.segments() {
                    let (a, b) = (self.points[i], self.points[i + 1]);
                    let (left, right, back) = if a.x < b.x { (a, b, 0) } else { (b, a, 1) };
                    if !(left.x <= p.x && p.x < right.x) {
                        continue;
                    }
                    let floor = Floor { left, right, half: piece.owner * 2 + back };
                    if orient_any(left, right, p) > 0.0
                        && best.is_none_or(|other| floor.is_above(&other))
                    {
                        best = Some(floor);
                    }
                }
            }
            best.map_or(f64::NEG_INFINITY, |floor| floor.left.y.min(floor.right.y))
        });
        best.map(|floor| floor.half)
    }

    /// The edge through `p`, and the segment of it, as the index of its first point.
    pub(crate) fn through(&self, p: Point2) -> Option<(u32, usize)> {
        let mut found = None;
        let Index { pieces, tree } = self.index();
        tree.query(&tree.window(&Bounds2::new(p, p)), |piece| {
            let piece = &pieces[piece as usize];
            if found.is_some() || !piece.bounds(&self.points).contains(p) {
                return;
            }
            for i in piece.segments() {
                let (a, b) = (self.points[i], self.points[i + 1]);
                if in_box(a, b, p) && orient_any(a, b, p) == 0.0 {
                    found = Some((piece.owner, i));
                }
            }
        });
        found
    }

    /// The face that holds `p`, in lattice steps, or [`NONE`](crate::topology::NONE); on an edge,
    /// one beside it.
    pub(crate) fn face_at(&self, p: Point2) -> u32 {
        self.below(p, |_| true).map_or(crate::topology::NONE, |half| self.face[half as usize])
    }

    /// Where `p`, in lattice steps, lies.
    pub(crate) fn locate(&self, p: Point2) -> Location {
        if !p.is_finite() {
            return Location::Unbounded;
        }
        if let Some((edge, _)) = self.through(p) {
            let end = self.ends[edge as usize].iter().find(|&&v| self.vertices[v as usize] == p);
            return end.map_or(Location::Edge(EdgeId(edge)), |&v| Location::Vertex(VertexId(v)));
        }
        FaceId::bounded(self.face_at(p)).map_or(Location::Unbounded, Location::Face)
    }
}
