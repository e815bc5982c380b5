//! The .vcad language: text to tokens to nodes to parts to a design.

mod ast;
mod density;
mod finish;
mod grade;
mod kind;
mod leaf;
mod lower;
mod number;
mod paint;
mod parser;
mod part;
mod token;

pub(crate) use lower::Lowering;
