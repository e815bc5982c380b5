//! Volume fractions: they sum to 1, agree with themselves, and say where there are none.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "to the lints the helpers of tests are no tests"
)]

mod common;

use std::sync::Arc;

use common::{cell, check_field, formula, point, points_in};
use fgm_core::{Bounds3, Field, Interval, MaterialField, MixtureError, Point3};
use fgm_field::{
    Convolved, Cuboid, Expr, ExprField, FieldError, FractionMode, MaterialRegions, PlacedMaterial,
    Region, SharedField, SharedMaterial, Sphere, VolumeFractions,
};
use glam::{DAffine3, DQuat};
use proptest::prelude::*;

use FractionMode::{Probability, Threshold};

fn exprs(texts: &[&str]) -> Vec<Expr> {
    texts.iter().map(|t| Expr::parse(t).unwrap_or_else(|e| panic!("{t}: {e}"))).collect()
}

fn fields(texts: &[&str]) -> Vec<SharedField> {
    exprs(texts).iter().map(|e| Arc::new(ExprField::new(e)) as SharedField).collect()
}

/// The fractions made both ways: from expressions and from fields.
fn both(texts: &[&str], mode: FractionMode) -> [VolumeFractions; 2] {
    [
        VolumeFractions::from_exprs(&exprs(texts), None, mode).unwrap(),
        VolumeFractions::new(fields(texts), mode).unwrap(),
    ]
}

fn both_with_rest(texts: &[&str]) -> [VolumeFractions; 2] {
    [
        VolumeFractions::from_exprs_with_rest(&exprs(texts), None).unwrap(),
        VolumeFractions::with_rest(fields(texts)).unwrap(),
    ]
}

/// At a point either a mixture that sums to 1 and agrees with the fraction fields, or NaN in all.
fn check_point(material: &dyn MaterialField, p: Point3) -> Result<(), TestCaseError> {
    let fields: Vec<f64> =
        (0..material.materials()).map(|i| material.fraction(i).eval(p)).collect();
    match material.mixture(p) {
        Ok(mixture) => {
            let sum: f64 = mixture.fractions().iter().sum();
            prop_assert!((sum - 1.0).abs() < 1e-12, "{mixture:?} at {p}");
            for (a, b) in mixture.fractions().iter().zip(&fields) {
                prop_assert!((a - b).abs() < 1e-12, "{mixture:?}, not {fields:?}, at {p}");
            }
        }
        Err(error) => {
            prop_assert_eq!(error.at, p);
            prop_assert!(fields.iter().all(|f| f.is_nan()), "{error}, but {fields:?}");
        }
    }
    Ok(())
}

/// All of the above, and that all evaluations of the fraction fields agree.
fn check_material(material: &dyn MaterialField, cell: &Bounds3) -> Result<(), TestCaseError> {
    for p in points_in(cell) {
        check_point(material, p)?;
    }
    for i in 0..material.materials() {
        check_field(material.fraction(i), cell)?;
    }
    Ok(())
}

#[test]
fn fractions_by_hand() {
    let at = Point3::new(2.0, 3.0, 0.0);
    for (texts, mode, expected) in [
        (&["x", "x + 4"][..], Probability, &[0.25, 0.75][..]),
        (&["x", "-y"], Probability, &[1.0, 0.0]),
        (&["0.25", "1 - 0.25"], Probability, &[0.25, 0.75]),
        (&["x/8", "1 - x/8"], Probability, &[0.25, 0.75]),
        (&["1 - x/8", "x/8"], Probability, &[0.75, 0.25]),
        (&["x", "1 - x"], Probability, &[1.0, 0.0]),
        (&["-x", "1 - -x"], Probability, &[0.0, 1.0]),
        (&["1", "2", "x + 3"], Probability, &[0.125, 0.25, 0.625]),
        (&["x", "y"], Threshold, &[0.0, 1.0]),
        (&["x", "x", "1"], Threshold, &[1.0, 0.0, 0.0]),
        (&["-x", "-y"], Threshold, &[1.0, 0.0]),
        (&["z", "-z"], Threshold, &[1.0, 0.0]),
    ] {
        for material in both(texts, mode) {
            assert_eq!(material.mixture(at).unwrap().fractions(), expected, "{texts:?} {mode:?}");
        }
    }
    for (texts, expected) in [
        (&["x/8"][..], &[0.25, 0.75][..]),
        (&["x"], &[1.0, 0.0]),
        (&["-x"], &[0.0, 1.0]),
        (&["0.25", "0.5"], &[0.25, 0.5, 0.25]),
        (&["x", "6"], &[0.25, 0.75, 0.0]),
        (&["-5", "0.5"], &[0.0, 0.5, 0.5]),
    ] {
        for material in both_with_rest(texts) {
            assert_eq!(material.mixture(at).unwrap().fractions(), expected, "{texts:?}");
        }
    }
    let uniform = VolumeFractions::uniform(3, 1).unwrap();
    assert_eq!(uniform.mixture(at).unwrap().fractions(), [0.0, 1.0, 0.0]);
}

