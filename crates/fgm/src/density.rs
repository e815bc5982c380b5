//! How dense the filling is: a number, a formula of the place, or as the design says.

use std::{fmt, str::FromStr, sync::Arc};

use fgm_core::{Bounds2, Interval, PlanarField, Point2};
use fgm_field::{
    Design, Expr, ExprError, ExprField, FieldError, Geometry, MeshDistance, SharedField,
    USUAL_DENSITY,
};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

/// The word for the design's own density.
const DESIGN: &str = "design";

/// The density of the filling, in percent.
#[derive(Clone, Debug, PartialEq)]
pub enum Density {
    /// As the design says; where it does not, the usual 15 %.
    Design,
    /// The same everywhere.
    Percent(f64),
    /// A formula.
    Graded(DensityFormula),
}

/// A density, in percent, by the coordinates of the design and its distance `d`; in the language
/// of the designs' expressions.
#[derive(Clone)]
pub struct DensityFormula {
    text: String,
    expr: Expr,
}

impl PartialEq for DensityFormula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl fmt::Debug for DensityFormula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.text)
    }
}

/// A density that is neither a number nor a formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{text}` is no density: {error} (at `{}`)", text.get(error.span.clone()).unwrap_or_default())]
pub struct DensityError {
    /// What stands there.
    pub text: String,
    /// What is wrong with it, and where.
    pub error: ExprError,
}

impl Density {
    /// The number, where it is one.
    pub fn percent(&self) -> Option<f64> {
        match self {
            Self::Percent(percent) => Some(*percent),
            Self::Design | Self::Graded(_) => None,
        }
    }

    /// What it means for a design.
    pub(crate) fn filling(&self, design: &Design) -> Result<Filling, FieldError> {
        Ok(match (self, &design.density) {
            (Self::Percent(percent), _) => Filling::Same(0.01 * percent),
            (Self::Graded(DensityFormula { expr, .. }), _) => {
                Filling::Graded { field: Arc::new(formula(expr, design)?), unit: 0.01 }
            }
            (Self::Design, None) => Filling::Same(USUAL_DENSITY),
            (Self::Design, Some(field)) => {
                let Interval { lo, hi } = field.bounds(&design.bounds);
                if lo == hi {
                    Filling::Same(lo.clamp(0.0, 1.0))
                } else {
                    Filling::Graded { field: Arc::clone(field), unit: 1.0 }
                }
            }
        })
    }
}

/// A formula as a field over a design.
fn formula(expr: &Expr, design: &Design) -> Result<ExprField, FieldError> {
    if !expr.uses_distance() {
        return Ok(ExprField::new(expr));
    }
    let distance = match &design.geometry {
        Geometry::Field(field) => field.clone(),
        Geometry::Mesh(mesh) => Arc::new(MeshDistance::new(mesh)?),
    };
    Ok(ExprField::with_distance(expr, distance))
}

/// How dense the filling of a design is.
pub(crate) enum Filling {
    /// This share everywhere.
    Same(f64),
    /// A field's value times `unit`, as a share.
    Graded { field: SharedField, unit: f64 },
}

impl Filling {
    /// The share, where it is the same everywhere.
    pub(crate) fn same(&self) -> Option<f64> {
        match self {
            Self::Same(share) => Some(*share),
            Self::Graded { .. } => None,
        }
    }

    /// Whether everything is filled.
    pub(crate) fn is_solid(&self) -> bool {
        self.same().is_some_and(|share| share >= 1.0)
    }

    /// A layer of it, where it varies.
    pub(crate) fn at_z(&self, z: f64) -> Option<Shares<'_>> {
        match self {
            Self::Same(_) => None,
            Self::Graded { field, unit } => Some(Shares { field: field.at_z(z), unit: *unit }),
        }
    }
}

/// A layer of a density field as shares.
pub(crate) struct Shares<'a> {
    field: Box<dyn PlanarField + 'a>,
    unit: f64,
}

impl PlanarField for Shares<'_> {
    fn eval(&self, p: Point2) -> f64 {
        self.unit * self.field.eval(p)
    }

    fn eval_into(&self, points: &[Point2], out: &mut [f64]) {
        self.field.eval_into(points, out);
        out.iter_mut().for_each(|value| *value *= self.unit);
    }

    fn bounds(&self, cell: &Bounds2) -> Interval {
        let Interval { lo, hi } = self.field.bounds(cell);
        Interval::new(self.unit * lo, self.unit * hi)
    }
}

impl From<f64> for Density {
    fn from(percent: f64) -> Self {
        Self::Percent(percent)
    }
}

/// A number, with or without `%`, a formula, or `design`.
impl FromStr for Density {
    type Err = DensityError;

    fn from_str(text: &str) -> Result<Self, DensityError> {
        let text = text.trim();
        if text == DESIGN {
            return Ok(Self::Design);
        }
        if let Ok(percent) = text.strip_suffix('%').unwrap_or(text).trim_end().parse() {
            return Ok(Self::Percent(percent));
        }
        match Expr::parse(text) {
            Ok(expr) => Ok(match expr.value() {
                Some(percent) => Self::Percent(percent),
                None => Self::Graded(DensityFormula { text: text.into(), expr }),
            }),
            Err(error) => Err(DensityError { text: text.into(), error }),
        }
    }
}

impl fmt::Display for Density {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Design => f.write_str(DESIGN),
            Self::Percent(percent) => write!(f, "{percent}"),
            Self::Graded(formula) => f.write_str(&formula.text),
        }
    }
}

impl Serialize for Density {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Design => s.serialize_str(DESIGN),
            Self::Percent(percent) => s.serialize_f64(*percent),
            Self::Graded(formula) => s.serialize_str(&formula.text),
        }
    }
}

impl<'de> Deserialize<'de> for Density {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Either {
            Number(f64),
            Text(String),
        }
        match Either::deserialize(d)? {
            Either::Number(percent) => Ok(Self::Percent(percent)),
            Either::Text(text) => text.parse().map_err(D::Error::custom),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_formulas_are_read() {
        for (text, percent) in [("15", 15.0), ("12.5%", 12.5), ("2*10 + 1", 21.0)] {
            assert_eq!(text.parse(), Ok(Density::Percent(percent)), "{text}");
        }
        assert_eq!("design".parse(), Ok(Density::Design));
        let graded: Density = "10 + 40 z/50".parse().unwrap();
        assert_eq!((graded.percent(), graded.to_string().as_str()), (None, "10 + 40 z/50"));
        assert_eq!(
            "10 + sine(z)".parse::<Density>().unwrap_err().to_string(),
            "`10 + sine(z)` is no density: unknown function `sine`; did you mean `sin`? (at `sine`)"
        );
    }

    #[test]
    fn files_hold_both() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct File {
            density: Density,
        }
        for (text, back) in [
            ("density = 20", "density = 20.0\n"),
            ("density = 'x'", "density = \"x\"\n"),
            ("density = 'design'", "density = \"design\"\n"),
        ] {
            let file: File = toml::from_str(text).unwrap();
            assert_eq!(toml::to_string(&file).unwrap(), back);
        }
        assert!(toml::from_str::<File>("density = true").is_err());
        let error = toml::from_str::<File>("density = '3 +'").unwrap_err();
        assert!(error.message().starts_with("`3 +` is no density"), "{error}");
    }
}
