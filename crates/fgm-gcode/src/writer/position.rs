use fgm_core::{Bounds3, Climb, Point2, Point3};

use crate::{Fixed, GcodeError, lines};

/// Where the nozzle is, and whether it may go somewhere.
#[derive(Clone, Debug)]
pub(super) struct Position {
    bed: Bounds3,
    offset: Point3,
    /// On the bed, not rounded; none before the first position is known.
    pub(super) at: Option<Point2>,
    /// As last written; none where a change of heads or a template left it unknown.
    pub(super) x: Option<Fixed<3>>,
    pub(super) y: Option<Fixed<3>>,
    pub(super) z: Option<Fixed<3>>,
    /// Where the last written move in the plane ended; kept where the place is lost.
    pub(super) written: Option<Point2>,
    /// Height of the layer's beads, on the bed.
    pub(super) layer_z: Fixed<3>,
    /// Height of the beads where the last one written ended, on the bed: below the layer's while
    /// it rises.
    pub(super) bead_z: Fixed<3>,
    /// The same in the design's coordinates, not rounded.
    pub(super) climb: Climb,
    /// The highest z written.
    pub(super) max_z: Fixed<3>,
    pub(super) feedrate: u32,
}

impl Position {
    pub(super) fn new(bed: Bounds3, offset: Point3) -> Self {
        Self {
            bed,
            offset,
            at: None,
            x: None,
            y: None,
            z: None,
            written: None,
            layer_z: Fixed::default(),
            bead_z: Fixed::default(),
            climb: Climb::default(),
            max_z: Fixed::default(),
            feedrate: 0,
        }
    }

    /// A design position on the bed, where it is inside the machine.
    #[inline]
    pub(super) fn place(&self, design: Point2) -> Result<Point2, GcodeError> {
        let p = design + self.offset.truncate();
        let (min, max) = (self.bed.min, self.bed.max);
        // NaN fails every comparison, and is told apart below.
        if p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y {
            return Ok(p);
        }
        self.inside(p.extend(self.layer_z.value())).and(Ok(p))
    }

    /// A layer's height on the bed, where it is inside the machine.
    pub(super) fn place_z(&self, z: f64) -> Result<Fixed<3>, GcodeError> {
        // Of the plane nothing is known yet: a template may have left the nozzle beside the bed.
        let plane = self.at.unwrap_or_else(|| self.bed.center().truncate());
        let plane = plane.clamp(self.bed.min.truncate(), self.bed.max.truncate());
        let position = plane.extend(z + self.offset.z);
        self.inside(position)?;
        Fixed::round(position.z)
    }

    /// The highest allowed z that is not above `z`.
    pub(super) fn clamp_z(&self, z: f64) -> f64 {
        z.min(self.bed.max.z)
    }

    pub(super) fn bed(&self) -> &Bounds3 {
        &self.bed
    }

    /// Where the coordinates may differ from a limit by rounding only.
    fn inside(&self, position: Point3) -> Result<(), GcodeError> {
        for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            let (at, least, most) = (position[axis], self.bed.min[axis], self.bed.max[axis]);
            if !at.is_finite() {
                return Err(GcodeError::NotANumber { value: at });
            }
            let limit = at.clamp(least, most);
            let over = (at - limit).abs();
            if over > 1e-9 {
                return Err(GcodeError::OutsideBed { axis: letter, at, over, limit, position });
            }
        }
        Ok(())
    }

    /// Follows the moves of a template, so that the print knows where they end.
    pub(super) fn follow(&mut self, text: &[u8]) -> Result<(), GcodeError> {
        let mut relative = false;
        let mut now = [None, None, None];
        for command in lines(text).filter_map(|line| line.command) {
            if command.is(b'G', 28) {
                now = [None; 3];
            } else if command.is(b'G', 90) || command.is(b'G', 91) {
                relative = command.is(b'G', 91);
            } else if command.is(b'G', 0) || command.is(b'G', 1) {
                for word in command.words() {
                    let Some(axis) = b"XYZ".iter().position(|l| *l == word.letter) else {
                        continue;
                    };
                    now[axis] = match (relative, now[axis], word.value) {
                        (true, Some(old), Some(by)) => Some(old + by),
                        (true, ..) => None,
                        (false, _, value) => value,
                    };
                }
            } else if matches!(command.code, crate::Code::Name(_)) {
                // A macro may go anywhere.
                now = [None; 3];
            }
        }
        let round = |value: Option<f64>| value.map(Fixed::round).transpose();
        (self.x, self.y, self.z) = (round(now[0])?, round(now[1])?, round(now[2])?);
        self.at = now[0].zip(now[1]).map(|(x, y)| Point2::new(x, y));
        self.written = self.at;
        self.feedrate = 0;
        Ok(())
    }

    /// A change of heads leaves the nozzle somewhere.
    pub(super) fn lose(&mut self) {
        (self.x, self.y, self.z, self.feedrate) = (None, None, None, 0);
    }
}
