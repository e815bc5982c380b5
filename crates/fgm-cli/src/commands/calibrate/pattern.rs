//! The motions of calibration prints, around the origin.

use fgm::core::{ColorId, Motion, Point2, Role, bead};

/// Beads of one section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Section {
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Section {
    /// mm³ a mm.
    pub(super) fn area(self) -> f64 {
        bead::area(self.width, self.height)
    }

    /// From line to line where they fill a layer, mm.
    pub(super) fn spacing(self) -> f64 {
        bead::spacing(self.width, self.height)
    }

    fn layer(self, index: u32) -> Motion {
        let z = self.height * f64::from(index + 1);
        Motion::Layer { index, z, height: self.height }
    }

    fn extrude(self, x: f64, y: f64) -> Motion {
        Motion::Extrude { to: Point2::new(x, y), width: self.width, role: Role::SolidInfill }
    }
}

fn travel(x: f64, y: f64) -> Motion {
    Motion::Travel { to: Point2::new(x, y) }
}

/// Room between a print and its ruler, mm, and the lengths of the ruler's marks.
const GAP: f64 = 2.0;
const MARKS: [f64; 3] = [2.0, 4.0, 7.0];

/// Ruler marks along x below `y`, every `step` mm to both sides of `zero`: each fifth is longer,
/// that at `zero` and each tenth longest.
fn ruler(
    section: Section,
    (zero, y): (f64, f64),
    (from, to): (f64, f64),
    step: f64,
    out: &mut Vec<Motion>,
) {
    let (first, last) = ((from - zero) / step, (to - zero) / step);
    for mark in first.ceil() as i64..=last.floor() as i64 {
        let length = match mark {
            m if m % 10 == 0 => MARKS[2],
            m if m % 5 == 0 => MARKS[1],
            _ => MARKS[0],
        };
        let x = zero + mark as f64 * step;
        out.extend([travel(x, y - length), section.extrude(x, y)]);
    }
}

/// A plate of lines back and forth along y, changing from colour 0 to 1 where the line in the
/// middle begins, with a ruler in mm from the middle along its lower edge. Gives the motions and
/// the middle's x.
pub(super) fn plate(section: Section, [width, depth]: [f64; 2]) -> (Vec<Motion>, f64) {
    let spacing = section.spacing();
    let half = ((0.5 * width / spacing).round() as i64).max(1);
    let edge = 0.5 * depth;
    // The change lies between two lines.
    let middle = 0.0;
    let mut out = vec![section.layer(0), Motion::Color(ColorId(0))];
    let step = if section.width < 0.7 { 1.0 } else { (2.0 * section.width).ceil() };
    let reach = half as f64 * spacing;
    ruler(section, (middle, -edge - GAP), (-reach, reach), step, &mut out);
    for line in -half..half {
        let x = (line as f64 + 0.5) * spacing;
        let side = if (line + half) % 2 == 0 { edge } else { -edge };
        if line == -half {
            out.push(travel(x, -side));
        } else {
            out.push(section.extrude(x, -side));
        }
        if line == 0 {
            out.push(Motion::Color(ColorId(1)));
        }
        out.push(section.extrude(x, side));
    }
    (out, middle)
}

/// Lines back and forth along x, `apart` mm from each other, that change between colours 0 and 1
/// in the middle of a line after every `room` mm³, with a ruler in cm from the middle. Gives the
/// motions and the numbers, from 1, of the lines with a change.
pub(super) fn lines(
    section: Section,
    length: f64,
    apart: f64,
    room: f64,
    changes: usize,
) -> (Vec<Motion>, Vec<usize>) {
    let each = ((room / section.area() / (length + apart)).ceil() as usize).max(1);
    let count = each * (changes + 1);
    let edge = 0.5 * length;
    let y = |line: usize| (line as f64 - 0.5 * (count - 1) as f64) * apart;
    let mut out = vec![section.layer(0), Motion::Color(ColorId(0))];
    ruler(section, (0.0, y(0) - GAP - section.width), (-edge, edge), 10.0, &mut out);
    let mut changed = Vec::new();
    for line in 0..count {
        let side = if line % 2 == 0 { edge } else { -edge };
        out.push(if line == 0 { travel(-side, y(0)) } else { section.extrude(-side, y(line)) });
        if line > 0 && line % each == 0 {
            changed.push(line + 1);
            out.push(section.extrude(0.0, y(line)));
            out.push(Motion::Color(ColorId((changed.len() % 2) as u16)));
        }
        out.push(section.extrude(side, y(line)));
    }
    (out, changed)
}

/// A square of one wall, `rungs` colours one above the other; each begins with a nose at a corner.
pub(super) fn ladder(section: Section, side: f64, rung: f64, rungs: u16) -> Vec<Motion> {
    let layers = ((rung / section.height).round() as u32).max(2);
    let edge = 0.5 * side;
    let nose = 4.0 * section.width;
    let mut out = Vec::new();
    for index in 0..layers * u32::from(rungs) {
        let color = (index / layers) as u16;
        out.extend([section.layer(index), Motion::Color(ColorId(color))]);
        let begins = index % layers == 0;
        let start = -edge - if begins { nose } else { 0.0 };
        out.push(travel(start, start));
        if begins {
            out.push(section.extrude(-edge, -edge));
        }
        for (x, y) in [(edge, -edge), (edge, edge), (-edge, edge), (-edge, -edge)] {
            out.push(section.extrude(x, y));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTION: Section = Section { width: 0.4, height: 0.2 };

    /// Extruded before and after the first change, the ruler left out, mm of bead.
    fn halves(motions: &[Motion]) -> (f64, f64) {
        let (mut at, mut sums, mut color) = (Point2::ZERO, [0.0; 2], 0);
        for motion in motions {
            match *motion {
                Motion::Travel { to } => at = to,
                Motion::Color(c) => color = c.index(),
                Motion::Extrude { to, .. } => {
                    if at.distance(to) > MARKS[2] + 1e-9 {
                        sums[color] += at.distance(to);
                    }
                    at = to;
                }
                _ => {}
            }
        }
        (sums[0], sums[1])
    }

    #[test]
    fn the_plate_changes_in_its_middle() {
        let (motions, middle) = plate(SECTION, [60.0, 40.0]);
        assert_eq!(middle, 0.0);
        let (before, after) = halves(&motions);
        assert!((before - after).abs() < 1e-6, "{before} {after}");
        assert!((before / 40.0 - (30.0 / SECTION.spacing()).round()).abs() < 1e-6);
    }

    #[test]
    fn the_lines_leave_room_for_each_change() {
        let (motions, changed) = lines(SECTION, 100.0, 1.2, 50.0, 2);
        assert_eq!(changed, [8, 15]);
        assert_eq!(motions.iter().filter(|m| matches!(m, Motion::Color(_))).count(), 3);
    }

    #[test]
    fn the_ladder_has_a_nose_for_each_rung() {
        let motions = ladder(SECTION, 20.0, 2.0, 3);
        let noses = |m: &&Motion| matches!(m, Motion::Travel { to } if to.x < -10.1);
        assert_eq!(motions.iter().filter(noses).count(), 3);
        assert_eq!(motions.iter().filter(|m| matches!(m, Motion::Layer { .. })).count(), 30);
    }
}
