//! What stands between the motions and the writer: commands before their boundaries.

use fgm_core::{Mixture, Motion};
use fgm_gcode::{GcodeError, Lead, Machine, MachineKind, Pace, State, Step};
use fgm_sim::{Compensate, CompensateOptions, Preheat};

use crate::{choice::Aim, report::DepositReport, settings::Settings};

/// The look-ahead alone, or commands chosen for the deposit, or temperatures told in time.
pub(crate) enum Ahead {
    Lead(Lead),
    Preheat(Box<Preheat>),
    Compensate { enabled: bool, aim: Aim, compensate: Box<Compensate> },
}

impl Ahead {
    /// What a machine needs: on a mixing machine with a transition the commands are chosen, or the
    /// error of the look-ahead alone is measured; a foaming filament whose nozzle's rates are named
    /// is heated in time; else there is the look-ahead.
    pub(crate) fn new(
        machine: &Machine,
        settings: &Settings,
        lead: f64,
        palette: &[Mixture],
        states: &[State],
    ) -> Self {
        if let Some(preheat) = Preheat::of(machine, lead, states) {
            return Self::Preheat(Box::new(preheat));
        }
        let mixing = machine.kind == MachineKind::Mixing;
        let Some(options) = CompensateOptions::of(machine).filter(|_| mixing) else {
            return Self::Lead(Lead::with_volume(machine, lead));
        };
        let wanted = &settings.compensation;
        let enabled = wanted.enabled.unwrap_or(true);
        let options = CompensateOptions {
            enabled,
            lead,
            uncertainty: wanted.uncertainty,
            shortest: wanted.shortest,
            ..options
        };
        let compensate = Box::new(Compensate::new(&options, palette, states));
        Self::Compensate { enabled, aim: settings.aim(), compensate }
    }

    /// Whether commands come a volume ahead of what they are for, so that none can be in time for
    /// the start: heads are taken where they are due, temperatures go by time.
    pub(crate) fn comes_early(&self, machine: &Machine) -> bool {
        machine.kind != MachineKind::ToolChanger && !matches!(self, Self::Preheat(_))
    }

    /// The beads that come next go at this pace, where time counts.
    pub(crate) fn set_pace(&mut self, pace: Pace) {
        if let Self::Preheat(preheat) = self {
            preheat.set_pace(pace);
        }
    }

    /// Whether it matters what the design is along each bead.
    pub(crate) fn aims(&self) -> bool {
        matches!(self, Self::Compensate { .. })
    }

    /// Takes the next motion, for a bead with what its deposit is to be where that is not its
    /// colour: mixtures of equal shares of it.
    pub(crate) fn push(
        &mut self,
        motion: Motion,
        wanted: &[Mixture],
        emit: impl FnMut(Step) -> Result<(), GcodeError>,
    ) -> Result<(), GcodeError> {
        match self {
            Self::Lead(lead) => lead.push(motion, emit),
            Self::Preheat(preheat) => preheat.push(motion, emit),
            Self::Compensate { compensate, .. } => compensate.push_toward(motion, wanted, emit),
        }
    }

    /// Emits the rest; gives what is predicted of the deposit.
    pub(crate) fn finish(
        self,
        emit: impl FnMut(Step) -> Result<(), GcodeError>,
    ) -> Result<Option<DepositReport>, GcodeError> {
        match self {
            Self::Lead(lead) => lead.finish(emit).map(|()| None),
            Self::Preheat(preheat) => preheat.finish(emit).map(|()| None),
            Self::Compensate { enabled, aim, compensate } => {
                let done = compensate.finish(emit)?;
                Ok(DepositReport::new(enabled, aim, &done))
            }
        }
    }
}
