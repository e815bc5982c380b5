//! What .vcad designs mean: where shapes are, and what every point is made of.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::fs;
use std::path::{Path, PathBuf};

use fgm_core::{Bounds3, Field, Point3};
use fgm_design::{LoadOptions, Loaded, load, parse_vcad};
use fgm_field::{Design, Geometry};
use glam::DVec3;

fn loaded(text: &str, options: &LoadOptions) -> Loaded {
    match parse_vcad(text, &folder(), options) {
        Ok(loaded) => loaded,
        Err(error) => panic!("{error} in {text}"),
    }
}

fn design(text: &str) -> Design {
    loaded(text, &LoadOptions::default()).design
}

/// A folder with a cube from 0 to 10 as `cube.stl`.
fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meaning");
    let file = folder.join("cube.stl");
    if !file.exists() {
        fs::create_dir_all(&folder).unwrap();
        let mut text = "solid cube\n".to_string();
        for axis in 0..3 {
            for (at, order) in [(0.0, [0, 2, 1, 3]), (10.0, [0, 1, 2, 3])] {
                let corner = |i: usize| {
                    let mut p = [at; 3];
                    p[(axis + 1) % 3] = (i & 1) as f64 * 10.0;
                    p[(axis + 2) % 3] = (i >> 1) as f64 * 10.0;
                    format!("vertex {} {} {}\n", p[0], p[1], p[2])
                };
                let [a, b, c, d] = order.map(corner);
                for triangle in [[&a, &b, &c], [&b, &d, &c]] {
                    text += "facet normal 0 0 0\nouter loop\n";
                    triangle.iter().for_each(|v| text += v);
                    text += "endloop\nendfacet\n";
                }
            }
        }
        text += "endsolid\n";
        // Written beside and renamed: tests run at the same time.
        let beside = folder.join(format!("cube-{:?}.tmp", std::thread::current().id()));
        fs::write(&beside, text).unwrap();
        fs::rename(&beside, &file).unwrap();
    }
    folder
}

fn field(design: &Design) -> &dyn Field {
    match &design.geometry {
        Geometry::Field(field) => &**field,
        Geometry::Mesh(_) => panic!("a mesh"),
    }
}

fn first_fraction(design: &Design, p: [f64; 3]) -> f64 {
    design.fractions.mixture(Point3::from(p)).unwrap().fractions()[0]
}

/// The name of the only material at a point.
fn pure(design: &Design, p: [f64; 3]) -> &str {
    let mixture = design.fractions.mixture(Point3::from(p)).unwrap();
    let material = mixture.fractions().iter().position(|f| *f == 1.0);
    &design.materials[material.unwrap_or_else(|| panic!("{mixture:?} at {p:?}"))].name
}

fn near(bounds: &Bounds3, min: [f64; 3], max: [f64; 3], what: &str) {
    let off = (bounds.min - Point3::from(min)).abs().max((bounds.max - Point3::from(max)).abs());
    assert!(off.max_element() < 1e-7, "{what}: {bounds:?}");
}

