use fgm_gcode::Machine;

/// How a nozzle's temperature follows what it is told: at a limited rate while far from it, then
/// as a first-order lag.
///
/// `dT/dt = (told - T) / time_constant`, held between `-cooling` and `heating`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    /// Greatest rate of heating, °C/s; may be infinite.
    pub heating: f64,
    /// Greatest rate of cooling, °C/s, above 0; may be infinite.
    pub cooling: f64,
    /// Time in which the rest of a change shrinks to 1/e, s; 0 for none.
    pub time_constant: f64,
}

impl Thermal {
    /// The rates that a profile names for its foaming filament's nozzle; none where it names none.
    /// A rate that is left out is infinite.
    pub fn of(machine: &Machine) -> Option<Self> {
        let foaming = &machine.foaming;
        (foaming.heating.is_some() || foaming.cooling.is_some()).then(|| Self {
            heating: foaming.heating.unwrap_or(f64::INFINITY),
            cooling: foaming.cooling.unwrap_or(f64::INFINITY),
            time_constant: 0.0,
        })
    }

    /// The temperature `seconds` after `celsius`, with `told` commanded, °C.
    ///
    /// ```
    /// use fgm_sim::Thermal;
    /// let nozzle = Thermal { heating: 2.0, cooling: 1.0, time_constant: 0.0 };
    /// assert_eq!(nozzle.after(190.0, 225.0, 10.0), 210.0);
    /// assert_eq!(nozzle.after(190.0, 225.0, 30.0), 225.0);
    /// assert_eq!(nozzle.after(225.0, 190.0, 30.0), 195.0);
    /// ```
    pub fn after(&self, celsius: f64, told: f64, seconds: f64) -> f64 {
        let mut gap = told - celsius;
        if gap == 0.0 || !seconds.is_finite() || seconds <= 0.0 {
            return celsius;
        }
        let rate = if gap > 0.0 { self.heating } else { self.cooling };
        let mut seconds = seconds;
        // Within this of the goal the lag is slower than the rate.
        let near = if self.time_constant > 0.0 { rate * self.time_constant } else { 0.0 };
        if gap.abs() > near {
            let limited = (gap.abs() - near) / rate;
            if seconds <= limited {
                return celsius + gap.signum() * rate * seconds;
            }
            gap = gap.signum() * near;
            seconds -= limited;
        }
        if self.time_constant > 0.0 {
            told - gap * (-seconds / self.time_constant).exp()
        } else {
            told
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn table() {
        let inf = f64::INFINITY;
        for (heating, cooling, tau, from, told, seconds, expected) in [
            (inf, inf, 0.0, 200.0, 210.0, 1e-9, 210.0),
            (inf, inf, 10.0, 200.0, 210.0, 10.0, 210.0 - 10.0 * (-1.0_f64).exp()),
            (1.0, 1.0, 5.0, 200.0, 220.0, 15.0, 215.0),
            (1.0, 1.0, 5.0, 200.0, 220.0, 20.0, 220.0 - 5.0 * (-1.0_f64).exp()),
            (1.0, 2.0, 0.0, 200.0, 190.0, 2.0, 196.0),
            (1.0, 1.0, 1.0, 200.0, 200.0, 2.0, 200.0),
            (1.0, 1.0, 1.0, 200.0, 220.0, 0.0, 200.0),
        ] {
            let found = Thermal { heating, cooling, time_constant: tau }.after(from, told, seconds);
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    proptest! {
        #[test]
        fn two_steps_are_one(
            heating in 0.1..10.0f64, cooling in 0.1..10.0f64, tau in 0.0..20.0f64,
            from in 150.0..250.0f64, told in 150.0..250.0f64, a in 0.0..30.0f64, b in 0.0..30.0f64,
        ) {
            let nozzle = Thermal { heating, cooling, time_constant: tau };
            let once = nozzle.after(from, told, a + b);
            let twice = nozzle.after(nozzle.after(from, told, a), told, b);
            prop_assert!((once - twice).abs() < 1e-6, "{} {}", once, twice);
            prop_assert!((told - once).abs() <= (told - from).abs() + 1e-9);
        }
    }
}
