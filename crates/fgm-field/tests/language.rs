//! What expressions mean, and what is said of those that mean nothing.

mod common;

use common::{arithmetic, point};
use fgm_core::{Field, Point3};
use fgm_field::{Arity, Expr, ExprErrorKind, ExprField};
use proptest::prelude::*;

fn at(text: &str, p: Point3) -> f64 {
    match Expr::parse(text) {
        Ok(expr) => ExprField::new(&expr).eval(p),
        Err(error) => {
            assert_eq!(error.to_string(), "", "{text} at {:?}", error.span);
            f64::NAN
        }
    }
}

#[test]
fn values() {
    // At x = 3, y = 4, z = 12.
    let p = Point3::new(3.0, 4.0, 12.0);
    let (pi, e) = (std::f64::consts::PI, std::f64::consts::E);
    for (text, expected) in [
        // Implicit multiplication.
        ("-4.5(rho - 4)", -4.5),
        ("4(3)^2(x^2+y^2)", 900.0),
        ("2x", 6.0),
        ("2 sin(x)", 2.0 * 3f64.sin()),
        ("(x)(y)", 12.0),
        ("(x)2", 6.0),
        ("x y", 12.0),
        ("x(y + 1)", 15.0),
        ("1/2x", 1.5),
        ("2x^2", 18.0),
        ("2pi", 2.0 * pi),
        ("2e", 2.0 * e),
        ("2e1x", 60.0),
        ("2exp(0)", 2.0),
        ("2e-x", 2.0 * e - 3.0),
        ("3 sin(0) + 1", 1.0),
        ("pi(2)", 2.0 * pi),
        // Precedence.
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("2 - 3 - 4", -5.0),
        ("2 / 4 / 2", 0.25),
        ("2^3^2", 512.0),
        ("-x^2", -9.0),
        ("(-x)^2", 9.0),
        ("2^-1", 0.5),
        ("2^-x^2", 0.001_953_125),
        ("-2 * -3", 6.0),
        ("--x", 3.0),
        ("+x", 3.0),
        ("7 % 4 * 2", 6.0),
        ("-7 % 4", -3.0),
        ("1 < 2 == 1", 1.0),
        ("1 or 0 and 0", 1.0),
        ("1 | 0 & 0", 1.0),
        ("not 0 and 0", 0.0),
        ("not(x) + 1", 1.0),
        ("not x == 0", 1.0),
        ("x > 2 and y > 2", 1.0),
        ("1 + 1 > 1", 1.0),
        ("x < 1 ? 10 : x < 5 ? 20 : 30", 20.0),
        ("1 ? 2 : 3 + 4", 2.0),
        ("(0 ? 2 : 3) + 4", 7.0),
        ("x >= 3", 1.0),
        ("x <= 2", 0.0),
        ("x != 3", 0.0),
        // Coordinates.
        ("rho", 5.0),
        ("r", 13.0),
        ("phi", 4f64.atan2(3.0)),
        ("phic", 4f64.atan2(3.0)),
        ("theta", 4f64.atan2(3.0)),
        ("phis", (12.0f64 / 13.0).acos()),
        // Functions.
        ("abs(-x)", 3.0),
        ("avg(x, y, 5)", 4.0),
        ("avg(x)", 3.0),
        ("ceil(1.2)", 2.0),
        ("clamp(1, x, 2)", 2.0),
        ("clamp(4, x, 5)", 4.0),
        ("clamp(0, x, 9)", 3.0),
        ("erf(0.5)", 0.520_499_877_813_046_5),
        ("erfc(0.5)", 0.479_500_122_186_953_5),
        ("exp(1)", e),
        ("expm1(1e-10)", 1e-10f64.exp_m1()),
        ("floor(-1.2)", -2.0),
        ("frac(-1.25)", -0.25),
        ("hypot(x, y)", 5.0),
        ("log(e)", 1.0),
        ("log10(1000)", 3.0),
        ("log1p(1e-10)", 1e-10f64.ln_1p()),
        ("log2(8)", 3.0),
        ("max(x, y, z, 1)", 12.0),
        ("min(x, y, z)", 3.0),
        ("mul(x, y, z)", 144.0),
        ("sum(x, y, z)", 19.0),
        ("pow(x, 2.5)", 3f64.powf(2.5)),
        ("root(27, x)", 3.0),
        ("root(-8, 3)", -2.0),
        ("root(-32, 5)", -2.0),
        ("root(9, 2)", 3.0),
        ("round(2.5)", 3.0),
        ("round(-2.5)", -3.0),
        ("sgn(-x)", -1.0),
        ("sgn(0)", 0.0),
        ("sqrt(y)", 2.0),
        ("trunc(-1.7)", -1.0),
        ("sin(x)", 3f64.sin()),
        ("cos(x)", 3f64.cos()),
        ("tan(x)", 3f64.tan()),
        ("asin(0.5)", 0.5f64.asin()),
        ("acos(0.5)", 0.5f64.acos()),
        ("atan(x)", 3f64.atan()),
        ("atan2(x, y)", 3f64.atan2(4.0)),
        ("sinh(1)", 1f64.sinh()),
        ("cosh(1)", 1f64.cosh()),
        ("tanh(1)", 1f64.tanh()),
        ("asinh(x)", 3f64.asinh()),
        ("acosh(x)", 3f64.acosh()),
        ("atanh(0.5)", 0.5f64.atanh()),
        ("deg2rad(180)", pi),
        ("rad2deg(pi)", 180.0),
        ("if(x > 1, y, z)", 4.0),
        ("if(x < 1, y, z)", 12.0),
        ("inrange(1, x, 5)", 1.0),
        ("inrange(4, x, 5)", 0.0),
        ("inrange(3, x, 3)", 1.0),
        // White space, numbers.
        (" 1\n+\t2\r\n", 3.0),
        (".5 + 1.", 1.5),
        ("1.5e-1", 0.15),
        ("1E2", 100.0),
        ("0 * x", 0.0),
    ] {
        let value = at(text, p);
        let near = (value - expected).abs() <= 4e-15 * expected.abs();
        assert!(near, "{text} = {value}, not {expected}");
    }
}

