//! Expressions: text to a hash-consed graph.

mod error;
pub(crate) mod graph;
mod names;
mod parser;
mod token;

use std::fmt;
use std::sync::Arc;

pub use error::{Arity, ExprError, ExprErrorKind};

use graph::{Graph, Node, NodeId, Var};

/// A formula in space: numbers, coordinates, operators and functions.
///
/// Immutable and cheap to clone. To evaluate one, compile it to an
/// [`ExprField`](crate::ExprField).
///
/// # Language
///
/// | | |
/// |---|---|
/// | coordinates, mm and radians | `x y z`; `rho phic` (also `phi`) and `z`; `r theta phis` |
/// | distance of the child, mm | `d`, negative inside |
/// | constants | `pi e` |
/// | functions of one number | `abs acos acosh asin asinh atan atanh ceil cos cosh deg2rad erf erfc exp expm1 floor frac log log10 log1p log2 rad2deg round sgn sin sinh sqrt tan tanh trunc` |
/// | of two | `atan2(y, x) hypot pow root(x, n)` |
/// | of three | `clamp(lo, x, hi) if(c, a, b) inrange(lo, x, hi)` |
/// | of any | `avg max min mul sum` |
///
/// Operators, tightest first:
///
/// | operator | groups | |
/// |---|---|---|
/// | `^` | from the right | the exponent may have a sign; `-x^2` is `-(x^2)` |
/// | `-` `+` `not` before a value | | |
/// | `*` `/` `%` and nothing at all | from the left | `2x`, `2 sin(x)`, `4(x)(y)`; `1/2x` is `(1/2)*x` |
/// | `+` `-` | from the left | |
/// | `==` `!=` `<` `<=` `>` `>=` | from the left | 0 or 1 |
/// | `and` `&` | from the left | 0 or 1; any number but 0 is true |
/// | `or` <code>&#124;</code> | from the left | 0 or 1 |
/// | `c ? a : b` | from the right | |
///
/// `%` has the sign of the dividend; `frac` is `x - trunc(x)`; `round` takes halves away from zero;
/// `root` is real for a negative `x` where `n` is odd. `phis` is the angle from the z axis, 0 at
/// the origin.
///
/// ```
/// use fgm_field::{Expr, ExprField};
/// use fgm_core::{Field, Point3};
///
/// let field = ExprField::new(&Expr::parse("-4.5(rho - 4) + 4(3)^2 z")?);
/// assert_eq!(field.eval(Point3::new(3.0, 4.0, 2.0)), -4.5 + 72.0);
/// # Ok::<(), fgm_field::ExprError>(())
/// ```
#[derive(Clone)]
pub struct Expr {
    nodes: Arc<[Node]>,
    root: NodeId,
}

impl Expr {
    /// The longest source, bytes.
    pub const MAX_LENGTH: usize = 1 << 16;
    /// The deepest nesting of parentheses, calls, signs, powers and ternaries.
    pub const MAX_DEPTH: usize = 200;
    /// The most different operations.
    pub const MAX_NODES: usize = 20_000;

    /// Reads a formula.
    ///
    /// # Errors
    /// [`ExprError`] with the place: what is not a formula, a part without variables that is not
    /// finite, a division by zero wherever it is evaluated, and what breaks the limits above.
    pub fn parse(source: &str) -> Result<Self, ExprError> {
        Self::parse_with(source, &[])
    }

    /// Reads a formula in which more names stand for numbers. They come before the built-in
    /// variables and constants of the same name.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_with(source: &str, constants: &[(&str, f64)]) -> Result<Self, ExprError> {
        let (graph, root) = parser::Parser::parse(source, constants)?;
        Ok(Self::of(graph, root))
    }

    /// The formula that is this number everywhere.
    pub fn constant(value: f64) -> Self {
        let mut graph = Graph::default();
        let root = graph.constant(value);
        Self::of(graph, root)
    }

    pub(crate) fn of(graph: Graph, root: NodeId) -> Self {
        Self { nodes: graph.into_nodes().into(), root }
    }

    /// Whether it reads `d`.
    pub fn uses_distance(&self) -> bool {
        self.reads(Var::DISTANCE)
    }

    /// The number it is everywhere, if it depends on nothing.
    pub fn value(&self) -> Option<f64> {
        graph::constant_of(self.nodes[self.root as usize])
    }

    pub(crate) fn reads(&self, var: Var) -> bool {
        let needed = graph::needed(&self.nodes, self.root);
        needed.iter().zip(&*self.nodes).any(|(&needed, &node)| needed && node == Node::Var(var))
    }

    /// The nodes and the root among them.
    pub(crate) fn graph(&self) -> (&[Node], NodeId) {
        (&self.nodes, self.root)
    }

    /// Adds this formula to a graph, with its own variables.
    pub(crate) fn add_to(&self, graph: &mut Graph) -> NodeId {
        graph.import(&self.nodes, self.root, Graph::var)
    }

    /// The same formula with a number in place of z.
    pub(crate) fn at_z(&self, z: f64) -> Self {
        let mut graph = Graph::default();
        let root = graph.import(&self.nodes, self.root, |graph, var| match var {
            Var::Z => graph.constant(z),
            _ => graph.var(var),
        });
        Self::of(graph, root)
    }
}

impl fmt::Debug for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Expr").field("nodes", &self.nodes.len()).finish_non_exhaustive()
    }
}
