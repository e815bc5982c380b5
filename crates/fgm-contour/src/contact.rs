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

/// Height of the strips in which segments are compared, in mean heights of segments.
const STRIP_HEIGHT: f64 = 2.0;
const MOST_STRIPS: f64 = 4096.0;

/// Finds the pairs of segments that cross or touch, other than neighbours at their joint.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    order: Vec<(f64, u32)>,
    /// For each strip, where its segments begin in `members`, which are in the order of x.
    offsets: Vec<u32>,
    members: Vec<u32>,
    open: Vec<u32>,
}

/// Level strips of the plane.
#[derive(Clone, Copy)]
struct Strips {
    bottom: f64,
    height: f64,
    count: usize,
}

impl Strips {
    fn new(segments: &[Segment]) -> Self {
        let (mut bottom, mut top, mut total) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for s in segments {
            bottom = s.a.y.min(s.b.y).min(bottom);
            top = s.a.y.max(s.b.y).max(top);
            total += (s.a.y - s.b.y).abs();
        }
        let n = segments.len() as f64;
        let count = ((top - bottom) * n / (STRIP_HEIGHT * total)).min(n).clamp(1.0, MOST_STRIPS);
        let count = if count.is_nan() { 1 } else { count as usize };
        Self { bottom, height: (top - bottom) / count as f64, count }
    }

    fn of(&self, y: f64) -> usize {
        (((y - self.bottom) / self.height) as usize).min(self.count - 1)
    }

    fn range(&self, s: &Segment) -> std::ops::RangeInclusive<usize> {
        self.of(s.a.y.min(s.b.y))..=self.of(s.a.y.max(s.b.y))
    }
}

impl Contacts {
    /// Calls `found` once with the indices of every such pair. Each strip of the plane is swept
    /// along x, every segment compared with those that are still open there.
    pub(crate) fn find(&mut self, segments: &[Segment], mut found: impl FnMut(usize, usize)) {
        let strips = Strips::new(segments);
        self.sort(segments, &strips);
        for strip in 0..strips.count {
            self.open.clear();
            let range = self.offsets[strip] as usize..self.offsets[strip + 1] as usize;
            for &k in &self.members[range] {
                let new = &segments[k as usize];
                let (x, low) = (new.a.x.min(new.b.x), new.a.y.min(new.b.y));
                self.open.retain(|&o| {
                    let old = &segments[o as usize];
                    if old.a.x.max(old.b.x) < x {
                        return false;
                    }
                    // In several strips together, they meet in the lowest of those.
                    let here = || strips.of(low.max(old.a.y.min(old.b.y))) == strip;
                    if old.boxes_meet(new) && here() && old.touches(new) {
                        found(o as usize, k as usize);
                    }
                    true
                });
                self.open.push(k);
            }
        }
    }

    fn sort(&mut self, segments: &[Segment], strips: &Strips) {
        self.order.clear();
        self.order.extend(segments.iter().enumerate().map(|(k, s)| (s.a.x.min(s.b.x), k as u32)));
        self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // Counted one place up, so that filling moves each beginning to where it belongs.
        self.offsets.clear();
        self.offsets.resize(strips.count + 2, 0);
        for segment in segments {
            for strip in strips.range(segment) {
                self.offsets[strip + 2] += 1;
            }
        }
        for strip in 2..self.offsets.len() {
            self.offsets[strip] += self.offsets[strip - 1];
        }
        self.members.clear();
        self.members.resize(self.offsets[strips.count + 1] as usize, 0);
        for &(_, k) in &self.order {
            for strip in strips.range(&segments[k as usize]) {
                let slot = &mut self.offsets[strip + 1];
                self.members[*slot as usize] = k;
                *slot += 1;
            }
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