#[test]
fn what_is_no_mixture_names_the_point() {
    let at = Point3::new(0.0, -1.0, 2.5);
    for (texts, mode, reason) in [
        (&["0", "0"][..], Probability, MixtureError::AllZero),
        (&["x", "y"], Probability, MixtureError::AllZero),
        (&["-1", "y"], Probability, MixtureError::AllZero),
        (&["1/x", "1"], Probability, MixtureError::NotFinite { material: 0, value: f64::INFINITY }),
        (&["1", "1/x"], Threshold, MixtureError::NotFinite { material: 1, value: f64::INFINITY }),
        (&["0", "0"], Threshold, MixtureError::AllZero),
        (&["0", "0*x"], Threshold, MixtureError::AllZero),
    ] {
        for material in both(texts, mode) {
            let error = material.mixture(at).unwrap_err();
            assert_eq!((error.at, error.reason), (at, reason), "{texts:?}");
            check_point(&material, at).unwrap();
        }
    }
    let [material, _] = both(&["sqrt(y)", "1"], Probability);
    let message = material.mixture(at).unwrap_err().to_string();
    assert_eq!(
        message,
        "no valid mixture at (0.0000, -1.0000, 2.5000): the fraction of material 0 is NaN"
    );
    let [material, _] = both(&["x / (y * 0)", "1"], Probability);
    assert!(material.mixture(at).is_err());
}

#[test]
fn numbers_of_materials_are_checked() {
    let count = |n: usize| VolumeFractions::new(fields(&vec!["x"; n]), Probability).err();
    assert_eq!(count(1), Some(FieldError::MaterialCount { count: 1 }));
    assert_eq!(count(8), None);
    assert_eq!(count(9), Some(FieldError::MaterialCount { count: 9 }));
    assert!(VolumeFractions::new(vec![], Threshold).is_err());
    assert!(VolumeFractions::with_rest(vec![]).is_err());
    assert!(VolumeFractions::with_rest(fields(&["x"; 8])).is_err());
    let none = VolumeFractions::uniform(2, 2).err();
    assert_eq!(none, Some(FieldError::NoSuchMaterial { material: 2, count: 2 }));
    assert!(VolumeFractions::uniform(1, 0).is_err());
    let material = VolumeFractions::uniform(2, 0).unwrap();
    assert!(material.fraction(2).eval(Point3::ZERO).is_nan());
}

#[test]
fn ranges_of_fractions_are_those_of_the_weights() {
    let cell = Bounds3::new(Point3::ZERO, Point3::new(1.0, 1.0, 1.0));
    for material in both(&["(x + 1) / 4", "1 - (x + 1) / 4"], Probability) {
        let (first, second) =
            (material.fraction(0).bounds(&cell), material.fraction(1).bounds(&cell));
        assert!((first.lo - 0.25).abs() < 1e-12 && (first.hi - 0.5).abs() < 1e-12, "{first:?}");
        assert!((second.lo - 0.5).abs() < 1e-12 && (second.hi - 0.75).abs() < 1e-12, "{second:?}");
    }
    for material in both(&["x + 10", "1"], Threshold) {
        assert_eq!(material.fraction(0).bounds(&cell), Interval::point(1.0));
        assert_eq!(material.fraction(1).bounds(&cell), Interval::point(0.0));
    }
}

#[test]
fn distance_in_weights() {
    let ball: SharedField = Arc::new(Sphere { radius: 10.0 });
    let weights = exprs(&["-d / 10", "1 + d / 10"]);
    let material = VolumeFractions::from_exprs(&weights, Some(ball), Probability).unwrap();
    assert_eq!(material.mixture(Point3::X * 7.5).unwrap().fractions(), [0.25, 0.75]);
    let without = VolumeFractions::from_exprs(&weights, None, Probability).unwrap();
    assert!(without.mixture(Point3::X).is_err());
}

