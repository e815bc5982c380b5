/// One process state of a printer, as an index into the palette: a mixture ratio, a toolhead, a
/// nozzle temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ColorId(pub u16);

impl ColorId {
    /// The index into the palette.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a region of a layer is printed with: one colour, or two in turn where a zipper overlaps.
///
/// The order of the two is the palette's: `first <= second`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Band {
    /// The colour, or the lower of the two.
    pub first: ColorId,
    /// The same as `first`, or the higher of the two.
    pub second: ColorId,
}

impl Band {
    /// A region of one colour.
    pub const fn pure(color: ColorId) -> Self {
        Self { first: color, second: color }
    }

    /// A region in which paths alternate between two colours; in either order.
    pub fn overlap(a: ColorId, b: ColorId) -> Self {
        Self { first: a.min(b), second: a.max(b) }
    }

    /// Whether the region has one colour only.
    pub fn is_pure(self) -> bool {
        self.first == self.second
    }

    /// The colour of the `turn`-th path through the region: even turns take the first.
    pub fn pick(self, turn: usize) -> ColorId {
        if turn.is_multiple_of(2) { self.first } else { self.second }
    }
}
