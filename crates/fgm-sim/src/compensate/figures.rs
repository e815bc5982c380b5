use super::{
    misfit::{Matter, Wanted, misfit, misfit_of},
    track::Told,
};
use crate::Transition;

/// How far the deposit is from what was wanted, with the plain lead and as told, over all volume
/// that matters.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The machine that it is predicted for.
    pub transition: Transition,
    /// Root of the mean squared error with the plain lead.
    pub plain: f64,
    /// The same with what was told.
    pub told: f64,
}

/// How far the deposit is from what was wanted where the part takes the old colour out of sight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HiddenFit {
    /// mm³.
    pub volume: f64,
    /// Root of the mean squared error with what was told, for the machine as measured.
    pub told: f64,
}

/// Squared errors while they are gathered, and the volume they are over.
#[derive(Clone, Debug)]
pub(super) struct Figures {
    sums: Vec<(Transition, f64, f64)>,
    volume: f64,
    measured: f64,
    /// The sum and the volume of what is hidden.
    hidden: (f64, f64),
}

impl Figures {
    pub(super) fn new(corners: &[Transition]) -> Self {
        let sums = corners.iter().map(|t| (*t, 0.0, 0.0)).collect();
        Self { sums, volume: 0.0, measured: 0.0, hidden: (0.0, 0.0) }
    }

    /// Goes on to the volume `upto`.
    pub(super) fn measure(&mut self, wanted: &[Wanted], upto: f64, plain: &[Told], told: &[Told]) {
        let part = (self.measured, upto);
        for (transition, of_plain, of_told) in &mut self.sums {
            *of_plain += misfit(transition, plain, wanted, part);
            *of_told += misfit(transition, told, wanted, part);
        }
        let mut at = self.measured;
        for wanted in wanted {
            let end = wanted.end.min(upto);
            let volume = (end - at).max(0.0);
            match wanted.matter {
                Matter::Part => self.volume += volume,
                Matter::Hidden => self.hidden.1 += volume,
                Matter::Waste => {}
            }
            at = at.max(end);
        }
        if let Some((transition, ..)) = self.sums.first()
            && wanted.iter().any(|wanted| wanted.matter == Matter::Hidden)
        {
            self.hidden.0 += misfit_of(transition, told, wanted, part, Matter::Hidden);
        }
        self.measured = upto;
    }

    /// What each error may come to from here on, where the plain lead alone would come to `plain`,
    /// so that the whole is no worse than with it.
    pub(super) fn allowance(&self, plain: &[f64]) -> Vec<f64> {
        let left = |((_, of_plain, of_told), plain): (&(Transition, f64, f64), &f64)| {
            of_plain - of_told + plain
        };
        self.sums.iter().zip(plain).map(left).collect()
    }

    /// The squared errors of what was told, as shares of those of the plain lead.
    pub(super) fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        self.sums.iter().map(|(_, plain, told)| if *plain > 0.0 { told / plain } else { 1.0 })
    }

    /// What is hidden; none where nothing is.
    pub(super) fn hidden(&self) -> Option<HiddenFit> {
        let (sum, volume) = self.hidden;
        (volume > 0.0).then(|| HiddenFit { volume, told: (sum / volume).sqrt() })
    }

    /// First for the machine as measured, then for each way it may be off.
    pub(super) fn fits(&self) -> Vec<Fit> {
        let root = |sum: f64| if self.volume > 0.0 { (sum / self.volume).sqrt() } else { 0.0 };
        let fit = |(transition, plain, told): &(Transition, f64, f64)| Fit {
            transition: *transition,
            plain: root(*plain),
            told: root(*told),
        };
        self.sums.iter().map(fit).collect()
    }
}
