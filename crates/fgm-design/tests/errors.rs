//! Every kind of wrong .vcad text, with the place it is told at.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::path::Path;

use fgm_design::{LoadOptions, load, parse_vcad};

/// The error of a text, without the name of the file.
fn error_of(text: &str) -> String {
    match parse_vcad(text, Path::new("."), &LoadOptions::default()) {
        Ok(loaded) => panic!("{text:?} is {loaded:?}"),
        Err(error) => {
            let told = error.to_string();
            let at = error.location().unwrap();
            assert_eq!(error.source_text(), Some(text));
            assert!(text.get(at.span.clone()).is_some(), "{told}: {:?}", at.span);
            let place = format!("<vcad>:{}:{}: ", at.line, at.column);
            assert!(told.starts_with(&place), "{told}");
            told["<vcad>:".len()..].to_string()
        }
    }
}

fn check(table: &[(&str, &str)]) {
    for (text, expected) in table {
        assert_eq!(error_of(text), *expected, "for {text:?}");
    }
}

#[test]
fn words_and_marks() {
    check(&[
        ("", "1:1: the file holds no node"),
        ("// only a comment\n", "1:1: the file holds no node"),
        ("sphere(1, \"a\") @", "1:16: unexpected character `@`"),
        ("union() {\n  sphere(1, \"a);\n}", "2:13: this string has no closing `\"`"),
        ("/* never\nends", "1:1: this comment has no closing `*/`"),
        ("union() {\n  sphere(1, \"a\");\n", "1:9: this `{` is never closed"),
        ("union() {\n  union() {\n  }\n", "1:9: this `{` is never closed"),
        ("sphere(1, \"a\"", "1:7: this `(` is never closed"),
        ("fgrade([\"x\", \"y\"", "1:8: this `[` is never closed"),
        (
            "sphere((1 + 2, \"a\");",
            "1:16: expected a number, a string, a vector or a list, found a string",
        ),
        ("sphere(1, \"a\"); }", "1:17: expected a node, found `}`"),
        ("union() { ] }", "1:11: expected a node or `}`, found `]`"),
        ("sphere 1;", "1:8: expected `(`, found `1`"),
        ("sphere(1, \"a\")\ncube(1);", "2:1: expected `;`, found `cube`"),
        ("union() sphere(1);", "1:9: expected `{`, found `sphere`"),
        ("union();", "1:8: expected `{`, found `;`"),
        ("sphere(1, \"a\") { cube(1); }", "1:1: `sphere` takes no children; end it with `;`"),
        ("sphere(1 \"a\");", "1:10: expected `,` or `)`, found a string"),
        (
            "rectprism((1, 2, ), \"a\");",
            "1:18: expected a number, a string, a vector or a list, found `)`",
        ),
    ]);
}

#[test]
fn nodes_and_arguments() {
    check(&[
        ("cilinder(1, 2);", "1:1: unknown node `cilinder`; did you mean `cylinder`?"),
        ("union() {\n  banana(1);\n}", "2:3: unknown node `banana`"),
        ("Sphere(1);", "1:1: unknown node `Sphere`; did you mean `sphere`?"),
        (
            "cylinder(1, \"a\");",
            "1:9: `cylinder` takes (radius, height) or (radius, height, \"material\"); \
             given: number, string",
        ),
        (
            "translate(1, 2) { cube(1, \"a\"); }",
            "1:10: `translate` takes (x, y, z); given: number, number",
        ),
        ("union(3) { cube(1, \"a\"); }", "1:6: `union` takes no arguments; given: number"),
        (
            "rectprism((1, 2), \"a\");",
            "1:10: `rectprism` takes (x, y, z) or ((x, y, z)), then \"material\" or nothing; \
             given: vector of 2, string",
        ),
        ("sphere(-1, \"a\");", "1:8: this is -1; it must be above 0"),
        ("cube(0, \"a\");", "1:6: this is 0; it must be above 0"),
        ("rectprism((1, 0, 3), \"a\");", "1:11: this is 0; it must be above 0"),
        ("cube(1);", "1:1: `cube` has no material: name one, or put it inside an fgrade"),
        ("union() {}", "1:1: `union` needs children, here 0"),
        ("root((0,0,0), (1,1,1), (1,1,1)) {}", "1:1: `root` needs children, here 0"),
        (
            "root((0,0,0), (0,1,1)) { cube(1, \"a\"); }",
            "1:6: every coordinate of the first corner must be below that of the second",
        ),
        (
            "scale(1, 0, 1) { cube(1, \"a\"); }",
            "1:6: the transform cannot be undone: its determinant is 0",
        ),
        ("extrude(2, [(0, 0), (1, 1), (2, 2, 2)], \"a\");", "1:29: a corner is a vector (x, y)"),
        (
            "extrude(2, [(0, 0), (1, 0), (2, 0)], \"a\");",
            "1:12: a polygon needs three corners or more that are not on a line",
        ),
        (
            "blend(2, 1.5, 1) { cube(1, \"a\"); }",
            "1:10: this is 1.5; it must be a whole number from 1 to 1000000",
        ),
        (
            "blend(1000, 1000, 1000) { cube(1, \"a\"); }",
            "1:6: a kernel of 1000000000 samples, where 1 to 32768 are possible",
        ),
        ("density(3) { cube(1, \"a\"); }", "1:8: `density` takes (\"expression\"); given: number"),
        (
            "convolve([[[1, 2], [3]]]) { cube(1, \"a\"); }",
            "1:10: a kernel is [[[...]]]: rows of equal length, in planes of equal size",
        ),
        (
            "convolve([[]]) { cube(1, \"a\"); }",
            "1:10: a kernel is [[[...]]]: rows of equal length, in planes of equal size",
        ),
        (
            "convolve([[[1, -2]]]) { cube(1, \"a\"); }",
            "1:9: kernel weight -2 at sample 1; weights are finite, not negative, and not all 0",
        ),
    ]);
}

