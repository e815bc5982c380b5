//! Volume fractions from weights.

use std::sync::Arc;

use fgm_core::{
    Bounds3, Field, Interval, MAX_MATERIALS, MaterialError, MaterialField, Mixture, MixtureError,
    Point3,
};

use super::field_at;
use crate::expr::graph::{Graph, NodeId, Var};
use crate::tape::op::{Binary, Unary};
use crate::{Expr, ExprField, FieldError, SharedField};

/// How weights become fractions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FractionMode {
    /// Each weight's share of their sum; negative weights count as 0.
    Probability,
    /// All of the material with the greatest weight, the first of equal ones; weights may be
    /// negative.
    Threshold,
}

/// Volume fractions of two or more materials, from one weight each. They always sum to 1.
///
/// There is no valid mixture where a weight is NaN or infinite, where no weight is above 0 (in
/// [`FractionMode::Probability`]), or anywhere if all are 0 everywhere. There the fractions are NaN,
/// and [`mixture`](MaterialField::mixture) names the point.
///
/// Made from expressions, what the weights have in common is computed once. Two weights of which one
/// is literally `1 - w` of the other are not divided by their sum: the fractions are then the
/// weights, limited to 0 and 1, whatever their values.
///
/// ```
/// use fgm_core::{MaterialField, Point3};
/// use fgm_field::{Expr, FractionMode, VolumeFractions};
///
/// let weights = [Expr::parse("x / 10")?, Expr::parse("1 - x / 10")?];
/// let fractions = VolumeFractions::from_exprs(&weights, None, FractionMode::Probability)?;
/// assert_eq!(fractions.mixture(Point3::X * 2.5)?.fractions(), [0.25, 0.75]);
/// assert_eq!(fractions.mixture(Point3::X * 99.0)?.fractions(), [1.0, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct VolumeFractions {
    weights: Vec<ExprField>,
    fractions: Vec<ExprField>,
    rule: Rule,
    /// Whether all weights are 0 everywhere.
    nothing: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Rule {
    Shares,
    Largest,
    /// The weights are shares themselves, and what they leave is the last material's.
    Rest,
}

impl From<FractionMode> for Rule {
    fn from(mode: FractionMode) -> Self {
        match mode {
            FractionMode::Probability => Self::Shares,
            FractionMode::Threshold => Self::Largest,
        }
    }
}

impl VolumeFractions {
    /// Fractions from one weight field a material.
    ///
    /// # Errors
    /// [`FieldError::MaterialCount`] for fewer than 2 or more than [`MAX_MATERIALS`] weights.
    pub fn new(weights: Vec<SharedField>, mode: FractionMode) -> Result<Self, FieldError> {
        let materials = weights.len();
        Self::build(&inputs(materials), &weights.into(), mode.into(), materials)
    }

    /// Fractions of one material more than there are weights: the last one's is what the others
    /// leave of 1. Weights that sum to more than 1 are divided by their sum and leave nothing.
    ///
    /// # Errors
    /// [`FieldError::MaterialCount`] for no weight or for [`MAX_MATERIALS`] or more.
    pub fn with_rest(weights: Vec<SharedField>) -> Result<Self, FieldError> {
        let materials = weights.len() + 1;
        Self::build(&inputs(weights.len()), &weights.into(), Rule::Rest, materials)
    }

