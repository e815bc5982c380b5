//! Moves.

use fgm_core::{Point2, Point3, bead};
use fgm_gcode::Command;

use super::{
    Follower, GREATEST,
    arc::{self, Center},
};
use crate::{Bead, Event, FaultKind, Travel};

/// Beads with this much filament still pulled back count as printed while retracted, mm.
const RETRACTED: f64 = 0.05;
/// Beads this much shorter than their section's width say nothing about it, mm.
const SHORTEST: f64 = 0.05;
/// Room beside the bed that rounding may take, mm.
const SLACK: f64 = 1e-6;

/// The words of a move.
#[derive(Clone, Copy, Debug, Default)]
struct Words {
    to: [Option<f64>; 3],
    e: Option<f64>,
    center: [Option<f64>; 2],
    radius: Option<f64>,
}

impl Follower {
    /// `G0`, `G1`.
    #[inline]
    pub(super) fn linear(&mut self, command: &Command<'_>) {
        let Some(words) = self.words(command) else { return };
        let from = self.place.at;
        let was_known = self.place.plane_known();
        let to = self.go(&words);
        let fed = words.e.map_or(0.0, |e| self.feed(e));
        self.piece(from, to, fed, was_known);
    }

    /// `G2`, `G3`.
    pub(super) fn arc(&mut self, command: &Command<'_>, clockwise: bool) {
        let Some(words) = self.words(command) else { return };
        let from = self.place.at;
        let was_known = self.place.plane_known();
        let to = self.go(&words);
        let fed = words.e.map_or(0.0, |e| self.feed(e));
        let center = match (words.radius, words.center) {
            (Some(radius), _) => Center::Radius(radius * self.place.unit),
            (None, [None, None]) => Center::Radius(0.0),
            (None, [i, j]) => {
                Center::Offset(Point2::new(i.unwrap_or(0.0), j.unwrap_or(0.0)) * self.place.unit)
            }
        };
        let Some(chords) = arc::chords(from, to, center, clockwise, self.arc_tolerance) else {
            self.bad_number(command);
            return self.piece(from, to, fed, was_known);
        };
        let ends: Vec<Point3> = chords.collect();
        let begins = || std::iter::once(from).chain(ends.iter().copied());
        let whole: f64 = begins().zip(&ends).map(|(a, b)| a.distance(*b)).sum();
        for (a, b) in begins().zip(&ends) {
            let share = if whole > 0.0 { a.distance(*b) / whole } else { 0.0 };
            self.piece(a, *b, fed * share, was_known);
        }
    }

    /// Takes the numbers of a move; none, and a fault, where one of them is no number.
    #[inline]
    fn words(&mut self, command: &Command<'_>) -> Option<Words> {
        let mut words = Words::default();
        let mut wrong = false;
        for word in command.words() {
            let slot = match word.letter {
                letter @ b'X'..=b'Z' => &mut words.to[usize::from(letter - b'X')],
                b'E' => &mut words.e,
                b'F' => {
                    match word.value.filter(|f| (0.0..=GREATEST * 60.0).contains(f)) {
                        Some(f) if f > 0.0 => self.place.speed = f * self.place.unit / 60.0,
                        Some(_) => {}
                        None => wrong = true,
                    }
                    continue;
                }
                b'I' => &mut words.center[0],
                b'J' => &mut words.center[1],
                b'R' => &mut words.radius,
                // Laser power, homing and other axes say nothing about the bead.
                b'S' | b'P' | b'H' | b'U' | b'V' | b'W' | b'A' | b'B' | b'C' | b'D' | b'K' => {
                    wrong |= word.value.is_none();
                    continue;
                }
                _ => {
                    wrong = true;
                    continue;
                }
            };
            match word.value.filter(|v| v.abs() <= GREATEST) {
                Some(value) => *slot = Some(value),
                None => wrong = true,
            }
        }
        if wrong {
            self.bad_number(command);
            return None;
        }
        Some(words)
    }

