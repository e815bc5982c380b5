//! Parallel scan lines through a region, and where they enter and leave it.

use fgm_core::{Point2, Polygon, Ring};

/// Parallel lines: `v = phase + i * pitch` in axes turned by `angle`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// Of the lines, radians from +x.
    pub(super) angle: f64,
    /// Between lines, mm.
    pub(super) pitch: f64,
    /// Of line 0, mm.
    pub(super) phase: f64,
}

/// Where a scan line meets a border, or ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The line.
    pub(super) line: i64,
    /// Along the line.
    pub(super) u: f64,
    /// The ring, counted over the whole region, or [`Crossing::INSIDE`].
    pub(super) ring: u32,
    /// Along the ring: the edge's index, and the share of the edge.
    pub(super) at: f64,
}

impl Crossing {
    /// In place of a ring where a line ends inside the region.
    pub(super) const INSIDE: u32 = u32::MAX;

    /// Whether it lies on a border, rather than being the end of a line inside.
    pub(super) fn is_on_border(&self) -> bool {
        self.ring != Self::INSIDE
    }
}

impl Lattice {
    /// The lines' direction; its left normal is the way the lines follow each other.
    pub(super) fn axis(&self) -> Point2 {
        Point2::from_angle(self.angle)
    }

    /// Across the lines.
    pub(super) fn v(&self, line: i64) -> f64 {
        self.phase + line as f64 * self.pitch
    }

    /// Back from the turned axes.
    pub(super) fn point(&self, crossing: &Crossing) -> Point2 {
        self.axis().rotate(Point2::new(crossing.u, self.v(crossing.line)))
    }

    /// All crossings with these rings, in order of line and then along it: an even number on
    /// every line, of which the pairs are inside.
    pub(super) fn crossings<'a>(&self, rings: impl Iterator<Item = &'a Ring>) -> Vec<Crossing> {
        let turn = self.axis() * Point2::new(1.0, -1.0);
        let index = |v: f64| (v - self.phase) / self.pitch;
        let mut out = Vec::new();
        for (ring, number) in rings.zip(0u32..) {
            for (edge, (a, b)) in ring.edges().enumerate() {
                let (a, b) = (turn.rotate(a), turn.rotate(b));
                let (low, high) = if a.y <= b.y { (a.y, b.y) } else { (b.y, a.y) };
                // A line through a corner belongs to the edge that rises from it.
                let (first, end) = (index(low).ceil(), index(high).ceil());
                let mut line = first as i64;
                while (line as f64) < end {
                    let share = ((self.v(line) - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
                    let u = a.x + (b.x - a.x) * share;
                    // Below the next whole number, so that crossings stay in order on the ring.
                    let at = edge as f64 + share.min(1.0 - 1e-9);
                    out.push(Crossing { line, u, ring: number, at });
                    line += 1;
                }
            }
        }
        out.sort_unstable_by(|a, b| {
            let place = |c: &Crossing| (c.line, c.ring);
            a.line.cmp(&b.line).then(a.u.total_cmp(&b.u)).then(place(a).cmp(&place(b)))
        });
        out
    }
}

/// The least and greatest distance of a polygon across lines of this direction.
pub(super) fn extent(polygon: &Polygon, angle: f64) -> (f64, f64) {
    let across = Point2::from_angle(angle).perp();
    let values = polygon.outer.points.iter().map(|p| p.dot(across));
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}
