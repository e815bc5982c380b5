//! The names that expressions know.

use crate::math;
use crate::tape::op::{Binary, Unary};

use super::error::Arity;
use super::graph::{Graph, NodeId, Var};

/// How a call becomes operations.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Call {
    Unary(Unary),
    Binary(Binary),
    /// Any number of arguments, joined from the left.
    Fold(Binary),
    Average,
    Clamp,
    InRange,
    If,
    /// Multiplied by a number.
    Scale(f64),
}

impl Call {
    pub(crate) fn arity(self) -> Arity {
        match self {
            Self::Unary(_) | Self::Scale(_) => Arity::Exactly(1),
            Self::Binary(_) => Arity::Exactly(2),
            Self::Fold(_) | Self::Average => Arity::AtLeast(1),
            Self::Clamp | Self::InRange | Self::If => Arity::Exactly(3),
        }
    }

    /// The call as nodes; `None` for a wrong number of arguments.
    pub(crate) fn lower(self, graph: &mut Graph, arguments: &[NodeId]) -> Option<NodeId> {
        Some(match (self, arguments) {
            (Self::Unary(op), &[a]) => graph.unary(op, a),
            (Self::Scale(factor), &[a]) => {
                let factor = graph.constant(factor);
                graph.binary(Binary::Mul, a, factor)
            }
            (Self::Binary(op), &[a, b]) => graph.binary(op, a, b),
            (Self::Fold(op), &[first, ref rest @ ..]) => fold(graph, op, first, rest),
            (Self::Average, &[first, ref rest @ ..]) => {
                let sum = fold(graph, Binary::Add, first, rest);
                let count = graph.constant(arguments.len() as f64);
                graph.binary(Binary::Div, sum, count)
            }
            (Self::Clamp, &[lo, x, hi]) => {
                let raised = graph.binary(Binary::Max, x, lo);
                graph.binary(Binary::Min, raised, hi)
            }
            (Self::InRange, &[lo, x, hi]) => {
                let above = graph.binary(Binary::LessEqual, lo, x);
                let below = graph.binary(Binary::LessEqual, x, hi);
                graph.binary(Binary::And, above, below)
            }
            (Self::If, &[c, a, b]) => graph.select(c, a, b),
            _ => return None,
        })
    }
}

fn fold(graph: &mut Graph, op: Binary, first: NodeId, rest: &[NodeId]) -> NodeId {
    rest.iter().fold(first, |sum, &next| graph.binary(op, sum, next))
}

/// Every function.
const FUNCTIONS: [(&str, Call); 42] = [
    ("abs", Call::Unary(Unary::Abs)),
    ("acos", Call::Unary(Unary::Acos)),
    ("acosh", Call::Unary(Unary::Acosh)),
    ("asin", Call::Unary(Unary::Asin)),
    ("asinh", Call::Unary(Unary::Asinh)),
    ("atan", Call::Unary(Unary::Atan)),
    ("atan2", Call::Binary(Binary::Atan2)),
    ("atanh", Call::Unary(Unary::Atanh)),
    ("avg", Call::Average),
    ("ceil", Call::Unary(Unary::Ceil)),
    ("clamp", Call::Clamp),
    ("cos", Call::Unary(Unary::Cos)),
    ("cosh", Call::Unary(Unary::Cosh)),
    ("deg2rad", Call::Scale(math::DEGREE)),
    ("erf", Call::Unary(Unary::Erf)),
    ("erfc", Call::Unary(Unary::Erfc)),
    ("exp", Call::Unary(Unary::Exp)),
    ("expm1", Call::Unary(Unary::Expm1)),
    ("floor", Call::Unary(Unary::Floor)),
    ("frac", Call::Unary(Unary::Frac)),
    ("hypot", Call::Binary(Binary::Hypot)),
    ("if", Call::If),
    ("inrange", Call::InRange),
    ("log", Call::Unary(Unary::Log)),
    ("log10", Call::Unary(Unary::Log10)),
    ("log1p", Call::Unary(Unary::Log1p)),
    ("log2", Call::Unary(Unary::Log2)),
    ("max", Call::Fold(Binary::Max)),
    ("min", Call::Fold(Binary::Min)),
    ("mul", Call::Fold(Binary::Mul)),
    ("pow", Call::Binary(Binary::Pow)),
    ("rad2deg", Call::Scale(math::RADIAN)),
    ("root", Call::Binary(Binary::Root)),
    ("round", Call::Unary(Unary::Round)),
    ("sgn", Call::Unary(Unary::Sgn)),
    ("sin", Call::Unary(Unary::Sin)),
    ("sinh", Call::Unary(Unary::Sinh)),
    ("sqrt", Call::Unary(Unary::Sqrt)),
    ("sum", Call::Fold(Binary::Add)),
    ("tan", Call::Unary(Unary::Tan)),
    ("tanh", Call::Unary(Unary::Tanh)),
    ("trunc", Call::Unary(Unary::Trunc)),
];

