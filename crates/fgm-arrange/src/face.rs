use crate::rings::Rings;
use crate::{Arrangement, Border, Borders, FaceId, inside};
use fgm_core::{Point2, Polygon, Ring};

/// A bounded face: a region without edges in it (but for dangling ones, if kept).
#[derive(Debug)]
pub struct Face<'a, L> {
    pub(crate) arrangement: &'a Arrangement<L>,
    pub(crate) id: FaceId,
}

impl<L> Clone for Face<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for Face<'_, L> {}

impl<'a, L> Face<'a, L> {
    /// Its name.
    pub fn id(&self) -> FaceId {
        self.id
    }

    /// Area less the holes', mm²; summed exactly, rounded once.
    pub fn area(&self) -> f64 {
        let steps = self.arrangement.topology.faces[self.id.index()].area;
        self.arrangement.lattice.area(steps)
    }

    /// The outer border, with the face to the left: anticlockwise.
    pub fn outer(&self) -> Borders<'a, L> {
        Borders::new(self.arrangement, self.arrangement.topology.faces[self.id.index()].outer)
    }

    /// The borders of what lies inside, with the face to the left: clockwise. Where pieces inside
    /// touch each other they have one border.
    pub fn holes(&self) -> impl ExactSizeIterator<Item = Borders<'a, L>> + use<'a, L> {
        let arrangement = self.arrangement;
        self.hole_halves().iter().map(move |&half| Borders::new(arrangement, half))
    }

    /// All borders: which face lies beyond along which labels.
    pub fn neighbours(&self) -> impl Iterator<Item = Border<'a, L>> + use<'a, L> {
        self.outer().chain(self.holes().flatten())
    }

    fn hole_halves(&self) -> &'a [u32] {
        let topology = &self.arrangement.topology;
        let face = &topology.faces[self.id.index()];
        &topology.holes[face.holes_start as usize..face.holes_end as usize]
    }

    /// The rings, in lattice steps: the outer one first.
    pub(crate) fn rings(&self) -> Vec<Vec<Point2>> {
        let topology = &self.arrangement.topology;
        let mut rings = Rings::new(topology);
        rings.walk(topology.faces[self.id.index()].outer);
        for &half in self.hole_halves() {
            rings.walk(half);
        }
        rings.finish()
    }

    /// The face as rings: anticlockwise outside, clockwise holes.
    ///
    /// Rings are simple and repeat no point. Where a border touches itself in a vertex it becomes
    /// several rings, which share that vertex. Dangling edges do not show.
    pub fn polygon(&self) -> Polygon {
        let lattice = self.arrangement.lattice;
        let ring =
            |ring: Vec<Point2>| Ring::new(ring.into_iter().map(|p| lattice.unscaled(p)).collect());
        let mut rings = self.rings().into_iter().map(ring);
        let outer = rings.next().unwrap_or_default();
        Polygon { outer, holes: rings.collect() }
    }

    /// A point inside, well away from the border: the middle of the widest chord among some
    /// level lines through the face. It lies on no dangling edge either.
    ///
    /// It is strictly inside wherever the `f64` numbers between the borders allow it, that is
    /// unless the face is everywhere thinner than a few units in the last place of its coordinates
    /// (1e-14 mm at 100 mm). Costs time in proportion to the face's points.
    pub fn inside_point(&self) -> Point2 {
        let topology = &self.arrangement.topology;
        let record = &topology.faces[self.id.index()];
        let cycles = std::iter::once(&record.outer).chain(self.hole_halves());
        let halves = cycles.flat_map(|&half| topology.cycle(half));
        let lines: Vec<_> = halves.map(|half| topology.line(half as usize / 2)).collect();
        inside::point(&lines, record.area, &self.arrangement.lattice)
    }
}
