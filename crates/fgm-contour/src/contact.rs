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

    /// Whether the two, whose boxes meet, share more than the end point at which one goes on from
    /// the other.
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

    /// Whether the two cross or touch, other than as neighbours at their joint.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.boxes_meet(other) && self.touches(other)
    }

    fn boxes_meet(&self, other: &Self) -> bool {
        let (lo, hi) = (self.a.min(self.b), self.a.max(self.b));
        let (other_lo, other_hi) = (other.a.min(other.b), other.a.max(other.b));
        lo.cmple(other_hi).all() && other_lo.cmple(hi).all()
    }
}

/// Height of the strips in which runs are compared, in mean heights of runs.
const STRIP_HEIGHT: f64 = 2.0;
const MOST_STRIPS: f64 = 4096.0;
/// Runs that begin in one column on average.
const RUNS_A_COLUMN: f64 = 2.0;
/// Segments of a run.
const MOST_SEGMENTS: usize = 8;

/// Consecutive segments that all head for the same quadrant, which keeps them off each other, and
/// the rectangle around them.
#[derive(Clone, Copy, Debug)]
struct Run {
    from: u32,
    to: u32,
    low: Point2,
    high: Point2,
}

impl Run {
    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// The segments that reach into the rectangle of another.
    fn reaching<'a>(
        &self,
        segments: &'a [Segment],
        other: &Self,
    ) -> impl Iterator<Item = (usize, &'a Segment)> + use<'a> {
        let (from, low, high) = (self.from as usize, other.low, other.high);
        let run = segments[from..self.to as usize].iter().enumerate();
        let reaches =
            move |s: &Segment| s.a.min(s.b).cmple(high).all() && low.cmple(s.a.max(s.b)).all();
        run.filter(move |(_, s)| reaches(s)).map(move |(k, s)| (from + k, s))
    }
}

fn split(segments: &[Segment], runs: &mut Vec<Run>) {
    runs.clear();
    let heading = |s: &Segment| s.a.cmple(s.b);
    let mut from = 0;
    while from < segments.len() {
        let first = &segments[from];
        let quadrant = heading(first);
        let next = segments[from..].windows(2).take(MOST_SEGMENTS - 1);
        let more = next.take_while(|w| w[0].b == w[1].a && heading(&w[1]) == quadrant).count();
        let to = from + 1 + more;
        let last = segments[to - 1].b;
        let (low, high) = (first.a.min(last), first.a.max(last));
        runs.push(Run { from: from as u32, to: to as u32, low, high });
        from = to;
    }
}

/// Finds the pairs of segments that cross or touch, other than neighbours at their joint.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    runs: Vec<Run>,
    /// The runs in the order of the columns in which they begin, and where each column does.
    order: Vec<u32>,
    columns: Vec<u32>,
    /// The same by the strips that they pass through, in the same order in each.
    members: Vec<u32>,
    strips: Vec<u32>,
    /// Runs still open, each with the column in which it ends.
    open: Vec<(u32, u32)>,
}

/// Equal divisions of a range of numbers.
#[derive(Clone, Copy)]
struct Divisions {
    start: f64,
    per_unit: f64,
    count: usize,
}

impl Divisions {
    fn new(start: f64, end: f64, count: f64, most: f64) -> Self {
        let count = if count.is_nan() { 1 } else { count.clamp(1.0, most) as usize };
        Self { start, per_unit: count as f64 / (end - start), count }
    }

    fn of(&self, value: f64) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(self.count - 1)
    }
}

/// Columns by where runs begin and strips by where they pass.
fn divide(runs: &[Run]) -> (Divisions, Divisions) {
    let (mut low, mut high) = (Point2::INFINITY, Point2::NEG_INFINITY);
    let mut total = 0.0;
    for run in runs {
        (low, high) = (low.min(run.low), high.max(run.high));
        total += run.high.y - run.low.y;
    }
    let n = runs.len() as f64;
    let strips = ((high.y - low.y) * n / (STRIP_HEIGHT * total)).min(n);
    (
        Divisions::new(low.x, high.x, n / RUNS_A_COLUMN, f64::from(u16::MAX)),
        Divisions::new(low.y, high.y, strips, MOST_STRIPS),
    )
}

