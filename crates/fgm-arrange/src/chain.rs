use fgm_core::Point2;

/// A line to be arranged: open or closed, with a label that its edges keep.
///
/// Anything goes: repeated points, self-crossings, runs that fold back on themselves, overlaps
/// with other chains. A chain of fewer than two different points adds nothing.
#[derive(Clone, Copy, Debug)]
pub struct Chain<'a, L> {
    /// The points in order, mm.
    pub points: &'a [Point2],
    /// Whether the last point joins the first (which may but need not be repeated).
    pub closed: bool,
    /// What the edges made of this chain carry.
    pub label: L,
}

impl<'a, L> Chain<'a, L> {
    /// A line with two ends.
    pub const fn open(points: &'a [Point2], label: L) -> Self {
        Self { points, closed: false, label }
    }

    /// A ring.
    pub const fn closed(points: &'a [Point2], label: L) -> Self {
        Self { points, closed: true, label }
    }
}

/// How to arrange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrangeOptions {
    /// Step of the lattice that all vertices lie on, mm. Coordinates may reach 2^40 steps (1.0995
    /// million mm at the default of 1e-6 mm) from the origin.
    pub lattice: f64,
    /// Whether to keep edges with the same face on both sides: dangling ends, bridges between
    /// rings, lines that enclose nothing. They never show in polygons.
    pub keep_dangling: bool,
}

impl Default for ArrangeOptions {
    fn default() -> Self {
        Self { lattice: 1e-6, keep_dangling: false }
    }
}

impl ArrangeOptions {
    /// The same with another lattice step, mm.
    #[must_use]
    pub const fn with_lattice(mut self, step: f64) -> Self {
        self.lattice = step;
        self
    }

    /// The same with dangling edges kept or dropped.
    #[must_use]
    pub const fn with_dangling(mut self, keep: bool) -> Self {
        self.keep_dangling = keep;
        self
    }
}
