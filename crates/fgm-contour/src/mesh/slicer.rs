use super::chain::{Border, close};
use super::issues::MeshIssues;
use super::section::Section;
use super::shells::inverted;
use super::slabs::Slabs;
use super::topology::{OPEN, join_sides};
use super::union::{Meeting, unite};
use super::weld::{Welded, weld};
use crate::ContourError;
use fgm_core::{Bounds3, Point2, TriangleMesh};
use std::sync::Mutex;

/// Holes of up to this width in a mesh are closed without further ado, mm.
pub const DEFAULT_GAP: f64 = 0.1;

/// Cuts a triangle mesh with level planes, exactly: every vertex of a section lies on an edge of
/// the mesh, and a section costs by the triangles it cuts.
///
/// A vertex at the plane's very height counts as above it, which leaves no special case: sections
/// of a closed mesh are closed at every height, through vertices, edges and whole faces too.
/// Overlapping shells are united by the winding-number rule (nonzero). Can be shared by threads.
#[derive(Debug)]
pub struct MeshSlicer {
    mesh: Welded,
    mates: Vec<u32>,
    /// By triangle; empty where none is.
    inverted: Vec<bool>,
    slabs: Slabs,
    bounds: Bounds3,
    issues: MeshIssues,
    gap: f64,
    scratch: Mutex<Vec<Scratch>>,
}

/// Memory kept from one section to the next.
#[derive(Debug, Default)]
struct Scratch {
    /// Triangles that a section has been through are stamped with its number.
    stamps: Vec<u32>,
    epoch: u32,
    meeting: Meeting,
}

impl Scratch {
    fn begin(&mut self, triangles: usize) {
        if self.epoch == u32::MAX {
            self.stamps.fill(0);
            self.epoch = 0;
        }
        self.stamps.resize(triangles, 0);
        self.epoch += 1;
    }

    /// Stamps a triangle; answers whether it was not yet.
    fn visit(&mut self, triangle: usize) -> bool {
        std::mem::replace(&mut self.stamps[triangle], self.epoch) != self.epoch
    }
}

impl MeshSlicer {
    /// Prepares a mesh: joins vertices in the same place and finds each triangle's neighbours.
    ///
    /// # Errors
    /// [`ContourError`] for a triangle that names no vertex of the mesh or one that is not
    /// finite. Faults in the surface are no errors: see [`issues`](Self::issues).
    pub fn new(mesh: &TriangleMesh) -> Result<Self, ContourError> {
        let mut issues = MeshIssues::default();
        let welded = weld(mesh, &mut issues)?;
        let mates = join_sides(&welded, &mut issues);
        let inverted = inverted(&welded, &mates, &mut issues);
        let slabs = Slabs::new(&welded);
        let used = welded.triangles.iter().flatten().map(|&v| welded.vertices[v as usize]);
        let bounds = Bounds3::of(used);
        let scratch = Mutex::new(Vec::new());
        Ok(Self { mesh: welded, mates, inverted, slabs, bounds, issues, gap: DEFAULT_GAP, scratch })
    }

    /// The same with another greatest width of gaps to be closed, mm; below 0 or NaN counts as 0.
    #[must_use]
    pub fn with_gap(mut self, gap: f64) -> Self {
        self.gap = gap.max(0.0);
        self
    }

    /// What is wrong with the mesh.
    pub fn issues(&self) -> &MeshIssues {
        &self.issues
    }

    /// The least box around the triangles.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// What the plane at height `z` cuts out of the mesh: the part just below the plane where
    /// that makes a difference. Empty for a NaN.
    pub fn section(&self, z: f64) -> Section {
        let mut scratch = self.take_scratch();
        scratch.begin(self.mesh.triangles.len());
        let (mut closed, mut open) = (Vec::new(), Vec::new());
        for &t in self.slabs.at(z) {
            let t = t as usize;
            if let Some((down, up)) = self.cut(t, z)
                && scratch.visit(t)
            {
                self.follow(z, (3 * t + down, 3 * t + up), &mut scratch, &mut closed, &mut open);
            }
        }
        let mut section = Section::default();
        if !open.is_empty() {
            closed.extend(close(open, self.gap, &mut section.warnings));
        }
        let rings = closed.into_iter().filter_map(Border::into_ring).collect();
        section.polygons = unite(rings, &mut scratch.meeting);
        self.give_scratch(scratch);
        section
    }

