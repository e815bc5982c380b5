use std::fmt;

use serde::Serialize;

/// What is wrong with a line of G-code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// A move to where the nozzle cannot go.
    OutsideBed,
    /// Extrusion while the nozzle is told a temperature too low for it.
    Cold,
    /// A bead while the filament is pulled back.
    Retracted,
    /// A letter without a number where one is needed, or a number that no machine can take.
    BadNumber,
    /// A command that no known firmware has.
    UnknownCommand,
    /// A bead with more section than the firmware allows.
    BeadTooLarge,
    /// A bead with a mixture in which no motor turns.
    NoMixture,
}

impl FaultKind {
    /// Every kind.
    pub const ALL: [Self; 7] = [
        Self::OutsideBed,
        Self::Cold,
        Self::Retracted,
        Self::BadNumber,
        Self::UnknownCommand,
        Self::BeadTooLarge,
        Self::NoMixture,
    ];
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OutsideBed => "outside the bed",
            Self::Cold => "extruded too cold",
            Self::Retracted => "printed while retracted",
            Self::BadNumber => "bad number",
            Self::UnknownCommand => "unknown command",
            Self::BeadTooLarge => "bead too large",
            Self::NoMixture => "no motor turns",
        })
    }
}

/// One fault, with its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// What is wrong.
    pub kind: FaultKind,
    /// The line of the file, from 1.
    pub line: u64,
    /// The particulars.
    pub message: String,
}

/// All faults counted, the first of each kind kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    counts: [u64; FaultKind::ALL.len()],
    kept: Vec<Fault>,
    most: usize,
}

impl Faults {
    /// No fault yet; of each kind the first `most` will be kept.
    pub fn new(most: usize) -> Self {
        Self { counts: [0; FaultKind::ALL.len()], kept: Vec::new(), most }
    }

    /// Counts a fault; its message is only asked for where it is kept.
    pub(crate) fn add(&mut self, kind: FaultKind, line: u64, message: impl FnOnce() -> String) {
        let count = &mut self.counts[kind as usize];
        *count += 1;
        if *count <= self.most as u64 {
            self.kept.push(Fault { kind, line, message: message() });
        }
    }

    /// How many of a kind.
    pub fn count(&self, kind: FaultKind) -> u64 {
        self.counts[kind as usize]
    }

    /// How many in all.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Those that were kept, in the order of the file.
    pub fn kept(&self) -> &[Fault] {
        &self.kept
    }
}
