use fgm_core::{Bounds3, MAX_MATERIALS};

use crate::{MachineKind, ProgressLines, State};

/// What a print came to. It covers the motions of the print, not the templates around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Volume of all beads, mm³: length times section times the role's flow. The purge is part of
    /// it; what foaming adds is not taken off.
    pub extruded_mm3: f64,
    /// That of the beads of the part itself, mm³.
    pub part_mm3: f64,
    /// That of the purge tower, mm³.
    pub purge_mm3: f64,
    /// Filament fed, mm³: `extruded_mm3` with each state's flow.
    pub fed_mm3: f64,
    /// Filament fed by each input, mm³: by each filament's share on a mixing machine, by each head
    /// on a tool changer; one number for a foaming filament.
    pub filament_mm3: Vec<f64>,
    /// Length of the beads, mm.
    pub extrude_mm: f64,
    /// Length of the moves in the plane without extrusion, mm.
    pub travel_mm: f64,
    /// Changes from one colour to another that were commanded; the first colour is none.
    pub state_changes: u64,
    /// Layers begun.
    pub layers: u64,
    /// Beads and travels written.
    pub moves: u64,
    /// Bytes written.
    pub bytes: u64,
    /// Estimated time, s; of the start what the profile says (`template.start_seconds`).
    pub print_time_s: f64,
    /// Where the progress is told, once it is filled in.
    pub progress: ProgressLines,
    /// Least and greatest position of an end of a bead, on the bed; empty where nothing was
    /// extruded.
    pub extents: Bounds3,
}

impl Summary {
    pub(super) fn new(inputs: usize) -> Self {
        Self {
            extruded_mm3: 0.0,
            part_mm3: 0.0,
            purge_mm3: 0.0,
            fed_mm3: 0.0,
            filament_mm3: vec![0.0; inputs],
            extrude_mm: 0.0,
            travel_mm: 0.0,
            state_changes: 0,
            layers: 0,
            moves: 0,
            bytes: 0,
            print_time_s: 0.0,
            progress: ProgressLines::default(),
            extents: Bounds3::EMPTY,
        }
    }

    /// How many inputs filament is counted for.
    pub(super) fn inputs(kind: MachineKind, states: &[State], inputs: usize) -> usize {
        match kind {
            MachineKind::Mixing => inputs.clamp(1, MAX_MATERIALS),
            MachineKind::Foaming => 1,
            MachineKind::ToolChanger => {
                let heads =
                    states.iter().filter_map(|s| s.tool).max().map_or(1, |t| t as usize + 1);
                heads.max(inputs)
            }
        }
    }

    /// Adds filament that was fed in a state.
    pub(super) fn feed(&mut self, kind: MachineKind, state: &State, volume: f64) {
        self.fed_mm3 += volume;
        match kind {
            MachineKind::Mixing => {
                for (sum, share) in self.filament_mm3.iter_mut().zip(state.mixture.fractions()) {
                    *sum += volume * share;
                }
            }
            MachineKind::ToolChanger | MachineKind::Foaming => {
                let input = state.tool.map_or(0, |t| t as usize);
                if let Some(sum) = self.filament_mm3.get_mut(input) {
                    *sum += volume;
                }
            }
        }
    }
}