/// Every variable and constant.
const VARIABLES: [&str; 12] =
    ["x", "y", "z", "rho", "phic", "phi", "r", "theta", "phis", "d", "pi", "e"];

/// The function of this name.
pub(crate) fn function(name: &str) -> Option<Call> {
    FUNCTIONS.iter().find(|(n, _)| *n == name).map(|(_, call)| *call)
}

/// The variable or constant of this name, as a node.
pub(crate) fn variable(graph: &mut Graph, name: &str) -> Option<NodeId> {
    let mut squares = |vars: &[Var]| {
        let squares: Vec<_> = vars
            .iter()
            .map(|&var| {
                let var = graph.var(var);
                graph.unary(Unary::Square, var)
            })
            .collect();
        let sum = fold(graph, Binary::Add, squares[0], &squares[1..]);
        graph.unary(Unary::Sqrt, sum)
    };
    Some(match name {
        "x" => graph.var(Var::X),
        "y" => graph.var(Var::Y),
        "z" => graph.var(Var::Z),
        "d" => graph.var(Var::DISTANCE),
        "pi" => graph.constant(std::f64::consts::PI),
        "e" => graph.constant(std::f64::consts::E),
        "rho" => squares(&[Var::X, Var::Y]),
        "r" => squares(&[Var::X, Var::Y, Var::Z]),
        "phi" | "phic" | "theta" => {
            let (y, x) = (graph.var(Var::Y), graph.var(Var::X));
            graph.binary(Binary::Atan2, y, x)
        }
        // The angle acos(z / r), in a form that keeps its digits near the axis and is 0, not NaN,
        // at the origin.
        "phis" => {
            let rho = squares(&[Var::X, Var::Y]);
            let z = graph.var(Var::Z);
            graph.binary(Binary::Atan2, rho, z)
        }
        _ => return None,
    })
}

/// The known name most like `name`, if one is like it: among functions or among variables and
/// `constants`.
pub(crate) fn suggestion(name: &str, functions: bool, constants: &[(&str, f64)]) -> Option<String> {
    let close = |known: &str| {
        let distance = edits(&name.to_ascii_lowercase(), &known.to_ascii_lowercase());
        // Short names: one edit would turn any into any other.
        let most = if known.len().min(name.len()) < 3 { 0 } else { name.len().div_ceil(3).min(2) };
        (distance <= most).then_some(distance)
    };
    let variables = VARIABLES.iter().copied().chain(constants.iter().map(|c| c.0));
    let names: Vec<&str> =
        if functions { FUNCTIONS.iter().map(|f| f.0).collect() } else { variables.collect() };
    let best = names.into_iter().filter_map(|n| Some((close(n)?, n))).min_by_key(|found| found.0);
    best.map(|(_, name)| name.to_owned())
}

/// The fewest letters to put in, take out or change to make `a` of `b` (Levenshtein's distance).
fn edits(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.bytes().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.bytes().enumerate() {
            let change = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = change.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_misses_are_suggested() {
        for (name, functions, expected) in [
            ("sine", true, Some("sin")),
            ("Sqrt", true, Some("sqrt")),
            ("arctan2", true, Some("atan2")),
            ("clmp", true, Some("clamp")),
            ("q", false, None),
            ("X", false, Some("x")),
            ("rhoo", false, Some("rho")),
            ("widht", false, Some("width")),
            ("zebra", false, None),
        ] {
            let found = suggestion(name, functions, &[("width", 1.0)]);
            assert_eq!(found.as_deref(), expected, "{name}");
        }
    }
}
