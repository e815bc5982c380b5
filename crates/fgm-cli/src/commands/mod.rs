//! One file a subcommand.

pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod inspect;
pub(crate) mod printers;
pub(crate) mod settings;
pub(crate) mod slice;
