//! Nodes that say what is made of what: fgrade, blend, convolve.

use std::sync::Arc;

use fgm_core::{MAX_MATERIALS, Point3};
use fgm_field::{
    Convolved, Expr, ExprField, FieldError, FractionMode, SharedField, VolumeFractions,
};

use super::ast::{Arg, Node, Value};
use super::kind::NodeKind;
use super::leaf::{split_material, text_span};
use super::lower::{Lowering, VOID, less};
use super::number;
use super::part::Part;
use crate::{DesignError, Problem, Warning};

impl Lowering<'_> {
    /// Finds the design's materials in the order in which they are first named. Names of shapes
    /// inside an fgrade do not count.
    pub(super) fn name_materials(
        &mut self,
        nodes: &[Node],
        graded: bool,
    ) -> Result<(), DesignError> {
        for node in nodes {
            match (node.kind, node.args.as_slice()) {
                (NodeKind::Fgrade, [_, Arg { value: Value::List(names), .. }, ..]) => {
                    for arg in names {
                        if let Value::Text(name) = &arg.value {
                            self.name_material(name, text_span(arg))?;
                        }
                    }
                }
                (kind, [.., last]) if kind.is_leaf() && !graded => {
                    if let Some(name) = split_material(node).1 {
                        self.name_material(name, text_span(last))?;
                    }
                }
                _ => {}
            }
            let children = node.children.as_deref().unwrap_or_default();
            self.name_materials(children, graded || node.kind == NodeKind::Fgrade)?;
        }
        Ok(())
    }

    fn name_material(&mut self, name: &str, at: std::ops::Range<usize>) -> Result<(), DesignError> {
        if name == VOID || self.materials.iter().any(|known| known == name) {
            return Ok(());
        }
        if self.materials.len() == MAX_MATERIALS {
            return Err(self
                .source
                .error(at, Problem::TooManyMaterials { name: name.to_string() }));
        }
        self.materials.push(name.to_string());
        Ok(())
    }

    /// How many materials the mixtures have: one that is alone gets company.
    pub(super) fn material_count(&self) -> usize {
        self.materials.len().max(2)
    }

    pub(super) fn material(&self, name: &str) -> Option<usize> {
        self.materials.iter().position(|known| known == name)
    }

    pub(super) fn fgrade(&mut self, node: &Node, child: Part) -> Result<Part, DesignError> {
        let (exprs, names, mode) = match node.args.as_slice() {
            [exprs, names] => (exprs, names, FractionMode::Probability),
            [exprs, names, mode] => (exprs, names, self.mode(node, mode)?),
            _ => return Err(self.wrong_arguments(node)),
        };
        let (Value::List(texts), Value::List(materials)) = (&exprs.value, &names.value) else {
            return Err(self.wrong_arguments(node));
        };
        if texts.len() != materials.len() {
            let problem =
                Problem::FractionCount { expressions: texts.len(), materials: materials.len() };
            return Err(self.source.error(exprs.span.start..names.span.end, problem));
        }
        if texts.is_empty() {
            return Err(self.source.error(exprs.span.clone(), Problem::EmptyList));
        }
        let unused = match mode {
            FractionMode::Probability => 0.0,
            FractionMode::Threshold => f64::MIN,
        };
        let mut weights = vec![Expr::constant(unused); self.material_count()];
        let mut seen: Vec<&str> = Vec::new();
        let mut void = None;
        for (text, name) in texts.iter().zip(materials) {
            let (Value::Text(_), Value::Text(material)) = (&text.value, &name.value) else {
                return Err(self.wrong_arguments(node));
            };
            let expr = number::expression(self.source, text_span(text), &node.names)?;
            if seen.contains(&material.as_str()) {
                self.warnings.push(Warning::DuplicateMaterial {
                    file: self.source.file.clone(),
                    at: Some(self.source.location(text_span(name))),
                    name: material.clone(),
                });
                continue;
            }
            seen.push(material);
            if material == VOID {
                if mode == FractionMode::Probability {
                    return Err(self.source.error(name.span.clone(), Problem::VoidMixed));
                }
                void = Some(expr);
            } else if let Some(index) = self.material(material) {
                weights[index] = expr;
            }
        }
        let at = |error| self.source.error(node.name_span.clone(), Problem::Field { error });
        self.grade(child, &weights, mode, void).map_err(at)
    }

    /// Says how densely a part is to be filled.
    pub(super) fn density(&self, node: &Node, mut child: Part) -> Result<Part, DesignError> {
        let [text] = node.args.as_slice() else { return Err(self.wrong_arguments(node)) };
        let expr = number::expression(self.source, text_span(text), &node.names)?;
        let field: SharedField = if expr.uses_distance() {
            let at = |error| self.source.error(node.name_span.clone(), Problem::Field { error });
            Arc::new(ExprField::with_distance(&expr, child.shape.field().map_err(at)?))
        } else {
            Arc::new(ExprField::new(&expr))
        };
        child.density = child.density.filled(&field);
        Ok(child)
    }

    /// Gives a part its fractions, and cuts away where there is nothing.
    fn grade(
        &self,
        mut child: Part,
        weights: &[Expr],
        mode: FractionMode,
        void: Option<Expr>,
    ) -> Result<Part, FieldError> {
        let distance = match weights.iter().chain(&void).any(Expr::uses_distance) {
            true => Some(child.shape.field()?),
            false => None,
        };
        let fractions = VolumeFractions::from_exprs(weights, distance.clone(), mode)?;
        child.paint = child.paint.filled(&(Arc::new(fractions) as _));
        if let Some(void) = void {
            let field = |expr: &Expr| -> SharedField {
                match &distance {
                    Some(distance) => {
                        Arc::new(ExprField::with_distance(expr, Arc::clone(distance)))
                    }
                    None => Arc::new(ExprField::new(expr)),
                }
            };
            // Empty where the greatest of the weights is below that of empty space.
            let rest = weights.iter().map(field).collect();
            child = less(child, vec![Arc::new(Below { rest, void: field(&void) })], None)?;
        }
        Ok(child)
    }

    fn mode(&self, node: &Node, arg: &Arg) -> Result<FractionMode, DesignError> {
        match &arg.value {
            Value::Text(mode) if mode == "prob" => Ok(FractionMode::Probability),
            Value::Text(mode) if mode == "thresh" => Ok(FractionMode::Threshold),
            Value::Text(mode) => {
                let problem = Problem::UnknownMode { mode: mode.clone() };
                Err(self.source.error(arg.span.clone(), problem))
            }
            _ => Err(self.wrong_arguments(node)),
        }
    }

    /// The offsets and weights of a blend or convolve.
    pub(super) fn kernel(&self, node: &Node) -> Result<Vec<(Point3, f64)>, DesignError> {
        let (counts, weights) = match (node.kind, node.args.as_slice()) {
            (NodeKind::Blend, [x, y, z]) => {
                let counts = [self.whole(x)?, self.whole(y)?, self.whole(z)?];
                let count = counts.iter().fold(1_usize, |n, c| n.saturating_mul(*c));
                self.kernel_limit(node, count)?;
                (counts, vec![1.0; count])
            }
            (NodeKind::Convolve, [Arg { value: Value::List(planes), span }]) => {
                let fault = || self.source.error(span.clone(), Problem::KernelShape);
                let planes: Vec<&[Arg]> = lists(planes).ok_or_else(fault)?;
                let rows: Vec<&[Arg]> = planes
                    .iter()
                    .map(|plane| lists(plane))
                    .collect::<Option<Vec<_>>>()
                    .ok_or_else(fault)?
                    .concat();
                let (ny, nx) = (planes[0].len(), rows[0].len());
                if planes.iter().any(|p| p.len() != ny) || rows.iter().any(|r| r.len() != nx) {
                    return Err(fault());
                }
                let number = |arg: &Arg| match arg.value {
                    Value::Number(v) => Some(v),
                    _ => None,
                };
                let weights: Option<Vec<f64>> =
                    rows.iter().flat_map(|r| r.iter()).map(number).collect();
                ([nx, ny, planes.len()], weights.ok_or_else(fault)?)
            }
            _ => return Err(self.wrong_arguments(node)),
        };
        self.kernel_limit(node, weights.len())?;
        if let Some(sample) = weights.iter().position(|w| *w < 0.0) {
            let error = FieldError::KernelWeight { sample, weight: weights[sample] };
            return Err(self.source.error(node.args_span.clone(), Problem::Field { error }));
        }
        if weights.iter().sum::<f64>() <= 0.0 {
            let error = FieldError::KernelWeight { sample: 0, weight: 0.0 };
            return Err(self.source.error(node.args_span.clone(), Problem::Field { error }));
        }
        let [nx, ny, _] = counts;
        let middle = counts.map(|n| (n as f64 - 1.0) * 0.5);
        let offset = |i: usize| {
            let at = [i % nx, i / nx % ny, i / (nx * ny)];
            let steps: [f64; 3] = std::array::from_fn(|k| at[k] as f64 - middle[k]);
            Point3::from_array(steps) * self.voxel
        };
        Ok(weights.into_iter().enumerate().map(|(i, w)| (offset(i), w)).collect())
    }

    fn kernel_limit(&self, node: &Node, count: usize) -> Result<(), DesignError> {
        let limit = Convolved::MAX_SAMPLES;
        if count <= limit {
            return Ok(());
        }
        let error = FieldError::KernelSize { count, limit };
        Err(self.source.error(node.args_span.clone(), Problem::Field { error }))
    }

    /// A whole number from 1 to a million.
    fn whole(&self, arg: &Arg) -> Result<usize, DesignError> {
        let value = self.positive(arg)?;
        if value.fract() != 0.0 || value > 1e6 {
            return Err(self.source.error(arg.span.clone(), Problem::NotWhole { value }));
        }
        Ok(value as usize)
    }
}

