use std::{collections::BTreeSet, ops::RangeInclusive};

use fgm_core::Polygon;
use fgm_gcode::Machine;

use crate::{Model, Reference, ReplayOptions};

/// What is checked, and through which model of the machine.
#[derive(Clone, Debug)]
pub struct CheckOptions {
    /// How the G-code is followed.
    pub replay: ReplayOptions,
    /// From command to deposit.
    pub model: Model,
    /// Layers that are compared with the design and measured, from 0; faults and totals are of the
    /// whole file.
    pub layers: RangeInclusive<u32>,
    /// Places are compared at this distance along the beads, mm.
    pub spacing: f64,
    /// Side of the cells in which coverage is measured, mm; none to leave it out.
    pub cell: Option<f64>,
    /// Colours of the materials, red, green, blue.
    pub colors: Vec<[u8; 3]>,
    /// Layers to paint, from 0.
    pub pictures: BTreeSet<u32>,
    /// Side of a pixel, mm, where the picture does not get too large.
    pub pixel: f64,
}

impl CheckOptions {
    /// By the machine's profile; for one that is not known, what is commanded is laid down.
    pub fn of(machine: Option<&Machine>) -> Self {
        let model = machine.map_or_else(|| Model::ideal(&Machine::default()), Model::of);
        let replay = ReplayOptions { machine: machine.cloned(), ..ReplayOptions::default() };
        Self {
            replay,
            model,
            layers: 0..=u32::MAX,
            spacing: 0.5,
            cell: None,
            colors: Vec::new(),
            pictures: BTreeSet::new(),
            pixel: 0.05,
        }
    }
}

/// The region of a design at a height in its own coordinates, mm; the message of what went wrong.
pub type OutlineAt<'a> = dyn Fn(f64) -> Result<Vec<Polygon>, String> + 'a;

/// The design that a file was made from.
#[derive(Clone, Copy)]
pub struct CheckDesign<'a> {
    /// Its materials, and where it stands.
    pub reference: Reference<'a>,
    /// Its outlines.
    pub outline: &'a OutlineAt<'a>,
}
