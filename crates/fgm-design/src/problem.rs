use fgm_field::{ExprErrorKind, FieldError};

use crate::DesignError;

/// The most bytes of a `.vcad` file or a palette.
pub const MAX_TEXT_BYTES: u64 = 16 << 20;
/// The most bytes of a mesh file, and of the XML inside a 3MF.
pub const MAX_MESH_BYTES: u64 = 2 << 30;
/// The most triangles of a mesh.
pub const MAX_TRIANGLES: usize = 20_000_000;
/// The most nodes of a `.vcad` design, numbers by name included.
pub const MAX_NODES: usize = 100_000;
/// How far from the origin a design may reach, mm.
pub const MAX_REACH: f64 = 1e6;
/// The most numbers by name that are known at a place.
pub const MAX_NAMES: usize = 1000;
/// How deep nodes may be nested.
pub const MAX_DEPTH: usize = 100;

/// What is wrong in a file, without the place.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    // Words and marks of a .vcad file.
    /// A character that stands for nothing.
    #[error("unexpected character `{}`", found.escape_default())]
    UnexpectedCharacter {
        /// Which.
        found: char,
    },
    /// Bytes that are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// A string has no closing quote.
    #[error("this string has no closing `\"`")]
    UnterminatedString,
    /// A comment has no end.
    #[error("this comment has no closing `*/`")]
    UnterminatedComment,
    /// An opening bracket has no partner.
    #[error("this `{open}` is never closed")]
    Unclosed {
        /// Which bracket.
        open: char,
    },
    /// Something else was wanted.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// What is there.
        found: String,
        /// What was wanted.
        expected: &'static str,
    },

    // Nodes.
    /// No node has this name.
    #[error("unknown node `{name}`{}", suggest(.suggestion.as_deref()))]
    UnknownNode {
        /// As written.
        name: String,
        /// The nearest that exists.
        suggestion: Option<String>,
    },
    /// The arguments are not those of the node.
    #[error("`{node}` takes {expected}; given: {given}")]
    Arguments {
        /// Which node.
        node: String,
        /// The forms there are.
        expected: &'static str,
        /// The kinds given.
        given: String,
    },
    /// A size that is not above zero.
    #[error("this is {value}; it must be above 0")]
    NotPositive {
        /// What it is.
        value: f64,
    },
    /// A count that is not a whole number.
    #[error("this is {value}; it must be a whole number from 1 to 1000000")]
    NotWhole {
        /// What it is.
        value: f64,
    },
    /// A box whose corners are not in order.
    #[error("every coordinate of the first corner must be below that of the second")]
    BoxOrder,
    /// A node that stands alone has children.
    #[error("`{node}` takes no children; end it with `;`")]
    ChildrenUnwanted {
        /// Which node.
        node: String,
    },
    /// A node with the wrong number of children.
    #[error("`{node}` needs {wanted}, here {count}")]
    Children {
        /// Which node.
        node: String,
        /// What is wanted.
        wanted: &'static str,
        /// How many there are.
        count: usize,
    },
    /// `let` of a name that has a meaning already.
    #[error("`{name}` already has a meaning in expressions")]
    ReservedName {
        /// Which.
        name: String,
    },
    /// A file needs one node at its top.
    #[error("the file holds no node")]
    NoNode,
    /// Too many nodes.
    #[error("more than {MAX_NODES} nodes")]
    TooManyNodes,
    /// Too many numbers by name.
    #[error("more than {MAX_NAMES} names")]
    TooManyNames,
    /// Nodes nested too deep.
    #[error("nodes nested more than {MAX_DEPTH} deep")]
    TooDeep,

    // Expressions and materials.
    /// An expression that cannot be read.
    #[error("{kind}")]
    Expression {
        /// Why.
        #[source]
        kind: ExprErrorKind,
    },
    /// A number that depends on the place, or is none.
    #[error("this must be a number, not something that varies in space")]
    NotConstant,
    /// As many expressions as materials are needed.
    #[error("{expressions} expression(s) for {materials} material(s)")]
    FractionCount {
        /// How many expressions.
        expressions: usize,
        /// How many materials.
        materials: usize,
    },
    /// Neither `prob` nor `thresh`.
    #[error("unknown mode `{mode}`; it is \"prob\" or \"thresh\"")]
    UnknownMode {
        /// As written.
        mode: String,
    },
    /// A leaf without a material.
    #[error("`{node}` has no material: name one, or put it inside an fgrade")]
    NoMaterial {
        /// Which node.
        node: String,
    },
    /// `d` where there is no child whose distance it could be.
    #[error("`d` is the distance of what an fgrade holds; a function holds nothing")]
    NoDistance,
    /// One name for two materials.
    #[error("material `{name}` is named twice")]
    RepeatedName {
        /// Which.
        name: String,
    },
    /// One expression fewer than materials, in a design that has materials of its own.
    #[error("the design has materials of its own: give one expression for each name")]
    RestAmongOthers,
    /// A mesh without volume fractions.
    #[error("a mesh has no materials of its own: give their volume fractions with --fraction")]
    NoFractions,
    /// More materials than a mixture holds.
    #[error(
        "material `{name}` is one more than the {} that a design may have",
        fgm_core::MAX_MATERIALS
    )]
    TooManyMaterials {
        /// The first that is too many.
        name: String,
    },
    /// `void` as a part of a mixture.
    #[error("`void` is empty space and cannot be mixed in; with \"thresh\" it cuts away")]
    VoidMixed,
    /// A list with nothing in it.
    #[error("this list is empty")]
    EmptyList,
    /// Rows of a kernel differ in length.
    #[error("a kernel is [[[...]]]: rows of equal length, in planes of equal size")]
    KernelShape,
    /// A kernel that is too large or does not sum to a positive number.
    #[error("{error}")]
    Field {
        /// Why.
        #[source]
        error: FieldError,
    },

    // Shapes.
    /// A mesh that a design names.
    #[error("{error}")]
    Mesh {
        /// Why it was not read.
        #[source]
        error: Box<DesignError>,
    },
    /// A function whose inside has no end.
    #[error(
        "the inside of this function has no end within {limit} mm; give its box: function((min), (max), \"...\")"
    )]
    Unbounded {
        /// How far was searched, mm.
        limit: f64,
    },
    /// A shape further away, or larger, than can be told from a mistake.
    #[error("this reaches further than {MAX_REACH} mm from the origin")]
    TooFar,
    /// A shape with nothing inside.
    #[error("this shape is empty")]
    EmptyShape,
    /// A corner of a polygon that is not one.
    #[error("a corner is a vector (x, y)")]
    OutlinePoint,
    /// A polygon without area.
    #[error("a polygon needs three corners or more that are not on a line")]
    Outline,

    // Mesh files.
    /// A file ends before its triangles do.
    #[error("the file ends early: {found} of {expected} triangles")]
    Truncated {
        /// How many it announces.
        expected: u64,
        /// How many are whole.
        found: u64,
    },
    /// A coordinate is NaN, infinite or far beyond any printer.
    #[error("triangle {triangle} (from 1) has a coordinate that is not a finite number")]
    NotFinite {
        /// Which, from 1.
        triangle: usize,
    },
    /// No triangle.
    #[error("the mesh has no triangles")]
    NoTriangles,
    /// Too many triangles.
    #[error("more than {MAX_TRIANGLES} triangles")]
    TooManyTriangles,
    /// Neither kind of STL.
    #[error("not an STL file: neither 84 bytes of a binary one nor the word `solid`")]
    NotStl,
    /// A line that the OBJ format does not know so.
    #[error("{error}")]
    Obj {
        /// Why.
        #[source]
        error: tobj::LoadError,
    },
    /// A face of vertices that are not there.
    #[error("a face uses vertex {index}; there are {count}")]
    VertexIndex {
        /// As written.
        index: i64,
        /// How many vertices there are.
        count: usize,
    },
    /// Not a ZIP archive, or a broken one.
    #[error("the 3MF archive: {error}")]
    Zip {
        /// Why.
        #[source]
        error: zip::result::ZipError,
    },
    /// The XML inside is broken.
    #[error("{part}: byte {offset}: {error}")]
    Xml {
        /// The part of the archive.
        part: String,
        /// Where in it.
        offset: u64,
        /// Why.
        #[source]
        error: quick_xml::Error,
    },
    /// The XML is not a 3MF model.
    #[error("{part}: byte {offset}: {what}")]
    Model {
        /// The part of the archive.
        part: String,
        /// Where in it.
        offset: u64,
        /// What is wrong.
        what: String,
    },
}

fn suggest(name: Option<&str>) -> String {
    name.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}
