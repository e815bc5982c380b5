//! Primitives, combinations and transforms: values by hand, and the agreement of all evaluations.

mod common;

use std::sync::Arc;

use common::{cell, check_field, point};
use fgm_core::{Bounds3, Field, Point2, Point3, Polygon, Ring};
use fgm_field::{
    Capsule, Cone, Cuboid, Cylinder, Difference, Expr, ExprField, Extrusion, FieldError, HalfSpace,
    Intersection, Offset, Placed, SharedField, Shell, SmoothDifference, SmoothIntersection,
    SmoothUnion, Sphere, Torus, Transformed, Union,
};
use glam::{DAffine3, DMat3, DQuat};
use proptest::prelude::*;

fn p(x: f64, y: f64, z: f64) -> Point3 {
    Point3::new(x, y, z)
}

fn shared(field: impl Field + Send + 'static) -> SharedField {
    Arc::new(field)
}

fn ring(points: &[(f64, f64)]) -> Ring {
    Ring::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect())
}

/// An L of 10 x 10 with a square hole in its corner.
fn bracket() -> Extrusion {
    let outer = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)];
    let hole = [(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)];
    Extrusion::new(&Polygon { outer: ring(&outer), holes: vec![ring(&hole)] }, 5.0)
}

/// Solids that are exact distances.
fn exact() -> Vec<(&'static str, SharedField)> {
    vec![
        ("sphere", shared(Sphere { radius: 5.0 })),
        ("cuboid", shared(Cuboid { size: p(4.0, 6.0, 8.0) })),
        ("cylinder", shared(Cylinder { radius: 3.0, height: 10.0 })),
        ("cone", shared(Cone { bottom: 5.0, top: 0.0, height: 10.0 })),
        ("frustum", shared(Cone { bottom: 2.0, top: 6.0, height: 3.0 })),
        ("torus", shared(Torus { major: 6.0, minor: 2.0 })),
        ("capsule", shared(Capsule { radius: 2.0, height: 10.0 })),
        ("half-space", shared(HalfSpace { normal: p(0.6, 0.0, 0.8), offset: 1.0 })),
        ("extrusion", shared(bracket())),
    ]
}

fn transforms() -> Vec<(&'static str, DAffine3)> {
    let turn = DQuat::from_rotation_z(0.7);
    let tilt = DQuat::from_rotation_x(0.4) * DQuat::from_rotation_y(-0.3);
    vec![
        ("moved", DAffine3::from_translation(p(1.0, -2.0, 3.0))),
        ("turned", DAffine3::from_rotation_translation(turn, p(1.0, 0.0, 0.5))),
        ("tilted", DAffine3::from_quat(tilt)),
        ("doubled", DAffine3::from_scale(Point3::splat(2.0))),
        ("stretched", DAffine3::from_scale(p(1.0, 2.0, 0.5))),
        ("mirrored", DAffine3::from_scale(p(-1.0, 1.0, 1.0))),
        (
            "all",
            DAffine3::from_scale_rotation_translation(p(1.0, 2.0, 3.0), tilt * turn, Point3::ONE),
        ),
    ]
}

fn transformed(field: &SharedField, by: DAffine3) -> SharedField {
    let field = Transformed::new(Arc::clone(field), by);
    field.map_or_else(|error| unreachable!("{error}"), shared)
}

fn placed(field: &SharedField, by: DAffine3) -> SharedField {
    let field = Placed::new(Arc::clone(field), by);
    field.map_or_else(|error| unreachable!("{error}"), shared)
}

