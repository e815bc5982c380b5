//! From nodes to parts.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fgm_core::{Bounds3, Point3, TriangleMesh};
use fgm_field::{
    Difference, FieldError, Intersection, Offset, SharedField, Shell, SmoothDifference,
    SmoothIntersection, SmoothUnion, Union,
};
use glam::{DAffine3, DMat3};

use super::ast::{Arg, Node, Value};
use super::density::Density;
use super::kind::NodeKind;
use super::leaf::{cut_to, point};
use super::paint::Paint;
use super::part::{EVERYWHERE, Part, Shape};
use crate::source::Source;
use crate::{DesignError, LoadOptions, Problem, Warning};

/// The name of empty space.
pub(crate) const VOID: &str = "void";

/// What is known while a design is made from its nodes.
pub(crate) struct Lowering<'a> {
    pub(super) source: &'a Source,
    pub(super) folder: &'a Path,
    pub(super) options: &'a LoadOptions,
    pub(crate) warnings: Vec<Warning>,
    /// The names of the design's materials.
    pub(super) materials: Vec<String>,
    /// Meshes read, by path.
    pub(super) meshes: BTreeMap<PathBuf, Arc<TriangleMesh>>,
    /// The sides of a voxel, mm: what `blend` and `convolve` count in.
    pub(super) voxel: Point3,
    /// The first function without an end.
    pub(super) endless: Option<Range<usize>>,
}

impl<'a> Lowering<'a> {
    pub(crate) fn new(source: &'a Source, folder: &'a Path, options: &'a LoadOptions) -> Self {
        Self {
            source,
            folder,
            options,
            warnings: Vec::new(),
            materials: Vec::new(),
            meshes: BTreeMap::new(),
            voxel: Point3::ONE,
            endless: None,
        }
    }

    /// A node and all it holds. `graded` says whether an fgrade stands around it.
    pub(super) fn part(&mut self, node: &Node, graded: bool) -> Result<Part, DesignError> {
        if node.kind.is_leaf() {
            return self.leaf(node, graded);
        }
        if let NodeKind::Root = node.kind {
            return self.root(node, graded);
        }
        let graded_inside = graded || node.kind == NodeKind::Fgrade;
        let children = node.children.as_deref().unwrap_or_default();
        let mut parts = Vec::with_capacity(children.len());
        for child in children {
            parts.push(self.part(child, graded_inside)?);
        }
        if parts.is_empty() {
            return Err(self.children(node, "children", 0));
        }
        self.combine(node, parts)
    }

    fn combine(&mut self, node: &Node, parts: Vec<Part>) -> Result<Part, DesignError> {
        let at = |error| self.source.error(node.name_span.clone(), Problem::Field { error });
        match (node.kind, node.args.as_slice()) {
            (NodeKind::Union, []) => union(parts).map_err(at),
            (NodeKind::Intersection, []) => intersection(parts, None).map_err(at),
            (NodeKind::Difference, []) => difference(parts, None).map_err(at),
            (NodeKind::SmoothUnion, [radius]) => {
                let radius = self.positive(radius)?;
                smooth_union(parts, radius).map_err(at)
            }
            (NodeKind::SmoothIntersection, [radius]) => {
                let radius = self.positive(radius)?;
                intersection(parts, Some(radius)).map_err(at)
            }
            (NodeKind::SmoothDifference, [radius]) => {
                let radius = self.positive(radius)?;
                difference(parts, Some(radius)).map_err(at)
            }
            (NodeKind::Translate | NodeKind::Scale | NodeKind::Rotate, _) => {
                let by = self.transform(node)?;
                union(parts).and_then(|part| part.transformed(&by)).map_err(|error| {
                    self.source.error(node.args_span.clone(), Problem::Field { error })
                })
            }
            (NodeKind::Offset, [Arg { value: Value::Number(distance), .. }]) => {
                union(parts).and_then(|part| offset(part, *distance)).map_err(at)
            }
            (NodeKind::Shell, [thickness]) => {
                let thickness = self.positive(thickness)?;
                union(parts).and_then(|part| shell(part, thickness)).map_err(at)
            }
            (NodeKind::Fgrade, _) => {
                let child = union(parts).map_err(at)?;
                self.fgrade(node, child)
            }
            (NodeKind::Density, [Arg { value: Value::Text(_), .. }]) => {
                let child = union(parts).map_err(at)?;
                self.density(node, child)
            }
            (NodeKind::Blend | NodeKind::Convolve, _) => {
                let kernel = self.kernel(node)?;
                let mut part = union(parts).map_err(at)?;
                part.paint = Paint::Blended { paint: Box::new(part.paint), kernel };
                Ok(part)
            }
            _ => Err(self.wrong_arguments(node)),
        }
    }

