//! How much is purged at a change of colour.

use fgm_core::{ColorId, Mixture};
use fgm_gcode::{Machine, MachineKind};
use fgm_sim::Transition;

use crate::{choice::Strategy, settings::Settings};

/// What changes between the colours of a palette need.
#[derive(Clone)]
pub(crate) struct Needs {
    palette: Vec<Mixture>,
    volumes: Volumes,
    /// mm³.
    dead: f64,
    /// Step of the mixture times dead volume up to which nothing is purged, mm³.
    threshold: f64,
    pub(super) arrival: Arrival,
}

/// Where in a purge the new colour is taken to come out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    /// A head has its own colour, and is purged of what has stood in it.
    Start,
    /// A transition that is known has its middle there.
    Middle,
    /// A sharp change may come anywhere in the dead volume, so it is waited for.
    End,
}

/// How much a change takes.
#[derive(Clone, Copy)]
enum Volumes {
    /// Each the same, mm³.
    Same(f64),
    /// Until the transition is within a tolerance of its goal.
    Until(Transition, f64),
}

/// Whether the old colour is to go anywhere.
pub(crate) fn wanted(machine: &Machine, settings: &Settings) -> bool {
    let usual = machine.kind != MachineKind::ToolChanger;
    settings.slice.strategy == Strategy::Sectioned && settings.purge.enabled.unwrap_or(usual)
}

impl Needs {
    /// For a machine whose commands come `lead` mm³ early.
    pub(crate) fn new(
        machine: &Machine,
        settings: &Settings,
        lead: f64,
        palette: Vec<Mixture>,
    ) -> Self {
        let transition = Transition::of(machine);
        let volumes = match (settings.purge.volume, transition) {
            (Some(volume), _) => Volumes::Same(volume),
            (None, Some(transition)) => Volumes::Until(transition, settings.purge.tolerance),
            (None, None) => Volumes::Same(lead),
        };
        let arrival = match machine.kind {
            MachineKind::ToolChanger => Arrival::Start,
            MachineKind::Mixing if transition.is_some() => Arrival::Middle,
            MachineKind::Mixing | MachineKind::Foaming => Arrival::End,
        };
        let threshold = settings.purge.threshold;
        Self { palette, volumes, dead: lead, threshold, arrival }
    }

    /// What a change takes where every one is purged, mm³. Nothing is known of what is in the
    /// nozzle before the first colour, so that counts as a whole change.
    pub(crate) fn whole(&self, from: Option<ColorId>, to: ColorId) -> f64 {
        if from == Some(to) { 0.0 } else { self.of_step(self.step(from, to)) }
    }

    /// What a change takes, mm³: nothing below the threshold.
    pub(crate) fn volume(&self, from: Option<ColorId>, to: ColorId) -> f64 {
        let step = self.step(from, to);
        if from == Some(to) || step * self.dead <= self.threshold {
            0.0
        } else {
            self.of_step(step)
        }
    }

    /// The most that a change between any two of the palette's colours takes, mm³.
    pub(crate) fn most(&self) -> f64 {
        let colors: Vec<ColorId> = (0..self.palette.len() as u16).map(ColorId).collect();
        self.most_between(&colors, &colors)
    }

    /// The most that a change from one of some colours to one of others takes, mm³.
    pub(crate) fn most_between(&self, from: &[ColorId], to: &[ColorId]) -> f64 {
        let pairs = from.iter().flat_map(|a| to.iter().map(move |b| (*a, *b)));
        pairs.map(|(a, b)| self.volume(Some(a), b)).fold(0.0, f64::max)
    }

    /// The most that the changes of a layer take together, whichever of these colours, in the
    /// palette's order or its reverse, it has, mm³.
    pub(crate) fn most_in_layer(&self, colors: &[ColorId]) -> f64 {
        let mut best: Vec<f64> = Vec::with_capacity(colors.len());
        for (i, to) in colors.iter().enumerate() {
            let ways = (0..i).map(|j| best[j] + self.volume(Some(colors[j]), *to));
            best.push(ways.fold(0.0, f64::max));
        }
        best.into_iter().fold(0.0, f64::max)
    }

    fn of_step(&self, step: f64) -> f64 {
        match self.volumes {
            Volumes::Same(volume) => volume,
            Volumes::Until(transition, tolerance) => transition.purge(step, tolerance),
        }
    }

    fn step(&self, from: Option<ColorId>, to: ColorId) -> f64 {
        let mixture = |color: ColorId| self.palette.get(color.index());
        let pair = from.and_then(mixture).zip(mixture(to));
        pair.map_or(1.0, |(from, to)| from.distance(to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(threshold: f64) -> Needs {
        let mut settings = Settings::default();
        settings.purge.threshold = threshold;
        let mixture = |i: i32| {
            let share = f64::from(i) / 4.0;
            Mixture::from_weights(&[share, 1.0 - share]).unwrap()
        };
        let machine = Machine::builtin("generic-mixing").unwrap();
        Needs::new(&machine, &settings, 40.0, (0..5).map(mixture).collect())
    }

    #[test]
    fn the_threshold_is_step_times_dead_volume() {
        // A step of a quarter leaves 10 mm³ of the wrong material.
        for (threshold, near, far) in [(0.0, 40.0, 40.0), (9.9, 40.0, 40.0), (10.0, 0.0, 40.0)] {
            let needs = needs(threshold);
            assert_eq!(needs.volume(Some(ColorId(1)), ColorId(2)), near);
            assert_eq!(needs.volume(Some(ColorId(3)), ColorId(1)), far);
            assert_eq!(needs.whole(Some(ColorId(1)), ColorId(2)), 40.0);
            assert_eq!(needs.volume(None, ColorId(2)), 40.0);
            assert_eq!(needs.whole(Some(ColorId(2)), ColorId(2)), 0.0);
        }
    }

    #[test]
    fn the_most_in_a_layer_may_leave_colours_out() {
        let all: Vec<_> = (0..5).map(ColorId).collect();
        assert_eq!(needs(0.0).most_in_layer(&all), 160.0);
        // Neighbours need nothing; 0, 2, 4 two purges.
        assert_eq!(needs(10.0).most_in_layer(&all), 80.0);
        assert_eq!(needs(20.0).most_in_layer(&all), 40.0);
        assert_eq!(needs(40.0).most_in_layer(&all), 0.0);
        assert_eq!(needs(0.0).most_in_layer(&all[..1]), 0.0);
        assert_eq!(needs(25.0).most_between(&all[..2], &all[3..]), 40.0);
    }
}
