/// Steps after which every second one halves the bracket.
const FREE_STEPS: u32 = 6;
/// Steps after which the bracket is taken as it is: beyond the resolution of an f64.
pub(crate) const MOST_STEPS: u32 = 120;

/// A bracketed search for where a function of `t` in 0..=1 changes sign: inverse quadratic
/// interpolation where that is safe and bisection elsewhere, after Chandrupatla, "A new hybrid
/// quadratic/bisection algorithm", Advances in Engineering Software 28 (1997).
///
/// The caller evaluates: this asks for a [`guess`](Self::guess) and takes the value there, so
/// that many searches can share one batched evaluation. A value of 0 counts as positive. At a
/// jump it converges to the jump.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bracket {
    // The newest point, the one on the other side of the root, and the one before.
    t: [f64; 3],
    f: [f64; 3],
    guess: f64,
    steps: u32,
}

impl Bracket {
    /// A search between values of different sign at 0 and 1. The first guess is the linear one.
    pub(crate) fn new(at_0: f64, at_1: f64) -> Self {
        let linear = at_0 / (at_0 - at_1);
        let guess = if linear.is_finite() { linear.clamp(0.0, 1.0) } else { 0.5 };
        Self { t: [0.0, 1.0, 1.0], f: [at_0, at_1, at_1], guess, steps: 0 }
    }

    /// Where the function is asked for next, and the answer once [`update`](Self::update) says
    /// that it is found.
    pub(crate) fn guess(&self) -> f64 {
        self.guess
    }

    /// Takes the value at the guess; answers whether the root is known to `tolerance`.
    pub(crate) fn update(&mut self, value: f64, tolerance: f64) -> bool {
        self.steps += 1;
        let third = if (value >= 0.0) == (self.f[0] >= 0.0) { 0 } else { 1 };
        (self.t[2], self.f[2]) = (self.t[third], self.f[third]);
        if third == 1 {
            (self.t[1], self.f[1]) = (self.t[0], self.f[0]);
        }
        (self.t[0], self.f[0]) = (self.guess, value);
        let width = (self.t[1] - self.t[0]).abs();
        if value == 0.0 || self.is_near(width, tolerance) {
            return true;
        }
        if width <= tolerance || self.steps >= MOST_STEPS {
            let best = usize::from(self.f[0].abs() > self.f[1].abs());
            self.guess = self.t[best];
            return true;
        }
        let halve = self.steps > FREE_STEPS && self.steps.is_multiple_of(2);
        let share = if halve { 0.5 } else { self.interpolate() };
        let least = (0.5 * tolerance / width).min(0.5);
        let share = share.clamp(least, 1.0 - least);
        self.guess = self.t[0] + share * (self.t[1] - self.t[0]);
        false
    }

    /// Whether the newest point is at the root, by the mean slope over the bracket and by that
    /// between the two newest points. One alone is misled by a jump after a flat stretch.
    fn is_near(&self, width: f64, tolerance: f64) -> bool {
        let limit = 0.5 * tolerance;
        let off = |width: f64, rise: f64| self.f[0].abs() * (width / rise).abs();
        off(width, self.f[1] - self.f[0]) <= limit
            && off(self.t[2] - self.t[0], self.f[2] - self.f[0]) <= limit
    }

    /// The share of the bracket, from the newest point on, at which the root is expected.
    fn interpolate(&self) -> f64 {
        let ([t1, t2, t3], [f1, f2, f3]) = (self.t, self.f);
        let xi = (t1 - t2) / (t3 - t2);
        let phi = (f1 - f2) / (f3 - f2);
        // Off these two parabolas the inverse quadratic is not monotone on the bracket.
        if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            let near = f1 / (f2 - f1) * (f3 / (f2 - f3));
            let far = (t3 - t1) / (t2 - t1) * (f1 / (f3 - f1)) * (f2 / (f3 - f2));
            let share = near + far;
            if share.is_finite() {
                return share;
            }
        }
        if self.steps == 1 {
            // One value inside: the linear guess on the remaining side still beats the middle.
            let linear = f1 / (f1 - f2);
            if linear.is_finite() {
                return linear;
            }
        }
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Finds the root in 0..=1 to 1e-9; answers it and the evaluations it took.
    fn solve(f: impl Fn(f64) -> f64) -> (f64, u32) {
        let mut bracket = Bracket::new(f(0.0), f(1.0));
        while !bracket.update(f(bracket.guess()), 1e-9) {}
        (bracket.guess(), bracket.steps)
    }

    #[test]
    fn roots_of_all_kinds_are_found_in_few_evaluations() {
        type Case = (&'static str, fn(f64) -> f64, f64, u32);
        let cases: [Case; 8] = [
            ("linear", |t| t - 0.3, 0.3, 1),
            ("circle", |t| (t * 0.5 + 9.8).hypot(0.2) - 10.0, 0.395_999_6, 4),
            ("cubic", |t| (t - 0.7).powi(3), 0.7, 80),
            ("jump", |t| if t < 0.123_456_789 { -1.0 } else { 1.0 }, 0.123_456_789, 70),
            ("steep", |t| ((t - 0.9) * 200.0).tanh(), 0.9, 20),
            ("uneven", |t| if t < 0.01 { -1e-9 } else { 1e9 }, 0.01, 70),
            ("infinite", |t| if t < 0.4 { f64::NEG_INFINITY } else { 2.0 }, 0.4, 70),
            ("falling", |t| 0.25 - t * t, 0.5, 8),
        ];
        for (name, f, root, evaluations) in cases {
            let (found, steps) = solve(f);
            let off = if name == "cubic" { 1e-3 } else { 1e-6 };
            assert!((found - root).abs() < off, "{name}: {found}");
            assert!(steps <= evaluations, "{name}: {steps} evaluations");
        }
    }
}
