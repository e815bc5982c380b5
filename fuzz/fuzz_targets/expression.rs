//! Any text is read as an expression or refused; what is read evaluates the same one point at a
//! time and many at a time, and inside its bounds.
#![no_main]

use fgm_core::{Bounds3, Field, Point3};
use fgm_field::{Expr, ExprField};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let expr = match Expr::parse(text) {
        Ok(expr) if !expr.uses_distance() => expr,
        Ok(_) => return,
        Err(error) => {
            assert!(error.span.start <= error.span.end && error.span.end <= text.len());
            assert!(text.is_char_boundary(error.span.start) && text.is_char_boundary(error.span.end));
            let _ = error.to_string();
            return;
        }
    };
    let field = ExprField::new(&expr);
    let cell = Bounds3::new(Point3::new(-1.5, 0.25, -3.0), Point3::new(2.0, 0.75, 4.0));
    let bounds = field.bounds(&cell);
    let points = cell.corners();
    let mut many = [0.0; 8];
    field.eval_into(&points, &mut many);
    for (p, many) in points.iter().zip(many) {
        let one = field.eval(*p);
        assert!(one == many || (one.is_nan() && many.is_nan()), "{one} {many} at {p}");
        if one.is_nan() {
            assert!(bounds == fgm_core::Interval::EVERYTHING, "{bounds:?} holds NaN at {p}");
        } else {
            assert!(bounds.contains(one), "{one} outside {bounds:?} at {p}");
        }
    }
});