/// One of every kind of field that there is.
fn every_kind() -> Vec<(String, SharedField)> {
    let mut all: Vec<(String, SharedField)> =
        exact().into_iter().map(|(name, field)| (name.into(), field)).collect();
    let sphere = || shared(Sphere { radius: 5.0 });
    let block = || shared(Cuboid { size: p(4.0, 6.0, 8.0) });
    let wave = || match Expr::parse("sin(x) cos(y) + sin(z) sqrt(y)") {
        Ok(expr) => shared(ExprField::new(&expr)),
        Err(error) => unreachable!("{error}"),
    };
    let parts = || vec![sphere(), block(), shared(Torus { major: 6.0, minor: 2.0 })];
    let mut add = |name: &str, field: SharedField| all.push((name.into(), field));
    add("union", shared(Union(parts())));
    add("union with NaN", shared(Union(vec![sphere(), wave()])));
    add("nothing", shared(Union(vec![])));
    add("intersection", shared(Intersection(parts())));
    add("everything", shared(Intersection(vec![])));
    add("difference", shared(Difference { first: sphere(), rest: vec![block(), wave()] }));
    for radius in [0.0, 1.5] {
        add("smooth union", shared(SmoothUnion { parts: parts(), radius }));
        add("smooth intersection", shared(SmoothIntersection { parts: parts(), radius }));
        let rest = vec![block()];
        add("smooth difference", shared(SmoothDifference { first: sphere(), rest, radius }));
    }
    add("smooth nothing", shared(SmoothUnion { parts: vec![], radius: 1.0 }));
    add("offset", shared(Offset { field: block(), distance: 0.7 }));
    add("shell", shared(Shell { field: block(), thickness: 0.8 }));
    for (name, by) in transforms() {
        let field = shared(Union(vec![block(), shared(bracket())]));
        add(name, transformed(&field, by));
        add(name, placed(&field, by));
        add(name, placed(&wave(), by));
    }
    all
}

#[test]
fn distances_by_hand() {
    let solids = exact();
    let solid = |name: &str| &solids.iter().find(|s| s.0 == name).unwrap().1;
    for (name, at, distance) in [
        ("sphere", p(0.0, 0.0, 0.0), -5.0),
        ("sphere", p(3.0, 0.0, 4.0), 0.0),
        ("cuboid", p(0.0, 0.0, 0.0), -2.0),
        ("cuboid", p(5.0, 7.0, 0.0), 5.0),
        ("cuboid", p(0.0, 0.0, -5.0), 1.0),
        ("cylinder", p(0.0, 0.0, 0.0), 0.0),
        ("cylinder", p(0.0, 0.0, 5.0), -3.0),
        ("cylinder", p(6.0, 0.0, 14.0), 5.0),
        ("cylinder", p(0.0, 0.0, -1.0), 1.0),
        ("cone", p(0.0, 0.0, 12.0), 2.0),
        ("cone", p(0.0, 0.0, -1.0), 1.0),
        ("cone", p(0.0, 0.0, 1.0), -1.0),
        ("cone", p(2.5, 0.0, 5.0), 0.0),
        ("frustum", p(7.0, 0.0, 3.0), 1.0),
        ("frustum", p(0.0, 0.0, 1.5), -1.5),
        ("torus", p(6.0, 0.0, 0.0), -2.0),
        ("torus", p(0.0, 0.0, 0.0), 4.0),
        ("capsule", p(0.0, 0.0, 0.0), 0.0),
        ("capsule", p(0.0, 0.0, 11.0), 1.0),
        ("capsule", p(3.0, 0.0, 5.0), 1.0),
        ("half-space", p(0.0, 0.0, 0.0), -1.0),
        ("half-space", p(0.6, 7.0, 0.8), 0.0),
        ("extrusion", p(2.0, 2.0, 2.5), 1.0),
        ("extrusion", p(7.0, 2.0, 2.5), -2.0),
        ("extrusion", p(7.0, 7.0, 2.5), 3.0),
        ("extrusion", p(7.0, 2.0, -3.0), 3.0),
        ("extrusion", p(13.0, 2.0, 9.0), 5.0),
    ] {
        let found = solid(name).eval(at);
        assert!((found - distance).abs() < 1e-14, "{name} at {at}: {found}, not {distance}");
    }
}

#[test]
fn combinations_by_hand() {
    let ball = |x: f64| -> SharedField {
        shared(
            Transformed::new(
                shared(Sphere { radius: 5.0 }),
                DAffine3::from_translation(p(x, 0.0, 0.0)),
            )
            .unwrap(),
        )
    };
    let (a, b) = (ball(0.0), ball(6.0));
    let pair = || vec![Arc::clone(&a), Arc::clone(&b)];
    let at = p(3.0, 0.0, 0.0);
    assert_eq!(Union(pair()).eval(at), -2.0);
    assert_eq!(Union(pair()).eval(p(6.0, 0.0, 0.0)), -5.0);
    assert_eq!(Intersection(pair()).eval(p(0.0, 0.0, 0.0)), 1.0);
    let cut = Difference { first: Arc::clone(&a), rest: vec![Arc::clone(&b)] };
    assert_eq!(cut.eval(at), 2.0);
    assert_eq!(cut.eval(p(-3.0, 0.0, 0.0)), -2.0);
    assert_eq!(SmoothUnion { parts: pair(), radius: 1.0 }.eval(at), -2.25);
    assert_eq!(SmoothIntersection { parts: pair(), radius: 1.0 }.eval(at), -1.75);
    assert_eq!(SmoothUnion { parts: pair(), radius: 1.0 }.eval(p(-9.0, 0.0, 0.0)), 4.0);
    assert_eq!(Offset { field: Arc::clone(&a), distance: 2.0 }.eval(at), -4.0);
    assert_eq!(Shell { field: Arc::clone(&a), thickness: 1.0 }.eval(at), 1.0);
    assert_eq!(Shell { field: a, thickness: 1.0 }.eval(p(4.5, 0.0, 0.0)), -0.5);
}

