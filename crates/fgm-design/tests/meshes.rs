//! Mesh files: every form of a cube, every kind of damage, and the real models where they are.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::path::Path;

use fgm_core::{Bounds3, Point3, TriangleMesh};
use fgm_design::{read_3mf, read_obj, read_stl};
use zip::write::{SimpleFileOptions, ZipWriter};

/// A cube from 0 to 10.
fn cube() -> TriangleMesh {
    let corner =
        |i: usize| Point3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 10.0;
    TriangleMesh {
        vertices: (0..8).map(corner).collect(),
        triangles: vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ],
    }
}

fn binary_stl(mesh: &TriangleMesh, head: &[u8]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for corners in mesh.corners() {
        bytes.extend([0; 12]);
        for v in corners.iter().flat_map(Point3::to_array) {
            bytes.extend((v as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn text_stl(mesh: &TriangleMesh) -> String {
    let mut text = "solid a cube of facets\n".to_string();
    for corners in mesh.corners() {
        text += "facet normal 0 0 1\n  outer loop\n";
        for p in corners {
            writeln!(text, "    vertex {:e} {:e} {:e}", p.x, p.y, p.z).unwrap();
        }
        text += "  endloop\nendfacet\n";
    }
    text + "endsolid a cube of facets\n"
}

/// A 3MF file of parts.
fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn mesh_xml(mesh: &TriangleMesh) -> String {
    let mut text = "<mesh><vertices>".to_string();
    for p in &mesh.vertices {
        write!(text, "<vertex x=\"{}\" y='{}' z=\" {} \"/>", p.x, p.y, p.z).unwrap();
    }
    text += "</vertices><triangles>";
    for [a, b, c] in &mesh.triangles {
        write!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\" p1=\"0\"></triangle>").unwrap();
    }
    text + "</triangles></mesh>"
}

fn model_3mf(head: &str, resources: &str, build: &str) -> Vec<u8> {
    let text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model {head} \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\
         <metadata name=\"vertex\">v &amp; w</metadata>\
         <resources>{resources}</resources><build>{build}</build></model>"
    );
    archive(&[("3D/3dmodel.model", &text)])
}

fn is_cube(mesh: &TriangleMesh, what: &str) {
    assert_eq!(mesh.vertices.len(), 8, "{what}");
    assert_eq!(mesh.triangles.len(), 12, "{what}");
    assert!((mesh.volume() - 1000.0).abs() < 1e-9, "{what}: {}", mesh.volume());
    assert_eq!(mesh.bounds(), Bounds3::new(Point3::ZERO, Point3::splat(10.0)), "{what}");
}

#[test]
fn every_format_gives_the_cube() {
    let cube = cube();
    let text = text_stl(&cube);
    for (what, bytes) in [
        ("binary", binary_stl(&cube, b"made by hand")),
        ("binary with a head like text", binary_stl(&cube, b"solid\nfacet normal 0 0 1\n")),
        ("binary with more behind", [binary_stl(&cube, b""), b"more".to_vec()].concat()),
        ("text", text.clone().into_bytes()),
        ("upper case", text.to_uppercase().into_bytes()),
        ("CRLF", text.replace('\n', "\r\n").into_bytes()),
        ("upper case and CRLF", text.to_uppercase().replace('\n', "\r\n").into_bytes()),
        ("CR alone", text.replace('\n', "\r").into_bytes()),
        ("no name, tabs", text.replace(" a cube of facets", "").replace("  ", "\t").into_bytes()),
        ("normals that are none", text.replace("normal 0 0 1", "normal nan -nan inf").into_bytes()),
        ("no end", text.replace("endsolid a cube of facets\n", "").into_bytes()),
        ("space before", format!("\n\n  {text}").into_bytes()),
    ] {
        is_cube(&read_stl(&bytes).unwrap(), what);
    }

    let vertices: String =
        cube.vertices.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
    let faces = |line: &dyn Fn([u32; 3]) -> String| -> String {
        cube.triangles.iter().map(|t| line(*t)).collect()
    };
    let plain = faces(&|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    let negative =
        faces(&|t| format!("f {} {} {}\n", t[0] as i64 - 8, t[1] as i64 - 8, t[2] as i64 - 8));
    let slashes = faces(&|[a, b, c]| format!("f {}/1/2 {}//3 {}/4 # face\n", a + 1, b + 1, c + 1));
    let quads = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    let halves = plain.replacen("f 1 2 5", "o second\ng other\nusemtl red\nf 1 2 5", 1);
    for (what, text) in [
        ("plain", format!("# cube\nmtllib gone.mtl\n{vertices}vt 0 0\nvn 0 0 1\n{plain}")),
        ("negative", format!("{vertices}{negative}")),
        ("slashes", format!("{vertices}{slashes}")),
        ("quads", format!("o cube\n{vertices}{quads}")),
        ("two objects", format!("o first\n{vertices}{halves}")),
        ("CRLF", format!("{vertices}{quads}").replace('\n', "\r\n")),
        ("colours", format!("{}{quads}", vertices.replace('\n', " 0.1 0.2 0.3\n"))),
        ("points and lines", format!("{vertices}{quads}p 1\nl 1 2\ncurv 0 1 1 2\n")),
    ] {
        is_cube(&read_obj(text.as_bytes()).unwrap(), what);
    }

    let object = format!("<object id=\"1\" type=\"model\">{}</object>", mesh_xml(&cube));
    let item = "<item objectid=\"1\"/>";
    let small = "<item objectid=\"1\" transform=\"0.1 0 0 0 0.1 0 0 0 0.1 0 0 0\"/>";
    let mirrored = "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 10 0 0\"/>";
    let nested = format!(
        "{object}<object id=\"2\"><components><component objectid=\"1\" \
         transform=\"0 1 0 -1 0 0 0 0 1 0 0 0\"/></components></object>"
    );
    let turned_back = "<item objectid=\"2\" transform=\"0 -1 0 1 0 0 0 0 1 0 0 0\"/>";
    for (what, bytes) in [
        ("plain", model_3mf("unit=\"millimeter\"", &object, item)),
        ("no unit, no build", model_3mf("", &object, "")),
        ("centimetres", model_3mf("unit=\"centimeter\"", &object, small)),
        ("mirrored", model_3mf("", &object, mirrored)),
        ("components", model_3mf("", &nested, turned_back)),
        (
            "one not printed",
            model_3mf("", &object, &format!("{item}<item objectid=\"9\" printable=\"0\"/>")),
        ),
    ] {
        is_cube(&read_3mf(&bytes).unwrap(), what);
    }
}

#[test]
fn units_transforms_and_several_items() {
    let object = format!("<object id=\"1\">{}</object>", mesh_xml(&cube()));
    let support = object.replace("id=\"1\"", "id=\"3\" type=\"support\"");
    let items = "<item objectid=\"1\"/><item objectid=\"3\"/>\
                 <item objectid=\"1\" transform=\"1 0 0 0 0 1 0 -1 0 100 2 3\"/>";
    let mesh = read_3mf(&model_3mf("unit=\"inch\"", &(object + &support), items)).unwrap();
    assert_eq!(mesh.triangles.len(), 24);
    assert!((mesh.volume() - 2000.0 * 25.4_f64.powi(3)).abs() < 1e-6);
    // (x, y, z) goes to (x + 100, -z + 2, y + 3).
    let bounds = mesh.bounds();
    let (min, max) = (Point3::new(0.0, -8.0, 0.0) * 25.4, Point3::new(110.0, 10.0, 13.0) * 25.4);
    assert!((bounds.min - min).abs().max((bounds.max - max).abs()).max_element() < 1e-9);
}

#[test]
fn parts_by_relation_prefix_and_production_extension() {
    let relations = "<Relationships><Relationship Id=\"r\" Target=\"/3D/Other.model\" \
                     Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let mesh =
        mesh_xml(&cube()).replace("</", "</c:").replace('<', "<c:").replace("<c:/c:", "</c:");
    let part = format!(
        "<c:model xmlns:c=\"core\" xmlns:s=\"slices\"><c:resources><s:vertices><s:vertex x=\"1\" y=\"2\"/>\
         </s:vertices><c:object id=\"7\">{mesh}</c:object></c:resources></c:model>"
    );
    let root = "<model xmlns:p=\"production\"><resources><object id=\"1\"><components>\
                <component p:path=\"/3D/Objects/cube.model\" objectid=\"7\"/></components></object>\
                </resources><build><item objectid=\"1\"/></build></model>";
    let bytes = archive(&[
        ("_rels/.rels", relations),
        ("3d/other.MODEL", root),
        ("3D/Objects/cube.model", &part),
    ]);
    is_cube(&read_3mf(&bytes).unwrap(), "parts");
}

#[test]
fn damaged_stl_files() {
    let whole = binary_stl(&cube(), b"cube");
    let mut nan = whole.clone();
    nan[84 + 50 * 4 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let text = text_stl(&cube());
    let cut = text.find("vertex 1e1 1e1 0e0").unwrap();
    for (bytes, expected) in [
        (whole[..84 + 50 * 5 + 20].to_vec(), "<stl>: the file ends early: 5 of 12 triangles"),
        (whole[..84].to_vec(), "<stl>: the file ends early: 0 of 12 triangles"),
        (nan, "<stl>: triangle 5 (from 1) has a coordinate that is not a finite number"),
        (vec![0; 84], "<stl>: the mesh has no triangles"),
        (b"solid nothing\nendsolid nothing\n".to_vec(), "<stl>: the mesh has no triangles"),
        (
            Vec::new(),
            "<stl>: not an STL file: neither 84 bytes of a binary one nor the word `solid`",
        ),
        (
            b"short".to_vec(),
            "<stl>: not an STL file: neither 84 bytes of a binary one nor the word `solid`",
        ),
        (
            text.as_bytes()[..cut].to_vec(),
            "<stl>:12:23: expected `vertex`, found the end of the file",
        ),
        (
            text.replacen("vertex 1e1", "vertex nan", 1).into_bytes(),
            "<stl>:6:22: triangle 1 (from 1) has a coordinate that is not a finite number",
        ),
        (text.replacen("1e1", "1,0", 1).into_bytes(), "<stl>:5:16: expected a number, found `1,0`"),
        (
            text.replacen("outer", "inner", 1).into_bytes(),
            "<stl>:3:3: expected `outer loop`, found `inner`",
        ),
        (
            text.replacen("endloop", "vertex 1 2 3", 1).into_bytes(),
            "<stl>:7:3: expected `endloop`: a facet has three vertices, found `vertex`",
        ),
        (
            text.replacen("endfacet\nfacet", "endfacet\nbanana", 1).into_bytes(),
            "<stl>:9:1: expected `facet` or `endsolid`, found `banana`",
        ),
    ] {
        assert_eq!(read_stl(&bytes).unwrap_err().to_string(), expected);
    }
}

#[test]
fn damaged_obj_files() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, expected) in [
        (String::new(), "<obj>: the mesh has no triangles"),
        (corners.to_string(), "<obj>: the mesh has no triangles"),
        (format!("{corners}f 1 2 4\nf 1 2 3\n"), "<obj>:4:1: a face uses vertex 4; there are 3"),
        (format!("{corners}f 1 2 0\n"), "<obj>:4:1: a face uses vertex 0; there are 3"),
        (format!("{corners}f 1 2 -4\n"), "<obj>:4:1: a face uses vertex -4; there are 3"),
        (format!("# head\n{corners}\nf 1 2 x\n"), "<obj>:6:1: face parse error"),
        (format!("# head\n{corners}v 1 zwei 3\nf 1 2 3\n"), "<obj>:5:1: position parse error"),
        (format!("{corners}v 1 2\nf 1 2 3\n"), "<obj>:4:1: position parse error"),
        (
            format!("{corners}v nan 0 0\nf 1 2 3\nf 1 2 4\n"),
            "<obj>: triangle 2 (from 1) has a coordinate that is not a finite number",
        ),
        (
            format!("{corners}f -9223372036854775808 1 2\n"),
            "<obj>:4:1: a face uses vertex -9223372036854775808; there are 3",
        ),
    ] {
        assert_eq!(read_obj(text.as_bytes()).unwrap_err().to_string(), expected, "{text}");
    }
}

#[test]
fn damaged_3mf_files() {
    let object = format!("<object id=\"1\">{}</object>", mesh_xml(&cube()));
    let item = "<item objectid=\"1\"/>";
    let whole = model_3mf("", &object, item);
    let part = "<3mf>: 3D/3dmodel.model: byte ";
    let broken = |from: &str, to: &str| model_3mf("", &object.replacen(from, to, 1), item);
    let cyclic = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    for (bytes, start, end) in [
        (b"PK nothing".to_vec(), "<3mf>: the 3MF archive: ", ""),
        (whole[..whole.len() / 2].to_vec(), "<3mf>: the 3MF archive: ", ""),
        (archive(&[("other", "")]), "<3mf>: the 3MF archive: ", ""),
        (archive(&[("3D/3dmodel.model", "")]), part, "no `model` element"),
        (
            archive(&[("3D/3dmodel.model", "<html/>")]),
            part,
            "expected a `model` element, found `html`",
        ),
        (archive(&[("3D/3dmodel.model", "<model><resources></model>")]), part, ""),
        (model_3mf("unit=\"parsec\"", &object, item), part, "unknown unit `parsec`"),
        (model_3mf("", &object, "<item objectid=\"2\"/>"), part, "no object 2"),
        (
            model_3mf("", &object, "<item/>"),
            part,
            "a component or item without a number as its `objectid`",
        ),
        (
            model_3mf("", &object, "<item objectid=\"1\" transform=\"1 0 0\"/>"),
            part,
            "a transform is twelve numbers, not `1 0 0`",
        ),
        (model_3mf("", cyclic, item), part, "components nested more than 32 deep"),
        (model_3mf("", "", ""), "<3mf>: the mesh has no triangles", ""),
        (broken("x=\"10\"", "x=\"nan\""), part, "vertex 1 of object 1 has no finite x, y, z"),
        (broken("v1=\"0\"", "v1=\"8\""), part, "triangle 0 of object 1 uses a vertex beyond its 8"),
        (broken("v1=\"0\"", "v1=\"-1\""), part, "triangle 0 of object 1 has no v1, v2, v3"),
        (broken("id=\"1\"", ""), part, "an object without a number as its `id`"),
    ] {
        let told = read_3mf(&bytes).unwrap_err().to_string();
        assert!(told.starts_with(start) && told.ends_with(end), "{told} for {start}...{end}");
    }
}

#[test]
fn the_real_models() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let read = |name: &str| {
        let path = folder.join(name);
        let bytes = std::fs::read(&path);
        if bytes.is_err() {
            eprintln!("skipped: {} is not here", path.display());
        }
        bytes.ok()
    };
    if let Some(bytes) = read("3DBenchy.3mf") {
        let mesh = read_3mf(&bytes).unwrap();
        let size = mesh.bounds().size();
        assert!((size - Point3::new(60.001, 31.004, 48.0)).abs().max_element() < 1e-9, "{size}");
        assert!((mesh.volume() - 15_550.498).abs() < 1e-3);
        assert!((225_100..=225_154).contains(&mesh.triangles.len()));
    }
    if let Some(bytes) = read("vase.stl") {
        let mesh = read_stl(&bytes).unwrap();
        assert_eq!(mesh.bounds().size(), Point3::new(135.0, 175.0, 100.0));
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (72_482, 144_960));
        assert!((mesh.volume() - 1_122_953.0).abs() < 1.0);
    }
}
