//! One point, many points, a layer, a box: all evaluations of an expression agree.

mod common;

use std::sync::Arc;

use common::{cell, check_field, formula};
use fgm_core::{Bounds3, Field, Interval, Point3};
use fgm_field::{Cuboid, Expr, ExprErrorKind, ExprField};
use proptest::prelude::*;

/// The formula compiled, with a box for `d`; `None` where a part without variables is not finite.
fn compiled(text: &str) -> Option<ExprField> {
    let distance = Arc::new(Cuboid { size: Point3::new(4.0, 6.0, 8.0) });
    match Expr::parse(text) {
        Ok(expr) => Some(ExprField::with_distance(&expr, distance)),
        Err(error) => {
            let kind = &error.kind;
            let expected =
                matches!(kind, ExprErrorKind::DivisionByZero | ExprErrorKind::NotFinite { .. });
            assert!(expected, "{text}: {error}");
            None
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn all_evaluations_agree(tree in formula(), cell in cell()) {
        let text = tree.text();
        if let Some(field) = compiled(&text) {
            check_field(&field, &cell).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
        }
    }
}

#[test]
fn ranges_are_tight() {
    let unit = Bounds3::new(Point3::splat(-1.0), Point3::new(2.0, 1.0, 3.0));
    // Over x in -1..2, y in -1..1, z in -1..3.
    for (text, lo, hi) in [
        ("x", -1.0, 2.0),
        ("x^2", 0.0, 4.0),
        ("x^3", -1.0, 8.0),
        ("x^4", 0.0, 16.0),
        ("abs(x) - 1", -1.0, 1.0),
        ("x*y", -2.0, 2.0),
        ("min(x, 0)", -1.0, 0.0),
        ("clamp(0, x, 1)", 0.0, 1.0),
        ("sin(x)", -(1.0f64.sin()), 1.0),
        ("cos(x)", 2.0f64.cos(), 1.0),
        ("(1 + sin(10x) cos(10y)) / 2", 0.0, 1.0),
        ("rho", 0.0, 5.0f64.sqrt()),
        ("hypot(x + 2, y)", 1.0, 17.0f64.sqrt()),
        ("atan2(x + 2, y)", 1.0f64.atan2(1.0), 1.0f64.atan2(-1.0)),
        ("x > 2", 0.0, 0.0),
        ("x >= -1", 1.0, 1.0),
        ("x < 0", 0.0, 1.0),
        ("x < 5 ? y : 100", -1.0, 1.0),
        ("x < 0 ? y : 3", -1.0, 3.0),
        ("(x + 11) % 20", 10.0, 13.0),
        ("(x + 11) % 5", 0.0, 3.0),
        ("(x + 13) % 5", 0.0, 5.0),
        ("frac(0.1x + 0.5)", 0.4, 0.7),
        ("exp(x)", (-1.0f64).exp(), 2.0f64.exp()),
        ("1 / (x + 2)", 0.25, 1.0),
        ("sqrt(x + 1)", 0.0, 3.0f64.sqrt()),
        ("tan(0.5x)", (-0.5f64).tan(), 1.0f64.tan()),
        ("root(x, 3)", -1.0, 2.0f64.cbrt()),
        ("floor(x)", -1.0, 2.0),
    ] {
        let range = compiled(text).unwrap().bounds(&unit);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14 * (1.0 + b.abs());
        assert!(near(range.lo, lo) && near(range.hi, hi), "{text}: {range:?}, not {lo}..{hi}");
    }
    for text in ["1 / x", "sqrt(x)", "log(y)", "asin(x)", "tan(2x)", "x^-1", "x^0.3", "root(x, 2)"]
    {
        assert_eq!(compiled(text).unwrap().bounds(&unit), Interval::EVERYTHING, "{text}");
    }
}

#[test]
fn a_missing_distance_is_nan() {
    let field = ExprField::new(&Expr::parse("d + 1").unwrap());
    assert!(field.eval(Point3::ZERO).is_nan());
    assert!(field.at_z(1.0).eval(fgm_core::Point2::ZERO).is_nan());
    assert_eq!(field.bounds(&Bounds3::new(Point3::ZERO, Point3::ONE)), Interval::EVERYTHING);
}

#[test]
fn tapes_too_long_for_the_stack_agree_too() {
    // Every term is kept until the end: more registers than fit on the stack.
    let terms: Vec<_> = (1..200).map(|i| format!("sin({i}x)")).collect();
    let nested = terms.iter().rev().fold(String::from("y"), |sum, t| format!("({t} + {sum})"));
    let products: Vec<_> = (1..90).map(|i| format!("(x + {i})")).collect();
    let crossed = format!(
        "min({}) - max({})",
        products.join(", "),
        products.iter().rev().cloned().collect::<Vec<_>>().join(", ")
    );
    let cell = Bounds3::new(Point3::splat(-1.0), Point3::splat(2.0));
    for text in [nested, crossed] {
        check_field(&compiled(&text).unwrap(), &cell).unwrap();
    }
}

#[test]
fn a_tape_inside_a_tape_agrees() {
    let inner = Arc::new(ExprField::new(&Expr::parse("sin(x) y + z").unwrap()));
    let outer = ExprField::with_distance(&Expr::parse("d^2 + cos(d) x").unwrap(), inner);
    check_field(&outer, &Bounds3::new(Point3::splat(-1.0), Point3::splat(2.0))).unwrap();
}

#[test]
fn an_operand_read_twice_keeps_its_register() {
    // Found by `all_evaluations_agree`: the condition's register was given back twice.
    let field = compiled("if(sin(x), 1, sin(x)) + cos(y) * cos(z)").unwrap();
    check_field(&field, &Bounds3::new(Point3::splat(-1.0), Point3::splat(2.0))).unwrap();
}

#[test]
fn the_sign_of_zero_is_kept() {
    // Found by `all_evaluations_agree`: `a - z` was taken for `a` in the layer z = -0.
    for text in ["atan2(0, (-(1 < x) - z) * 1)", "atan2(0, -(1 < x) + z)", "atan2(0, abs(sqrt(z)))"]
    {
        let field = compiled(text).unwrap();
        for z in [0.0, -0.0] {
            let value = field.eval(Point3::new(0.0, 0.0, z));
            assert_eq!(value, field.at_z(z).eval(fgm_core::Point2::ZERO), "{text} at {z}");
        }
    }
}

#[test]
fn short_and_long_runs_agree() {
    let field = compiled("sin(x) / (y + 1) + x^5").unwrap();
    for count in [0, 1, 2, 15, 16, 17, 127, 128, 129, 300] {
        let points: Vec<_> =
            (0..count).map(|i| Point3::new(f64::from(i) * 0.1, 0.3, 0.0)).collect();
        let mut out = vec![f64::NAN; points.len()];
        field.eval_into(&points, &mut out);
        assert!(points.iter().zip(&out).all(|(p, v)| field.eval(*p) == *v), "{count} points");
    }
}

#[test]
fn far_sines_are_those_of_libm() {
    for text in ["sin(1e7 x)", "cos(1e9 x)"] {
        check_field(&compiled(text).unwrap(), &Bounds3::new(Point3::ZERO, Point3::ONE)).unwrap();
    }
    assert_eq!(compiled("sin(1e7 x)").unwrap().eval(Point3::X), libm::sin(1e7));
}