    fn take_scratch(&self) -> Scratch {
        self.scratch.lock().ok().and_then(|mut pool| pool.pop()).unwrap_or_default()
    }

    fn give_scratch(&self, scratch: Scratch) {
        if let Ok(mut pool) = self.scratch.lock() {
            pool.push(scratch);
        }
    }

    /// The sides of a triangle by which its section comes in and goes out with the inside on its
    /// left: that which falls through the plane and that which rises.
    fn cut(&self, t: usize, z: f64) -> Option<(usize, usize)> {
        let above = self.mesh.triangles[t].map(|v| self.mesh.vertices[v as usize].z >= z);
        match above {
            [true, false, false] => Some((0, 2)),
            [false, true, false] => Some((1, 0)),
            [false, false, true] => Some((2, 1)),
            [false, true, true] => Some((2, 0)),
            [true, false, true] => Some((0, 1)),
            [true, true, false] => Some((1, 2)),
            _ => None,
        }
    }

    /// Walks the border through a triangle, forward and, if that ends in the open, backward.
    fn follow(
        &self,
        z: f64,
        (down, up): (usize, usize),
        scratch: &mut Scratch,
        closed: &mut Vec<Border>,
        open: &mut Vec<Border>,
    ) {
        let mut border = Border { points: vec![self.crossing(down, z)], votes: 0.0 };
        if self.walk(z, down, up, scratch, &mut border) {
            border.points.pop();
            closed.push(border);
            return;
        }
        border.points.reverse();
        border.votes = -border.votes;
        if self.mates[down] != OPEN {
            self.walk_on(z, down, scratch, &mut border);
        }
        border.points.reverse();
        border.votes = -border.votes;
        open.push(border);
    }

    /// From side to side; answers whether it came back to where it began.
    fn walk(
        &self,
        z: f64,
        start: usize,
        out: usize,
        scratch: &mut Scratch,
        border: &mut Border,
    ) -> bool {
        self.step(z, out, true, border);
        self.walk_on(z, out, scratch, border) == Some(start)
    }

    /// Goes on from a side already reached; answers the side at which it met its own start.
    fn walk_on(
        &self,
        z: f64,
        mut out: usize,
        scratch: &mut Scratch,
        border: &mut Border,
    ) -> Option<usize> {
        loop {
            let mate = self.mates[out];
            if mate == OPEN {
                return None;
            }
            let mate = mate as usize;
            let t = mate / 3;
            let (down, up) = self.cut(t, z)?;
            if !scratch.visit(t) {
                return Some(mate);
            }
            let inside_left = mate == 3 * t + down;
            out = 3 * t + if inside_left { up } else { down };
            self.step(z, out, inside_left, border);
        }
    }

    fn step(&self, z: f64, out: usize, inside_left: bool, border: &mut Border) {
        let point = self.crossing(out, z);
        let length = border.points.last().map_or(0.0, |p| p.distance(point));
        let inverted = self.inverted.get(out / 3) == Some(&true);
        border.votes += if inside_left != inverted { length } else { -length };
        border.points.push(point);
    }

    /// Where the plane cuts a side: always from its lower end to its upper, so that both
    /// triangles agree to the bit.
    fn crossing(&self, side: usize, z: f64) -> Point2 {
        let corners = self.mesh.triangles[side / 3];
        let [a, b] =
            [corners[side % 3], corners[(side + 1) % 3]].map(|v| self.mesh.vertices[v as usize]);
        let (low, high) = if a.z < b.z { (a, b) } else { (b, a) };
        let t = (z - low.z) / (high.z - low.z);
        if t < 1.0 { low.truncate() + (high - low).truncate() * t } else { high.truncate() }
    }
}
