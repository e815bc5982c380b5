//! Contours of a flower-shaped plate and a section of a mesh, as an SVG drawing on the standard
//! output: `cargo run -p fgm-contour --example flower > flower.svg`.

#![allow(clippy::print_stdout)]

use fgm_contour::{ContourError, ContourOptions, MeshSlicer, isolines, outline};
use fgm_core::{Bounds2, Point2, Point3, Polygon, TriangleMesh};

/// A plate with nine petals and a square hole: negative inside.
fn flower(p: Point2) -> f64 {
    let petals = p.length() - 30.0 - 4.0 * (9.0 * p.to_angle()).sin();
    let hole = 9.0 - p.abs().max_element();
    petals.max(hole)
}

/// The share of one of two materials.
fn share(p: Point2) -> f64 {
    (1.0 + (0.06 * p.x + 0.09 * p.y).sin() * (0.09 * p.x - 0.06 * p.y).cos()) / 2.0
}

fn octahedron(radius: f64) -> TriangleMesh {
    let axes = [Point3::X, Point3::Y, Point3::NEG_X, Point3::NEG_Y, Point3::Z, Point3::NEG_Z];
    let vertices = axes.map(|a| a * radius).to_vec();
    let around = (0..4).map(|k| (k, (k + 1) % 4));
    let triangles = around.flat_map(|(a, b)| [[a, b, 4], [b, a, 5]]).collect();
    TriangleMesh { vertices, triangles }
}

fn path(points: &[Point2], closed: bool) -> String {
    let steps: Vec<String> = points.iter().map(|p| format!("{:.3},{:.3}", p.x, -p.y)).collect();
    format!("M{}{}", steps.join("L"), if closed { "Z" } else { "" })
}

fn fill(polygons: &[Polygon], color: &str) {
    let rings = polygons.iter().flat_map(Polygon::rings);
    let data: String = rings.map(|ring| path(&ring.points, true)).collect();
    println!("<path fill='{color}' d='{data}'/>");
}

fn main() -> Result<(), ContourError> {
    let window = Bounds2::new(Point2::splat(-40.0), Point2::splat(40.0));
    let options = ContourOptions::default();
    println!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-40 -40 80 80'>");
    fill(&outline(&flower, &window, &options)?, "gold");
    let levels: Vec<f64> = (1..8).map(|k| f64::from(k) / 8.0).collect();
    for lines in isolines(&share, &window, &levels, &options)? {
        let rings = lines.rings.iter().map(|r| path(&r.points, true));
        let open = lines.lines.iter().map(|l| path(&l.points, false));
        let data: String = rings.chain(open).collect();
        println!("<path fill='none' stroke='steelblue' stroke-width='0.3' d='{data}'/>");
    }
    fill(&MeshSlicer::new(&octahedron(8.0))?.section(1.5).polygons, "tomato");
    println!("</svg>");
    Ok(())
}
