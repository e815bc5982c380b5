//! What a graded print really lays down: a model of the way from a change of mixture at the motors
//! to the change of material at the nozzle's tip.

mod transition;

pub use transition::Transition;