/// Two boxes side by side, of materials 0 and 1, meeting at x = 0.
fn halves() -> MaterialRegions {
    let half = |x: f64, material: usize| {
        let by = DAffine3::from_translation(Point3::new(x, 0.0, 0.0));
        let cube: SharedField = Arc::new(Cuboid { size: Point3::splat(10.0) });
        Region {
            geometry: Arc::new(fgm_field::Transformed::new(cube, by).unwrap()),
            fractions: Arc::new(VolumeFractions::uniform(2, material).unwrap()),
        }
    };
    MaterialRegions::new(vec![half(-5.0, 0), half(5.0, 1)]).unwrap()
}

#[test]
fn regions_by_hand() {
    let material = halves();
    for (x, expected) in
        [(-3.0, [1.0, 0.0]), (3.0, [0.0, 1.0]), (0.0, [1.0, 0.0]), (40.0, [0.0, 1.0])]
    {
        assert_eq!(material.mixture(Point3::X * x).unwrap().fractions(), expected, "at {x}");
    }
    // Away from the border a box has one value.
    let right = Bounds3::new(Point3::new(4.0, 0.0, 0.0), Point3::new(5.0, 1.0, 1.0));
    assert_eq!(material.fraction(1).bounds(&right), Interval::point(1.0));
    let across = Bounds3::new(Point3::new(-1.0, 0.0, 0.0), Point3::new(1.0, 1.0, 1.0));
    assert_eq!(material.fraction(1).bounds(&across), Interval::new(0.0, 1.0));

    assert_eq!(MaterialRegions::new(vec![]).err(), Some(FieldError::NoRegion));
    let region = |count| Region {
        geometry: Arc::new(Sphere { radius: 1.0 }),
        fractions: Arc::new(VolumeFractions::uniform(count, 0).unwrap()),
    };
    let error = MaterialRegions::new(vec![region(2), region(3)]).err();
    assert_eq!(error, Some(FieldError::RegionMaterials { region: 1, expected: 2, found: 3 }));
}

#[test]
fn many_regions_agree() {
    // More than are kept while looking for the nearest.
    let regions = (0..40).map(|i| {
        let by = DAffine3::from_translation(Point3::X * f64::from(i));
        let ball: SharedField = Arc::new(Sphere { radius: 1.0 });
        Region {
            geometry: Arc::new(fgm_field::Transformed::new(ball, by).unwrap()),
            fractions: Arc::new(VolumeFractions::uniform(2, i as usize % 2).unwrap()),
        }
    });
    let material = MaterialRegions::new(regions.collect()).unwrap();
    for x in [0.2, 3.2, 16.0, 31.7, 50.0] {
        let cell = Bounds3::new(Point3::new(x, -0.1, -0.1), Point3::new(x + 0.2, 0.1, 0.1));
        check_material(&material, &cell).unwrap();
        assert!(x == 3.2 || material.fraction(0).bounds(&cell).width() == 0.0, "at {x}");
    }
}

#[test]
fn blurs_by_hand() {
    let material: SharedMaterial = Arc::new(halves());
    let blurred = Convolved::boxed(Arc::clone(&material), [4, 1, 1], Point3::ONE).unwrap();
    for (x, first) in [(-3.0, 1.0), (-1.25, 0.75), (0.25, 0.5), (1.25, 0.25), (3.0, 0.0)] {
        let mixture = blurred.mixture(Point3::X * x).unwrap();
        assert!((mixture.fractions()[0] - first).abs() < 1e-12, "{mixture:?} at {x}");
    }
    let far = Bounds3::new(Point3::new(3.0, 0.0, 0.0), Point3::new(4.0, 1.0, 1.0));
    assert!(blurred.fraction(0).bounds(&far).hi < 1e-12);

    let new =
        |samples: &[(Point3, f64)]| Convolved::new(Arc::clone(&material), samples.to_vec()).err();
    assert_eq!(new(&[(Point3::ZERO, 2.0), (Point3::X, 0.0)]), None);
    assert!(matches!(new(&[]), Some(FieldError::KernelSize { count: 0, .. })));
    assert!(matches!(new(&[(Point3::ZERO, 0.0)]), Some(FieldError::KernelWeight { .. })));
    let negative = new(&[(Point3::ZERO, 2.0), (Point3::X, -1.0)]);
    assert_eq!(negative, Some(FieldError::KernelWeight { sample: 1, weight: -1.0 }));
    let huge = Convolved::boxed(Arc::clone(&material), [usize::MAX, 2, 2], Point3::ONE).err();
    assert!(matches!(huge, Some(FieldError::KernelSize { .. })));
    let none = Convolved::boxed(material, [0, 2, 2], Point3::ONE).err();
    assert!(matches!(none, Some(FieldError::KernelSize { count: 0, .. })));
}

