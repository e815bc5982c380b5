/// The heights at which the material along a path is looked up, mm: they change evenly with its
/// length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Heights {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Heights {
    /// One height all along.
    pub(crate) fn flat(z: f64) -> Self {
        Self { from: z, to: z }
    }

    pub(crate) fn is_flat(&self) -> bool {
        self.from == self.to
    }

    /// The height at a share of the length.
    pub(crate) fn at(&self, share: f64) -> f64 {
        if self.is_flat() { self.from } else { self.from + (self.to - self.from) * share }
    }
}
