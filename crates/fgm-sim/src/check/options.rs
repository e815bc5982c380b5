use std::ops::RangeInclusive;

use fgm_gcode::Machine;

use crate::{Model, ReplayOptions};

/// What is checked, and through which model of the machine.
#[derive(Clone, Debug)]
pub struct CheckOptions {
    /// How the G-code is followed.
    pub replay: ReplayOptions,
    /// From command to deposit.
    pub model: Model,
    /// Layers that are compared with the design, from 0; faults and totals are of the whole file.
    pub layers: RangeInclusive<u32>,
}

impl CheckOptions {
    /// By the machine's profile; for one that is not known, what is commanded is laid down.
    pub fn of(machine: Option<&Machine>) -> Self {
        let model = machine.map_or_else(|| Model::ideal(&Machine::default()), Model::of);
        let replay = ReplayOptions { machine: machine.cloned(), ..ReplayOptions::default() };
        Self { replay, model, layers: 0..=u32::MAX }
    }
}
