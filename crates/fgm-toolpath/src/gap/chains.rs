//! The middle of a triangulated region as chains of gates.
//!
//! A gate is an edge from side to side. Between two gates lies a triangle; its height is the
//! thickness there, and its area the area the bead has to fill.

use fgm_core::Point2;

use super::mesh::{BORDER, Mesh};

/// The cosine of the angle below which an end is pointed, and not cut off straight: 53 degrees.
const POINTED: f64 = 0.6;

/// A stretch of a region between forks, crossed by gates.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// Right and left end of every gate, seen along the chain.
    pub(super) gates: Vec<(Point2, Point2)>,
    /// Area between each gate and the next.
    areas: Vec<f64>,
    /// Whether the last gate is the first.
    pub(super) closed: bool,
}

impl Chain {
    fn middle(&self, gate: usize) -> Point2 {
        let (r, l) = self.gates[gate];
        (r + l) * 0.5
    }

    /// Length of the middle line from gate `i` to the next.
    pub(super) fn step(&self, i: usize) -> f64 {
        self.middle(i).distance(self.middle(i + 1))
    }

    pub(super) fn length(&self) -> f64 {
        (0..self.areas.len()).map(|i| self.step(i)).sum()
    }

    /// The thickness between gates, each averaged over about `window` mm of the chain: area by
    /// length, so that the area stays.
    pub(super) fn smooth_thickness(&self, window: f64) -> Vec<f64> {
        let n = self.areas.len();
        let mut along = Vec::with_capacity(n + 1);
        let mut filled = Vec::with_capacity(n + 1);
        let (mut length, mut area) = (0.0, 0.0);
        for i in 0..n {
            along.push(length);
            filled.push(area);
            length += self.step(i);
            area += self.areas[i];
        }
        along.push(length);
        filled.push(area);
        let mut out = Vec::with_capacity(n);
        let (mut low, mut high) = (0, 0);
        for i in 0..n {
            let middle = 0.5 * (along[i] + along[i + 1]);
            // The window shrinks towards the ends, so that it stays centred on the step.
            let reach = (0.5 * window).min(middle).min(length - middle);
            while low < i && along[low] < middle - reach {
                low += 1;
            }
            high = high.max(i + 1);
            while high < n && along[high] < middle + reach {
                high += 1;
            }
            let span = along[high] - along[low];
            out.push(if span > 1e-9 { (filled[high] - filled[low]) / span } else { 0.0 });
        }
        out
    }

    /// The points at a share of the way across, from the right, of gates `from..=to`.
    pub(super) fn line(
        &self,
        share: f64,
        from: usize,
        to: usize,
    ) -> impl Iterator<Item = Point2> + '_ {
        self.gates[from..=to].iter().map(move |&(r, l)| r + (l - r) * share)
    }
}

/// Splits a mesh into chains, the spurs into corners cut off. At free ends they lead to the very
/// end, or stop half the thickness before it.
pub(super) fn chains(mesh: Mesh, to_the_end: bool) -> Vec<Chain> {
    let mut graph = Graph::new(mesh, to_the_end);
    graph.prune();
    graph.chains()
}

struct Graph {
    mesh: Mesh,
    to_the_end: bool,
    alive: Vec<bool>,
    degree: Vec<u8>,
    /// Area of each triangle, with that of the spurs cut off at it.
    areas: Vec<f64>,
    seen: Vec<bool>,
}

impl Graph {
    fn new(mesh: Mesh, to_the_end: bool) -> Self {
        let count = |t: &super::mesh::Triangle| t.across.iter().filter(|&&n| n != BORDER).count();
        let degree = mesh.triangles.iter().map(|t| count(t) as u8).collect();
        let areas = mesh.triangles.iter().map(super::mesh::Triangle::area).collect();
        let n = mesh.triangles.len();
        let (alive, seen) = (vec![true; n], vec![false; n]);
        Self { mesh, to_the_end, alive, degree, areas, seen }
    }

