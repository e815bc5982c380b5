//! Lines that meet end to end, as one.

use fgm_core::Point2;

use crate::Path;

/// A line of one or several paths that meet.
#[derive(Clone, Debug)]
pub(super) struct Strand {
    pub(super) points: Vec<Point2>,
    /// The path that each segment comes from; of a closed strand the last segment leads back.
    pub(super) beads: Vec<u32>,
    pub(super) closed: bool,
}

impl Strand {
    fn of(path: &mut Path, bead: u32) -> Self {
        let points = std::mem::take(&mut path.points);
        let segments = points.len() - usize::from(!path.closed);
        Self { points, beads: vec![bead; segments], closed: path.closed }
    }

    fn ends(&self) -> [Point2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    pub(super) fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let [first, last] = self.ends();
        if self.closed { open + last.distance(first) } else { open }
    }

    fn reverse(&mut self) {
        self.points.reverse();
        self.beads.reverse();
    }

    /// Takes `length` mm, less than the strand has, off its end.
    fn shorten(&mut self, mut length: f64) {
        while let [.., a, b] = self.points[..] {
            let step = a.distance(b);
            if step > length {
                let last = self.points.len() - 1;
                self.points[last] = b + (a - b) * (length / step);
                return;
            }
            length -= step;
            self.points.pop();
            self.beads.pop();
        }
    }
}

/// The strands of some paths, whose points they take: those that meet joined, and what runs side by
/// side closed to loops.
pub(super) fn strands(paths: &mut [Path], spacing: f64) -> Vec<Strand> {
    let (mut out, mut open): (Vec<Strand>, Vec<Strand>) = (Vec::new(), Vec::new());
    for (path, bead) in paths.iter_mut().zip(0..) {
        // Beads of a varying width come one after the other.
        match open.last_mut() {
            Some(last) if !path.closed && last.ends()[1] == path.points[0] => {
                last.points.extend_from_slice(&path.points[1..]);
                last.beads.resize(last.points.len() - 1, bead);
            }
            _ if path.closed => out.push(Strand::of(path, bead)),
            _ => open.push(Strand::of(path, bead)),
        }
    }
    let open = linked(open);
    let (closed, open): (Vec<_>, Vec<_>) = open.into_iter().partition(|s| s.closed);
    out.extend(closed);
    out.extend(paired(open, spacing));
    out
}

/// Open strands whose ends are the same point become one.
fn linked(strands: Vec<Strand>) -> Vec<Strand> {
    // Ends by place; a place with several ends joins them two by two.
    let of = |s: usize| strands[s].ends().map(|p| (p, s)).into_iter().zip(0..2);
    let mut ends: Vec<((Point2, usize), usize)> = (0..strands.len()).flat_map(of).collect();
    ends.sort_by(|((a, _), _), ((b, _), _)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut partner = vec![[None; 2]; strands.len()];
    let mut i = 0;
    while i + 1 < ends.len() {
        let (((p, s), e), ((q, t), f)) = (ends[i], ends[i + 1]);
        if p == q {
            (partner[s][e], partner[t][f]) = (Some((t, f)), Some((s, e)));
            i += 1;
        }
        i += 1;
    }
    let mut rest: Vec<Option<Strand>> = strands.into_iter().map(Some).collect();
    let mut out = Vec::new();
    // Chains from their free ends, then what is left: rings.
    for free_ends in [true, false] {
        for first in 0..rest.len() {
            let enter = (0..2).find(|&e| partner[first][e].is_none());
            if rest[first].is_some() && enter.is_some() == free_ends {
                out.extend(follow(&mut rest, &partner, first, enter.unwrap_or(0)));
            }
        }
    }
    out
}

/// The chain that is entered at one end of a strand.
fn follow(
    rest: &mut [Option<Strand>],
    partner: &[[Option<(usize, usize)>; 2]],
    first: usize,
    enter: usize,
) -> Option<Strand> {
    let mut whole: Option<Strand> = None;
    let mut at = Some((first, enter));
    while let Some((strand, enter)) = at {
        let Some(mut next) = rest[strand].take() else { break };
        if enter == 1 {
            next.reverse();
        }
        match &mut whole {
            Some(whole) => {
                whole.points.extend_from_slice(&next.points[1..]);
                whole.beads.extend(next.beads);
            }
            None => whole = Some(next),
        }
        at = partner[strand][1 - enter];
    }
    let mut whole = whole?;
    if at.is_some() && whole.points.len() > 3 {
        whole.closed = true;
        whole.points.pop();
    }
    Some(whole)
}

/// Open strands that run side by side from end to end become loops, their ends cut back by as much
/// as the caps add.
fn paired(strands: Vec<Strand>, spacing: f64) -> Vec<Strand> {
    let mut found = pairs(&strands, spacing);
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut rest: Vec<Option<Strand>> = strands.into_iter().map(Some).collect();
    let mut out = Vec::with_capacity(rest.len());
    for (_, s, t) in found {
        if rest[s].is_some()
            && rest[t].is_some()
            && let (Some(a), Some(b)) = (rest[s].take(), rest[t].take())
        {
            out.push(capped(a, b));
        }
    }
    out.extend(rest.into_iter().flatten());
    out
}

/// Strands that may make a loop, with how far apart their ends are.
fn pairs(strands: &[Strand], spacing: f64) -> Vec<(f64, usize, usize)> {
    let far = 1.8 * spacing;
    let lengths: Vec<f64> = strands.iter().map(Strand::length).collect();
    let mut starts: Vec<(Point2, usize)> = Vec::with_capacity(2 * strands.len());
    for (i, strand) in strands.iter().enumerate() {
        starts.extend(strand.ends().map(|p| (p, i)));
    }
    starts.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)));
    let mut out = Vec::new();
    for (i, &(p, s)) in starts.iter().enumerate() {
        for &(q, t) in starts[i + 1..].iter().take_while(|(q, _)| q.x - p.x <= far) {
            let (s, t) = (s.min(t), s.max(t));
            let long = lengths[s].min(lengths[t]);
            if s == t || p.distance(q) > far || long < 0.7 * lengths[s].max(lengths[t]) {
                continue;
            }
            let (near, other) = apart(&strands[s], &strands[t]);
            if near.max(other) <= far && long > 1.2 * (near + other) {
                out.push((near + other, s, t));
            }
        }
    }
    out
}

/// How far apart two strands' ends are, each with the nearer.
fn apart(a: &Strand, b: &Strand) -> (f64, f64) {
    let ([p, q], [r, s]) = (a.ends(), b.ends());
    let (same, turned) = ((p.distance(r), q.distance(s)), (p.distance(s), q.distance(r)));
    if same.0 + same.1 <= turned.0 + turned.1 { same } else { turned }
}

/// One loop of two strands.
fn capped(mut a: Strand, mut b: Strand) -> Strand {
    let ([p, q], [r, s]) = (a.ends(), b.ends());
    if p.distance(r) + q.distance(s) <= p.distance(s) + q.distance(r) {
        b.reverse();
    }
    // Now b begins where a ends.
    let [r, s] = b.ends();
    let (far, near) = (0.5 * q.distance(r), 0.5 * p.distance(s));
    a.shorten(far);
    b.shorten(near);
    for (strand, length) in [(&mut a, near), (&mut b, far)] {
        strand.reverse();
        strand.shorten(length);
        strand.reverse();
    }
    let (cap, close) = (a.beads[a.beads.len() - 1], b.beads[b.beads.len() - 1]);
    a.beads.push(cap);
    a.points.extend(b.points);
    a.beads.extend(b.beads);
    a.beads.push(close);
    a.closed = true;
    a
}