#[test]
fn points_where_there_is_no_value_are_nan_or_infinite() {
    for (text, p) in [("1/x", Point3::ZERO), ("sqrt(x)", -Point3::X), ("x/(x*y)", Point3::X)] {
        assert!(!at(text, p).is_finite(), "{text}");
    }
    assert_eq!(at("phis", Point3::ZERO), 0.0);
    assert!(at("min(sqrt(x), 1)", -Point3::X).is_nan());
    assert!(at("max(1, sqrt(x))", -Point3::X).is_nan());
    assert!(at("clamp(0, sqrt(x), 1)", -Point3::X).is_nan());
}

#[test]
fn errors_point_at_the_place() {
    for (text, span, message) in [
        ("", 0..0, "the expression ends here; expected a number, a variable, a function or `(`"),
        ("1 +", 3..3, "the expression ends here; expected a number, a variable, a function or `(`"),
        ("1 + * 2", 4..5, "unexpected `*`; expected a number, a variable, a function or `(`"),
        ("(1 + 2", 6..6, "the expression ends here; expected an operator or `)`"),
        ("1 + 2)", 5..6, "unexpected `)`; expected an operator or the end; no `(` belongs to this"),
        ("max(1, 2", 8..8, "the expression ends here; expected an operator, `,` or `)`"),
        ("max(1; 2)", 5..6, "unexpected character ';'; expected a number, a name or an operator"),
        ("x = 1", 2..3, "unexpected character '='; expected `==` to compare"),
        ("[x]", 0..1, "unexpected character '['; expected `(` or `)`"),
        ("x 2", 2..3, "unexpected `2`; expected an operator or the end"),
        ("1.2.3", 0..4, "unexpected `1.2.`; expected a number with one decimal point and a digit"),
        (".", 0..1, "unexpected `.`; expected a number with one decimal point and a digit"),
        ("1 ? 2", 5..5, "the expression ends here; expected `:` and the value for the other case"),
        ("and 1", 0..3, "unexpected `and`; expected a number, a variable, a function or `(`"),
        ("2 sine(x)", 2..6, "unknown function `sine`; did you mean `sin`?"),
        ("blorp(x)", 0..5, "unknown function `blorp`"),
        ("x + rh", 4..6, "unknown variable `rh`"),
        ("rhoo + 1", 0..4, "unknown variable `rhoo`; did you mean `rho`?"),
        ("sin x", 0..3, "`sin` is a function; expected `(` and 1 argument after it"),
        ("clamp(1, 2)", 0..11, "`clamp` takes 3 arguments, not 2"),
        ("1 + min()", 4..9, "`min` takes at least 1 argument, not 0"),
        ("if(1, 2, 3, 4)", 0..14, "`if` takes 3 arguments, not 4"),
        ("x + 1/0", 4..7, "division by zero"),
        ("x / (y - y)", 0..11, "division by zero"),
        ("x % 0", 0..5, "division by zero"),
        ("2 + sqrt(-1)", 4..12, "the value of this is NaN; expected a finite number"),
        ("log(0) + x", 0..6, "the value of this is -inf; expected a finite number"),
        ("1e400", 0..5, "the value of this is inf; expected a finite number"),
        ("0^-1", 0..4, "the value of this is inf; expected a finite number"),
        ("x + é", 4..6, "unexpected character 'é'; expected a number, a name or an operator"),
    ] {
        let error = Expr::parse(text).expect_err(text);
        assert_eq!((error.to_string().as_str(), error.span), (message, span), "{text}");
    }
}

