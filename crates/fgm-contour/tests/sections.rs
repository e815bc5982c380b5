//! Plane sections of meshes.

// Helpers outside of test functions may fail tests too.
#![allow(clippy::unwrap_used)]

mod common;

use common::{area, assert_uncrossed, assert_valid, both, box_mesh, soup};
use fgm_contour::{ContourError, MeshSlicer, SectionWarning};
use fgm_core::{Point2, Point3, Polygon, TriangleMesh};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn slicer(mesh: &TriangleMesh) -> MeshSlicer {
    MeshSlicer::new(mesh).unwrap()
}

/// The section of a mesh that needs no mending.
fn clean(slicer: &MeshSlicer, z: f64) -> Vec<Polygon> {
    let section = slicer.section(z);
    assert_eq!(section.warnings, [], "at {z}");
    assert_valid(&section.polygons);
    section.polygons
}

fn unit_box() -> TriangleMesh {
    box_mesh(Point3::ZERO, Point3::new(5.0, 4.0, 3.0), 0.0)
}

/// A sphere of quads in rings, poles on the axis.
fn sphere(radius: f64, rings: u32, sides: u32) -> TriangleMesh {
    let mut vertices = vec![Point3::new(0.0, 0.0, -radius)];
    for r in 1..rings {
        let up = f64::from(r) / f64::from(rings) * PI - PI / 2.0;
        for s in 0..sides {
            let around = Point2::from_angle(f64::from(s) / f64::from(sides) * TAU);
            vertices.push((around * radius * up.cos()).extend(radius * up.sin()));
        }
    }
    vertices.push(Point3::new(0.0, 0.0, radius));
    let at = |r: u32, s: u32| 1 + (r - 1) * sides + s % sides;
    let top = vertices.len() as u32 - 1;
    let mut triangles = Vec::new();
    for s in 0..sides {
        triangles.push([0, at(1, s + 1), at(1, s)]);
        for r in 1..rings - 1 {
            triangles.push([at(r, s), at(r, s + 1), at(r + 1, s + 1)]);
            triangles.push([at(r, s), at(r + 1, s + 1), at(r + 1, s)]);
        }
        triangles.push([top, at(rings - 1, s), at(rings - 1, s + 1)]);
    }
    TriangleMesh { vertices, triangles }
}

#[test]
fn a_box_is_cut_at_every_height_faces_included() {
    for mesh in [unit_box(), soup(&unit_box())] {
        let slicer = slicer(&mesh);
        assert!(slicer.issues().is_clean(), "{:?}", slicer.issues());
        // At the lower face nothing lies below, at the upper one everything does.
        for (z, expected) in
            [(-3.1, 0.0), (-3.0, 0.0), (-2.9, 80.0), (0.0, 80.0), (3.0, 80.0), (3.1, 0.0)]
        {
            assert!((area(&clean(&slicer, z)) - expected).abs() < 1e-9, "at {z}");
        }
        assert!(slicer.section(f64::NAN).polygons.is_empty());
    }
}