    /// A union that may carry a box and the size of a voxel.
    fn root(&mut self, node: &Node, graded: bool) -> Result<Part, DesignError> {
        let values: Vec<&Value> = node.args.iter().map(|arg| &arg.value).collect();
        let bounds = match values.as_slice() {
            [] => None,
            [Value::Vector(a), Value::Vector(b), rest @ ..]
                if a.len() == 3 && b.len() == 3 && rest.len() < 2 =>
            {
                Some(self.given_box(&node.args[0], &node.args[1])?)
            }
            _ => return Err(self.wrong_arguments(node)),
        };
        let outer = self.voxel;
        match node.args.get(2) {
            Some(voxel @ Arg { value: Value::Vector(v), .. }) if v.len() == 3 => {
                self.voxel = self.sizes(voxel)?;
            }
            Some(voxel @ Arg { value: Value::Number(_), .. }) => {
                self.voxel = Point3::splat(self.positive(voxel)?);
            }
            Some(_) => return Err(self.wrong_arguments(node)),
            None => {}
        }
        let mut parts = Vec::new();
        for child in node.children.as_deref().unwrap_or_default() {
            parts.push(self.part(child, graded)?);
        }
        self.voxel = outer;
        if parts.is_empty() {
            return Err(self.children(node, "children", 0));
        }
        let at = |error| self.source.error(node.name_span.clone(), Problem::Field { error });
        let mut part = union(parts).map_err(at)?;
        if let Some(bounds) = bounds
            && !(bounds.contains(part.bounds.min) && bounds.contains(part.bounds.max))
        {
            part.shape = Shape::Field(cut_to(part.shape.field().map_err(at)?, &bounds));
            part.bounds = part.bounds.intersection(&bounds);
            part.tight = false;
        }
        Ok(part)
    }

    fn transform(&self, node: &Node) -> Result<DAffine3, DesignError> {
        let v = match node.args.as_slice() {
            [
                Arg { value: Value::Number(x), .. },
                Arg { value: Value::Number(y), .. },
                Arg { value: Value::Number(z), .. },
            ] => Point3::new(*x, *y, *z),
            [arg @ Arg { value: Value::Vector(v), .. }] if v.len() == 3 => point(arg),
            _ => return Err(self.wrong_arguments(node)),
        };
        Ok(match node.kind {
            NodeKind::Translate => DAffine3::from_translation(v),
            NodeKind::Scale => DAffine3::from_scale(v),
            _ => DAffine3::from_mat3(turn(2, v.z) * turn(1, v.y) * turn(0, v.x)),
        })
    }

    /// A number above zero.
    pub(super) fn positive(&self, arg: &Arg) -> Result<f64, DesignError> {
        match arg.value {
            Value::Number(value) if value > 0.0 => Ok(value),
            Value::Number(value) => {
                Err(self.source.error(arg.span.clone(), Problem::NotPositive { value }))
            }
            _ => Err(self.source.error(
                arg.span.clone(),
                Problem::Unexpected {
                    found: format!("a {}", arg.value.shape()),
                    expected: "a number",
                },
            )),
        }
    }

    /// A vector of three numbers above zero.
    pub(super) fn sizes(&self, arg: &Arg) -> Result<Point3, DesignError> {
        let size = point(arg);
        if let Some(&value) = size.to_array().iter().find(|v| **v <= 0.0) {
            return Err(self.source.error(arg.span.clone(), Problem::NotPositive { value }));
        }
        Ok(size)
    }

    pub(super) fn wrong_arguments(&self, node: &Node) -> DesignError {
        let given: Vec<String> = node.args.iter().map(|a| a.value.shape().to_string()).collect();
        let given = if given.is_empty() { "nothing".to_string() } else { given.join(", ") };
        let problem =
            Problem::Arguments { node: node.name.clone(), expected: node.kind.usage(), given };
        self.source.error(node.args_span.clone(), problem)
    }

    fn children(&self, node: &Node, wanted: &'static str, count: usize) -> DesignError {
        let problem = Problem::Children { node: node.name.clone(), wanted, count };
        self.source.error(node.name_span.clone(), problem)
    }
}

