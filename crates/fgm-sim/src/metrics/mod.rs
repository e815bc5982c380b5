//! Figures of what is laid down against what was designed.

mod fidelity;
mod shades;
mod spread;

pub use fidelity::{Fidelity, FidelityFigures, Reference};
pub use shades::Shades;
pub use spread::{Spread, SpreadFigures, Worst};