#[test]
fn shapes_stand_where_the_reference_says() {
    for (text, min, max) in [
        ("sphere(2, \"a\");", [-2.0; 3], [2.0; 3]),
        ("cube(3, \"a\");", [-1.5; 3], [1.5; 3]),
        ("rectprism(2, 4, 6, \"a\");", [-1.0, -2.0, -3.0], [1.0, 2.0, 3.0]),
        ("rectprism((2, 4, 6), \"a\");", [-1.0, -2.0, -3.0], [1.0, 2.0, 3.0]),
        ("cylinder(2, 5, \"a\");", [-2.0, -2.0, 0.0], [2.0, 2.0, 5.0]),
        ("cone(2, 5, \"a\");", [-2.0, -2.0, 0.0], [2.0, 2.0, 5.0]),
        ("cone(2, 3, 5, \"a\");", [-3.0, -3.0, 0.0], [3.0, 3.0, 5.0]),
        ("cone(2, 0, 5, \"a\");", [-2.0, -2.0, 0.0], [2.0, 2.0, 5.0]),
        ("torus(5, 1, \"a\");", [-6.0, -6.0, -1.0], [6.0, 6.0, 1.0]),
        ("capsule(1, 6, \"a\");", [-1.0, -1.0, 0.0], [1.0, 1.0, 6.0]),
        ("extrude(2, [(1, 1), (4, 1), (4, 3), (1, 1)], \"a\");", [1.0, 1.0, 0.0], [4.0, 3.0, 2.0]),
        ("gyroid((20, 20, 10), 10, 1, \"a\");", [-10.0, -10.0, -5.0], [10.0, 10.0, 5.0]),
        ("mesh(\"cube.stl\", \"a\");", [0.0; 3], [10.0; 3]),
        ("function(\"x^2 + y^2 + (z - 3)^2 - 4\", \"a\");", [-2.0, -2.0, 1.0], [2.0, 2.0, 5.0]),
        (
            "function(\"max(abs(x) - 700, abs(y) - 0.25, abs(z - 50) - 50)\", \"a\");",
            [-700.0, -0.25, 0.0],
            [700.0, 0.25, 100.0],
        ),
        (
            "function((-9, -9, -9), (9, 9, 1), \"r - 4\", \"a\");",
            [-4.0, -4.0, -4.0],
            [4.0, 4.0, 1.0],
        ),
        ("translate(1, 2, 3) { cube(2, \"a\"); }", [0.0, 1.0, 2.0], [2.0, 3.0, 4.0]),
        ("scale(1, 2, -3) { cylinder(1, 1, \"a\"); }", [-1.0, -2.0, -3.0], [1.0, 2.0, 0.0]),
        // About x by 90 degrees: y to z.
        (
            "rotate(90, 0, 0) { translate(1, 2, 3) { cube(2, \"a\"); } }",
            [0.0, -4.0, 1.0],
            [2.0, -2.0, 3.0],
        ),
        // Then about y: x to -z; then about z: x to y.
        (
            "rotate(0, 90, 0) { translate(1, 2, 3) { cube(2, \"a\"); } }",
            [2.0, 1.0, -2.0],
            [4.0, 3.0, 0.0],
        ),
        (
            "rotate(0, 0, 90) { translate(1, 2, 3) { cube(2, \"a\"); } }",
            [-3.0, 0.0, 2.0],
            [-1.0, 2.0, 4.0],
        ),
        (
            "rotate(90, 0, 90) { translate(1, 2, 3) { cube(2, \"a\"); } }",
            [2.0, 0.0, 1.0],
            [4.0, 2.0, 3.0],
        ),
        ("rotate(30, 40, 50) { sphere(3, \"a\"); }", [-3.0; 3], [3.0; 3]),
        (
            "rotate(0, 0, 45) { cube(2, \"a\"); }",
            [-2.0_f64.sqrt(), -2.0_f64.sqrt(), -1.0],
            [2.0_f64.sqrt(), 2.0_f64.sqrt(), 1.0],
        ),
        ("rotate(0, 0, 90) { mesh(\"cube.stl\", \"a\"); }", [-10.0, 0.0, 0.0], [0.0, 10.0, 10.0]),
        (
            "union() { cube(2, \"a\"); translate(5, 0, 0) { cube(2, \"b\"); } }",
            [-1.0; 3],
            [6.0, 1.0, 1.0],
        ),
        ("cube(2, \"a\"); translate(5, 0, 0) { cube(2, \"b\"); }", [-1.0; 3], [6.0, 1.0, 1.0]),
        // A dome: the search finds its foot, which no part's own bounds know.
        (
            "difference() { sphere(5, \"a\"); translate(0, 0, -10) { cube(20, \"a\"); } }",
            [-5.0, -5.0, 0.0],
            [5.0; 3],
        ),
        (
            "intersection() { sphere(5, \"a\"); translate(0, 0, 13) { cube(20, \"a\"); } }",
            [-4.0, -4.0, 3.0],
            [4.0, 4.0, 5.0],
        ),
        (
            "intersection() { function(\"sin(x)*0 + z - 1\", \"a\"); cube(4, \"a\"); }",
            [-2.0; 3],
            [2.0, 2.0, 1.0],
        ),
        ("offset(1) { sphere(5, \"a\"); }", [-6.0; 3], [6.0; 3]),
        ("offset(-1) { sphere(5, \"a\"); }", [-4.0; 3], [4.0; 3]),
        ("shell(1) { sphere(5, \"a\"); }", [-5.0; 3], [5.0; 3]),
        (
            "root((-1, -1, -1), (1, 1, 1), (0.1, 0.1, 0.1)) { sphere(3, \"a\"); }",
            [-1.0; 3],
            [1.0; 3],
        ),
        ("root((-9, -9, -9), (9, 9, 9), 0.5) { sphere(3, \"a\"); }", [-3.0; 3], [3.0; 3]),
        ("root() { sphere(3, \"a\"); }", [-3.0; 3], [3.0; 3]),
        ("let n = 2; union() { let n = n*3; sphere(n/2, \"a\"); }", [-3.0; 3], [3.0; 3]),
    ] {
        near(&design(text).bounds, min, max, text);
    }
}

