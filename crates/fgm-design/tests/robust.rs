//! Nothing that is read makes the readers panic, and what they give holds together.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::path::Path;

use fgm_core::{Bounds3, Point3};
use fgm_design::{DesignError, LoadOptions, parse_vcad, read_3mf, read_obj, read_stl};
use fgm_field::Geometry;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Texts with every kind of node and argument.
const TEXTS: [&str; 8] = [
    r#"// A ring.
let inner = 15; let outer = 50;
fgrade(["(rho - inner)/(outer - inner)", "(outer - rho)/(outer - inner)"], ["y", "b"]) {
  difference() { cylinder(outer, 10); cylinder(inner, 10); }
}"#,
    r#"root((-10, -10, -10), (10, 10, 10), (0.5, 0.5, 0.5)) {
  blend(3, 1, 2) { f_grade(["x", "d", "1"], ["a", "b", "void"], "thresh") { cube(5); sphere(2, "m"); } }
}"#,
    r#"function((-5, -5, 0), (5, 5, 9), "4(3)^2(x^2+y^2)/36 - z", "m");"#,
    r#"function("max(rho - 3, abs(z) - 2)", "m"); /* two */ rectprism((1, 2, 3), "n");"#,
    r#"translate(1, 2, 3) { scale(-1, 2, 0.5) { rotate(30, -45, 180) { torus(5, 1, "m"); } } }"#,
    r#"smooth_union(2) { cone(3, 1, 5, "a"); capsule(1, 9, "b"); }
extrude(2, [(0, 0), (4, 0), (2, 3)], "c");"#,
    r#"offset(0.5) { shell(1) { smooth_difference(1) { cube(9, "a"); sphere(5, "a"); } } }"#,
    r#"convolve([[[1, 2, 1], [0, 1, 0]]]) { intersection() { gyroid((9, 9, 9), 5, 1, "a"); cone(4, 4, "b"); } }"#,
];

fn small_mesh_files() -> Vec<Vec<u8>> {
    let text =
        b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                 endloop\nendfacet\nendsolid a\n";
    let mut binary = vec![b' '; 80];
    binary.extend(2_u32.to_le_bytes());
    for i in 0..100_u8 {
        binary.push(i.wrapping_mul(37) & 0x3f);
    }
    let obj = b"o a\nv 0 0 0\nv 1 0 0 1 1 1\nv 0 1 0\nvt 0 0\nf 1/1 2//1 3\nf -3 -2 -1\nf 1 2 3 1\nl 1 2\n";
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    zip.start_file("3D/3dmodel.model", options).unwrap();
    let model = b"<model unit=\"inch\"><resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
        <vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>\
        <triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object><object id=\"2\"><components>\
        <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 3 4 5\"/></components></object></resources>\
        <build><item objectid=\"2\"/></build></model>";
    std::io::Write::write_all(&mut zip, model).unwrap();
    vec![text.to_vec(), binary, obj.to_vec(), zip.finish().unwrap().into_inner()]
}

fn read_all(bytes: &[u8]) {
    for mesh in [read_stl(bytes), read_obj(bytes), read_3mf(bytes)].into_iter().flatten() {
        assert!(!mesh.triangles.is_empty());
        assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < mesh.vertices.len()));
        assert!(mesh.vertices.iter().all(|p| p.is_finite()));
    }
}

/// Reads a text and, if it is a design, looks at it; an error must point into it.
fn read_text(text: &str) {
    match parse_vcad(text, Path::new("/nowhere"), &LoadOptions::default()) {
        Ok(loaded) => {
            let design = loaded.design;
            assert!(design.bounds.is_finite(), "{text}");
            assert_eq!(design.materials.len(), design.fractions.materials());
            for p in design.bounds.corners() {
                if let Ok(mixture) = design.fractions.mixture(p) {
                    assert!((mixture.fractions().iter().sum::<f64>() - 1.0).abs() < 1e-9);
                }
            }
        }
        Err(DesignError::Source { at, text: whole, .. }) => {
            assert!(whole.get(at.span.clone()).is_some(), "{at:?} of {text}");
        }
        Err(error) => panic!("{error} does not point, for {text}"),
    }
}

