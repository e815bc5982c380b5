//! Where the nozzle is.

use fgm_core::{Bounds3, Point3};

/// Position, and how coordinates are meant.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// On the bed, mm.
    pub(super) at: Point3,
    /// Whether x, y and z are known: not before homing, not after a macro.
    pub(super) known: [bool; 3],
    /// Position = coordinate of the program + this, from `G92`.
    shift: Point3,
    /// `G90` or `G91`.
    pub(super) absolute: bool,
    /// `M82` or `M83`.
    pub(super) absolute_e: bool,
    /// The coordinate of E, mm of filament.
    pub(super) e: f64,
    /// mm of a unit: 1, or 25.4 after `G20`.
    pub(super) unit: f64,
    /// mm/s.
    pub(super) speed: f64,
    home: Point3,
}

/// Speed before the first `F`, mm/s.
const FIRST_SPEED: f64 = 25.0;

impl Place {
    pub(super) fn new(bed: Option<&Bounds3>) -> Self {
        let home = bed.map_or(Point3::ZERO, |b| Point3::ZERO.clamp(b.min, b.max));
        Self {
            at: home,
            known: [false; 3],
            shift: Point3::ZERO,
            absolute: true,
            absolute_e: true,
            e: 0.0,
            unit: 1.0,
            speed: FIRST_SPEED,
            home,
        }
    }

    /// Where a coordinate of an axis lies on the bed.
    #[inline]
    pub(super) fn target(&self, axis: usize, value: f64) -> f64 {
        let value = value * self.unit;
        if self.absolute { value + self.shift[axis] } else { self.at[axis] + value }
    }

    /// By how much E moves, mm of filament.
    #[inline]
    pub(super) fn feed(&mut self, value: f64) -> f64 {
        let value = value * self.unit;
        let by = if self.absolute_e { value - self.e } else { value };
        self.e += by;
        by
    }

    /// `G92`: the axis is here called `value`.
    pub(super) fn call(&mut self, axis: usize, value: f64) {
        self.shift[axis] = self.at[axis] - value * self.unit;
    }

    /// `G92.1`.
    pub(super) fn uncall(&mut self) {
        self.shift = Point3::ZERO;
    }

    /// `G28`: the axes go home, wherever that is.
    pub(super) fn home(&mut self, axes: [bool; 3]) {
        let all = axes == [false; 3];
        for (axis, named) in axes.into_iter().enumerate() {
            if all || named {
                self.at[axis] = self.home[axis];
                self.shift[axis] = 0.0;
                self.known[axis] = false;
            }
        }
    }

    /// Whether the place in the plane is known.
    #[inline]
    pub(super) fn plane_known(&self) -> bool {
        self.known[0] && self.known[1]
    }
}
