use fgm_gcode::Machine;

/// How the material at the nozzle's tip follows the mixture at the motors, over extruded volume
/// (active-mixing paper, eq. 8-10: lengths there, volumes here, since volumes carry over between
/// bead sections).
///
/// After a command the deposit stays as it was for `delay` mm³ and then changes linearly over
/// `length` mm³. In general the deposit at volume v is the mean of the commands between
/// v - (delay + length) and v - delay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transition {
    /// Nothing changes for this volume after a command, mm³.
    pub delay: f64,
    /// The change then takes this volume, mm³; 0 for a sharp one.
    pub length: f64,
}

impl Transition {
    /// What is commanded is laid down at once.
    pub const IDEAL: Self = Self { delay: 0.0, length: 0.0 };

    /// The transition that a machine's profile gives; none where it gives none.
    pub fn of(machine: &Machine) -> Option<Self> {
        machine.transition.volumes().map(|(delay, length)| Self { delay, length })
    }

    /// Where the middle of a change lies behind its command, mm³: the lead that puts it in place.
    pub fn lead(&self) -> f64 {
        self.delay + 0.5 * self.length
    }

    /// How far behind a command its change is over, mm³.
    pub fn reach(&self) -> f64 {
        self.delay + self.length
    }

    /// The least volume, mm³, between where a change by `distance` begins to come out and where
    /// the deposit is within `tolerance` of what was commanded: what a purge has to take.
    ///
    /// Exact for this model: what is still missing falls linearly from `distance` to 0 over the
    /// length. The delay is no part of it, since what comes out during it is the old mixture: the
    /// command goes out that much before the purge begins.
    ///
    /// ```
    /// use fgm_sim::Transition;
    /// let transition = Transition { delay: 13.0, length: 26.0 };
    /// assert_eq!(transition.purge(1.0, 0.0), 26.0);
    /// assert_eq!(transition.purge(0.5, 0.25), 13.0);
    /// assert_eq!(transition.purge(0.1, 0.2), 0.0);
    /// ```
    pub fn purge(&self, distance: f64, tolerance: f64) -> f64 {
        if distance > tolerance.max(0.0) {
            self.length * (1.0 - tolerance.max(0.0) / distance)
        } else {
            0.0
        }
    }

    /// The same transition with its delay and its length off by a share each.
    pub fn scaled(&self, delay: f64, length: f64) -> Self {
        Self { delay: self.delay * delay, length: self.length * length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lead_is_the_middle_of_the_change() {
        let transition = Transition { delay: 9.0, length: 18.0 };
        assert_eq!((transition.lead(), transition.reach()), (18.0, 27.0));
        assert_eq!(Transition::IDEAL.lead(), 0.0);
    }

    #[test]
    fn a_profile_may_give_a_transition() {
        let mut machine = Machine::default();
        assert_eq!(Transition::of(&machine), None);
        machine.transition.delay = Some(2.0);
        machine.transition.change = Some(6.0);
        assert_eq!(Transition::of(&machine), Some(Transition { delay: 2.0, length: 6.0 }));
        assert_eq!(machine.dead_volume(), 5.0);
    }
}
