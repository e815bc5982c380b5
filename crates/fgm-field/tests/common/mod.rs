//! Random formulas: a tree, its text, and a plain evaluation that shares nothing with the crate.
#![allow(dead_code, clippy::panic)]

use fgm_core::{Bounds3, Field, Interval, Point3};
use proptest::prelude::*;

#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Number(f64),
    Name(&'static str),
    /// `-a`, `+a`, `not a`.
    Prefix(&'static str, Box<Tree>),
    Infix(&'static str, Box<Tree>, Box<Tree>),
    Ternary(Box<Tree>, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

use Tree::{Call, Infix, Name, Number, Prefix, Ternary};

/// Binds tighter the higher; a value is 9.
fn precedence(tree: &Tree) -> u8 {
    match tree {
        Number(_) | Name(_) | Call(..) => 9,
        Infix("^", ..) => 8,
        Prefix(..) => 7,
        Infix("*" | "/" | "%", ..) => 6,
        Infix("+" | "-", ..) => 5,
        Infix("<" | "<=" | ">" | ">=" | "==" | "!=", ..) => 4,
        Infix("and", ..) => 3,
        Infix("or", ..) => 2,
        Infix(other, ..) => panic!("no precedence for {other}"),
        Ternary(..) => 1,
    }
}

impl Tree {
    /// The text with no more parentheses than the documented precedences need.
    pub(crate) fn text(&self) -> String {
        match self {
            Number(value) => format!("{value}"),
            Name(name) => (*name).into(),
            Prefix(sign, a) => format!("{sign} {}", a.within(7)),
            Infix("^", a, b) => format!("{}^{}", a.within(9), b.within(7)),
            Infix(op, a, b) => {
                let own = precedence(self);
                format!("{} {op} {}", a.within(own), b.within(own + 1))
            }
            Ternary(c, a, b) => format!("{} ? {} : {}", c.within(2), a.text(), b.text()),
            Call(name, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(Tree::text).collect();
                format!("{name}({})", arguments.join(", "))
            }
        }
    }

    /// The text, in parentheses if it binds looser than `least`.
    fn within(&self, least: u8) -> String {
        if precedence(self) < least { format!("({})", self.text()) } else { self.text() }
    }

    /// The text with parentheses around everything.
    pub(crate) fn full_text(&self) -> String {
        match self {
            Number(_) | Name(_) => self.text(),
            Prefix(sign, a) => format!("({sign}({}))", a.full_text()),
            Infix(op, a, b) => format!("({}{op}{})", parens(a), parens(b)),
            Ternary(c, a, b) => format!("({}?{}:{})", parens(c), parens(a), parens(b)),
            Call(name, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(Tree::full_text).collect();
                format!("{name}({})", arguments.join(","))
            }
        }
    }

    /// The value, for the arithmetic that is exact to the bit.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let flag = |c: bool| f64::from(u8::from(c));
        match self {
            Number(value) => *value,
            Name("x") => p.x,
            Name("y") => p.y,
            Name("z") => p.z,
            Name(other) => panic!("no value for {other}"),
            Prefix("-", a) => -a.value(p),
            Prefix("+", a) => a.value(p),
            Prefix(_, a) => flag(a.value(p) == 0.0),
            Ternary(c, a, b) => if c.value(p) != 0.0 { a } else { b }.value(p),
            Infix(op, a, b) => {
                let (a, b) = (a.value(p), b.value(p));
                match *op {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "%" => a % b,
                    "^" if b == 2.0 => a * a,
                    "^" => a * a * a,
                    "<" => flag(a < b),
                    "<=" => flag(a <= b),
                    ">" => flag(a > b),
                    ">=" => flag(a >= b),
                    "==" => flag(a == b),
                    "!=" => flag(a != b),
                    "and" => flag(a != 0.0 && b != 0.0),
                    "or" => flag(a != 0.0 || b != 0.0),
                    other => panic!("no value for {other}"),
                }
            }
            Call(name, _) => panic!("no value for {name}"),
        }
    }
}

fn parens(tree: &Tree) -> String {
    format!("({})", tree.full_text())
}

fn infix(op: &'static str, a: Tree, b: Tree) -> Tree {
    Infix(op, Box::new(a), Box::new(b))
}

fn leaf(names: &'static [&'static str]) -> impl Strategy<Value = Tree> {
    prop_oneof![
        prop::sample::select(vec![0.0, 1.0, 2.0, 3.0, 0.5, 0.25, 10.0, 1e-3]).prop_map(Number),
        (0.0..10.0f64).prop_map(Number),
        prop::sample::select(names).prop_map(Name),
        prop::sample::select(names).prop_map(Name),
    ]
}

const INFIXES: &[&str] =
    &["+", "-", "*", "/", "%", "<", "<=", ">", ">=", "==", "!=", "and", "or", "+", "-", "*"];

fn arithmetic_over(leaf: impl Strategy<Value = Tree> + 'static) -> impl Strategy<Value = Tree> {
    leaf.prop_recursive(5, 40, 3, |inner| {
        prop_oneof![
            4 => (prop::sample::select(INFIXES), inner.clone(), inner.clone())
                .prop_map(|(op, a, b)| infix(op, a, b)),
            1 => (prop::sample::select(&["-", "+", "not"][..]), inner.clone())
                .prop_map(|(sign, a)| Prefix(sign, Box::new(a))),
            1 => (inner.clone(), prop::sample::select(vec![2.0, 3.0]))
                .prop_map(|(a, n)| infix("^", a, Number(n))),
            1 => (inner.clone(), inner.clone(), inner)
                .prop_map(|(c, a, b)| Ternary(Box::new(c), Box::new(a), Box::new(b))),
        ]
    })
}

/// Formulas of operators over coordinates.
pub(crate) fn arithmetic() -> impl Strategy<Value = Tree> {
    arithmetic_over(leaf(&["x", "y", "z"]))
}

const UNARY: &[&str] = &[
    "abs", "acos", "acosh", "asin", "asinh", "atan", "atanh", "ceil", "cos", "cosh", "deg2rad",
    "erf", "erfc", "exp", "expm1", "floor", "frac", "log", "log10", "log1p", "log2", "rad2deg",
    "round", "sgn", "sin", "sinh", "sqrt", "tan", "tanh", "trunc",
];
const OF_TWO: &[&str] = &["atan2", "hypot", "pow", "root", "min", "max", "avg", "sum", "mul"];
const OF_THREE: &[&str] = &["clamp", "if", "inrange", "min", "max", "avg"];

/// Formulas of everything that the language has.
pub(crate) fn formula() -> impl Strategy<Value = Tree> {
    let leaf = leaf(&["x", "y", "z", "rho", "phi", "r", "theta", "phis", "d", "pi", "e"]);
    arithmetic_over(leaf).prop_recursive(3, 30, 3, |inner| {
        prop_oneof![
            3 => (prop::sample::select(UNARY), inner.clone())
                .prop_map(|(name, a)| Call(name, vec![a])),
            1 => (inner.clone(), -5i32..=7)
                .prop_map(|(a, n)| Call("pow", vec![a, Number(f64::from(n))])),
            1 => (inner.clone(), -3i32..=5)
                .prop_map(|(a, n)| Call("root", vec![a, Number(f64::from(n))])),
            2 => (prop::sample::select(OF_TWO), inner.clone(), inner.clone())
                .prop_map(|(name, a, b)| Call(name, vec![a, b])),
            1 => (prop::sample::select(OF_THREE), inner.clone(), inner.clone(), inner.clone())
                .prop_map(|(name, a, b, c)| Call(name, vec![a, b, c])),
            2 => (prop::sample::select(INFIXES), inner.clone(), inner)
                .prop_map(|(op, a, b)| infix(op, a, b)),
        ]
    })
}

/// Coordinates, with those that fields dislike.
pub(crate) fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -20.0..20.0f64,
        1 => -3000.0..3000.0f64,
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 10.0, 1e-12, -1e-12, 0.5]),
    ]
}