    /// Moves the nozzle; where to.
    #[inline]
    fn go(&mut self, words: &Words) -> Point3 {
        let mut outside = None;
        for (axis, value) in words.to.into_iter().enumerate() {
            let Some(value) = value else { continue };
            let to = self.place.target(axis, value);
            self.place.at[axis] = to;
            // Relative to an unknown place is an unknown place.
            self.place.known[axis] |= self.place.absolute;
            if let Some(bed) = &self.machine.bed
                && !(bed.min[axis] - SLACK..=bed.max[axis] + SLACK).contains(&to)
                && self.place.known[axis]
            {
                outside = Some((axis, to, to.clamp(bed.min[axis], bed.max[axis])));
            }
        }
        if let Some((axis, at, limit)) = outside {
            let axis = char::from(b"XYZ"[axis]);
            self.fault(FaultKind::OutsideBed, || {
                format!("{axis} = {at:.3}, {:.3} mm beyond {limit:.3}", (at - limit).abs())
            });
        }
        self.place.at
    }

    /// Moves the filament, mm.
    #[inline]
    fn feed(&mut self, e: f64) -> f64 {
        self.place.feed(e) * self.heads.now().flow
    }

    /// Tells what a straight piece of a move does.
    #[inline]
    fn piece(&mut self, from: Point3, to: Point3, fed: f64, known: bool) {
        self.begin_layer();
        let length = from.distance(to);
        let way = if length > 0.0 { length } else { fed.abs() };
        let seconds = way / (self.place.speed * self.speed_factor);
        let retracted = self.heads.now().retracted();
        let out = if fed == 0.0 { 0.0 } else { self.heads.now().feed(fed) };
        if fed <= 0.0 {
            if from.x != to.x || from.y != to.y || from.z != to.z {
                let line = self.line;
                self.out.push_back(Event::Travel(Travel { line, from, to, known, seconds }));
            } else if fed < 0.0 {
                self.out.push_back(Event::Pause { seconds, filament: fed });
            }
            return;
        }
        self.check_hot();
        if length == 0.0 && out <= 0.0 {
            self.out.push_back(Event::Pause { seconds, filament: fed });
            return;
        }
        if length > 0.0 && retracted > RETRACTED {
            self.fault(FaultKind::Retracted, || format!("by {retracted:.3} mm of filament"));
        }
        self.push_bead(from, to, out * self.area, seconds);
    }

    #[inline]
    fn push_bead(&mut self, from: Point3, to: Point3, fed: f64, seconds: f64) {
        let length = from.distance(to);
        let height = if length > 0.0 { self.bead_height(to.z) } else { 0.0 };
        let area = if length > 0.0 { fed / length } else { 0.0 };
        if let Some(limit) = self.machine.max_bead_area.filter(|limit| area > limit * 1.02)
            && length > SHORTEST
        {
            self.fault(FaultKind::BeadTooLarge, || {
                format!("{area:.4} mm2 of filament a mm, more than {limit}")
            });
        }
        let Some(mixture) = self.mixture() else {
            self.fault(FaultKind::NoMixture, || "every motor's weight is 0".into());
            return;
        };
        let head = self.heads.active();
        self.count_change(head, &mixture);
        let tagged = self.bead.width.filter(|_| length > 0.0);
        let bead = Bead {
            line: self.line,
            layer: self.layers.now,
            from,
            to,
            fed,
            height,
            width: tagged.unwrap_or_else(|| bead::width(area, height)),
            role: self.bead.role,
            head,
            mixture,
            celsius: self.heads.now().celsius,
            seconds,
        };
        debug_assert!(bead::area(bead.width, height) >= 0.0, "{bead:?}");
        self.out.push_back(Event::Bead(bead));
    }

    #[inline]
    fn check_hot(&mut self) {
        let least = self.machine.least_celsius;
        let cold = self.heads.now().celsius.filter(|celsius| *celsius < least);
        if let Some(celsius) = cold.filter(|_| !self.cold_allowed) {
            self.fault(FaultKind::Cold, || format!("at {celsius} °C, below {least} °C"));
        }
    }
}