    /// Fractions from one expression a material; `distance` is what `d` in them stands for.
    ///
    /// Quicker than [`new`](Self::new) on the same expressions: each fraction is one compiled whole.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_exprs(
        weights: &[Expr],
        distance: Option<SharedField>,
        mode: FractionMode,
    ) -> Result<Self, FieldError> {
        let inputs: Vec<_> = distance.into_iter().collect();
        Self::build(weights, &inputs.into(), mode.into(), weights.len())
    }

    /// As [`with_rest`](Self::with_rest), from expressions; `distance` is what `d` in them stands
    /// for.
    ///
    /// # Errors
    /// As [`with_rest`](Self::with_rest).
    pub fn from_exprs_with_rest(
        weights: &[Expr],
        distance: Option<SharedField>,
    ) -> Result<Self, FieldError> {
        let inputs: Vec<_> = distance.into_iter().collect();
        Self::build(weights, &inputs.into(), Rule::Rest, weights.len() + 1)
    }

    /// All of one material out of `count`, everywhere.
    ///
    /// # Errors
    /// [`FieldError::MaterialCount`] for fewer than 2 or more than [`MAX_MATERIALS`],
    /// [`FieldError::NoSuchMaterial`] where `material` is not below `count`.
    pub fn uniform(count: usize, material: usize) -> Result<Self, FieldError> {
        if material >= count {
            return Err(FieldError::NoSuchMaterial { material, count });
        }
        let weights: Vec<_> =
            (0..count).map(|i| Expr::constant(if i == material { 1.0 } else { 0.0 })).collect();
        Self::build(&weights, &Arc::from([]), Rule::Shares, count)
    }

    fn build(
        weights: &[Expr],
        inputs: &Arc<[SharedField]>,
        rule: Rule,
        materials: usize,
    ) -> Result<Self, FieldError> {
        if !(2..=MAX_MATERIALS).contains(&materials) || weights.is_empty() {
            return Err(FieldError::MaterialCount { count: materials });
        }
        let compile = |expr: &Expr| ExprField::with_inputs(expr, inputs);
        let weight_fields: Vec<_> = weights.iter().map(compile).collect();
        let nothing = rule != Rule::Rest && weight_fields.iter().all(is_zero_everywhere);
        let fractions = if nothing {
            vec![compile(&Expr::constant(f64::NAN)); materials]
        } else {
            let fraction = |material| compile(&Fraction::of(weights, rule, material));
            (0..materials).map(fraction).collect()
        };
        Ok(Self { weights: weight_fields, fractions, rule, nothing })
    }

    fn mixture_of(&self, weights: &mut [f64]) -> Result<Mixture, MixtureError> {
        if self.nothing {
            return Err(MixtureError::AllZero);
        }
        if let Some((material, &value)) = weights.iter().enumerate().find(|w| !w.1.is_finite()) {
            return Err(MixtureError::NotFinite { material, value });
        }
        match self.rule {
            Rule::Shares => {}
            Rule::Largest => {
                let first_greatest = (1..weights.len())
                    .fold(0, |best, i| if weights[i] > weights[best] { i } else { best });
                return Mixture::pure(first_greatest, weights.len());
            }
            Rule::Rest => {
                let last = weights.len() - 1;
                let sum: f64 = weights[..last].iter().map(|w| w.max(0.0)).sum();
                weights[last] = (1.0 - sum).max(0.0);
            }
        }
        Mixture::from_weights(weights)
    }
}

/// One expression for each of the first `count` input fields.
fn inputs(count: usize) -> Vec<Expr> {
    let input = |i: usize| {
        let mut graph = Graph::default();
        let root = graph.var(Var::Input(i.min(MAX_MATERIALS - 1) as u8));
        Expr::of(graph, root)
    };
    (0..count).map(input).collect()
}

fn is_zero_everywhere(field: &ExprField) -> bool {
    let everywhere = Bounds3::new(Point3::splat(-1e6), Point3::splat(1e6));
    field.bounds(&everywhere) == Interval::point(0.0)
}

/// Builds the expression of one fraction from those of the weights.
struct Fraction {
    graph: Graph,
    weights: Vec<NodeId>,
}

impl Fraction {
    fn of(weights: &[Expr], rule: Rule, material: usize) -> Expr {
        let mut graph = Graph::default();
        let weights = weights.iter().map(|w| w.add_to(&mut graph)).collect();
        let mut fraction = Self { graph, weights };
        let root = match rule {
            Rule::Shares if fraction.is_complement() => fraction.clamped(material),
            Rule::Shares => fraction.share(material),
            Rule::Largest => fraction.largest(material),
            Rule::Rest => fraction.of_one(material),
        };
        Expr::of(fraction.graph, root)
    }

