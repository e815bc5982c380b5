//! A hollow, fluted ball of three materials: prints the layer at half of its height as characters,
//! one letter a material where it has more than half, a small one where none has.
//!
//! `cargo run -p fgm-field --example graded_ball`

#![allow(clippy::print_stdout)]

use std::sync::Arc;

use fgm_core::{MaterialField, Point2};
use fgm_field::{
    Expr, ExprField, FractionMode, SharedField, Shell, SmoothUnion, Sphere, VolumeFractions,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let flutes = Expr::parse_with("r - size - 1.5 sin(8 phi)", &[("size", 18.0)])?;
    let flutes: SharedField = Arc::new(ExprField::new(&flutes));
    let ball: SharedField = Arc::new(Sphere { radius: 17.0 });
    let solid = SmoothUnion { parts: vec![ball, flutes], radius: 1.0 };
    let shell: SharedField = Arc::new(Shell { field: Arc::new(solid), thickness: 8.0 });

    // The nearer to the outside, the more of B; C in the direction of x.
    let weights = [Expr::parse("-d")?, Expr::parse("4 + d")?, Expr::parse("0.5 (x - 5)")?];
    let mode = FractionMode::Probability;
    let material = VolumeFractions::from_exprs(&weights, Some(Arc::clone(&shell)), mode)?;

    let layer = shell.at_z(0.0);
    for row in (-20..=20).rev() {
        let mut line = String::new();
        for column in -40..=40 {
            let p = Point2::new(f64::from(column) * 0.5, f64::from(row));
            line.push(if layer.eval(p) > 0.0 {
                ' '
            } else {
                let mixture = material.mixture(p.extend(0.0))?;
                let most = mixture.fractions().iter().position(|f| *f > 0.5);
                most.and_then(|i| ['A', 'B', 'C'].get(i).copied()).unwrap_or('.')
            });
        }
        println!("{}", line.trim_end());
    }
    Ok(())
}
