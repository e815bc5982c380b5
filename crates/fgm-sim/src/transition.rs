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

    /// Where the middle of a change lies behind its command, mm³: the lead that puts it in place.
    pub fn lead(&self) -> f64 {
        self.delay + 0.5 * self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lead_is_the_middle_of_the_change() {
        assert_eq!(Transition { delay: 9.0, length: 18.0 }.lead(), 18.0);
        assert_eq!(Transition::IDEAL.lead(), 0.0);
    }
}
