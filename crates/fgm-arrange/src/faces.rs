use crate::predicate::{by_angle, by_place};
use crate::topology::{FaceRecord, NONE, Topology};
use fgm_core::Point2;
use std::cmp::Ordering;

/// The border of a face: a cycle of half-edges.
#[derive(Clone, Copy, Debug)]
struct Cycle {
    half: u32,
    /// Twice the area to its left, square steps: positive around a bounded face, not positive
    /// around a component seen from outside.
    twice_area: i128,
    /// The face to its left.
    face: u32,
    /// The least of its points.
    least: Point2,
}

fn lesser(a: Point2, b: Point2) -> Point2 {
    if by_place(b, a) == Ordering::Less { b } else { a }
}

/// Union-find with halving paths.
struct Sets(Vec<u32>);

impl Sets {
    fn find(&mut self, mut a: u32) -> u32 {
        while self.0[a as usize] != a {
            let up = self.0[self.0[a as usize] as usize];
            self.0[a as usize] = up;
            a = up;
        }
        a
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// The cross product, whatever the size.
fn cross(a: Point2, b: Point2) -> i128 {
    i128::from(a.x as i64) * i128::from(b.y as i64)
        - i128::from(a.y as i64) * i128::from(b.x as i64)
}

/// Twice the area between a piece and its chord: exact.
fn twice_area_of_piece(line: &[Point2]) -> i128 {
    let (first, last) = (line[0], line[line.len() - 1]);
    let reach = (last - first).abs().max_element();
    // A piece is monotone: its ends bound it. Sums of up to 2^4 products below 2 * 2^48 are exact.
    if reach < (1u64 << 24) as f64 {
        let sum: f64 = line.windows(2).map(|w| (w[0] - first).perp_dot(w[1] - w[0])).sum();
        sum as i128
    } else {
        line.windows(2).map(|w| cross(w[0] - first, w[1] - first)).sum()
    }
}

/// How an edge differs from the chord between its ends.
#[derive(Clone, Copy, Debug)]
struct Bend {
    edge: u32,
    /// Twice the area between them, square steps; positive where the edge bends to the right.
    twice_area: i128,
    /// The least of the edge's points.
    least: Point2,
}

impl Topology {
    /// Walks the cycles, finds the faces they border, and puts components into the faces around
    /// them.
    pub(crate) fn find_faces(&mut self) {
        let (mut cycles, mut cycle_of) = self.walk();
        self.bridge = cycle_of.chunks_exact(2).map(|sides| sides[0] == sides[1]).collect();
        self.name_faces(&mut cycles);
        self.components = cycles.iter().filter(|c| c.twice_area <= 0).count();
        if self.components > 1 {
            self.nest(&mut cycles, &cycle_of);
        }
        self.record(&cycles, &cycle_of);
        for cycle in &mut cycle_of {
            *cycle = cycles[*cycle as usize].face;
        }
        self.face = cycle_of;
    }

    /// The cycles, and for each half-edge its own.
    fn walk(&self) -> (Vec<Cycle>, Vec<u32>) {
        let bends = self.bends();
        let mut cycle_of = vec![NONE; self.next.len()];
        // Euler's formula for one component.
        let mut cycles =
            Vec::with_capacity((2 + self.ends.len()).saturating_sub(self.vertices.len()));
        for first in 0..self.next.len() as u32 {
            if cycle_of[first as usize] != NONE {
                continue;
            }
            let start = self.vertices[self.origin(first) as usize];
            let mut cycle = Cycle { half: first, twice_area: 0, face: NONE, least: start };
            let (mut half, mut at) = (first, start);
            while cycle_of[half as usize] == NONE {
                cycle_of[half as usize] = cycles.len() as u32;
                let to = self.vertices[self.origin(half ^ 1) as usize];
                cycle.twice_area += cross(at - start, to - start);
                cycle.least = lesser(cycle.least, to);
                if let Some(bend) = self.bend(&bends, half / 2) {
                    let back = half & 1 == 1;
                    cycle.twice_area += if back { -bend.twice_area } else { bend.twice_area };
                    cycle.least = lesser(cycle.least, bend.least);
                }
                at = to;
                half = self.next[half as usize];
            }
            cycles.push(cycle);
        }
        (cycles, cycle_of)
    }

    /// The edges that are not straight, in order.
    fn bends(&self) -> Vec<Bend> {
        if self.points.len() == 2 * self.ends.len() {
            return Vec::new();
        }
        let bent = (0..self.ends.len() as u32).filter(|&edge| self.line(edge as usize).len() > 2);
        let mut own = Vec::new();
        let mut pieces = match self.made_index() {
            Some(index) => index.pieces.iter(),
            None => {
                bent.clone().for_each(|edge| self.split(edge, &mut own));
                own.iter()
            }
        }
        .peekable();
        let bend = |edge: u32| {
            let start = self.line(edge as usize)[0];
            let mut bend = Bend { edge, twice_area: 0, least: start };
            while pieces.next_if(|piece| piece.owner < edge).is_some() {}
            while let Some(piece) = pieces.next_if(|piece| piece.owner == edge) {
                let line = &self.points[piece.first as usize..=piece.last as usize];
                let (from, to) = (line[0], line[line.len() - 1]);
                bend.twice_area += twice_area_of_piece(line) + cross(from - start, to - start);
                // Not at an end of the piece where that begins or ends upright.
                if from.x.min(to.x) <= bend.least.x {
                    bend.least = line.iter().copied().fold(bend.least, lesser);
                }
            }
            bend
        };
        bent.map(bend).collect()
    }

    fn bend<'a>(&self, bends: &'a [Bend], edge: u32) -> Option<&'a Bend> {
        if bends.is_empty() || self.line(edge as usize).len() == 2 {
            return None;
        }
        bends.get(bends.partition_point(|bend| bend.edge < edge))
    }

