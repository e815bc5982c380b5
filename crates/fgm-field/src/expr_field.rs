//! A compiled expression as a field.

use std::fmt;
use std::sync::Arc;

use fgm_core::{Bounds2, Bounds3, Field, Interval, PlanarField, Point2, Point3};

use crate::SharedField;
use crate::expr::Expr;
use crate::expr::graph::Var;
use crate::sampled::{Layer, Sampled, layers};
use crate::tape::Tape;
use crate::tape::chunk::CHUNK;

/// An [`Expr`] compiled for evaluation: one point at a time, many points at a time, and ranges over
/// boxes. Cheap to clone.
///
/// Many points at a time give the same bits as one, on every machine. No evaluation allocates
/// (but for registers, once a thread).
///
/// ```
/// use fgm_core::{Bounds3, Field, Point3};
/// use fgm_field::{Expr, ExprField};
///
/// let field = ExprField::new(&Expr::parse("x^2 - 1")?);
/// let range = field.bounds(&Bounds3::new(Point3::splat(-2.0), Point3::splat(1.0)));
/// assert_eq!((range.lo, range.hi), (-1.0, 3.0));
/// # Ok::<(), fgm_field::ExprError>(())
/// ```
#[derive(Clone)]
pub struct ExprField {
    expr: Expr,
    tape: Arc<Tape>,
    reads_z: bool,
    /// The other fields that the expression reads, by number.
    inputs: Arc<[SharedField]>,
}

impl ExprField {
    /// Compiles an expression. A `d` in it is NaN: give the distance with
    /// [`with_distance`](Self::with_distance) where [`Expr::uses_distance`].
    pub fn new(expr: &Expr) -> Self {
        Self::with_inputs(expr, &Arc::from([]))
    }

    /// Compiles an expression whose `d` is the value of `distance`.
    pub fn with_distance(expr: &Expr, distance: SharedField) -> Self {
        Self::with_inputs(expr, &Arc::from([distance]))
    }

    /// Compiles an expression that reads other fields.
    pub(crate) fn with_inputs(expr: &Expr, inputs: &Arc<[SharedField]>) -> Self {
        let (nodes, root) = expr.graph();
        let reads_any = (0..inputs.len()).any(|i| expr.reads(Var::Input(i as u8)));
        Self {
            tape: Arc::new(Tape::compile(nodes, root)),
            reads_z: expr.reads(Var::Z),
            inputs: if reads_any { Arc::clone(inputs) } else { Arc::from([]) },
            expr: expr.clone(),
        }
    }

    /// The expression.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }
}

impl fmt::Debug for ExprField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ExprField").field("tape", &self.tape).finish_non_exhaustive()
    }
}

/// The values of a tape at many points, `coordinate(p, i)` being the `i`-th coordinate.
fn values_at<S: Sampled>(
    tape: &Tape,
    points: &[S::Point],
    out: &mut [f64],
    inputs: &[S],
    coordinate: impl Fn(&S::Point, usize) -> f64,
) {
    let load = |points: &[S::Point], lanes: &mut [f64], i: usize| {
        lanes.iter_mut().zip(points).for_each(|(lane, p)| *lane = coordinate(p, i));
    };
    for (points, out) in points.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
        // One loop a coordinate, so that each is compiled for its own.
        tape.eval_chunk(out, |var, lanes| match var {
            0 => load(points, lanes, 0),
            1 => load(points, lanes, 1),
            2 => load(points, lanes, 2),
            _ => match inputs.get(var - 3) {
                Some(field) => field.values(points, lanes),
                None => lanes.fill(f64::NAN),
            },
        });
    }
}

impl Field for ExprField {
    fn eval(&self, p: Point3) -> f64 {
        self.tape.eval(|var| match var {
            0 => p.x,
            1 => p.y,
            2 => p.z,
            _ => self.inputs.get(var - 3).map_or(f64::NAN, |field| field.eval(p)),
        })
    }

    fn eval_into(&self, points: &[Point3], out: &mut [f64]) {
        values_at(&self.tape, points, out, &self.inputs, |p, i| p[i]);
    }

    fn bounds(&self, cell: &Bounds3) -> Interval {
        self.tape.bounds(|var| match var {
            0 => cell.x(),
            1 => cell.y(),
            2 => cell.z(),
            _ => self.inputs.get(var - 3).map_or(Interval::EVERYTHING, |field| field.bounds(cell)),
        })
    }

    fn varies_with_z(&self) -> bool {
        self.reads_z || self.inputs.iter().any(|input| input.varies_with_z())
    }

    fn at_z(&self, z: f64) -> Box<dyn PlanarField + '_> {
        let tape = if self.reads_z {
            let layer = self.expr.at_z(z);
            let (nodes, root) = layer.graph();
            Arc::new(Tape::compile(nodes, root))
        } else {
            Arc::clone(&self.tape)
        };
        Box::new(ExprLayer { tape, inputs: layers(self.inputs.iter(), z) })
    }
}

/// An expression at one height: what depends on the height alone is a constant, and no tape here
/// reads z.
struct ExprLayer<'a> {
    tape: Arc<Tape>,
    inputs: Vec<Layer<'a>>,
}

impl PlanarField for ExprLayer<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.tape.eval(|var| match var {
            0 => p.x,
            1 => p.y,
            _ => self.input(var).map_or(f64::NAN, |field| field.eval(p)),
        })
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        let coordinate = |p: &Point2, i: usize| if i == 0 { p.x } else { p.y };
        values_at(&self.tape, points, out, &self.inputs, coordinate);
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        self.tape.bounds(|var| match var {
            0 => cell.x(),
            1 => cell.y(),
            _ => self.input(var).map_or(Interval::EVERYTHING, |field| field.bounds(cell)),
        })
    }
}

impl<'a> ExprLayer<'a> {
    /// The other field that a variable stands for.
    fn input(&self, var: usize) -> Option<&Layer<'a>> {
        self.inputs.get(var.checked_sub(3)?)
    }
}
