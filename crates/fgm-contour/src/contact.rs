use fgm_core::Point2;
use robust::{Coord, orient2d};

/// A segment of one of several lines, with a tag of the caller's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub(crate) a: Point2,
    pub(crate) b: Point2,
    pub(crate) tag: u32,
}

/// Which side of the line through `a` and `b` point `c` lies on, exactly: positive on the left.
pub(crate) fn side(a: Point2, b: Point2, c: Point2) -> f64 {
    let coord = |p: Point2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

impl Segment {
    /// Whether both join the same two points.
    pub(crate) fn coincides(&self, other: &Self) -> bool {
        (self.a == other.a && self.b == other.b) || (self.a == other.b && self.b == other.a)
    }

    /// Whether the two share more than the end point at which one goes on from the other.
    fn touches(&self, other: &Self) -> bool {
        let (a, b, c, d) = (self.a, self.b, other.a, other.b);
        if self.coincides(other) {
            return true;
        }
        let shared = if a == c {
            Some((a, b, d))
        } else if a == d {
            Some((a, b, c))
        } else if b == c {
            Some((b, a, d))
        } else if b == d {
            Some((b, a, c))
        } else {
            None
        };
        if let Some((joint, p, q)) = shared {
            return (p - joint).dot(q - joint) > 0.0 && side(joint, p, q) == 0.0;
        }
        let opposite = |s: f64, t: f64| s == 0.0 || t == 0.0 || (s > 0.0) != (t > 0.0);
        opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b))
    }

    fn boxes_meet(&self, other: &Self) -> bool {
        let (lo, hi) = (self.a.min(self.b), self.a.max(self.b));
        let (other_lo, other_hi) = (other.a.min(other.b), other.a.max(other.b));
        lo.cmple(other_hi).all() && other_lo.cmple(hi).all()
    }
}

/// Finds the pairs of segments that cross or touch, other than neighbours at their joint.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    order: Vec<(f64, u32)>,
    open: Vec<u32>,
}

impl Contacts {
    /// Calls `found` with the indices of every such pair, lesser x first. Sorts by x and compares
    /// with the segments still open there.
    pub(crate) fn find(&mut self, segments: &[Segment], mut found: impl FnMut(usize, usize)) {
        self.order.clear();
        self.order.extend(segments.iter().enumerate().map(|(k, s)| (s.a.x.min(s.b.x), k as u32)));
        self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.open.clear();
        for &(x, k) in &self.order {
            let new = &segments[k as usize];
            self.open.retain(|&o| {
                let old = &segments[o as usize];
                if old.a.x.max(old.b.x) < x {
                    return false;
                }
                if old.boxes_meet(new) && old.touches(new) {
                    found(o as usize, k as usize);
                }
                true
            });
            self.open.push(k);
        }
    }

    /// Whether any two segments cross or touch.
    pub(crate) fn any(&mut self, segments: &[Segment]) -> bool {
        let mut any = false;
        self.find(segments, |_, _| any = true);
        any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(s: [f64; 4]) -> Segment {
        Segment { a: Point2::new(s[0], s[1]), b: Point2::new(s[2], s[3]), tag: 0 }
    }

    #[test]
    fn contacts_are_told_from_joints() {
        let first = [0.0, 0.0, 2.0, 0.0];
        let cases = [
            ("crossing", [1.0, -1.0, 1.0, 1.0], true),
            ("joint", [2.0, 0.0, 3.0, 1.0], false),
            ("joint at the other end", [-1.0, 3.0, 0.0, 0.0], false),
            ("straight on", [2.0, 0.0, 3.0, 0.0], false),
            ("folded back", [2.0, 0.0, 1.0, 0.0], true),
            ("folded back beyond", [2.0, 0.0, -1.0, 0.0], true),
            ("touching inside", [1.0, 0.0, 1.0, 1.0], true),
            ("overlapping", [1.0, 0.0, 5.0, 0.0], true),
            ("collinear, apart", [3.0, 0.0, 5.0, 0.0], false),
            ("the same", [0.0, 0.0, 2.0, 0.0], true),
            ("the same, reversed", [2.0, 0.0, 0.0, 0.0], true),
            ("parallel", [0.0, 1e-300, 2.0, 1e-300], false),
        ];
        for (name, second, expected) in cases {
            for flip in 0..8 {
                let turn = |s: [f64; 4]| match flip & 3 {
                    0 => s,
                    1 => [s[2], s[3], s[0], s[1]],
                    2 => [s[1], s[0], s[3], s[2]],
                    _ => [-s[0], s[1], -s[2], s[3]],
                };
                let mut pair = [segment(turn(first)), segment(turn(second))];
                if flip >= 4 {
                    pair.swap(0, 1);
                }
                assert_eq!(Contacts::default().any(&pair), expected, "{name}, turned {flip}");
            }
        }
    }
}