#[test]
fn placed_materials_move() {
    let by = DAffine3::from_translation(Point3::X * 10.0);
    let [material, _] = both(&["x/8", "1 - x/8"], Probability);
    let placed = PlacedMaterial::new(Arc::new(material), by).unwrap();
    assert_eq!(placed.mixture(Point3::X * 12.0).unwrap().fractions(), [0.25, 0.75]);
    let [broken, _] = both(&["0", "0"], Probability);
    let placed = PlacedMaterial::new(Arc::new(broken), by).unwrap();
    assert_eq!(placed.mixture(Point3::X).unwrap_err().at, Point3::X);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn fractions_of_any_weights(
        trees in prop::collection::vec(formula(), 1..4), cell in cell(), threshold: bool
    ) {
        let texts: Vec<_> = trees.iter().map(common::Tree::text).collect();
        let Ok(weights) = texts.iter().map(|t| Expr::parse(t)).collect::<Result<Vec<_>, _>>() else {
            return Ok(());
        };
        let ball: SharedField = Arc::new(Sphere { radius: 10.0 });
        let mode = if threshold { Threshold } else { Probability };
        let field = |e: &Expr| -> SharedField {
            Arc::new(ExprField::with_distance(e, Arc::clone(&ball)))
        };
        let shared: Vec<_> = weights.iter().map(field).collect();
        let mut made = vec![
            VolumeFractions::from_exprs_with_rest(&weights, Some(Arc::clone(&ball))),
            VolumeFractions::with_rest(shared.clone()),
        ];
        if weights.len() > 1 {
            made.push(VolumeFractions::from_exprs(&weights, Some(Arc::clone(&ball)), mode));
            made.push(VolumeFractions::new(shared, mode));
        }
        // Sums that overflow are beyond what is promised.
        let huge = |p: &Point3| {
            weights.iter().any(|w| ExprField::with_distance(w, Arc::clone(&ball)).eval(*p).abs() > 1e300)
        };
        prop_assume!(!points_in(&cell).iter().any(huge));
        for material in made {
            check_material(&material.unwrap(), &cell)
                .map_err(|e| TestCaseError::fail(format!("{texts:?} {mode:?}: {e}")))?;
        }
    }

    #[test]
    fn complements_are_the_same_the_short_way(tree in formula(), p in point()) {
        // Of the same value but not the same formula, so that nothing is cut short.
        let (short, long) = (format!("1 - ({})", tree.text()), format!("1 + (-({}))", tree.text()));
        let make = |other: &str| {
            let weights = [Expr::parse(&tree.text()).ok()?, Expr::parse(other).ok()?];
            VolumeFractions::from_exprs(&weights, None, Probability).ok()
        };
        let (Some(short), Some(long)) = (make(&short), make(&long)) else { return Ok(()) };
        for i in 0..2 {
            let (a, b) = (short.fraction(i).eval(p), long.fraction(i).eval(p));
            // `0` and `1 - 0` as constants are told apart from `0` and `0` only by their values.
            prop_assert!((a - b).abs() < 1e-12 || (a.is_nan() && b.is_nan()), "{a} and {b}");
        }
    }

    #[test]
    fn composed_materials_agree(cell in cell()) {
        let by = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.4), Point3::ONE);
        let tilt = DAffine3::from_quat(DQuat::from_rotation_x(0.4));
        let [graded, _] = both(&["x/8", "y/3", "sin(z) + 1"], Probability);
        let graded: SharedMaterial = Arc::new(graded);
        let kernel = vec![(Point3::ZERO, 2.0), (Point3::X, 1.0), (Point3::new(0.0, -0.5, 0.3), 0.5)];
        let materials: Vec<SharedMaterial> = vec![
            Arc::new(halves()),
            Arc::new(Convolved::new(Arc::clone(&graded), kernel).unwrap()),
            Arc::new(PlacedMaterial::new(Arc::clone(&graded), by).unwrap()),
            Arc::new(PlacedMaterial::new(graded, tilt).unwrap()),
        ];
        for material in materials {
            check_material(material.as_ref(), &cell)?;
        }
    }
}