/// A rotation about an axis by degrees; exact for quarter turns.
fn turn(axis: usize, degrees: f64) -> DMat3 {
    let quarters = degrees / 90.0;
    let (sin, cos) = if quarters.fract() == 0.0 {
        [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarters.rem_euclid(4.0) as usize % 4]
    } else {
        degrees.to_radians().sin_cos()
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = DMat3::IDENTITY;
    m.col_mut(u)[u] = cos;
    m.col_mut(u)[v] = sin;
    m.col_mut(v)[u] = -sin;
    m.col_mut(v)[v] = cos;
    m
}

fn fields(parts: &[Part]) -> Result<Vec<SharedField>, FieldError> {
    parts.iter().map(|part| part.shape.field()).collect()
}

/// What is in any part that is no empty space, less the empty space.
pub(super) fn union(mut parts: Vec<Part>) -> Result<Part, FieldError> {
    if parts.len() == 1 {
        return Ok(parts.remove(0));
    }
    let (voids, solids): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| part.void);
    let void = solids.is_empty();
    let mut whole = joined(if void { voids.clone() } else { solids })?;
    whole.void = void;
    if !void && !voids.is_empty() {
        whole = less(whole, fields(&voids)?, None)?;
    }
    Ok(whole)
}

/// Parts of one kind as one.
fn joined(mut parts: Vec<Part>) -> Result<Part, FieldError> {
    if parts.len() == 1 {
        return Ok(parts.remove(0));
    }
    let fields = fields(&parts)?;
    let of_density = fields.iter().cloned().zip(parts.iter().map(|p| p.density.clone()));
    Ok(Part {
        shape: Shape::Field(Arc::new(Union(fields.clone()))),
        bounds: parts.iter().fold(Bounds3::EMPTY, |all, part| all.union(&part.bounds)),
        tight: parts.iter().all(|part| part.tight),
        void: false,
        density: Density::of_union(of_density.collect()),
        paint: Paint::of_union(
            fields.into_iter().zip(parts.into_iter().map(|p| p.paint)).collect(),
        ),
    })
}

fn smooth_union(parts: Vec<Part>, radius: f64) -> Result<Part, FieldError> {
    let fields = fields(&parts)?;
    let mut whole = union(parts)?;
    whole.shape = Shape::Field(Arc::new(SmoothUnion { parts: fields, radius }));
    // The smooth minimum of n values is at most radius / 4 below the least, n - 1 times.
    whole.bounds = whole.bounds.grown(radius);
    whole.tight = false;
    Ok(whole)
}

fn intersection(parts: Vec<Part>, radius: Option<f64>) -> Result<Part, FieldError> {
    let fields = fields(&parts)?;
    let bounds = parts.iter().fold(EVERYWHERE, |all, part| all.intersection(&part.bounds));
    let void = parts.iter().any(|part| part.void);
    let alone = parts.len() == 1;
    let mut parts = parts.into_iter();
    let Some(first) = parts.next() else { return Err(FieldError::NoRegion) };
    if alone {
        return Ok(first);
    }
    let field: SharedField = match radius {
        Some(radius) => Arc::new(SmoothIntersection { parts: fields, radius }),
        None => Arc::new(Intersection(fields)),
    };
    let Part { paint, density, .. } = first;
    Ok(Part { shape: Shape::Field(field), bounds, tight: false, paint, density, void })
}

fn difference(parts: Vec<Part>, radius: Option<f64>) -> Result<Part, FieldError> {
    let fields = fields(parts.get(1..).unwrap_or_default())?;
    match parts.into_iter().next() {
        Some(first) if fields.is_empty() => Ok(first),
        Some(first) => less(first, fields, radius),
        None => Err(FieldError::NoRegion),
    }
}

/// A part without what is inside of other fields.
pub(super) fn less(
    mut part: Part,
    rest: Vec<SharedField>,
    radius: Option<f64>,
) -> Result<Part, FieldError> {
    let first = part.shape.field()?;
    part.shape = Shape::Field(match radius {
        Some(radius) => Arc::new(SmoothDifference { first, rest, radius }),
        None => Arc::new(Difference { first, rest }),
    });
    part.tight = false;
    Ok(part)
}

fn offset(mut part: Part, distance: f64) -> Result<Part, FieldError> {
    part.shape = Shape::Field(Arc::new(Offset { field: part.shape.field()?, distance }));
    // A field that is less than a distance reaches further than its offset: the search for the
    // end starts from twice as far out.
    part.bounds = part.bounds.grown(if distance > 0.0 { 2.0 * distance } else { 0.0 });
    part.tight = false;
    Ok(part)
}

fn shell(mut part: Part, thickness: f64) -> Result<Part, FieldError> {
    part.shape = Shape::Field(Arc::new(Shell { field: part.shape.field()?, thickness }));
    Ok(part)
}
