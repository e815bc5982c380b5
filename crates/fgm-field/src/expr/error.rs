//! Why a text is not an expression, and where.

use std::fmt;
use std::ops::Range;

/// What is wrong with an expression, and where.
///
/// `Display` says what was found and what was expected; it does not repeat the source, since the
/// caller knows how to show a place in it.
///
/// ```
/// let error = fgm_field::Expr::parse("2 + sine(x)").unwrap_err();
/// assert_eq!(error.to_string(), "unknown function `sine`; did you mean `sin`?");
/// assert_eq!(error.span, 4..8);
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{kind}")]
pub struct ExprError {
    /// The place, as a byte range of the source; empty at the end of it.
    pub span: Range<usize>,
    /// What is wrong there.
    pub kind: ExprErrorKind,
}

/// How many arguments a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// This many.
    Exactly(usize),
    /// This many or more.
    AtLeast(usize),
}

impl Arity {
    /// Whether `count` arguments are right.
    pub fn allows(self, count: usize) -> bool {
        match self {
            Self::Exactly(n) => count == n,
            Self::AtLeast(n) => count >= n,
        }
    }
}

impl fmt::Display for Arity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (words, n) = match *self {
            Self::Exactly(n) => ("", n),
            Self::AtLeast(n) => ("at least ", n),
        };
        write!(f, "{words}{n} argument{}", if n == 1 { "" } else { "s" })
    }
}

/// A name that may have been meant, as an end of a sentence.
struct Meant<'a>(&'a Option<String>);

impl fmt::Display for Meant<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(name) => write!(f, "; did you mean `{name}`?"),
            None => Ok(()),
        }
    }
}

/// What can be wrong with an expression.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExprErrorKind {
    /// A character that no expression has.
    #[error("unexpected character {found:?}; expected {expected}")]
    UnexpectedCharacter {
        /// The character.
        found: char,
        /// What could stand here.
        expected: &'static str,
    },
    /// A token in the wrong place.
    #[error("unexpected `{found}`; expected {expected}")]
    Unexpected {
        /// The token's text.
        found: String,
        /// What could stand here.
        expected: &'static str,
    },
    /// The source ends too early.
    #[error("the expression ends here; expected {expected}")]
    UnexpectedEnd {
        /// What is missing.
        expected: &'static str,
    },
    /// A name that is neither a variable nor a constant.
    #[error("unknown variable `{name}`{}", Meant(suggestion))]
    UnknownVariable {
        /// The name.
        name: String,
        /// A known name like it.
        suggestion: Option<String>,
    },
    /// A name before parentheses that is no function.
    #[error("unknown function `{name}`{}", Meant(suggestion))]
    UnknownFunction {
        /// The name.
        name: String,
        /// A known name like it.
        suggestion: Option<String>,
    },
    /// A function without its parentheses.
    #[error("`{name}` is a function; expected `(` and {arity} after it")]
    MissingArguments {
        /// The function.
        name: String,
        /// What it takes.
        arity: Arity,
    },
    /// A function with too few or too many arguments.
    #[error("`{function}` takes {expected}, not {found}")]
    ArgumentCount {
        /// The function.
        function: String,
        /// What it takes.
        expected: Arity,
        /// What it was given.
        found: usize,
    },
    /// A part that divides by zero wherever it is evaluated.
    #[error("division by zero")]
    DivisionByZero,
    /// A part without variables whose value is not a finite number.
    #[error("the value of this is {value}; expected a finite number")]
    NotFinite {
        /// The value: NaN or infinite.
        value: f64,
    },
    /// The source is longer than [`Expr::MAX_LENGTH`](crate::Expr::MAX_LENGTH).
    #[error("the expression has {length} bytes, where {limit} are possible")]
    TooLong {
        /// How long it is.
        length: usize,
        /// How long it may be.
        limit: usize,
    },
    /// Parentheses, signs and powers nest deeper than [`Expr::MAX_DEPTH`](crate::Expr::MAX_DEPTH).
    #[error("nested deeper than {limit} levels")]
    TooDeep {
        /// How deep they may.
        limit: usize,
    },
    /// More different operations than [`Expr::MAX_NODES`](crate::Expr::MAX_NODES).
    #[error("more than {limit} different operations")]
    TooManyNodes {
        /// How many there may be.
        limit: usize,
    },
}
