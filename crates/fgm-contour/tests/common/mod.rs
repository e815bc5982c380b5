//! Checks that the tests share.
#![allow(dead_code)]

use fgm_core::{Point2, Point3, Polygon, Ring, TriangleMesh};

fn cross(a: Point2, b: Point2, c: Point2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether two segments share a point.
pub(crate) fn meet(a: Point2, b: Point2, c: Point2, d: Point2) -> bool {
    let boxes = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
    let opposite = |s: f64, t: f64| s == 0.0 || t == 0.0 || (s > 0.0) != (t > 0.0);
    boxes && opposite(cross(a, b, c), cross(a, b, d)) && opposite(cross(c, d, a), cross(c, d, b))
}

/// Fails where any two edges of the lines meet elsewhere than at a joint of neighbours.
pub(crate) fn assert_apart<'a>(lines: impl IntoIterator<Item = (&'a [Point2], bool)>) {
    let mut edges = Vec::new();
    for (index, (points, closed)) in lines.into_iter().enumerate() {
        let n = points.len();
        let count = if closed { n } else { n - 1 };
        edges.extend((0..count).map(|k| (index, k, count, closed, points[k], points[(k + 1) % n])));
    }
    let least = |e: &(usize, usize, usize, bool, Point2, Point2)| e.4.x.min(e.5.x);
    edges.sort_by(|a, b| least(a).total_cmp(&least(b)));
    for (s, a) in edges.iter().enumerate() {
        assert!(a.4 != a.5, "an edge without length: {a:?}");
        for b in edges[s + 1..].iter().take_while(|b| least(b) <= a.4.x.max(a.5.x)) {
            let (i, j) = (a.1.min(b.1), a.1.max(b.1));
            let next = a.0 == b.0 && (j == i + 1 || (a.3 && i == 0 && j + 1 == a.2));
            assert!(next || !meet(a.4, a.5, b.4, b.5), "edges meet: {a:?} and {b:?}");
        }
    }
}

/// Fails unless the polygons are simple, apart, and rightly oriented and nested.
pub(crate) fn assert_valid(polygons: &[Polygon]) {
    assert_apart(polygons.iter().flat_map(Polygon::rings).map(|r| (r.points.as_slice(), true)));
    for polygon in polygons {
        assert!(polygon.outer.area() > 0.0, "an outer ring runs clockwise");
        for hole in &polygon.holes {
            assert!(hole.area() < 0.0, "a hole runs anticlockwise");
            assert!(polygon.outer.contains(hole.points[0]), "a hole outside its outer ring");
        }
    }
    let depth = |ring: &Ring| {
        let rings = polygons.iter().flat_map(Polygon::rings);
        rings.filter(|r| !std::ptr::eq(*r, ring) && r.contains(ring.points[0])).count()
    };
    for polygon in polygons {
        assert_eq!(depth(&polygon.outer) % 2, 0, "an outer ring at an odd depth");
        assert!(polygon.holes.iter().all(|h| depth(h) % 2 == 1), "a hole at an even depth");
    }
}

/// Fails unless rings are closed, rightly oriented, and cross neither themselves nor each other by
/// more than `rounding`. They may touch.
pub(crate) fn assert_uncrossed(polygons: &[Polygon], rounding: f64) {
    let rings = || polygons.iter().flat_map(Polygon::rings);
    let edges: Vec<(Point2, Point2)> = rings().flat_map(Ring::edges).collect();
    for (k, &(a, b)) in edges.iter().enumerate() {
        assert!(a != b, "an edge without length at {a}");
        for &(c, d) in &edges[k + 1..] {
            let off = |p: Point2, q: Point2, r: Point2| cross(p, q, r) / p.distance(q);
            let through = |p: Point2, q: Point2, r: Point2, s: Point2| {
                let (r, s) = (off(p, q, r), off(p, q, s));
                r.abs().min(s.abs()) > rounding && (r > 0.0) != (s > 0.0)
            };
            assert!(!(through(a, b, c, d) && through(c, d, a, b)), "{a} {b} crosses {c} {d}");
        }
    }
    assert!(rings().all(|r| r.points.len() > 2));
    for polygon in polygons {
        assert!(polygon.outer.area() > 0.0, "an outer ring runs clockwise");
        assert!(polygon.holes.iter().all(|h| h.area() < 0.0), "a hole runs anticlockwise");
    }
}

pub(crate) fn area(polygons: &[Polygon]) -> f64 {
    polygons.iter().map(Polygon::area).sum()
}

/// The signed distance of a box turned by `angle`.
pub(crate) fn turned_box(p: Point2, center: Point2, half: Point2, angle: f64) -> f64 {
    let q = Point2::from_angle(-angle).rotate(p - center).abs() - half;
    q.max(Point2::ZERO).length() + q.max_element().min(0.0)
}

/// A box as a mesh, turned about the vertical.
pub(crate) fn box_mesh(center: Point3, half: Point3, angle: f64) -> TriangleMesh {
    let turn = Point2::from_angle(angle);
    let vertices = (0..8)
        .map(|k| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let p = Point3::new(sign(0), sign(1), sign(2)) * half;
            center + turn.rotate(p.truncate()).extend(p.z)
        })
        .collect();
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    TriangleMesh { vertices, triangles }
}

/// Two meshes as one.
pub(crate) fn both(a: TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let mut mesh = a;
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend_from_slice(&b.vertices);
    mesh.triangles.extend(b.triangles.iter().map(|t| t.map(|v| v + first)));
    mesh
}

/// The same mesh with three vertices of its own for every triangle, as STL has.
pub(crate) fn soup(mesh: &TriangleMesh) -> TriangleMesh {
    let vertices: Vec<Point3> = mesh.corners().flatten().collect();
    let triangles =
        (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriangleMesh { vertices, triangles }
}
