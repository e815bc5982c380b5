/// A closed range of numbers `[lo, hi]`, used to bound a field over a box.
///
/// A bound that is not known is [`Interval::EVERYTHING`]; a field that may be NaN somewhere in the
/// box must answer that too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Least value.
    pub lo: f64,
    /// Greatest value.
    pub hi: f64,
}

impl Interval {
    /// All numbers: nothing is known.
    pub const EVERYTHING: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// The range between two numbers given in order.
    pub const fn new(lo: f64, hi: f64) -> Self {
        Self { lo, hi }
    }

    /// A single number.
    pub const fn point(value: f64) -> Self {
        Self { lo: value, hi: value }
    }

    /// Whether `value` lies inside or at an end.
    pub fn contains(&self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// `hi - lo`.
    pub fn width(&self) -> f64 {
        self.hi - self.lo
    }

    /// The least range around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }
}