/// The lists in a list; none where there is something else, nothing, or an empty list.
fn lists(args: &[Arg]) -> Option<Vec<&[Arg]>> {
    let list = |arg: &'_ Arg| match &arg.value {
        Value::List(list) if !list.is_empty() => Some(()),
        _ => None,
    };
    if args.is_empty() || args.iter().any(|arg| list(arg).is_none()) {
        return None;
    }
    Some(
        args.iter()
            .filter_map(|arg| match &arg.value {
                Value::List(list) => Some(list.as_slice()),
                _ => None,
            })
            .collect(),
    )
}

/// Inside, at or below 0, where the greatest of `rest` is below `void`.
struct Below {
    rest: Vec<SharedField>,
    void: SharedField,
}

impl fgm_core::Field for Below {
    fn eval(&self, p: Point3) -> f64 {
        let greatest = self.rest.iter().map(|w| w.eval(p)).fold(f64::NEG_INFINITY, f64::max);
        greatest - self.void.eval(p)
    }

    fn bounds(&self, cell: &fgm_core::Bounds3) -> fgm_core::Interval {
        let void = self.void.bounds(cell);
        let nothing = fgm_core::Interval::point(f64::NEG_INFINITY);
        let rest = self
            .rest
            .iter()
            .map(|w| w.bounds(cell))
            .fold(nothing, |a, b| fgm_core::Interval::new(a.lo.max(b.lo), a.hi.max(b.hi)));
        fgm_core::Interval::new(rest.lo - void.hi, rest.hi - void.lo)
    }
}
