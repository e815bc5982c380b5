//! The moving average of eq. 8-10, over extruded volume.

use std::collections::VecDeque;

use fgm_core::MAX_MATERIALS;

use crate::Transition;

/// Fractions, or a temperature in the first place.
pub(super) type Values = [f64; MAX_MATERIALS];

/// A transition no longer than this is a sharp change, mm³.
const SHARP: f64 = 1e-6;

/// A stretch of one command.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Volume extruded when it was given, mm³.
    start: f64,
    values: Values,
    /// Integral of all commands up to its start.
    integral: Values,
}

/// What was commanded over the last `delay + length` mm³, and its mean at the nozzle's tip.
///
/// Holds one entry for each change of command in that window. Every step costs the same.
#[derive(Clone, Debug)]
pub(super) struct Window {
    transition: Transition,
    stretches: VecDeque<Stretch>,
    /// Extruded so far, mm³.
    volume: f64,
    /// The stretch that comes out last, with everything before it in front: the one at
    /// `volume - delay`. The first one is that at `volume - delay - length`.
    late: usize,
}

impl Window {
    pub(super) fn new(transition: &Transition) -> Self {
        let length = if transition.length > SHARP { transition.length } else { 0.0 };
        let transition = Transition { delay: transition.delay.max(0.0), length };
        Self { transition, stretches: VecDeque::new(), volume: 0.0, late: 0 }
    }

    /// The machine is told something else. What is told first fills the nozzle.
    #[inline]
    pub(super) fn command(&mut self, values: &Values) {
        let Some(last) = self.stretches.back_mut() else {
            let (start, integral) = (f64::NEG_INFINITY, [0.0; MAX_MATERIALS]);
            self.stretches.push_back(Stretch { start, values: *values, integral });
            return;
        };
        if last.values == *values {
            return;
        }
        if last.start == self.volume || self.volume == 0.0 {
            // Nothing came out under the last command.
            last.values = *values;
            return;
        }
        // Integrals count from the volume 0 on.
        let since = self.volume - last.start.max(0.0);
        let mut integral = last.integral;
        for (sum, value) in integral.iter_mut().zip(&last.values) {
            *sum += value * since;
        }
        self.stretches.push_back(Stretch { start: self.volume, values: *values, integral });
        self.settle();
    }

    /// How much can be extruded until the tip's composition takes another course, mm³; infinite
    /// where no change is on its way.
    #[inline]
    pub(super) fn until_break(&self) -> f64 {
        let due = |next: usize, behind: f64| {
            self.stretches.get(next).map_or(f64::INFINITY, |s| s.start + behind - self.volume)
        };
        let Transition { delay, length } = self.transition;
        due(self.late + 1, delay).min(if length > 0.0 {
            due(1, delay + length)
        } else {
            f64::INFINITY
        })
    }

    /// Whether the tip's composition does not change before the next break.
    #[inline]
    pub(super) fn is_steady(&self) -> bool {
        self.late == 0
    }

    /// The composition at the tip after `ahead` mm³ more, which is not beyond the next break.
    pub(super) fn at(&self, ahead: f64) -> Values {
        let Some(late) = self.stretches.get(self.late) else { return [0.0; MAX_MATERIALS] };
        if self.late == 0 {
            return late.values;
        }
        let Transition { delay, length } = self.transition;
        let (from, to) = (self.volume + ahead - delay - length, self.volume + ahead - delay);
        let early = &self.stretches[0];
        std::array::from_fn(|i| {
            let upto = |s: &Stretch, v: f64| s.integral[i] + s.values[i] * (v - s.start.max(0.0));
            (upto(late, to) - upto(early, from)) / length
        })
    }

    /// So much came out.
    #[inline]
    pub(super) fn extrude(&mut self, volume: f64) {
        self.volume += volume;
        self.settle();
    }

