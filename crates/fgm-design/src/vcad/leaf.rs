//! The shapes that stand alone.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use fgm_core::{Bounds3, Point2, Point3, Polygon, Ring, TriangleMesh};
use fgm_field::{
    Capsule, Cone, Cuboid, Cylinder, Expr, ExprField, Extrusion, Intersection, SharedField, Sphere,
    Torus, Transformed,
};
use glam::DAffine3;

use super::ast::{Arg, Node, Value};
use super::density::Density;
use super::kind::NodeKind;
use super::lower::{Lowering, VOID};
use super::number;
use super::paint::Paint;
use super::part::{EVERYWHERE, Part, Shape};
use crate::{DesignError, Problem, extent, mesh};

/// A shape and its bounds, before its material.
struct Body {
    shape: Shape,
    bounds: Bounds3,
    tight: bool,
}

impl Body {
    fn tight(field: impl fgm_core::Field + Send + 'static, bounds: Bounds3) -> Self {
        Self { shape: Shape::Field(Arc::new(field)), bounds, tight: true }
    }
}

/// A solid around the z axis standing on z = 0.
fn standing(radius: f64, height: f64) -> Bounds3 {
    Bounds3::new(Point3::new(-radius, -radius, 0.0), Point3::new(radius, radius, height))
}

fn centred(size: Point3) -> Bounds3 {
    Bounds3::new(size * -0.5, size * 0.5)
}

impl Lowering<'_> {
    /// A shape. `graded` says whether an fgrade stands around it.
    pub(super) fn leaf(&mut self, node: &Node, graded: bool) -> Result<Part, DesignError> {
        let (args, material) = split_material(node);
        let body = self.body(node, args)?;
        let void = material.is_some_and(|name| name == VOID);
        let paint = match material {
            _ if void || graded => Paint::Inherit,
            // Every material that counts was named before.
            Some(name) => self.material(name).map_or(Paint::Inherit, Paint::Pure),
            None => {
                let problem = Problem::NoMaterial { node: node.name.clone() };
                return Err(self.source.error(node.name_span.clone(), problem));
            }
        };
        let Body { shape, bounds, tight } = body;
        Ok(Part { shape, bounds, tight, paint, density: Density::Inherit, void })
    }

    fn body(&mut self, node: &Node, args: &[Arg]) -> Result<Body, DesignError> {
        let values: Vec<&Value> = args.iter().map(|arg| &arg.value).collect();
        let positive = |i: usize| self.positive(&args[i]);
        use Value::{List, Number, Text, Vector};
        Ok(match (node.kind, values.as_slice()) {
            (NodeKind::Sphere, [Number(_)]) => {
                let radius = positive(0)?;
                Body::tight(Sphere { radius }, centred(Point3::splat(2.0 * radius)))
            }
            (NodeKind::Cube, [Number(_)]) => cuboid(Point3::splat(positive(0)?)),
            (NodeKind::Rectprism, [Number(_), Number(_), Number(_)]) => {
                cuboid(Point3::new(positive(0)?, positive(1)?, positive(2)?))
            }
            (NodeKind::Rectprism, [Vector(v)]) if v.len() == 3 => cuboid(self.sizes(&args[0])?),
            (NodeKind::Cylinder, [Number(_), Number(_)]) => {
                let (radius, height) = (positive(0)?, positive(1)?);
                Body::tight(Cylinder { radius, height }, standing(radius, height))
            }
            (NodeKind::Cone, [Number(_), Number(_)]) => {
                let (bottom, height) = (positive(0)?, positive(1)?);
                Body::tight(Cone { bottom, top: 0.0, height }, standing(bottom, height))
            }
            (NodeKind::Cone, [Number(_), Number(top), Number(_)]) => {
                let top = if *top == 0.0 { 0.0 } else { positive(1)? };
                let (bottom, height) = (positive(0)?, positive(2)?);
                Body::tight(Cone { bottom, top, height }, standing(bottom.max(top), height))
            }
            (NodeKind::Torus, [Number(_), Number(_)]) => {
                let (major, minor) = (positive(0)?, positive(1)?);
                let size = Point3::new(major + minor, major + minor, minor) * 2.0;
                Body::tight(Torus { major, minor }, centred(size))
            }
            (NodeKind::Capsule, [Number(_), Number(_)]) => {
                let (radius, height) = (positive(0)?, positive(1)?);
                let bounds = standing(radius, height.max(2.0 * radius));
                Body::tight(Capsule { radius, height }, bounds)
            }
            (NodeKind::Extrude, [Number(_), List(points)]) => {
                let ring = self.outline(points, args[1].span.clone())?;
                let height = positive(0)?;
                let polygon = Polygon::simple(ring);
                let bounds = polygon.bounds().extrude(fgm_core::Interval::new(0.0, height));
                Body::tight(Extrusion::new(&polygon, height), bounds)
            }
            (NodeKind::Gyroid, [Vector(v), Number(_), Number(_)]) if v.len() == 3 => {
                self.gyroid(self.sizes(&args[0])?, positive(1)?, positive(2)?, node)?
            }
            (NodeKind::Mesh, [Text(name)]) => self.mesh(name, &args[0])?,
            (NodeKind::Function, [Text(_)]) => {
                let field = self.expression_field(node, &args[0])?;
                self.endless(field, args[0].span.clone())?
            }
            (NodeKind::Function, [Vector(min), Vector(max), Text(_)])
                if min.len() == 3 && max.len() == 3 =>
            {
                let bounds = self.given_box(&args[0], &args[1])?;
                let field = self.expression_field(node, &args[2])?;
                boxed(field, bounds)
            }
            _ => return Err(self.wrong_arguments(node)),
        })
    }

    /// A function's field; its expression is not about a child, so it has no `d`.
    fn expression_field(&self, node: &Node, arg: &Arg) -> Result<SharedField, DesignError> {
        let span = text_span(arg);
        let expr = number::expression(self.source, span.clone(), &node.names)?;
        if expr.uses_distance() {
            return Err(self.source.error(span, Problem::NoDistance));
        }
        Ok(Arc::new(ExprField::new(&expr)))
    }

    /// A function without a box.
    fn endless(&mut self, field: SharedField, span: Range<usize>) -> Result<Body, DesignError> {
        let bounds = match extent::enclose(&*field) {
            Some(bounds) if bounds.is_empty() => {
                return Err(self.source.error(span, Problem::EmptyShape));
            }
            Some(bounds) => bounds,
            None => {
                self.endless.get_or_insert(span);
                EVERYWHERE
            }
        };
        Ok(Body { shape: Shape::Field(field), bounds, tight: false })
    }

    /// The two corners of a box.
    pub(super) fn given_box(&self, min: &Arg, max: &Arg) -> Result<Bounds3, DesignError> {
        let bounds = Bounds3::new(point(min), point(max));
        if !bounds.size().cmpgt(Point3::ZERO).all() {
            return Err(self.source.error(min.span.start..max.span.end, Problem::BoxOrder));
        }
        Ok(bounds)
    }

    fn outline(&self, points: &[Arg], span: Range<usize>) -> Result<Ring, DesignError> {
        let mut ring = Ring::default();
        for arg in points {
            let Value::Vector(v) = &arg.value else {
                return Err(self.source.error(arg.span.clone(), Problem::OutlinePoint));
            };
            let [x, y] = v[..] else {
                return Err(self.source.error(arg.span.clone(), Problem::OutlinePoint));
            };
            ring.points.push(Point2::new(x, y));
        }
        if ring.points.len() > 2 && ring.points.first() == ring.points.last() {
            ring.points.pop();
        }
        let size = ring.bounds().size();
        if ring.points.len() < 3 || !(size.x > 0.0 && size.y > 0.0) {
            return Err(self.source.error(span, Problem::Outline));
        }
        Ok(ring)
    }

    fn gyroid(
        &self,
        size: Point3,
        cell: f64,
        thickness: f64,
        node: &Node,
    ) -> Result<Body, DesignError> {
        // The gradient of the gyroid's formula is 1.5 per radian on average over its surface.
        let (k, half) = (std::f64::consts::TAU / cell, 0.5 * thickness);
        let text = "abs(sin(k x)cos(k y) + sin(k y)cos(k z) + sin(k z)cos(k x))/(1.5k) - half";
        let expr = Expr::parse_with(text, &[("k", k), ("half", half)]).map_err(|error| {
            let problem = Problem::Expression { kind: error.kind };
            self.source.error(node.args_span.clone(), problem)
        })?;
        Ok(boxed(Arc::new(ExprField::new(&expr)), centred(size)))
    }

    fn mesh(&mut self, name: &str, arg: &Arg) -> Result<Body, DesignError> {
        let path = self.folder.join(Path::new(name));
        let mesh: Arc<TriangleMesh> = match self.meshes.get(&path) {
            Some(mesh) => Arc::clone(mesh),
            None => {
                let read = mesh::load(&path, &mut self.warnings).map_err(|error| {
                    let problem = Problem::Mesh { error: Box::new(error) };
                    self.source.error(arg.span.clone(), problem)
                })?;
                let mesh = Arc::new(read);
                self.meshes.insert(path, Arc::clone(&mesh));
                mesh
            }
        };
        let bounds = mesh.bounds();
        Ok(Body { shape: Shape::Mesh(mesh), bounds, tight: true })
    }
}