#[test]
fn expressions_and_materials() {
    let graded = |exprs: &str| format!("fgrade({exprs}, [\"a\", \"b\"]) {{\n  cube(1);\n}}");
    for (exprs, expected) in [
        ("[\"x\", \"1 - w\"]", "1:19: unknown variable `w`"),
        ("[\"x\",\n\"1 +\n  sine(y)\"]", "3:3: unknown function `sine`; did you mean `sin`?"),
        ("[\"x\", \"1 +\"]", "1:18: the expression ends here; expected a number"),
        ("[\"x/0\", \"1\"]", "1:10: division by zero"),
        ("[\"x\"]", "1:8: 1 expression(s) for 2 material(s)"),
        (
            "[\"x\", 3]",
            "1:7: `fgrade` takes ([\"expression\", ...], [\"material\", ...], \"prob\" or \"thresh\"); given: list, list",
        ),
    ] {
        let told = error_of(&graded(exprs));
        assert!(told.starts_with(expected), "{told} for {exprs}");
    }
    check(&[
        ("fgrade([], []) { cube(1); }", "1:8: this list is empty"),
        (
            "fgrade([\"x\", \"y\"], [\"a\", \"b\"], \"half\") { cube(1); }",
            "1:32: unknown mode `half`; it is \"prob\" or \"thresh\"",
        ),
        (
            "fgrade([\"x\", \"y\"], [\"a\", \"void\"]) { cube(1); }",
            "1:26: `void` is empty space and cannot be mixed in; with \"thresh\" it cuts away",
        ),
        ("let x = 3; cube(x, \"a\");", "1:5: `x` already has a meaning in expressions"),
        ("let sin = 3; cube(1, \"a\");", "1:5: `sin` already has a meaning in expressions"),
        ("let side 3; cube(1, \"a\");", "1:10: expected `=`, found `3`"),
        ("let side = \"3\"; cube(1, \"a\");", "1:12: expected a number, found a string"),
        ("cube(2x, \"a\");", "1:6: this must be a number, not something that varies in space"),
        ("cube(side, \"a\");", "1:6: unknown variable `side`"),
        (
            "union() { let side = 2; cube(side, \"a\"); }\ncube(side, \"a\");",
            "2:6: unknown variable `side`",
        ),
        (
            "union() { cube(1,\"a\"); cube(1,\"b\"); cube(1,\"c\"); cube(1,\"d\"); cube(1,\"e\");\n\
             cube(1,\"f\"); cube(1,\"g\"); cube(1,\"h\"); cube(1,\"i\"); }",
            "2:48: material `i` is one more than the 8 that a design may have",
        ),
    ]);
}