/// The search for the ends once went on for ever where numbers are further apart than its goal.
#[test]
fn far_from_the_origin_the_ends_are_found_too() {
    let text = "translate(999990, 2, 3) { rotate(30, -45, 180) { torus(5, 1, \"m\"); } }";
    let bounds = design(text).bounds;
    assert!((bounds.center().x - 999_990.0).abs() < 1e-6, "{bounds:?}");
    // What a ring of radius 5 reaches along x, whose axis lies at 30 and 45 degrees, and the tube.
    let axis = [0.75_f64.sqrt() * 0.5_f64.sqrt(), 0.5, 0.75_f64.sqrt() * 0.5_f64.sqrt()];
    let reach = |k: usize| 5.0 * (1.0 - axis[k] * axis[k]).sqrt() + 1.0;
    let size = Point3::new(reach(0), reach(1), reach(2)) * 2.0;
    assert!((bounds.size() - size).abs().max_element() < 1e-4, "{:?} {size}", bounds.size());
}

#[test]
fn combinations_hold_what_they_say() {
    let inside = |text: &str, p: [f64; 3]| field(&design(text)).eval(Point3::from(p)) <= 0.0;
    let two = "{ sphere(5, \"a\"); translate(6, 0, 0) { sphere(5, \"a\"); } }";
    for (p, union, both, first) in [
        ([-1.0, 0.0, 0.0], true, false, true),
        ([3.0, 0.0, 0.0], true, true, false),
        ([9.0, 0.0, 0.0], true, false, false),
        ([3.0, 9.0, 0.0], false, false, false),
    ] {
        assert_eq!(inside(&format!("union() {two}"), p), union, "{p:?}");
        assert_eq!(inside(&format!("intersection() {two}"), p), both, "{p:?}");
        assert_eq!(inside(&format!("difference() {two}"), p), first, "{p:?}");
    }
    // In the crease between the spheres, which is 4 from the axis.
    assert!(!inside(&format!("union() {two}"), [3.0, 4.1, 0.0]));
    assert!(inside(&format!("smooth_union(2) {two}"), [3.0, 4.1, 0.0]));
    assert!(!inside(&format!("smooth_intersection(2) {two}"), [3.0, 3.9, 0.0]));
    assert!(inside(&format!("difference() {two}"), [2.8, 3.9, 0.0]));
    assert!(!inside(&format!("smooth_difference(2) {two}"), [2.8, 3.9, 0.0]));
    assert!(!inside("shell(1) { sphere(5, \"a\"); }", [3.9, 0.0, 0.0]));
    assert!(inside("shell(1) { sphere(5, \"a\"); }", [4.1, 0.0, 0.0]));
}