#[test]
fn transforms_that_cannot_be_undone_are_refused() {
    let flat = DAffine3::from_scale(p(1.0, 0.0, 1.0));
    let nan = DAffine3::from_translation(p(f64::NAN, 0.0, 0.0));
    for by in [flat, nan] {
        let field = shared(Sphere { radius: 1.0 });
        let error = Transformed::new(Arc::clone(&field), by).err();
        assert!(matches!(error, Some(FieldError::SingularTransform { .. })));
        assert!(Placed::new(field, by).is_err());
    }
}

#[test]
fn scaling_keeps_distances() {
    let cube = shared(Cuboid { size: Point3::splat(2.0) });
    let by = DAffine3::from_mat3_translation(
        DMat3::from_quat(DQuat::from_rotation_z(0.3)) * 3.0,
        p(1.0, 2.0, 3.0),
    );
    let scaled = Transformed::new(Arc::clone(&cube), by).unwrap();
    let (inside, outside) =
        (by.transform_point3(Point3::ZERO), by.transform_point3(p(3.0, 0.0, 0.0)));
    assert!((scaled.eval(inside) + 3.0).abs() < 1e-12);
    assert!((scaled.eval(outside) - 6.0).abs() < 1e-12);
    // Values that are no distances stay as they are.
    assert!((Placed::new(cube, by).unwrap().eval(outside) - 2.0).abs() < 1e-12);
}

#[test]
fn flat_boxes_have_exact_ranges_under_moves() {
    // The range of a layer's fold must not grow in z, or layers next to a flat top are never empty.
    let by = DAffine3::from_translation(p(0.1, 0.2, 0.3));
    let field = Placed::new(shared(ExprField::new(&Expr::parse("z").unwrap())), by).unwrap();
    let range = field.bounds(&Bounds3::new(p(0.0, 0.0, 0.7), p(1.0, 1.0, 0.7)));
    assert_eq!(range.lo, range.hi);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn all_evaluations_agree(cell in cell()) {
        for (name, field) in every_kind() {
            check_field(field.as_ref(), &cell)
                .map_err(|e| TestCaseError::fail(format!("{name}: {e}")))?;
        }
    }

    #[test]
    fn distances_change_no_faster_than_the_way(a in point(), b in point(), share in 0.0..1e-3f64) {
        let near = a + (b - a) * share;
        for (name, field) in exact() {
            for q in [b, near] {
                let (change, way) = ((field.eval(a) - field.eval(q)).abs(), a.distance(q));
                let room = 1e-12 * (1.0 + a.length() + q.length());
                prop_assert!(change <= way + room, "{name}: {change} over {way}");
            }
        }
    }

    #[test]
    fn transformed_values_are_bounds_of_the_distance(a in point(), b in point()) {
        for (name, by) in transforms() {
            let field = Transformed::new(shared(bracket()), by).unwrap();
            let (change, way) = ((field.eval(a) - field.eval(b)).abs(), a.distance(b));
            let room = 1e-12 * (1.0 + a.length() + b.length());
            prop_assert!(change <= way + room, "{name}: {change} over {way}");
            let local = by.inverse().transform_point3(a);
            let plain = bracket().eval(local);
            prop_assert!(plain.abs() < 1e-9 || plain.signum() == field.eval(a).signum(), "{name}");
        }
    }

    #[test]
    fn ranges_of_small_boxes_are_small(cell in cell()) {
        // Within the change that a distance can have across the box, times two.
        let room = 2.0 * cell.size().length() + 1e-12 * (100.0 + cell.min.length());
        for (name, field) in exact() {
            let range = field.bounds(&cell);
            prop_assert!(range.width() <= room, "{name}: {range:?} over {cell:?}");
        }
    }
}
