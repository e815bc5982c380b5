//! The operations of the tape and what each does to numbers.

/// Defines an operation enum whose variants each have one scalar function; `$each` becomes a macro
/// that hands the table on, so that every evaluator has the same operations.
macro_rules! operations {
    ($(#[$doc:meta])* $name:ident [$($params:tt)*] $args:tt $each:ident { $($variant:ident => $f:expr,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub(crate) enum $name { $($variant,)* }

        impl $name {
            /// The operation on numbers.
            #[inline(always)]
            pub(crate) fn apply(self, $($params)*) -> f64 {
                match self { $(Self::$variant => ($f) $args,)* }
            }
        }

        /// Evaluates `$with!(f)` with the scalar function of an operation known only at run time,
        /// so that the loop inside is compiled once for each.
        macro_rules! $each {
            ($op:expr, $with:ident) => {
                match $op { $($name::$variant => $with!($f),)* }
            };
        }
        pub(crate) use $each;
    };
}

operations! {
    /// Operations on one number.
    Unary [a: f64] (a) each_unary {
        Neg => |a: f64| -a,
        Abs => |a: f64| a.abs(),
        Square => |a: f64| a * a,
        Sqrt => |a: f64| a.sqrt(),
        Floor => |a: f64| a.floor(),
        Ceil => |a: f64| a.ceil(),
        Round => |a: f64| a.round(),
        Trunc => |a: f64| a.trunc(),
        Frac => crate::math::frac,
        Sgn => crate::math::sgn,
        Sin => crate::math::sin,
        Cos => crate::math::cos,
        Tan => libm::tan,
        Asin => libm::asin,
        Acos => libm::acos,
        Atan => crate::math::atan,
        Sinh => libm::sinh,
        Cosh => libm::cosh,
        Tanh => libm::tanh,
        Asinh => libm::asinh,
        Acosh => libm::acosh,
        Atanh => libm::atanh,
        Exp => crate::math::exp,
        Expm1 => libm::expm1,
        Log => libm::log,
        Log2 => libm::log2,
        Log10 => libm::log10,
        Log1p => libm::log1p,
        Erf => libm::erf,
        Erfc => libm::erfc,
        Weight => crate::math::weight,
        Not => |a: f64| crate::math::flag(a == 0.0),
    }
}

operations! {
    /// Operations on two numbers.
    Binary [a: f64, b: f64] (a, b) each_binary {
        Add => |a: f64, b: f64| a + b,
        Sub => |a: f64, b: f64| a - b,
        Mul => |a: f64, b: f64| a * b,
        Div => |a: f64, b: f64| a / b,
        Rem => |a: f64, b: f64| a % b,
        Pow => crate::math::pow,
        Root => crate::math::root,
        Hypot => crate::math::hypot,
        Atan2 => crate::math::atan2,
        Min => crate::math::min,
        Max => crate::math::max,
        Less => |a: f64, b: f64| crate::math::flag(a < b),
        LessEqual => |a: f64, b: f64| crate::math::flag(a <= b),
        Equal => |a: f64, b: f64| crate::math::flag(a == b),
        NotEqual => |a: f64, b: f64| crate::math::flag(a != b),
        And => |a: f64, b: f64| crate::math::flag((a != 0.0) & (b != 0.0)),
        Or => |a: f64, b: f64| crate::math::flag((a != 0.0) | (b != 0.0)),
        Share => crate::math::share,
    }
}

impl Binary {
    /// Whether the operands may change places without changing a bit of the result.
    pub(crate) fn commutes(self) -> bool {
        matches!(self, Self::Add | Self::Mul | Self::Equal | Self::NotEqual | Self::And | Self::Or)
    }
}

/// `c ? a : b`: `a` for any `c` that is not 0.
#[inline(always)]
pub(crate) fn select(c: f64, a: f64, b: f64) -> f64 {
    if c != 0.0 { a } else { b }
}

/// Whether the exact reciprocal of `x` exists, so that dividing is multiplying.
pub(crate) fn exact_reciprocal(x: f64) -> Option<f64> {
    let power_of_two = x.is_normal() && x.to_bits() << 12 == 0;
    let reciprocal = 1.0 / x;
    (power_of_two && reciprocal.is_normal()).then_some(reciprocal)
}
