use serde::Serialize;

use crate::{Fault, FaultKind, Figures};

/// What a check found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// Lines of the file.
    pub lines: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// The model of the machine in words.
    pub model: String,
    /// What is wrong, counted.
    pub fault_count: u64,
    /// The same by kind, those that occur.
    pub fault_kinds: Vec<(FaultKind, u64)>,
    /// The first of each kind.
    pub faults: Vec<Fault>,
    /// Changes of colour after the first one.
    pub state_changes: u64,
    /// Totals of the print.
    pub totals: Figures,
    /// Mass of the filament fed, g, the start's included.
    pub mass_g: f64,
    /// Mass of what purge towers and the start take, g.
    pub purge_g: f64,
}
