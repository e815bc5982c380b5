/// The kinds of node there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NodeKind {
    // Combining.
    Root,
    Union,
    Intersection,
    Difference,
    SmoothUnion,
    SmoothIntersection,
    SmoothDifference,
    // Of one child.
    Translate,
    Scale,
    Rotate,
    Offset,
    Shell,
    Fgrade,
    Blend,
    Convolve,
    Density,
    // Leaves.
    Sphere,
    Cube,
    Rectprism,
    Cylinder,
    Cone,
    Torus,
    Capsule,
    Extrude,
    Gyroid,
    Mesh,
    Function,
}

/// A row: the name, the kind, and the arguments as they are told to a person.
struct Row(&'static str, NodeKind, &'static str);

/// Every node. Where a kind has two names the first is the usual one.
const NODES: [Row; 28] = [
    Row("root", NodeKind::Root, "((min), (max), (voxel)) or nothing"),
    Row("union", NodeKind::Union, "no arguments"),
    Row("intersection", NodeKind::Intersection, "no arguments"),
    Row("difference", NodeKind::Difference, "no arguments"),
    Row("smooth_union", NodeKind::SmoothUnion, "(radius)"),
    Row("smooth_intersection", NodeKind::SmoothIntersection, "(radius)"),
    Row("smooth_difference", NodeKind::SmoothDifference, "(radius)"),
    Row("translate", NodeKind::Translate, "(x, y, z)"),
    Row("scale", NodeKind::Scale, "(x, y, z)"),
    Row("rotate", NodeKind::Rotate, "(pitch, yaw, roll)"),
    Row("offset", NodeKind::Offset, "(distance)"),
    Row("shell", NodeKind::Shell, "(thickness)"),
    Row(
        "fgrade",
        NodeKind::Fgrade,
        "([\"expression\", ...], [\"material\", ...], \"prob\" or \"thresh\")",
    ),
    Row(
        "f_grade",
        NodeKind::Fgrade,
        "([\"expression\", ...], [\"material\", ...], \"prob\" or \"thresh\")",
    ),
    Row("blend", NodeKind::Blend, "(nx, ny, nz)"),
    Row("convolve", NodeKind::Convolve, "([[[...]]])"),
    Row("density", NodeKind::Density, "(\"expression\")"),
    Row("sphere", NodeKind::Sphere, "(radius) or (radius, \"material\")"),
    Row("cube", NodeKind::Cube, "(side) or (side, \"material\")"),
    Row("rectprism", NodeKind::Rectprism, "(x, y, z) or ((x, y, z)), then \"material\" or nothing"),
    Row("cylinder", NodeKind::Cylinder, "(radius, height) or (radius, height, \"material\")"),
    Row(
        "cone",
        NodeKind::Cone,
        "(radius, height) or (radius, top radius, height), then \"material\" or nothing",
    ),
    Row("torus", NodeKind::Torus, "(ring radius, tube radius) or the same and \"material\""),
    Row("capsule", NodeKind::Capsule, "(radius, height) or (radius, height, \"material\")"),
    Row("extrude", NodeKind::Extrude, "(height, [(x, y), ...]) or the same and \"material\""),
    Row("gyroid", NodeKind::Gyroid, "((x, y, z), cell, thickness) or the same and \"material\""),
    Row("mesh", NodeKind::Mesh, "(\"file\") or (\"file\", \"material\")"),
    Row(
        "function",
        NodeKind::Function,
        "(\"expression\") or ((min), (max), \"expression\"), then \"material\" or nothing",
    ),
];

impl NodeKind {
    /// The kind of this name; names are in lower case.
    pub(crate) fn by_name(name: &str) -> Option<Self> {
        NODES.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// The arguments it takes, as told to a person.
    pub(crate) fn usage(self) -> &'static str {
        NODES.iter().find(|row| row.1 == self).map_or("", |row| row.2)
    }

    /// Whether it stands alone, without children.
    pub(crate) fn is_leaf(self) -> bool {
        matches!(
            self,
            Self::Sphere
                | Self::Cube
                | Self::Rectprism
                | Self::Cylinder
                | Self::Cone
                | Self::Torus
                | Self::Capsule
                | Self::Extrude
                | Self::Gyroid
                | Self::Mesh
                | Self::Function
        )
    }

    /// The name most like `name`, where one is alike at all.
    pub(crate) fn nearest(name: &str) -> Option<&'static str> {
        let lower: String = name.chars().take(40).collect::<String>().to_ascii_lowercase();
        let allowed = (lower.len() / 3).max(1);
        NODES
            .iter()
            .map(|row| (edits(&lower, row.0), row.0))
            .filter(|(distance, _)| *distance <= allowed)
            .min_by_key(|(distance, _)| *distance)
            .map(|(_, name)| name)
    }
}

/// How many letters must be put in, left out, changed or swapped with a neighbour to make one word
/// the other (optimal string alignment).
fn edits(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = [vec![0; b.len() + 1], (0..=b.len()).collect(), vec![0; b.len() + 1]];
    for i in 1..=a.len() {
        rows[2][0] = i;
        for j in 1..=b.len() {
            let change = rows[1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = change.min(rows[1][j] + 1).min(rows[2][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[0][j - 2] + 1);
            }
            rows[2][j] = least;
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_the_one_meant() {
        for (name, nearest) in [
            ("cilinder", Some("cylinder")),
            ("Cube", Some("cube")),
            ("uinon", Some("union")),
            ("rectprizm", Some("rectprism")),
            ("f-grade", Some("fgrade")),
            ("banana", None),
            ("x", None),
        ] {
            assert_eq!(NodeKind::nearest(name), nearest, "{name}");
        }
        assert_eq!((edits("", "abc"), edits("ab", "ba"), edits("kitten", "sitting")), (3, 1, 3));
    }

    #[test]
    fn every_row_is_found_by_its_name() {
        for Row(name, kind, usage) in &NODES {
            assert_eq!(NodeKind::by_name(name), Some(*kind));
            assert_eq!(kind.usage(), *usage);
        }
    }
}
