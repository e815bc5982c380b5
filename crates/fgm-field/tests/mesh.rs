//! Distance to meshes, against solids whose distance is known.
#![cfg(feature = "mesh")]

mod common;

use common::{cell, check_field, point};
use fgm_core::{Bounds3, Field, Interval, Point3, TriangleMesh};
use fgm_field::{Cuboid, FieldError, MeshDistance};
use proptest::prelude::*;

const SIZE: Point3 = Point3::new(4.0, 6.0, 8.0);

/// A box, its triangles facing outwards.
fn cuboid() -> TriangleMesh {
    let vertices = Bounds3::new(SIZE * -0.5, SIZE * 0.5).corners().to_vec();
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh { vertices, triangles }
}

/// The same with every triangle's corners of its own, as in an STL file.
fn soup(mesh: &TriangleMesh) -> TriangleMesh {
    let vertices: Vec<Point3> = mesh.corners().flatten().collect();
    let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh { vertices, triangles }
}

fn inside_out(mut mesh: TriangleMesh) -> TriangleMesh {
    mesh.triangles.iter_mut().for_each(|t| t.reverse());
    mesh
}

#[test]
fn what_has_no_distance_is_refused() {
    let error = |mesh: &TriangleMesh| MeshDistance::new(mesh).err();
    let mesh = |reason| Some(FieldError::Mesh { reason });
    assert_eq!(error(&TriangleMesh::default()), mesh("it has no triangle with an area"));
    let mut bad = cuboid();
    bad.triangles[3][1] = 8;
    assert_eq!(error(&bad), mesh("a triangle names a vertex that is not there"));
    let mut bad = cuboid();
    bad.vertices[3].y = f64::NAN;
    assert_eq!(error(&bad), mesh("a vertex is not finite"));
    let flat = TriangleMesh { vertices: vec![Point3::ZERO; 3], triangles: vec![[0, 1, 2]] };
    assert_eq!(error(&flat), mesh("it has no triangle with an area"));
}

#[test]
fn triangles_without_area_do_no_harm() {
    let mut mesh = cuboid();
    mesh.triangles.push([0, 1, 1]);
    mesh.triangles.push([2, 2, 2]);
    let field = MeshDistance::new(&mesh).unwrap();
    assert!(field.is_closed());
    assert_eq!(field.eval(Point3::ZERO), -2.0);
}

#[test]
fn an_open_mesh_says_so_and_promises_no_side() {
    let mut mesh = cuboid();
    mesh.triangles.pop();
    let field = MeshDistance::new(&mesh).unwrap();
    assert!(!field.is_closed());
    let range = field.bounds(&Bounds3::new(Point3::splat(9.0), Point3::splat(9.5)));
    assert!(range.lo < 0.0 && range.hi > 0.0);
    assert!(MeshDistance::new(&cuboid()).unwrap().is_closed());
}

#[test]
fn no_distance_to_nowhere() {
    let field = MeshDistance::new(&cuboid()).unwrap();
    assert!(field.eval(Point3::new(f64::NAN, 0.0, 0.0)).is_nan());
    assert!(field.eval(Point3::new(f64::INFINITY, 0.0, 0.0)).is_nan());
    assert_eq!(field.bounds(&Bounds3::EMPTY), Interval::EVERYTHING);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_mesh_of_a_box_is_as_far_as_the_box(p in point(), cell in cell()) {
        let exact = Cuboid { size: SIZE }.eval(p);
        for mesh in [cuboid(), soup(&cuboid()), inside_out(cuboid()), inside_out(soup(&cuboid()))] {
            let field = MeshDistance::new(&mesh).unwrap();
            let found = field.eval(p);
            prop_assert!((found - exact).abs() < 1e-12 * (1.0 + p.length()), "{found}, not {exact}");
            check_field(&field, &cell)?;
        }
    }
}
