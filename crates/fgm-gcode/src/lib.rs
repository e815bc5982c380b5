//! G-code for graded parts: dialects, machines, look-ahead for dead volume, a fast writer and a
//! reader.

mod dialect;
mod error;
mod fixed;
mod lead;
mod machine;
mod ratio;
mod reader;
mod state;
mod step;
mod template;
mod text;
mod time;
mod writer;

pub use dialect::{
    Change, Dialect, Foam, Kalico, MarlinDirect, MarlinMixing, Motors, Move, PrusaXl, RepRap,
    Repetier, ToolChange,
};
pub use error::GcodeError;
pub use fixed::Fixed;
pub use lead::{Lead, Led};
#[cfg(feature = "serde")]
pub use machine::MachineError;
pub use machine::{
    Bed, DialectName, DialectOptions, Fan, Foaming, LeadOptions, Machine, MachineKind,
    MotionLimits, Retraction, Speeds, Temperatures, Templates, ToolChanging,
};
pub use ratio::safe_ratios;
pub use reader::{Arguments, Code, Command, Line, Lines, Pairs, Reader, Word, lines};
pub use state::State;
pub use step::Step;
pub use template::VARIABLES;
pub use text::Text;
pub use time::TimeEstimate;
pub use writer::{Summary, Writer, WriterOptions};