    /// Takes the step to the next break exactly, whatever the rounding.
    pub(super) fn extrude_to_break(&mut self) {
        let by = self.until_break();
        if !by.is_finite() {
            return;
        }
        self.volume += by.max(0.0);
        let before = (self.late, self.stretches.len());
        self.settle();
        if before == (self.late, self.stretches.len()) {
            // The sum fell short of the break by its last digit.
            self.volume = self.volume.next_up();
            self.settle();
        }
    }

    /// Lets go of what has come out.
    #[inline]
    fn settle(&mut self) {
        let Transition { delay, length } = self.transition;
        while self.stretches.get(self.late + 1).is_some_and(|s| s.start + delay <= self.volume) {
            self.late += 1;
        }
        let behind = delay + length;
        while self.late > 0
            && self.stretches.get(1).is_some_and(|s| s.start + behind <= self.volume)
        {
            self.stretches.pop_front();
            self.late -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn one(value: f64) -> Values {
        let mut values = [0.0; MAX_MATERIALS];
        values[0] = value;
        values
    }

    #[test]
    fn a_change_waits_and_then_ramps() {
        let mut window = Window::new(&Transition { delay: 9.0, length: 18.0 });
        window.command(&one(0.0));
        window.extrude(50.0);
        window.command(&one(1.0));
        for (volume, expected) in [(0.0, 0.0), (9.0, 0.0), (9.0, 0.5), (9.0, 1.0), (50.0, 1.0)] {
            let mut left: f64 = volume;
            while left >= window.until_break() {
                left -= window.until_break();
                window.extrude_to_break();
            }
            window.extrude(left);
            assert!((window.at(0.0)[0] - expected).abs() < 1e-12, "{volume} {expected}");
        }
        assert!(window.is_steady() && window.until_break() == f64::INFINITY);
        assert_eq!(window.stretches.len(), 1);
    }

    #[test]
    fn the_first_command_fills_the_nozzle() {
        let mut window = Window::new(&Transition { delay: 5.0, length: 5.0 });
        window.command(&one(0.25));
        window.command(&one(0.75));
        assert_eq!(window.at(0.0)[0], 0.75);
    }

    /// The mean of the commands by their definition.
    fn mean(commands: &[(f64, f64)], transition: &Transition, volume: f64) -> f64 {
        let at = |v: f64| {
            let last = commands.iter().rev().find(|c| c.0 <= v);
            last.unwrap_or(&commands[0]).1
        };
        if transition.length == 0.0 {
            return at(volume - transition.delay);
        }
        let to = volume - transition.delay;
        let from = to - transition.length;
        let mut cuts = vec![from, to];
        cuts.extend(commands.iter().map(|c| c.0).filter(|v| (from..to).contains(v)));
        cuts.sort_by(f64::total_cmp);
        cuts.windows(2).map(|w| (w[1] - w[0]) * at(0.5 * (w[0] + w[1]))).sum::<f64>()
            / transition.length
    }

    proptest! {
        #[test]
        fn is_the_mean_of_the_commands(
            commands in prop::collection::vec((0.01..20.0f64, 0.0..1.0f64), 1..40),
            delay in prop_oneof![Just(0.0), 0.0..30.0f64],
            length in prop_oneof![Just(0.0), 0.01..30.0f64],
        ) {
            let transition = Transition { delay, length };
            let mut window = Window::new(&transition);
            let mut told: Vec<(f64, f64)> = Vec::new();
            let mut volume = 0.0;
            for (by, value) in commands {
                told.push((volume, value));
                window.command(&one(value));
                let mut left = by;
                let end = volume + by;
                while left > 0.0 {
                    let step = left.min(window.until_break());
                    let middle = end - left + 0.5 * step;
                    if step > 1e-9 {
                        let seen = window.at(0.5 * step)[0];
                        let expected = mean(&told, &transition, middle);
                        prop_assert!((seen - expected).abs() < 1e-7, "{} {} {}", middle, seen, expected);
                    }
                    if step < left { window.extrude_to_break(); } else { window.extrude(step); }
                    left -= step;
                }
                volume = end;
            }
            prop_assert!(window.stretches.len() <= told.len());
        }
    }
}