    /// The living triangle after `at`, coming from `before`, with the edge to it.
    fn next(&self, at: u32, before: u32) -> Option<(usize, u32)> {
        let triangle = &self.mesh.triangles[at as usize];
        (0..3)
            .map(|e| (e, triangle.across[e]))
            .find(|&(_, n)| n != BORDER && n != before && self.alive[n as usize])
    }

    /// Cuts off branches no longer than the region is thick where they leave it: they lead into
    /// corners, and the bead fills those anyway.
    fn prune(&mut self) {
        for _ in 0..8 {
            let mut changed = false;
            for leaf in 0..self.mesh.triangles.len() as u32 {
                if self.alive[leaf as usize] && self.degree[leaf as usize] == 1 {
                    changed |= self.prune_from(leaf);
                }
            }
            if !changed {
                break;
            }
        }
    }

    fn prune_from(&mut self, leaf: u32) -> bool {
        let mut branch = vec![leaf];
        let (mut before, mut at) = (BORDER, leaf);
        let mut tip = None;
        let mut area = self.areas[leaf as usize];
        loop {
            let Some((edge, next)) = self.next(at, before) else { return false };
            let corners = &self.mesh.triangles[at as usize].corners;
            let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
            let tip = *tip.get_or_insert(corners[(edge + 2) % 3]);
            let reach = tip.distance((a + b) * 0.5);
            if self.degree[next as usize] == 3 {
                if reach > 1.2 * a.distance(b) {
                    return false;
                }
                self.degree[next as usize] = 2;
                self.areas[next as usize] += area;
                branch.iter().for_each(|&t| self.alive[t as usize] = false);
                return true;
            }
            if self.degree[next as usize] != 2 || branch.len() > 64 {
                return false;
            }
            branch.push(next);
            area += self.areas[next as usize];
            (before, at) = (at, next);
        }
    }

    fn chains(&mut self) -> Vec<Chain> {
        let mut out = Vec::new();
        let n = self.mesh.triangles.len() as u32;
        // Ends and forks first, then what is left: rings without either.
        for start in 0..n {
            if !self.alive[start as usize] || self.degree[start as usize] == 2 {
                continue;
            }
            for edge in 0..3 {
                let next = self.mesh.triangles[start as usize].across[edge];
                if next == BORDER || !self.alive[next as usize] || self.seen[next as usize] {
                    continue;
                }
                // A stretch between two neighbouring forks has no triangle to mark as seen.
                if self.degree[next as usize] != 2 && next < start {
                    continue;
                }
                out.push(self.walk(start, edge));
            }
        }
        for start in 0..n {
            let free = self.alive[start as usize] && !self.seen[start as usize];
            if free
                && self.degree[start as usize] == 2
                && let Some((edge, _)) = self.next(start, BORDER)
            {
                self.seen[start as usize] = true;
                out.push(self.walk(start, edge));
            }
        }
        out
    }

    /// Follows the gates from a triangle over one of its edges to the next end, fork, or itself.
    fn walk(&mut self, start: u32, edge: usize) -> Chain {
        let mut chain = Chain { gates: Vec::new(), areas: Vec::new(), closed: false };
        let (mut at, mut edge) = (start, edge);
        self.open_fork(start, edge, &mut chain);
        loop {
            let triangle = &self.mesh.triangles[at as usize];
            chain.gates.push((triangle.corners[edge], triangle.corners[(edge + 1) % 3]));
            let next = triangle.across[edge];
            if next == start && self.degree[start as usize] == 2 {
                // Round: the start's own area closes the ring.
                chain.areas.push(self.areas[start as usize]);
                chain.gates.push(chain.gates[0]);
                chain.closed = true;
                return chain;
            }
            if self.degree[next as usize] != 2 || self.seen[next as usize] {
                self.close_end(next, &mut chain);
                if self.degree[start as usize] == 1 {
                    self.open_end(start, &mut chain);
                }
                return chain;
            }
            self.seen[next as usize] = true;
            chain.areas.push(self.areas[next as usize]);
            let Some((onward, _)) = self.next(next, at) else { return chain };
            (at, edge) = (next, onward);
        }
    }