#[test]
fn planes_through_vertices_and_edges_give_closed_rings() {
    let ball = sphere(10.0, 16, 24);
    let slicer = slicer(&ball);
    assert!(slicer.issues().is_clean(), "{:?}", slicer.issues());
    let mut heights: Vec<f64> = ball.vertices.iter().map(|v| v.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    for &z in &heights[1..heights.len() - 1] {
        let here = area(&clean(&slicer, z));
        let polygon = 12.0 * (TAU / 24.0).sin() * (100.0 - z * z);
        assert!((here - polygon).abs() < 1e-6, "at {z}: {here}, not {polygon}");
    }
    assert!(clean(&slicer, heights[0]).is_empty());
    assert!(clean(&slicer, heights[heights.len() - 1]).is_empty(), "a pole has no area");
}

#[test]
fn a_ridge_in_the_plane_is_no_region() {
    // A roof: two slopes that meet in a ridge at z = 2.
    let v = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let vertices = vec![
        v(0.0, 0.0, 0.0),
        v(6.0, 0.0, 0.0),
        v(6.0, 4.0, 0.0),
        v(0.0, 4.0, 0.0),
        v(0.0, 2.0, 2.0),
        v(6.0, 2.0, 2.0),
    ];
    let triangles = vec![
        [0, 2, 1],
        [0, 3, 2],
        [0, 1, 5],
        [0, 5, 4],
        [2, 3, 4],
        [2, 4, 5],
        [0, 4, 3],
        [1, 2, 5],
    ];
    let slicer = slicer(&TriangleMesh { vertices, triangles });
    assert!(slicer.issues().is_clean());
    assert!(clean(&slicer, 2.0).is_empty());
    assert!((area(&clean(&slicer, 1.0)) - 12.0).abs() < 1e-12);
}

#[test]
fn overlapping_shells_are_united_and_cavities_stay() {
    let (a, b) = (Point3::ZERO, Point3::new(3.0, 2.0, 0.0));
    let overlap = both(box_mesh(a, Point3::splat(4.0), 0.0), &box_mesh(b, Point3::splat(4.0), 0.0));
    let exact = 64.0 + 64.0 - 5.0 * 6.0;
    assert!((area(&clean(&slicer(&overlap), 1.0)) - exact).abs() < 1e-4);
    // One inside another: facing outwards it is the same solid twice, inwards a cavity.
    let inner = box_mesh(Point3::ZERO, Point3::splat(2.0), 0.3);
    let solid = both(box_mesh(a, Point3::splat(4.0), 0.0), &inner);
    assert!((area(&clean(&slicer(&solid), 1.0)) - 64.0).abs() < 1e-9);
    let mut facing_in = inner;
    facing_in.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let hollow = both(box_mesh(a, Point3::splat(4.0), 0.0), &facing_in);
    let found = clean(&slicer(&hollow), 1.0);
    assert!((area(&found) - 48.0).abs() < 1e-9);
    assert_eq!(found[0].holes.len(), 1);
}

#[test]
fn shells_that_share_a_face_become_one() {
    let a = box_mesh(Point3::ZERO, Point3::splat(4.0), 0.0);
    let b = box_mesh(Point3::new(8.0, 0.0, 0.0), Point3::splat(4.0), 0.0);
    let found = clean(&slicer(&both(a, &b)), 1.0);
    assert_eq!(found.len(), 1);
    assert!((area(&found) - 128.0).abs() < 1e-4);
}

/// The plane cuts the diagonals of both boxes' sides where the boxes cross: the rings cross at
/// vertices that they have in common, and no edge crosses another.
#[test]
fn rings_that_cross_at_common_vertices_are_united() {
    for corner in [1.0, -1.0] {
        let a = box_mesh(Point3::ZERO, Point3::ONE, 0.0);
        let b = box_mesh(Point3::new(corner, 1.0, 0.0), Point3::ONE, 0.0);
        let found = clean(&slicer(&both(a, &b)), 0.0);
        assert_eq!(found.len(), 1);
        assert!((area(&found) - 7.0).abs() < 1e-4, "{}", area(&found));
    }
}

#[test]
fn an_inside_out_shell_adds_to_what_it_overlaps() {
    let a = box_mesh(Point3::ZERO, Point3::splat(4.0), 0.0);
    let mut b = box_mesh(Point3::new(3.0, 2.0, 0.0), Point3::splat(4.0), 0.0);
    b.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let slicer = slicer(&both(a, &b));
    assert_eq!(slicer.issues().inverted_shells.count, 1);
    assert!((area(&clean(&slicer, 1.0)) - 98.0).abs() < 1e-4);
}

#[test]
fn flipped_duplicate_and_degenerate_triangles_do_no_harm() {
    let mut mesh = unit_box();
    mesh.triangles[7].swap(0, 1);
    mesh.triangles.push(mesh.triangles[3]);
    mesh.triangles.push([2, 2, 5]);
    let slicer = slicer(&mesh);
    let issues = slicer.issues();
    assert_eq!(issues.flipped_edges.count, 3);
    assert_eq!(issues.duplicate_triangles.count, 1);
    assert_eq!(issues.degenerate_triangles.count, 1);
    assert!(issues.is_closed());
    assert!((area(&clean(&slicer, 1.0)) - 80.0).abs() < 1e-9);
    // Two triangles back to back enclose nothing.
    let mut sheet = unit_box();
    sheet.triangles.extend([[0, 3, 7], [0, 7, 3]]);
    assert!((area(&clean(&self::slicer(&sheet), 1.0)) - 80.0).abs() < 1e-9);
}

#[test]
fn cubes_that_share_an_edge_stay_whole() {
    // Vertices welded by place: four triangles on the common upright edge.
    let a = box_mesh(Point3::new(-2.0, -2.0, 0.0), Point3::splat(2.0), 0.0);
    let b = box_mesh(Point3::new(2.0, 2.0, 0.0), Point3::splat(2.0), 0.0);
    let slicer = slicer(&both(a, &b));
    assert_eq!(slicer.issues().non_manifold_edges.count, 1);
    assert!(slicer.issues().is_closed());
    for z in [-1.0, 0.0, 2.0] {
        let section = slicer.section(z);
        assert_eq!(section.warnings, []);
        assert!((area(&section.polygons) - 32.0).abs() < 1e-4, "at {z}");
    }
}

#[test]
fn small_holes_are_closed_and_openings_told() {
    // A missing triangle leaves the border open across a side.
    let mut mesh = unit_box();
    let missing = mesh.triangles.remove(4);
    let slicer = slicer(&mesh);
    assert_eq!(slicer.issues().open_edges.count, 3);
    let section = slicer.section(-1.0);
    assert_valid(&section.polygons);
    assert!((area(&section.polygons) - 80.0).abs() < 1e-9, "missing {missing:?}");
    assert!(matches!(section.warnings[..], [SectionWarning::OpeningClosed { .. }]));
    let section = slicer.with_gap(20.0).section(-1.0);
    assert!(matches!(section.warnings[..], [SectionWarning::GapClosed { .. }]));
    // A lone triangle encloses nothing.
    let sheet = TriangleMesh { triangles: vec![missing], vertices: unit_box().vertices };
    let section = self::slicer(&sheet).section(-1.0);
    assert!(section.polygons.is_empty());
    assert!(matches!(section.warnings[..], [SectionWarning::Dropped { .. }]));
}

#[test]
fn vertices_apart_by_less_than_the_gap_are_bridged() {
    // Every triangle has its own, displaced vertices: nothing is joined by identity.
    let mut mesh = soup(&sphere(10.0, 12, 16));
    for (k, v) in mesh.vertices.iter_mut().enumerate() {
        *v += Point3::new((k * 7 % 11) as f64, (k * 5 % 13) as f64, 0.0) * 1e-4;
    }
    let slicer = slicer(&mesh);
    let section = slicer.section(1.3);
    assert!(!section.warnings.is_empty());
    assert!(section.warnings.iter().all(|w| matches!(w, SectionWarning::GapClosed { .. })));
    let exact = area(&clean(&self::slicer(&sphere(10.0, 12, 16)), 1.3));
    assert!((area(&section.polygons) - exact).abs() < 0.2);
}

#[test]
fn bad_meshes_are_refused() {
    let mut mesh = unit_box();
    mesh.triangles[2] = [0, 1, 8];
    let error = MeshSlicer::new(&mesh).unwrap_err();
    assert_eq!(error, ContourError::VertexOutOfRange { triangle: 2, vertex: 8, count: 8 });
    let mut mesh = unit_box();
    mesh.vertices[3].y = f64::NAN;
    assert!(matches!(MeshSlicer::new(&mesh), Err(ContourError::VertexNotFinite { vertex: 3, .. })));
    assert!(slicer(&TriangleMesh::default()).section(0.0).polygons.is_empty());
}

#[test]
fn the_vase_is_closed_at_every_layer() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/models/vase.stl");
    let Ok(bytes) = std::fs::read(path) else {
        println!("skipped: no vase.stl beside the workspace");
        return;
    };
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap());
    let vertices: Vec<Point3> = (0..count as usize)
        .flat_map(|t| (0..3).map(move |k| 84 + 50 * t + 12 + 12 * k))
        .map(|at| Point3::new(number(at), number(at + 4), number(at + 8)))
        .collect();
    let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let mesh = TriangleMesh { vertices, triangles };
    let slicer = slicer(&mesh);
    assert!(slicer.issues().is_closed(), "{:?}", slicer.issues());
    let (bottom, top) = (mesh.bounds().min.z, mesh.bounds().max.z);
    let step = (top - bottom) / 500.0;
    let mut volume = 0.0;
    for layer in 0..500 {
        let section = slicer.section(bottom + (f64::from(layer) + 0.5) * step);
        assert_eq!(section.warnings, []);
        assert!(!section.polygons.is_empty());
        volume += area(&section.polygons) * step;
    }
    assert!((volume / mesh.volume() - 1.0).abs() < 1e-3, "{volume} of {}", mesh.volume());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_tetrahedra_have_the_right_volume(
        corners in prop::collection::vec((-4..5i32, -4..5i32, -4..5i32), 4)
    ) {
        // Integer corners put vertices, edges and faces into the planes.
        let vertices: Vec<Point3> =
            corners.iter().map(|&(x, y, z)| Point3::new(x.into(), y.into(), z.into())).collect();
        let mut triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut mesh = TriangleMesh { vertices, triangles: triangles.clone() };
        if mesh.volume() < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(0, 1));
            mesh.triangles = triangles;
        }
        prop_assume!(mesh.volume() > 0.1);
        let slicer = slicer(&mesh);
        for k in -8..=8 {
            clean(&slicer, f64::from(k) / 2.0);
        }
        // Simpson's rule is exact for the quadratic area between vertex heights.
        let mut heights: Vec<f64> = mesh.vertices.iter().map(|v| v.z).collect();
        heights.sort_by(f64::total_cmp);
        let volume: f64 = heights.windows(2).filter(|w| w[0] < w[1]).map(|w| {
            let inset = 1e-9 * (w[1] - w[0]);
            let at = |z| area(&clean(&slicer, z));
            (w[1] - w[0]) / 6.0
                * (at(w[0] + inset) + 4.0 * at(w[0].midpoint(w[1])) + at(w[1]))
        }).sum();
        prop_assert!((volume - mesh.volume()).abs() < 1e-5, "{volume} {}", mesh.volume());
    }

    /// Whatever is done to a mesh: sections are closed, simple, nested rings.
    #[test]
    fn damaged_meshes_give_closed_rings(
        boxes in prop::collection::vec((-4..5i32, -4..5i32, -2..3i32, 1..4i32), 1..3),
        damage in prop::collection::vec((0..5u8, any::<prop::sample::Index>(), -3..4i32, -3..4i32), 0..8),
        gap in prop_oneof![Just(0.0), Just(0.1), Just(5.0)],
    ) {
        let mut mesh = TriangleMesh::default();
        for &(x, y, h, half) in &boxes {
            let center = Point3::new(x.into(), y.into(), h.into());
            mesh = both(mesh, &box_mesh(center, Point3::splat(half.into()), 0.0));
        }
        for (kind, which, x, y) in damage {
            if mesh.triangles.is_empty() {
                continue;
            }
            let t = which.index(mesh.triangles.len());
            match kind {
                0 => drop(mesh.triangles.swap_remove(t)),
                1 => mesh.triangles[t].swap(0, 1),
                2 => mesh.triangles.push(mesh.triangles[t]),
                3 => mesh.triangles[t][0] = mesh.triangles[t][1],
                // A fin, and a vertex moved: edges of three triangles, faces that cut each other.
                _ => {
                    let v = which.index(mesh.vertices.len());
                    mesh.vertices[v] += Point3::new(x.into(), y.into(), 0.5);
                    let [a, b, _] = mesh.triangles[t];
                    mesh.triangles.push([a, b, v as u32]);
                }
            }
        }
        let slicer = slicer(&mesh).with_gap(gap);
        for k in -10..=10 {
            let section = slicer.section(f64::from(k) / 2.0);
            assert_uncrossed(&section.polygons, 1e-5);
            for warning in &section.warnings {
                if let SectionWarning::GapClosed { gap: closed, .. } = warning {
                    prop_assert!(*closed <= gap);
                }
            }
            prop_assert!(section.warnings.is_empty() || slicer.issues().open_edges.any());
        }
    }

    #[test]
    fn boxes_in_any_place_unite(
        boxes in prop::collection::vec((-6..7i32, -6..7i32, -3..4i32, 1..5i32, 0..4u32), 1..5),
        z in -6..7i32,
    ) {
        let mut mesh = TriangleMesh::default();
        let mut rects = Vec::new();
        let z = f64::from(z) * 0.5;
        for &(x, y, h, half, turn) in &boxes {
            let (center, half) = (Point3::new(x.into(), y.into(), h.into()), f64::from(half));
            let angle = if turn == 3 { 0.4 } else { 0.0 };
            mesh = both(mesh, &box_mesh(center, Point3::splat(half), angle));
            if center.z - half < z && z <= center.z + half {
                rects.push((center.truncate(), half, angle));
            }
        }
        let section = slicer(&mesh).section(z);
        prop_assert_eq!(&section.warnings, &vec![]);
        // Compared point by point, off the borders.
        for i in -24..=24 {
            for j in -24..=24 {
                let p = Point2::new(f64::from(i) * 0.5 + 0.2371, f64::from(j) * 0.5 + 0.1713);
                let inside = rects.iter().any(|&(c, half, angle)| {
                    common::turned_box(p, c, Point2::splat(half), angle) < 0.0
                });
                let near = rects.iter().any(|&(c, half, angle)| {
                    common::turned_box(p, c, Point2::splat(half), angle).abs() < 1e-4
                });
                let found = section.polygons.iter().any(|q| q.contains(p));
                prop_assert!(near || found == inside, "{p} at {z}");
            }
        }
    }
}
