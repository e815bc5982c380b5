//! What a graded print really lays down.
//!
//! G-code of any slicer is followed line by line as its firmware would ([`Replay`]), and what it
//! commands goes through a model of the machine ([`Model`]): the dead volume between mixing and
//! nozzle, the length over which a change spreads, the time a temperature takes. What comes out
//! are [`Piece`]s with the composition they really have ([`Deposit`]).
//!
//! # The cast
//!
//! | for | use |
//! |---|---|
//! | what the head of a file says | [`Head`] |
//! | G-code to what the machine does | [`Replay`], [`Follower`], [`ReplayOptions`], [`Event`]: [`Layer`], [`Bead`], [`Travel`], [`Heat`] |
//! | what is wrong with it | [`Faults`], [`Fault`], [`FaultKind`] |
//! | from command to deposit | [`Deposit`], [`Model`], [`Transition`], [`Thermal`], [`Piece`] |
//! | everything about a file | [`check`], [`CheckOptions`], [`CheckDesign`], [`CheckReport`] |
//! | a layer's cells | [`Coverage`], [`LayerFigures`], [`Picture`] |
//! | against the design | [`Fidelity`], [`Reference`], [`Shades`], [`Spread`] |
//! | commands chosen for the deposit | [`Compensate`], [`CompensateOptions`], [`Compensated`], [`Fit`], [`HiddenFit`]; [`Preheat`] |
//! | figures | [`Totals`], [`Figures`] |
//! | what can go wrong | [`SimError`] |
//!
//! # Conventions
//!
//! Millimetres, mm³, seconds, °C. Positions are the nozzle's on the bed, at the top of the bead;
//! `bed position = design position + offset`. Volume is what comes out of the nozzle: what a
//! retraction pulls back and pushes again does not count.

mod check;
mod compensate;
mod deposit;
mod error;
mod event;
mod fault;
mod foam;
mod head;
mod metrics;
mod picture;
mod piece;
mod raster;
mod replay;
mod totals;
mod transition;

pub use check::{CheckDesign, CheckOptions, CheckReport, CoverageFigures, OutlineAt, check};
pub use compensate::{Compensate, CompensateOptions, Compensated, Fit, HiddenFit, Preheat};
pub use deposit::{Deposit, Model, Thermal};
pub use error::SimError;
pub use event::{Bead, Event, Heat, Layer, Travel};
pub use fault::{Fault, FaultKind, Faults};
pub use head::Head;
pub use metrics::{Fidelity, FidelityFigures, Reference, Shades, Spread, SpreadFigures, Worst};
pub use picture::{Picture, PictureKind};
pub use piece::Piece;
pub use raster::{Coverage, LayerFigures};
pub use replay::{Follower, Replay, ReplayOptions};
pub use totals::{Figures, Totals};
pub use transition::Transition;

/// The README's example runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