    /// Numbers the bounded faces by the least points of their outer borders, and by the angle at
    /// which the border leaves it: by place alone, so that labels and the number of vertices do
    /// not matter.
    fn name_faces(&self, cycles: &mut [Cycle]) {
        let bounded = |&c: &u32| cycles[c as usize].twice_area > 0;
        let mut order: Vec<_> = (0..cycles.len() as u32).filter(bounded).collect();
        let least = |c: u32| cycles[c as usize].least;
        // They are found by the places of their vertices, and mostly those are their least points.
        if !order.is_sorted_by(|&a, &b| by_place(least(a), least(b)) != Ordering::Greater) {
            order.sort_unstable_by(|&a, &b| by_place(least(a), least(b)));
        }
        for group in order.chunk_by_mut(|&a, &b| least(a) == least(b)).filter(|g| g.len() > 1) {
            let leaving = |c: u32| self.leaving(cycles[c as usize].half, least(c));
            group.sort_unstable_by(|&a, &b| by_angle(leaving(a), leaving(b)));
        }
        for (id, &c) in order.iter().enumerate() {
            cycles[c as usize].face = id as u32;
        }
    }

    /// The direction in which a cycle leaves a point on it; the first by angle where it comes
    /// there more than once.
    fn leaving(&self, half: u32, point: Point2) -> Point2 {
        let mut found: Option<Point2> = None;
        for h in self.cycle(half) {
            let line = self.line(h as usize / 2);
            let mut check = |a: Point2, b: Point2| {
                let less = |d| by_angle(b - a, d) == Ordering::Less;
                if a == point && found.is_none_or(less) {
                    found = Some(b - a);
                }
            };
            for w in line.windows(2) {
                if h & 1 == 0 { check(w[0], w[1]) } else { check(w[1], w[0]) }
            }
        }
        found.unwrap_or_default()
    }

    /// Finds the face around each component: the one above the first edge straight below the
    /// component's least point.
    fn nest(&self, cycles: &mut [Cycle], cycle_of: &[u32]) {
        let mut sets = Sets((0..self.vertices.len() as u32).collect());
        for &[a, b] in &self.ends {
            sets.join(a, b);
        }
        let component: Vec<_> = self.ends.iter().map(|ends| sets.find(ends[0])).collect();
        let mut order: Vec<_> = (0..cycles.len()).filter(|&c| cycles[c].twice_area <= 0).collect();
        order.sort_unstable_by(|&a, &b| by_place(cycles[a].least, cycles[b].least));
        // What is hit belongs to a component that begins before this one, so its face is known.
        for c in order {
            let mine = component[cycles[c].half as usize / 2];
            let below = self.below(cycles[c].least, |edge| component[edge as usize] != mine);
            if let Some(half) = below {
                cycles[c].face = cycles[cycle_of[half as usize] as usize].face;
            }
        }
    }

    fn record(&mut self, cycles: &[Cycle], cycle_of: &[u32]) {
        let mut holes: Vec<_> = Vec::new();
        let bounded = cycles.iter().filter(|c| c.twice_area > 0).count();
        let none = FaceRecord { outer: NONE, holes_start: 0, holes_end: 0, area: 0.0 };
        self.faces = vec![none; bounded];
        for cycle in cycles {
            if cycle.twice_area > 0 {
                let face = &mut self.faces[cycle.face as usize];
                (face.outer, face.area) = (cycle.half, cycle.twice_area as f64 * 0.5);
            } else if cycle.face == NONE {
                self.outlines.push(cycle.half);
            } else {
                holes.push((cycle.face, cycle.half, cycle.twice_area));
            }
        }
        holes.sort_unstable();
        for group in holes.chunk_by(|a, b| a.0 == b.0) {
            let face = &mut self.faces[group[0].0 as usize];
            let outer = &cycles[cycle_of[face.outer as usize] as usize];
            let twice = outer.twice_area + group.iter().map(|hole| hole.2).sum::<i128>();
            face.area = twice as f64 * 0.5;
            face.holes_start = self.holes.len() as u32;
            self.holes.extend(group.iter().map(|hole| hole.1));
            face.holes_end = self.holes.len() as u32;
        }
    }
}