#[test]
fn expressions_see_the_frame_of_their_fgrade() {
    let grade = "fgrade([\"z/10\", \"1 - z/10\"], [\"a\", \"b\"])";
    let outside = design(&format!("translate(0, 0, 50) {{ {grade} {{ cylinder(5, 10); }} }}"));
    let inside = design(&format!("{grade} {{ translate(0, 0, 50) {{ cylinder(5, 10); }} }}"));
    assert_eq!(outside.bounds, inside.bounds);
    assert_eq!(first_fraction(&outside, [0.0, 0.0, 55.0]), 0.5);
    assert_eq!(first_fraction(&inside, [0.0, 0.0, 55.0]), 1.0);
    let turned = design(&format!(
        "rotate(0, 90, 0) {{ scale(2, 2, 2) {{ {grade} {{ cylinder(5, 10); }} }} }}"
    ));
    assert!((first_fraction(&turned, [5.0, 0.0, 0.0]) - 0.25).abs() < 1e-12);
    // The distance is that of the child, in the same frame.
    let by_depth =
        design("scale(2, 2, 2) { fgrade([\"-d/5\", \"1 + d/5\"], [\"a\", \"b\"]) { sphere(5); } }");
    assert_eq!(first_fraction(&by_depth, [0.0; 3]), 1.0);
    assert!((first_fraction(&by_depth, [5.0, 0.0, 0.0]) - 0.5).abs() < 1e-12);
}

#[test]
fn a_mesh_under_one_fgrade_stays_a_mesh() {
    let grade = "fgrade([\"x/10\", \"1 - x/10\"], [\"a\", \"b\"])";
    let mesh = "mesh(\"cube.stl\", \"ignored\");";
    for (text, fraction, at, volume) in [
        (format!("{grade} {{ {mesh} }}"), 0.5, [5.0, 1.0, 1.0], 1000.0),
        (format!("{grade} {{ translate(5, 0, 0) {{ {mesh} }} }}"), 1.0, [10.0, 1.0, 1.0], 1000.0),
        (format!("translate(5, 0, 0) {{ {grade} {{ {mesh} }} }}"), 0.5, [10.0, 1.0, 1.0], 1000.0),
        (
            format!("scale(-1, 1, 2) {{ root() {{ {grade} {{ {mesh} }} }} }}"),
            0.5,
            [-5.0, 1.0, 1.0],
            2000.0,
        ),
        (format!("{grade} {{ rotate(10, 20, 30) {{ {mesh} }} }}"), 0.2, [2.0, 3.0, 4.0], 1000.0),
    ] {
        let design = design(&text);
        let Geometry::Mesh(mesh) = &design.geometry else { panic!("no mesh: {text}") };
        assert_eq!(mesh.bounds(), design.bounds);
        assert!((mesh.volume() - volume).abs() < 1e-9, "{text}: {}", mesh.volume());
        assert!((first_fraction(&design, at) - fraction).abs() < 1e-12, "{text}");
    }
    // Combined with something it is a distance.
    let holed = design(&format!(
        "{grade} {{ difference() {{ {mesh} translate(5, 5, 5) {{ sphere(2); }} }} }}"
    ));
    assert!(field(&holed).eval(Point3::splat(5.0)) > 1.9);
    assert!((field(&holed).eval(Point3::new(5.0, 5.0, 9.0)) + 1.0).abs() < 1e-9);
    near(&holed.bounds, [0.0; 3], [10.0; 3], "with a hole");
}