    /// Begins a chain at a fork.
    fn open_fork(&self, start: u32, edge: usize, chain: &mut Chain) {
        let triangle = &self.mesh.triangles[start as usize];
        let (right, left) = (triangle.corners[edge], triangle.corners[(edge + 1) % 3]);
        if self.degree[start as usize] == 3 {
            let (gate, area) = self.fork_gate(start, right, left);
            chain.gates.push(gate);
            chain.areas.push(area);
        }
    }

    /// Leads a chain to the fork or the free end after its last gate.
    fn close_end(&self, end: u32, chain: &mut Chain) {
        let Some(&(right, left)) = chain.gates.last() else { return };
        let found = if self.degree[end as usize] == 3 {
            Some(self.fork_gate(end, right, left))
        } else {
            let before = chain.gates.len().checked_sub(2).map(|i| chain.middle(i));
            self.free_gate(end, right, left, before)
        };
        if let Some((gate, area)) = found {
            chain.gates.push(gate);
            chain.areas.push(area);
        }
    }

    /// Leads a chain to the free end before its first gate.
    fn open_end(&self, start: u32, chain: &mut Chain) {
        let Some(&(right, left)) = chain.gates.first() else { return };
        let after = (chain.gates.len() > 1).then(|| chain.middle(1));
        // Seen the other way, left and right change places.
        if let Some(((left, right), area)) = self.free_gate(start, left, right, after) {
            chain.gates.insert(0, (right, left));
            chain.areas.insert(0, area);
        }
    }

    /// The gate in the middle of a fork, and the area up to it.
    fn fork_gate(&self, fork: u32, right: Point2, left: Point2) -> ((Point2, Point2), f64) {
        let shift = self.mesh.triangles[fork as usize].center() - (right + left) * 0.5;
        ((right + shift, left + shift), self.areas[fork as usize] / 3.0)
    }

    /// The gate at a free end, and the area up to it, seen from the last gate; `before` is the
    /// middle of the one before that.
    fn free_gate(
        &self,
        end: u32,
        right: Point2,
        left: Point2,
        before: Option<Point2>,
    ) -> Option<((Point2, Point2), f64)> {
        let triangle = &self.mesh.triangles[end as usize];
        let &tip = triangle.corners.iter().find(|&&c| c != right && c != left)?;
        let (across, middle) = (right.distance(left), (right + left) * 0.5);
        let area = self.areas[end as usize];
        let (to_right, to_left) = ((right - tip).try_normalize()?, (left - tip).try_normalize()?);
        let (gate, area) = if to_right.dot(to_left) < POINTED {
            // A blunt end: one of the two edges beyond the gate is a side, the other the end.
            let ends_right = match before {
                Some(before) => {
                    let ahead = middle - before;
                    to_right.dot(ahead).abs() < to_left.dot(ahead).abs()
                }
                None => tip.distance_squared(right) < tip.distance_squared(left),
            };
            (if ends_right { (right, tip) } else { (tip, left) }, area)
        } else {
            let height = 2.0 * triangle.area() / across.max(1e-9);
            let depth = (area / across.max(1e-9)).min(height);
            let shift = (tip - middle).normalize_or_zero() * depth;
            ((right + shift, left + shift), across * depth)
        };
        if self.to_the_end {
            return Some((gate, area));
        }
        let length = middle.distance((gate.0 + gate.1) * 0.5);
        let thickness = gate.0.distance(gate.1);
        let share = 1.0 - 0.5 * thickness / length.max(1e-9);
        let part = |from: Point2, to: Point2| from + (to - from) * share;
        let worth = share * length >= 0.1 * thickness;
        worth.then(|| ((part(right, gate.0), part(left, gate.1)), area * share))
    }
}