/// What is put into a text to damage it.
const PIECES: [&str; 26] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ";",
    "\"",
    "//",
    "/*",
    "let a = 2;",
    "-",
    "0",
    "1e308",
    "1e-320",
    "nan",
    "x",
    "ö",
    "union() {",
    "cube(1, \"m\");",
    "mesh(\"a.stl\");",
    "9999999",
    "\0",
    "fgrade",
    "d",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn damaged_texts_are_read_or_refused(
        text in select(&TEXTS[..]),
        damage in prop::collection::vec((any::<Index>(), 0..6_usize, select(&PIECES[..])), 1..4),
    ) {
        let mut damaged: Vec<char> = text.chars().collect();
        for (at, cut, piece) in damage {
            let at = at.index(damaged.len() + 1);
            let end = (at + cut).min(damaged.len());
            damaged.splice(at..end, piece.chars());
        }
        read_text(&damaged.into_iter().collect::<String>());
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,60}") {
        read_text(&text);
    }

    #[test]
    fn damaged_meshes_are_read_or_refused(
        which in 0..4_usize,
        damage in prop::collection::vec((any::<Index>(), any::<u8>()), 0..6),
        cut in any::<Index>(),
        shorten in any::<bool>(),
    ) {
        let mut bytes = small_mesh_files().swap_remove(which);
        for (at, value) in damage {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if shorten {
            bytes.truncate(cut.index(bytes.len()));
        }
        read_all(&bytes);
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        read_all(&bytes);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Wherever it is moved and however it is turned, a dome's bounds touch it, and its material
    /// stays with it.
    #[test]
    fn bounds_and_material_move_with_the_shape(
        (x, y, z) in (-50.0..50.0_f64, -50.0..50.0_f64, -50.0..50.0_f64),
        (a, b, c) in (-180.0..180.0_f64, -180.0..180.0_f64, -180.0..180.0_f64),
        size in 0.1..5.0_f64,
    ) {
        let dome = "fgrade([\"z/5\", \"1 - z/5\"], [\"a\", \"b\"]) {
            difference() { sphere(5); translate(0, 0, -10) { cube(20); } } }";
        let text = format!(
            "translate({x}, {y}, {z}) {{ rotate({a}, {b}, {c}) {{ scale({size}, {size}, {size}) {{ {dome} }} }} }}"
        );
        let design = parse_vcad(&text, Path::new("."), &LoadOptions::default()).unwrap().design;
        let (a, b, c) = (a.to_radians(), b.to_radians(), c.to_radians());
        let turn = glam::DMat3::from_rotation_z(c) * glam::DMat3::from_rotation_y(b)
            * glam::DMat3::from_rotation_x(a);
        let place = |p: Point3| turn * (p * size) + Point3::new(x, y, z);
        // The dome's own points: its rim and its round.
        let points = (0..=80).flat_map(|i| (0..360).map(move |k| {
            let (up, round) = (f64::from(i) / 160.0 * std::f64::consts::PI, f64::from(k).to_radians());
            Point3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin()) * 5.0
        }));
        let touched = Bounds3::of(points.map(place));
        let off = (touched.min - design.bounds.min).abs().max((touched.max - design.bounds.max).abs());
        prop_assert!(off.max_element() < 5e-4 * size, "{touched:?} {:?}", design.bounds);
        let mixture = design.fractions.mixture(place(Point3::new(1.0, 2.0, 2.5))).unwrap();
        prop_assert!((mixture.fractions()[0] - 0.5).abs() < 1e-9);
        prop_assert!(matches!(design.geometry, Geometry::Field(_)));
    }

    /// Written and read again, a soup of triangles is the same soup.
    #[test]
    fn stl_triangles_come_back(numbers in prop::collection::vec(-1e6..1e6_f32, 9..200)) {
        let triangles = numbers.as_chunks::<9>().0;
        let mut bytes = vec![0; 80];
        bytes.extend((triangles.len() as u32).to_le_bytes());
        let mut text = "solid\n".to_string();
        for t in triangles {
            bytes.extend([0; 12]);
            t.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
            bytes.extend([0; 2]);
            let v = t.map(|v| v.to_string());
            text += &format!(
                "facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n",
                v[..3].join(" "), v[3..6].join(" "), v[6..].join(" "),
            );
        }
        let (binary, text) = (read_stl(&bytes).unwrap(), read_stl(text.as_bytes()).unwrap());
        let expected: Vec<[Point3; 3]> = triangles.iter().map(|t| {
            std::array::from_fn(|i| Point3::new(t[3 * i].into(), t[3 * i + 1].into(), t[3 * i + 2].into()))
        }).collect();
        prop_assert_eq!(binary.corners().collect::<Vec<_>>(), expected);
        // The text's decimals are the shortest that give the same f32, not the same f64.
        let near = |a: &[Point3; 3], b: &[Point3; 3]| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs().max_element() < 0.1)
        };
        prop_assert!(binary.corners().zip(text.corners()).all(|(a, b)| near(&a, &b)));
    }
}

/// A zip of a few kilobytes that would unpack to gigabytes is refused or read within its limit,
/// whatever size it says it has.
#[test]
fn a_lying_archive_costs_no_memory() {
    let mut bytes = small_mesh_files().swap_remove(3);
    // The uncompressed size in the archive's directory, said to be 4 GB.
    let at = bytes.windows(4).rposition(|w| w == b"PK\x01\x02").unwrap();
    bytes[at + 24..at + 28].copy_from_slice(&u32::MAX.to_le_bytes()[..4]);
    read_all(&bytes);
}
