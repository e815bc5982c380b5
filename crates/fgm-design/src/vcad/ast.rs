use std::ops::Range;
use std::sync::Arc;

use super::kind::NodeKind;

/// Numbers by name, in the order in which they were given; a later one of the same name hides the
/// earlier.
pub(crate) type Names = Arc<Vec<(String, f64)>>;

/// A node as written: `name(args) { children }` or `name(args);`.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) kind: NodeKind,
    /// Where the name stands.
    pub(crate) name_span: Range<usize>,
    pub(crate) args: Vec<Arg>,
    /// From `(` to `)`.
    pub(crate) args_span: Range<usize>,
    /// None for a node that ends with `;`.
    pub(crate) children: Option<Vec<Node>>,
    /// The numbers that expressions in its strings may use.
    pub(crate) names: Names,
}

/// An argument and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Arg {
    pub(crate) value: Value,
    pub(crate) span: Range<usize>,
}

/// What an argument is.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// A number, or an expression of numbers and names, already worked out.
    Number(f64),
    /// The text between quotes; it begins one byte after the argument.
    Text(String),
    /// `(a, b, ...)`, of two or more numbers.
    Vector(Vec<f64>),
    /// `[...]`.
    List(Vec<Arg>),
}

/// The kinds of [`Value`], to tell apart what was given and what was wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Number,
    Text,
    Vector(usize),
    List,
}

impl Value {
    pub(crate) fn shape(&self) -> Shape {
        match self {
            Self::Number(_) => Shape::Number,
            Self::Text(_) => Shape::Text,
            Self::Vector(v) => Shape::Vector(v.len()),
            Self::List(_) => Shape::List,
        }
    }
}

impl std::fmt::Display for Shape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number => f.write_str("number"),
            Self::Text => f.write_str("string"),
            Self::Vector(n) => write!(f, "vector of {n}"),
            Self::List => f.write_str("list"),
        }
    }
}