pub(crate) fn point() -> impl Strategy<Value = Point3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Point3::new(x, y, z))
}

/// Boxes large, small and flat.
pub(crate) fn cell() -> impl Strategy<Value = Bounds3> {
    let size = prop_oneof![Just(0.0), 0.0..1e-6f64, 0.0..1.0f64, 0.0..50.0f64];
    (point(), [size.clone(), size.clone(), size])
        .prop_map(|(p, size)| Bounds3::new(p, p + Point3::from_array(size)))
}

/// Points of a box: its corners, its middle, and some between.
pub(crate) fn points_in(cell: &Bounds3) -> Vec<Point3> {
    let size = cell.size();
    let grid = |i: usize| Point3::new((i % 4) as f64, (i / 4 % 4) as f64, (i / 16) as f64) / 3.0;
    let inside = (0..64).map(|i| (cell.min + size * grid(i)).min(cell.max));
    cell.corners().into_iter().chain(inside).chain([cell.center()]).collect()
}

/// Every evaluation of a field agrees with the value at each point, and the ranges hold it.
pub(crate) fn check_field(field: &dyn Field, cell: &Bounds3) -> Result<(), TestCaseError> {
    let points = points_in(cell);
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a == b || (a.is_nan() && b.is_nan());
    let holds = |range: Interval, value: f64| {
        if value.is_nan() { range == Interval::EVERYTHING } else { range.contains(value) }
    };
    let mut many = vec![0.0; points.len()];
    field.eval_into(&points, &mut many);
    let range = field.bounds(cell);
    for (p, many) in points.iter().zip(&many) {
        let value = field.eval(*p);
        prop_assert!(same(value, *many), "{value} alone, {many} among others, at {p}");
        prop_assert!(holds(range, value), "{value} at {p} not in {range:?} over {cell:?}");
    }
    for z in [cell.min.z, cell.max.z] {
        let layer = field.at_z(z);
        let flat: Vec<_> = points.iter().map(|p| p.truncate()).collect();
        layer.eval_into(&flat, &mut many);
        let range = layer.bounds(&cell.xy());
        for (p, many) in flat.iter().zip(&many) {
            let value = field.eval(p.extend(z));
            let alone = layer.eval(*p);
            prop_assert!(same(value, alone), "{value} in space, {alone} in the layer, at {p} {z}");
            prop_assert!(same(alone, *many), "{alone} alone, {many} among others, at {p} {z}");
            prop_assert!(holds(range, value), "{value} at {p} {z} not in the layer's {range:?}");
        }
    }
    Ok(())
}
