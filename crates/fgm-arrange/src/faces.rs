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

/// Sum of the cross products of the successive points of a piece, and so of the triangles that
/// they make with the origin: exact. Around a closed line they are twice its area.
fn twice_area_of_piece(line: &[Point2]) -> i128 {
    let (first, last) = (line[0], line[line.len() - 1]);
    let reach = (last - first).abs().max_element();
    // A piece is monotone: its ends bound it. Sums of up to 2^4 products below 2 * 2^48 are exact.
    let near = if reach < (1u64 << 24) as f64 {
        let sum: f64 = line.windows(2).map(|w| (w[0] - first).perp_dot(w[1] - w[0])).sum();
        sum as i128
    } else {
        line.windows(2).map(|w| cross(w[0] - first, w[1] - first)).sum()
    };
    near + cross(first, last - first)
}

impl Topology {
    /// Walks the cycles, finds the faces they border, and puts components into the faces around
    /// them.
    pub(crate) fn find_faces(&mut self) {
        let (mut cycles, mut cycle_of) = self.walk();
        self.bridge.extend(cycle_of.chunks_exact(2).map(|sides| sides[0] == sides[1]));
        self.name_faces(&mut cycles);
        self.components = cycles.iter().filter(|c| c.twice_area <= 0).count();
        if self.components > 1 {
            self.nest(&mut cycles, &cycle_of);
        }
        for cycle in &mut cycle_of {
            *cycle = cycles[*cycle as usize].face;
        }
        self.face = cycle_of;
        self.record(&cycles);
    }

    fn walk(&self) -> (Vec<Cycle>, Vec<u32>) {
        let mut cycle_of = vec![NONE; self.next.len()];
        let mut cycles = Vec::new();
        for half in 0..self.next.len() as u32 {
            if cycle_of[half as usize] != NONE {
                continue;
            }
            for h in self.cycle(half) {
                cycle_of[h as usize] = cycles.len() as u32;
            }
            let least = self.vertices[self.origin(half) as usize];
            cycles.push(Cycle { half, twice_area: 0, face: NONE, least });
        }
        let mut pieces = self.pieces.iter().peekable();
        for edge in 0..self.ends.len() {
            let start = self.points[self.edge_starts[edge] as usize];
            let (mut area, mut least) = (0, start);
            while let Some(piece) = pieces.next_if(|piece| piece.owner as usize == edge) {
                let line = &self.points[piece.first as usize..=piece.last as usize];
                area += twice_area_of_piece(line);
                // Not at an end of the piece where that begins or ends upright.
                if line[0].x.min(line[line.len() - 1].x) <= least.x {
                    least = line.iter().copied().fold(least, lesser);
                }
            }
            for (half, area) in [(2 * edge, area), (2 * edge + 1, -area)] {
                let cycle = &mut cycles[cycle_of[half] as usize];
                cycle.twice_area += area;
                cycle.least = lesser(cycle.least, least);
            }
        }
        (cycles, cycle_of)
    }

    /// Numbers the bounded faces by the least points of their outer borders, and by the angle at
    /// which the border leaves it: by place alone, so that labels and the number of vertices do
    /// not matter.
    fn name_faces(&self, cycles: &mut [Cycle]) {
        let mut order: Vec<_> = (0..cycles.len()).filter(|&c| cycles[c].twice_area > 0).collect();
        order.sort_unstable_by(|&a, &b| {
            let (a, b) = (&cycles[a], &cycles[b]);
            by_place(a.least, b.least).then_with(|| {
                by_angle(self.leaving(a.half, a.least), self.leaving(b.half, b.least))
            })
        });
        for (id, &c) in order.iter().enumerate() {
            cycles[c].face = id as u32;
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

    fn record(&mut self, cycles: &[Cycle]) {
        let mut holes: Vec<_> = Vec::new();
        let bounded = cycles.iter().filter(|c| c.twice_area > 0).count();
        let none = FaceRecord { outer: NONE, holes_start: 0, holes_end: 0, area: 0.0 };
        self.faces = vec![none; bounded];
        let mut areas = vec![0; bounded];
        for cycle in cycles {
            if cycle.twice_area > 0 {
                self.faces[cycle.face as usize].outer = cycle.half;
                areas[cycle.face as usize] = cycle.twice_area;
            } else if cycle.face == NONE {
                self.outlines.push(cycle.half);
            } else {
                holes.push((cycle.face, cycle.half, cycle.twice_area));
            }
        }
        holes.sort_unstable();
        let mut at = 0;
        for (id, face) in self.faces.iter_mut().enumerate() {
            face.holes_start = at as u32;
            while let Some(&(_, half, area)) = holes.get(at).filter(|hole| hole.0 == id as u32) {
                self.holes.push(half);
                areas[id] += area;
                at += 1;
            }
            face.holes_end = at as u32;
            face.area = areas[id] as f64 * 0.5;
        }
    }
}