/// Sorts by counting: `keys` gives each item's places, in order; answers where each place begins.
fn count_sort<K: IntoIterator<Item = usize>>(
    items: impl Iterator<Item = u32> + Clone,
    keys: impl Fn(u32) -> K,
    places: usize,
    (starts, sorted): (&mut Vec<u32>, &mut Vec<u32>),
) {
    // Counted one place up, so that filling moves each beginning to where it belongs.
    starts.clear();
    starts.resize(places + 2, 0);
    items.clone().flat_map(&keys).for_each(|key| starts[key + 2] += 1);
    for place in 2..starts.len() {
        starts[place] += starts[place - 1];
    }
    sorted.clear();
    sorted.resize(starts[places + 1] as usize, 0);
    for item in items {
        for key in keys(item) {
            let slot = &mut starts[key + 1];
            sorted[*slot as usize] = item;
            *slot += 1;
        }
    }
}

impl Contacts {
    /// Calls `found` once with the indices of every such pair. Each strip of the plane is swept
    /// along x, every run of segments compared with those that are still open there.
    pub(crate) fn find(&mut self, segments: &[Segment], found: impl FnMut(usize, usize)) {
        self.find_by(segments, |k, l| segments[k].meets(&segments[l]), found);
    }

    /// The same for another idea of what meets; asked of pairs of segments whose boxes do.
    pub(crate) fn find_by(
        &mut self,
        segments: &[Segment],
        meets: impl Fn(usize, usize) -> bool,
        mut found: impl FnMut(usize, usize),
    ) {
        split(segments, &mut self.runs);
        let runs = &self.runs;
        let (columns, strips) = divide(runs);
        let column = |k: u32| [columns.of(runs[k as usize].low.x)];
        let passes = |k: u32| {
            let run = &runs[k as usize];
            strips.of(run.low.y)..=strips.of(run.high.y)
        };
        let all = 0..runs.len() as u32;
        count_sort(all, column, columns.count, (&mut self.columns, &mut self.order));
        let order = self.order.iter().copied();
        count_sort(order, passes, strips.count, (&mut self.strips, &mut self.members));
        for strip in 0..strips.count {
            self.open.clear();
            let range = self.strips[strip] as usize..self.strips[strip + 1] as usize;
            for &k in &self.members[range] {
                let new = &runs[k as usize];
                let first = columns.of(new.low.x);
                self.open.retain(|&(o, end)| {
                    // What ended before this column has nothing more to meet.
                    if (end as usize) < first {
                        return false;
                    }
                    let old = &runs[o as usize];
                    // In several strips together, they meet in the lowest of those.
                    if old.meets(new) && strips.of(new.low.y.max(old.low.y)) == strip {
                        compare(segments, (old, new), &meets, &mut found);
                    }
                    true
                });
                self.open.push((k, columns.of(new.high.x) as u32));
            }
        }
    }
}

fn compare(
    segments: &[Segment],
    (a, b): (&Run, &Run),
    meets: &impl Fn(usize, usize) -> bool,
    found: &mut impl FnMut(usize, usize),
) {
    for (k, _) in a.reaching(segments, b) {
        for (l, _) in b.reaching(segments, a) {
            if meets(k, l) {
                found(k, l);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(s: [f64; 4]) -> Segment {
        Segment { a: Point2::new(s[0], s[1]), b: Point2::new(s[2], s[3]), tag: 0 }
    }

    fn any(segments: &[Segment]) -> bool {
        let mut any = false;
        Contacts::default().find(segments, |_, _| any = true);
        any
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
                assert_eq!(any(&pair), expected, "{name}, turned {flip}");
            }
        }
    }

    /// Two long lines of many runs: what the sweep finds is what comparing all finds.
    #[test]
    fn the_sweep_finds_what_comparing_all_finds() {
        let mut state = 7_u64;
        let mut random = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % n
        };
        for round in 0..300 {
            let (count, size) = (2 + random(60), 2 + random(40));
            let mut at = Point2::ZERO;
            let mut segments = Vec::new();
            for _ in 0..count {
                // Short steps on a lattice: touches, overlaps and repeated places abound.
                let to =
                    at + Point2::new(random(size) as f64, random(size) as f64) - (size / 2) as f64;
                let jump = random(9) == 0;
                if to != at && !jump {
                    segments.push(Segment { a: at, b: to, tag: 0 });
                }
                at = to;
            }
            let mut expected = Vec::new();
            for (k, s) in segments.iter().enumerate() {
                for (l, t) in segments.iter().enumerate().skip(k + 1) {
                    if s.meets(t) {
                        expected.push((k, l));
                    }
                }
            }
            let mut found = Vec::new();
            Contacts::default().find(&segments, |k, l| found.push((k.min(l), k.max(l))));
            found.sort_unstable();
            assert_eq!(found, expected, "round {round}");
        }
    }
}