#[test]
fn every_point_has_its_parts_material() {
    let parts = design(
        "union() { cube(2, \"red\"); translate(5, 0, 0) { sphere(1, \"blue\"); cube(0.5, \"red\"); } }",
    );
    let names: Vec<_> = parts.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["red", "blue"]);
    assert_eq!(pure(&parts, [0.0, 0.0, 0.0]), "red");
    assert_eq!(pure(&parts, [5.8, 0.0, 0.0]), "blue");
    assert_eq!(pure(&parts, [2.2, 0.0, 0.0]), "red", "outside: the nearest");
    let cut = design("difference() { cube(4, \"red\"); sphere(1, \"blue\"); }");
    assert_eq!(pure(&cut, [1.0, 0.0, 0.0]), "red");

    // Of nested fgrades the inner one counts, where it is; names of shapes do not.
    let nested = design(
        "fgrade([\"1\", \"0\"], [\"outer\", \"other\"]) {
           cube(2, \"ignored\");
           translate(5, 0, 0) { fgrade([\"x\", \"-x\"], [\"right\", \"left\"], \"thresh\") { cube(2); } }
         }",
    );
    let names: Vec<_> = nested.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["outer", "other", "right", "left"]);
    assert_eq!(pure(&nested, [0.0, 0.0, 0.0]), "outer");
    assert_eq!(pure(&nested, [4.5, 0.0, 0.0]), "left");
    assert_eq!(pure(&nested, [5.5, 0.0, 0.0]), "right");
    // Not even the weight of a material that is not in an fgrade's list wins it.
    let below = design(
        "union() { cube(1, \"c\"); translate(9, 0, 0) {
           fgrade([\"-1\", \"-2\"], [\"a\", \"b\"], \"thresh\") { cube(2); } } }",
    );
    assert_eq!(pure(&below, [9.0, 0.0, 0.0]), "a");
}

#[test]
fn void_cuts_away() {
    let holed = design("union() { cube(4, \"a\"); sphere(1, \"void\"); cube(1, \"b\"); }");
    assert!(field(&holed).eval(Point3::ZERO) > 0.0, "in any order");
    assert_eq!(holed.materials.len(), 2);
    let halves = design(
        "fgrade([\"1\", \"2 - x\", \"x\"], [\"a\", \"b\", \"void\"], \"thresh\") { cube(4); }",
    );
    near(&halves.bounds, [-2.0; 3], [1.0, 2.0, 2.0], "the rest is void");
    assert_eq!(pure(&halves, [0.0, 0.0, 0.0]), "b");
}

#[test]
fn blends_are_averages() {
    let step = "fgrade([\"x > 0\", \"x <= 0\"], [\"a\", \"b\"]) { cube(20); }";
    let of = |text: &str, x: f64| first_fraction(&design(text), [x, 0.0, 0.0]);
    assert_eq!(of(step, 0.1), 1.0);
    // Four points, at -1.5, -0.5, 0.5 and 1.5 mm.
    let blend = format!("blend(4, 1, 1) {{ {step} }}");
    assert_eq!([-1.6, -1.4, 0.4, 1.4, 1.6].map(|x| of(&blend, x)), [0.0, 0.25, 0.5, 0.75, 1.0]);
    // The voxel of the root around is the unit.
    let fine = format!("root((-30,-30,-30), (30,30,30), (0.5, 1, 1)) {{ {blend} }}");
    assert_eq!([-0.8, -0.7, 0.1].map(|x| of(&fine, x)), [0.0, 0.25, 0.5]);
    // Weights along x; a move outside moves the average too.
    let kernel = format!("translate(10, 0, 0) {{ convolve([[[3, 0, 1]]]) {{ {step} }} }}");
    assert_eq!([8.9, 9.5, 10.5, 11.5].map(|x| of(&kernel, x)), [0.0, 0.25, 0.25, 1.0]);
    // Inside an fgrade the average is of what the shapes get from it.
    let inner = "fgrade([\"x > 0\", \"x <= 0\"], [\"a\", \"b\"]) { blend(2, 1, 1) { cube(20); } }";
    assert_eq!([-0.6, 0.0, 0.6].map(|x| of(inner, x)), [0.0, 0.5, 1.0]);
}

#[test]
fn options_scale_and_grade() {
    let fractions = |texts: &[&str]| LoadOptions {
        fractions: texts.iter().map(|t| (*t).to_string()).collect(),
        size: Some(DVec3::new(50.0, 20.0, 30.0)),
        ..LoadOptions::default()
    };
    let cube = folder().join("cube.stl");
    let one = load(&cube, &fractions(&["x/20"])).unwrap();
    assert!(one.warnings.is_empty(), "{:?}", one.warnings);
    near(&one.design.bounds, [0.0; 3], [20.0; 3], "the most that fits");
    let names: Vec<_> = one.design.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!((one.design.name.as_str(), names), ("cube", vec!["A", "B"]));
    assert_eq!(first_fraction(&one.design, [10.0, 0.0, 0.0]), 0.5, "scaled coordinates");
    assert_eq!(first_fraction(&one.design, [90.0, 0.0, 0.0]), 1.0);

    let mut options = fractions(&["x/20", "y/20"]);
    let two = load(&cube, &options).unwrap().design;
    assert_eq!(first_fraction(&two, [5.0, 15.0, 0.0]), 0.25);
    options.names = ["p", "q", "rest"].map(String::from).into();
    let three = load(&cube, &options).unwrap().design;
    let mixture = three.fractions.mixture(Point3::new(5.0, 10.0, 0.0)).unwrap();
    assert_eq!(mixture.fractions(), [0.25, 0.5, 0.25]);
    assert_eq!(three.materials[2].name, "rest");

    // A design's own material is scaled with it.
    let text = "fgrade([\"z/10\", \"1 - z/10\"], [\"a\", \"b\"]) { cylinder(2, 10); }";
    let size = Some(DVec3::splat(20.0));
    let scaled = loaded(text, &LoadOptions { size, ..LoadOptions::default() }).design;
    near(&scaled.bounds, [-4.0, -4.0, 0.0], [4.0, 4.0, 20.0], "scaled");
    assert_eq!(first_fraction(&scaled, [0.0, 0.0, 5.0]), 0.25);
    // A design without materials gets the options'.
    let bare = loaded("cube(4);", &fractions(&["d < -1"])).design;
    near(&bare.bounds, [-10.0; 3], [10.0; 3], "bare");
    assert_eq!(first_fraction(&bare, [0.0; 3]), 1.0);
    assert_eq!(first_fraction(&bare, [9.9, 0.0, 0.0]), 0.0);

    let told = load(&cube, &LoadOptions::default()).unwrap_err().to_string();
    assert!(
        told.ends_with(
            "a mesh has no materials of its own: give their volume fractions with --fraction"
        ),
        "{told}"
    );
}

#[test]
fn palettes_and_warnings() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("palettes");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let file = folder.join("part.vcad");
    fs::write(
        &file,
        "fgrade([\"1\", \"2\", \"9\"], [\"steel\", \"blue\", \"steel\"]) { cube(2); }",
    )
    .unwrap();
    let told = |loaded: &Loaded| -> Vec<String> {
        let folder = format!("{}/", folder.display());
        loaded.warnings.iter().map(|w| w.to_string().replace(&folder, "")).collect()
    };
    let duplicate = "part.vcad:1:44: material `steel` is named twice; the first counts";

    let none = load(&file, &LoadOptions::default()).unwrap();
    assert_eq!(told(&none), [duplicate]);
    assert_eq!(none.design.materials[0].color, None);
    assert!((first_fraction(&none.design, [0.0; 3]) - 1.0 / 3.0).abs() < 1e-15);

    let entry =
        |name: &str, r: u8| format!("{{\"name\":\"{name}\",\"r\":{r},\"g\":2,\"b\":3,\"a\":255}}");
    let palette = |entries: &[String]| format!("{{\"materials\": [{}]}}", entries.join(", "));
    fs::write(folder.join("palette.json"), palette(&[entry("steel", 1), entry("blue", 1)]))
        .unwrap();
    fs::write(folder.join("materials.json"), palette(&[entry("steel", 2)])).unwrap();
    // A report of the same name is no palette.
    fs::write(folder.join("part.json"), "{\"layers\": 10}").unwrap();
    let found = load(&file, &LoadOptions::default()).unwrap();
    assert_eq!(found.design.materials[0].color, Some([2, 2, 3]));
    assert_eq!(told(&found), [duplicate, "materials.json: no colour for material `blue`"]);

    fs::write(folder.join("part.json"), "{\"materials\": oops}").unwrap();
    let broken = load(&file, &LoadOptions::default()).unwrap();
    assert_eq!(broken.design.materials[0].color, Some([2, 2, 3]));
    assert_eq!(
        told(&broken)[1],
        "part.json: expected value at line 1 column 15; its colours are not used"
    );

    let alone = loaded("cube(1, \"steel\");", &LoadOptions::default());
    assert_eq!(alone.warnings[0].to_string(), "the design has one material only, `steel`");
    assert_eq!(alone.design.fractions.materials(), 2);
    assert_eq!(pure(&alone.design, [0.0; 3]), "steel");

    let open = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
    let turned = open.replace("f 1 3 2\nf 1 2 4\nf 1 4 3", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3");
    for (text, expected) in [
        (open.to_string(), "open.obj: the mesh is not closed: 3 edge(s) without a partner"),
        (turned, "open.obj: the mesh was inside out; turned"),
    ] {
        fs::write(folder.join("open.obj"), text).unwrap();
        let options = LoadOptions { fractions: vec!["x".into()], ..LoadOptions::default() };
        let open = load(&folder.join("open.obj"), &options).unwrap();
        assert_eq!(told(&open)[0], expected);
        let Geometry::Mesh(mesh) = &open.design.geometry else { panic!("no mesh") };
        assert!(mesh.volume() > 0.0);
    }
}

#[test]
fn densities() {
    let at = |design: &Design, p: [f64; 3]| {
        let density = design.density.as_ref().unwrap();
        let value = density.eval(Point3::from(p));
        let mut many = [0.0];
        density.at_z(p[2]).eval_into(&[fgm_core::Point2::new(p[0], p[1])], &mut many);
        assert_eq!(value, many[0]);
        let bounds = density.bounds(&Bounds3::of([Point3::from(p)]));
        assert!(bounds.lo <= value && value <= bounds.hi);
        value
    };
    assert!(design("cube(4, \"a\");").density.is_none());
    // Moves outside of the node move the density with the shape, moves inside do not.
    let outside = design("translate(10, 0, 0) { density(\"x/10 + 0.5\") { cube(4, \"a\"); } }");
    assert_eq!(at(&outside, [11.0, 0.0, 0.0]), 0.6);
    let inside = design("density(\"x/20\") { translate(10, 0, 0) { cube(4, \"a\"); } }");
    assert_eq!(at(&inside, [11.0, 0.0, 0.0]), 0.55);
    // The distance is that of what it holds, under a scale as well.
    let scaled = design("scale(2, 2, 2) { density(\"d + 2\") { cube(4, \"a\"); } }");
    assert_eq!(at(&scaled, [0.0, 0.0, 3.0]), 1.5);
    // The inner one counts where it is; what has none has the usual one.
    let text = "union() {
        density(\"0.5\") {
            cube(4, \"a\");
            translate(10, 0, 0) { density(\"0.7\") { cube(4, \"b\"); } }
        }
        translate(20, 0, 0) { cube(4, \"a\"); }
    }";
    let several = design(text);
    for (x, density) in [(0.0, 0.5), (10.0, 0.7), (20.0, fgm_field::USUAL_DENSITY)] {
        assert_eq!(at(&several, [x, 0.0, 0.0]), density);
    }
    // A difference and an intersection have that of their first child.
    let text = "difference() { density(\"0.3\") { cube(4, \"a\"); } density(\"0.9\") { sphere(1, \"a\"); } }";
    assert_eq!(at(&design(text), [1.5, 0.0, 0.0]), 0.3);
}