#[test]
fn limits_hold() {
    let kind = |text: &str| Expr::parse(text).map(|_| ()).map_err(|e| e.kind);
    let long = "1+".repeat(Expr::MAX_LENGTH / 2) + "1";
    assert!(matches!(kind(&long), Err(ExprErrorKind::TooLong { .. })));
    for (open, close) in
        [("(", ")"), ("-", ""), ("sin(", ")"), ("x^", ""), ("x?1:", ""), ("not ", "")]
    {
        let nested = |n: usize| open.repeat(n) + "x" + &close.repeat(n);
        assert_eq!(kind(&nested(Expr::MAX_DEPTH - 1)), Ok(()), "{open}");
        let deep = kind(&nested(Expr::MAX_DEPTH + 1));
        assert_eq!(deep, Err(ExprErrorKind::TooDeep { limit: Expr::MAX_DEPTH }), "{open}");
    }
    // Flat chains are not deep.
    assert_eq!(kind(&("x".to_owned() + &"+x*y".repeat(16_000))), Ok(()));
    let many: Vec<_> = (0..6000).map(|i| format!("(x+{i})")).collect();
    assert_eq!(kind(&many.join("*")), Ok(()));
    let many: Vec<_> = (0..8_000).map(|i| format!("x+{i}")).collect();
    assert!(matches!(kind(&many.join("|")), Err(ExprErrorKind::TooManyNodes { .. })));
}

#[test]
fn numbers_by_name() {
    let names = [("width", 4.0), ("e", 7.0), ("bad", f64::NAN)];
    let field = ExprField::new(&Expr::parse_with("2width(x) + e", &names).unwrap());
    assert_eq!(field.eval(Point3::X), 15.0);
    let error = Expr::parse_with("x + bad", &names).unwrap_err();
    assert!(matches!(error.kind, ExprErrorKind::NotFinite { .. }) && error.span == (4..7));
    let error = Expr::parse_with("widht", &names).unwrap_err();
    assert_eq!(error.to_string(), "unknown variable `widht`; did you mean `width`?");
}

#[test]
fn what_an_expression_knows_of_itself() {
    let expr = |text| Expr::parse(text).unwrap();
    assert!(expr("x + d").uses_distance());
    assert!(!expr("x").uses_distance());
    assert_eq!(expr("2 * 3 + max(1, 2)").value(), Some(8.0));
    assert_eq!(expr("x").value(), None);
    assert_eq!(Expr::constant(3.0).value(), Some(3.0));
    assert!(Arity::AtLeast(1).allows(3) && !Arity::Exactly(2).allows(3));
}

proptest! {
    #[test]
    fn text_means_what_the_tree_means(tree in arithmetic(), p in point()) {
        let value = tree.value(p);
        for text in [tree.text(), tree.full_text()] {
            match Expr::parse(&text) {
                Ok(expr) => {
                    let ours = ExprField::new(&expr).eval(p);
                    let same = ours == value || (ours.is_nan() && value.is_nan());
                    prop_assert!(same, "{text} at {p}: {ours}, not {value}");
                }
                Err(error) => {
                    let expected = matches!(
                        error.kind,
                        ExprErrorKind::DivisionByZero | ExprErrorKind::NotFinite { .. }
                    );
                    prop_assert!(expected, "{text}: {error}");
                }
            }
        }
    }

    #[test]
    fn any_text_is_an_expression_or_an_error_inside_it(text in ".{0,60}") {
        check_any(&text)?;
    }

    #[test]
    fn any_words_are_an_expression_or_an_error_inside_them(
        words in prop::collection::vec(prop::sample::select(WORDS), 0..40)
    ) {
        check_any(&words.concat())?;
        check_any(&words.join(" "))?;
    }
}

const WORDS: &[&str] = &[
    "x", "rho", "d", "pi", "e", "sin", "min", "if", "clamp", "(", ")", "(", ")", ",", "+", "-",
    "*", "/", "%", "^", "==", "<", "?", ":", "and", "or", "not", "&", "1", "2.5", "1e3", "0", ".",
    "é",
];

fn check_any(text: &str) -> Result<(), TestCaseError> {
    if let Err(error) = Expr::parse(text) {
        prop_assert!(text.get(error.span.clone()).is_some(), "{text:?}: {:?}", error.span);
        prop_assert!(!error.to_string().is_empty());
    }
    Ok(())
}
