//! G-code for graded parts: dialects, machines, look-ahead for dead volume, a fast writer and a
//! reader.
//!
//! A print is a stream of [`Motion`](fgm_core::Motion)s. [`Lead`] moves the changes of colour in
//! it up by the machine's dead volume, [`Writer`] writes it in the machine's [`Dialect`]. The way
//! back, from text to commands, is [`Reader`].
//!
//! # The cast
//!
//! | group | items |
//! |---|---|
//! | machines | [`Machine`], [`MachineKind`], [`Bed`], [`DialectOptions`], [`Auger`], [`LeadOptions`], [`TransitionOptions`], [`Temperatures`], [`Foaming`], [`Speeds`], [`MotionLimits`], [`Retraction`], [`Fan`], [`ToolChanging`], [`Templates`], [`VARIABLES`] |
//! | colours | [`State`], [`Machine::states`], [`safe_ratios`] |
//! | look-ahead | [`Lead`], [`Led`], [`MotionQueue`], [`Step`] |
//! | dialects | [`Dialect`], [`Change`], [`Move`], [`Text`], [`Fixed`]; [`MarlinMixing`], [`MarlinTools`], [`MarlinDirect`], [`RepRap`], [`Kalico`], [`Repetier`], [`ToolChange`], [`PrusaXl`], [`Foam`] |
//! | writing | [`Writer`], [`WriterOptions`], [`Summary`], [`ProgressLines`] |
//! | time | [`TimeEstimate`], [`Pacer`], [`Paced`], [`Pace`] |
//! | reading | [`Reader`], [`lines`], [`Line`], [`Command`], [`Code`], [`Word`] |
//! | faults | [`GcodeError`], `MachineError` |
//!
//! # Conventions
//!
//! Millimetres, mm³, seconds, mm/s, °C; mm/min only in the `F` words. Motions are in the design's
//! coordinates; `bed position = design position + offset`. Extrusion is relative.
//!
//! # Example
//!
//! ```
//! use fgm_core::{ColorId, Mixture, Motion, Point2, Role};
//! use fgm_gcode::{Lead, LeadOptions, Machine, Writer, WriterOptions, lines};
//!
//! // A mixing hotend with 2 mm³ between the mixing and the nozzle's tip.
//! let lead = LeadOptions { volume: Some(2.0), ..LeadOptions::default() };
//! let machine = Machine { lead, ..Machine::default() };
//! let palette = [Mixture::from_weights(&[1.0, 0.0])?, Mixture::from_weights(&[0.25, 0.75])?];
//! let states = machine.states(&palette)?;
//!
//! let bead = |x| Motion::Extrude { to: Point2::new(x, 50.0), width: 0.4, role: Role::Infill };
//! let print = [
//!     Motion::Layer { index: 0, z: 0.2, height: 0.2 },
//!     Motion::Color(ColorId(0)),
//!     Motion::Travel { to: Point2::new(20.0, 50.0) },
//!     bead(120.0),
//!     Motion::Color(ColorId(1)),
//!     bead(220.0),
//! ];
//!
//! let mut gcode = Vec::new();
//! let mut writer = Writer::new(&mut gcode, &machine, &states, &WriterOptions::of(&machine))?;
//! for step in Lead::for_machine(&machine).over(print) {
//!     writer.push(step)?;
//! }
//! assert_eq!(writer.finish()?.state_changes, 1);
//!
//! // 2 mm³ are 28.005 mm of this bead: the change is commanded that far before x = 120.
//! let commanded = lines(&gcode).skip_while(|l| l.comment != Some(b"COLOR:1 0.25 0.75"));
//! let next = commanded.filter_map(|l| l.command).find(|c| c.is(b'G', 1));
//! assert_eq!(next.and_then(|c| c.value(b'X')), Some(120.0));
//! assert!(String::from_utf8(gcode)?.contains("G1 X91.995 "));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Templates
//!
//! The start and end G-code of a machine may use the variables of [`VARIABLES`] in braces. A start
//! template that does not use `{nozzle_temperature}` or `{bed_temperature}` has the heating put
//! before it, one that does not use `{initial_state}` has the first colour set after it.
//!
//! # Features
//!
//! `serde` (default): profiles as TOML, and the built-in ones.

mod dialect;
mod error;
mod fixed;
mod lead;
mod machine;
mod pace;
mod progress;
mod queue;
mod ratio;
mod reader;
mod state;
mod step;
mod template;
mod text;
mod time;
mod writer;

pub use dialect::{
    Change, Dialect, Foam, Kalico, MarlinDirect, MarlinMixing, MarlinTools, Motors, Move, PrusaXl,
    RepRap, Repetier, ToolChange,
};
pub use error::GcodeError;
pub use fixed::Fixed;
pub use lead::{Lead, Led};
#[cfg(feature = "serde")]
pub use machine::MachineError;
pub use machine::{
    Auger, Bed, DialectName, DialectOptions, Fan, Foaming, LeadOptions, Machine, MachineKind,
    MotionLimits, Retraction, Speeds, Temperatures, Templates, ToolChanging, TransitionOptions,
};
pub use pace::{Pace, Paced, Pacer};
pub use progress::ProgressLines;
pub use queue::MotionQueue;
pub use ratio::safe_ratios;
pub use reader::{Arguments, Code, Command, Line, Lines, Pairs, Reader, Word, lines};
pub use state::State;
pub use step::Step;
pub use template::VARIABLES;
pub use text::Text;
pub use time::TimeEstimate;
pub use writer::{Summary, Writer, WriterOptions};

/// The examples of the documentation, run as tests.
#[cfg(all(doctest, feature = "serde"))]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/dialects.md")]
struct Documentation;