    fn op(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        self.graph.binary(op, a, b)
    }

    /// Whether there are two weights and one is 1 less the other.
    ///
    /// Then, if 0 <= w <= 1, the sum is 1; if w < 0, it counts as 0 and its fraction is 0; if
    /// w > 1, the other counts as 0 and its fraction is 1.
    fn is_complement(&mut self) -> bool {
        let [a, b] = self.weights[..] else { return false };
        let one = self.graph.constant(1.0);
        self.op(Binary::Sub, one, a) == b || self.op(Binary::Sub, one, b) == a
    }

    /// The weight itself, from 0 to 1.
    fn clamped(&mut self, material: usize) -> NodeId {
        let weight = self.counted(material);
        let one = self.graph.constant(1.0);
        self.op(Binary::Min, weight, one)
    }

    /// The weight as it counts: not negative, NaN where not finite.
    fn counted(&mut self, material: usize) -> NodeId {
        self.graph.unary(Unary::Weight, self.weights[material])
    }

    /// The sum of the weights that count, without one of them.
    fn sum_without(&mut self, left_out: Option<usize>) -> NodeId {
        let counted: Vec<_> = (0..self.weights.len())
            .filter(|material| Some(*material) != left_out)
            .map(|material| self.counted(material))
            .collect();
        let sum = counted.into_iter().reduce(|sum, weight| self.op(Binary::Add, sum, weight));
        sum.unwrap_or_else(|| self.graph.constant(0.0))
    }

    fn share(&mut self, material: usize) -> NodeId {
        let rest = self.sum_without(Some(material));
        let weight = self.counted(material);
        self.op(Binary::Share, weight, rest)
    }

    /// 1 where the weight is above all before it and not below any after it, else 0; NaN where one
    /// of them is not finite.
    fn largest(&mut self, material: usize) -> NodeId {
        let own = self.weights[material];
        let zero = self.graph.constant(0.0);
        let mut wins = self.graph.constant(1.0);
        for (i, other) in self.weights.clone().into_iter().enumerate() {
            if i != material {
                let op = if i < material { Binary::Less } else { Binary::LessEqual };
                let beats = self.op(op, other, own);
                wins = self.op(Binary::And, wins, beats);
            }
        }
        for weight in self.weights.clone() {
            let nan_if_not_finite = self.op(Binary::Mul, weight, zero);
            wins = self.op(Binary::Add, wins, nan_if_not_finite);
        }
        wins
    }

    /// The weight as a share of 1, or what all of them leave for the last material.
    fn of_one(&mut self, material: usize) -> NodeId {
        let sum = self.sum_without(None);
        let one = self.graph.constant(1.0);
        if material == self.weights.len() {
            let zero = self.graph.constant(0.0);
            let rest = self.op(Binary::Sub, one, sum);
            return self.op(Binary::Max, rest, zero);
        }
        if self.weights.len() == 1 {
            return self.clamped(material);
        }
        let weight = self.counted(material);
        let whole = self.op(Binary::Max, sum, one);
        let share = self.op(Binary::Div, weight, whole);
        self.op(Binary::Min, share, one)
    }
}

impl MaterialField for VolumeFractions {
    fn materials(&self) -> usize {
        self.fractions.len()
    }

    fn mixture(&self, p: Point3) -> Result<Mixture, MaterialError> {
        // Of two materials one fraction tells the other; it is NaN where there is no mixture.
        if let [first, _] = &self.fractions[..] {
            let fraction = first.eval(p);
            if let Ok(mixture) = Mixture::from_weights(&[fraction, 1.0 - fraction]) {
                return Ok(mixture);
            }
        }
        let mut weights = [0.0; MAX_MATERIALS];
        for (weight, field) in weights.iter_mut().zip(&self.weights) {
            *weight = field.eval(p);
        }
        self.mixture_of(&mut weights[..self.fractions.len()])
            .map_err(|reason| MaterialError { at: p, reason })
    }

    fn fraction(&self, material: usize) -> &dyn Field {
        field_at(&self.fractions, material)
    }
}