fn cuboid(size: Point3) -> Body {
    Body::tight(Cuboid { size }, centred(size))
}

/// What of a field lies in a box.
fn boxed(field: SharedField, bounds: Bounds3) -> Body {
    Body { shape: Shape::Field(cut_to(field, &bounds)), bounds, tight: false }
}

/// A field cut to a box.
pub(super) fn cut_to(field: SharedField, bounds: &Bounds3) -> SharedField {
    let cuboid = Arc::new(Cuboid { size: bounds.size() });
    let moved: SharedField =
        match Transformed::new(cuboid, DAffine3::from_translation(bounds.center())) {
            Ok(moved) => Arc::new(moved),
            // A move can always be undone.
            Err(_) => return field,
        };
    Arc::new(Intersection(vec![field, moved]))
}

/// The arguments without the material's name at their end, and the name. Where a shape's own last
/// argument is a string, it is not the material.
pub(super) fn split_material(node: &Node) -> (&[Arg], Option<&str>) {
    let own = match node.kind {
        NodeKind::Mesh => 1,
        NodeKind::Function
            if matches!(node.args.first(), Some(Arg { value: Value::Text(_), .. })) =>
        {
            1
        }
        NodeKind::Function => 3,
        _ => 0,
    };
    match node.args.split_last() {
        Some((Arg { value: Value::Text(name), .. }, rest)) if rest.len() >= own => {
            (rest, Some(name))
        }
        _ => (&node.args, None),
    }
}

/// Where the text of a string stands, without its quotes.
pub(super) fn text_span(arg: &Arg) -> Range<usize> {
    arg.span.start + 1..arg.span.end - 1
}

/// A vector of three as a point; the caller has seen its length.
pub(super) fn point(arg: &Arg) -> Point3 {
    match &arg.value {
        Value::Vector(v) if v.len() == 3 => Point3::new(v[0], v[1], v[2]),
        _ => Point3::NAN,
    }
}