#[test]
fn functions_meshes_and_emptiness() {
    check(&[
        (
            "function(\"x - 3\", \"a\");",
            "1:10: the inside of this function has no end within 2048 mm; give its box: \
             function((min), (max), \"...\")",
        ),
        ("function(\"x^2 + y^2 + z^2 + 1\", \"a\");", "1:10: this shape is empty"),
        ("function((0,0,0), (1,1,1), \"x + 5\", \"a\");", "1:1: this shape is empty"),
        (
            "function(\"d - 1\", \"a\");",
            "1:11: `d` is the distance of what an fgrade holds; a function holds nothing",
        ),
        ("function(\"1/0\", \"a\");", "1:11: division by zero"),
        (
            "intersection() {\n  sphere(1, \"a\");\n  translate(5, 0, 0) { sphere(1, \"a\"); }\n}",
            "1:1: this shape is empty",
        ),
        ("difference() { sphere(1, \"a\"); cube(3, \"a\"); }", "1:1: this shape is empty"),
        ("cube(1e7, \"a\");", "1:1: this reaches further than 1000000 mm from the origin"),
        (
            "extrude(2, [(0, 0), (4, 1e308), (2, 3)], \"c\");",
            "1:1: this reaches further than 1000000 mm from the origin",
        ),
        (
            "scale(1e150, 1, 1) { scale(1e150, 1, 1) { scale(1e150, 1, 1) { cube(1, \"c\"); } } }",
            "1:1: this reaches further than 1000000 mm from the origin",
        ),
        ("sphere(1, \"void\");", "1:1: this shape is empty"),
        ("offset(-2) { sphere(1, \"a\"); }", "1:1: this shape is empty"),
    ]);
    let told = error_of("fgrade([\"x\", \"1\"], [\"a\", \"b\"]) {\n  mesh(\"nowhere.stl\");\n}");
    let missing = "2:8: cannot read ./nowhere.stl: No such file";
    assert!(told.starts_with(missing), "{told}");
    let told = error_of("mesh(\"errors.rs\", \"a\");");
    assert_eq!(told, "1:6: ./errors.rs: designs end in .vcad, .stl, .obj or .3mf, not in `rs`");
}

#[test]
fn limits_are_named() {
    let deep = "union() { ".repeat(101) + "cube(1, \"a\");";
    assert_eq!(error_of(&deep), "1:1001: nodes nested more than 100 deep");
    let least = "translate(1, 0, 0) { ".repeat(99) + "cube(1, \"a\");" + &"}".repeat(99);
    let least = parse_vcad(&least, Path::new("."), &LoadOptions::default()).unwrap().design;
    assert_eq!(least.bounds.center().x, 99.0);
    let many = "union() { ".to_string() + &"cube(1, \"a\");\n".repeat(100_000) + "}";
    assert_eq!(error_of(&many), "100000:1: more than 100000 nodes");
    let names = "let n = 1;\n".repeat(1001);
    assert_eq!(error_of(&names), "1001:5: more than 1000 names");
    let lists = "convolve(".to_string() + &"[".repeat(1000);
    assert_eq!(error_of(&lists), "1:218: nodes nested more than 100 deep");
    let brackets = "cube(".to_string() + &"(".repeat(1000) + "1" + &")".repeat(1000) + ");";
    assert!(error_of(&brackets).contains("nested deeper than"), "{}", error_of(&brackets));
}

#[test]
fn options_are_checked_too() {
    let cube = "cube(1);";
    let told =
        |options: &LoadOptions| parse_vcad(cube, Path::new("."), options).map(|_| ()).unwrap_err();
    let fractions = |texts: &[&str], names: &[&str]| LoadOptions {
        fractions: texts.iter().map(|t| (*t).to_string()).collect(),
        names: names.iter().map(|t| (*t).to_string()).collect(),
        ..LoadOptions::default()
    };
    let error = told(&fractions(&["z/10 + wobble"], &[]));
    assert_eq!(error.to_string(), "--fraction:1:8: unknown variable `wobble`");
    assert_eq!(error.source_text(), Some("z/10 + wobble"));
    for (texts, names, expected) in [
        (&["x"; 9][..], &[][..], "--fraction: 9 expression(s) for 9 material(s)"),
        (&["x"], &["a", "b", "c"], "--fraction: 1 expression(s) for 3 material(s)"),
        (&["x", "y"], &["a", "a"], "--fraction: material `a` is named twice"),
        (&["x"], &["a"], "--fraction: 1 expression(s) for 1 material(s)"),
    ] {
        assert_eq!(told(&fractions(texts, names)).to_string(), expected);
    }
    let size =
        LoadOptions { size: Some(glam::DVec3::new(1.0, 0.0, 1.0)), ..fractions(&["x"], &[]) };
    assert_eq!(told(&size).to_string(), "--size: this is 0; it must be above 0");
}

#[test]
fn files_that_are_not_there_or_unknown() {
    for (name, expected) in [
        ("nowhere.vcad", "cannot read nowhere.vcad: No such file"),
        ("nowhere.stl", "cannot read nowhere.stl: No such file"),
        ("part.step", "part.step: designs end in .vcad, .stl, .obj or .3mf, not in `step`"),
        ("part", "part: designs end in .vcad, .stl, .obj or .3mf, not in ``"),
    ] {
        let error = load(Path::new(name), &LoadOptions::default()).unwrap_err();
        assert!(error.to_string().starts_with(expected), "{error}");
        assert!(error.location().is_none());
    }
}
