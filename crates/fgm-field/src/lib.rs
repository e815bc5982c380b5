//! Scalar fields in space, for designs that are functions: where the solid is and what it is made of
//! at every point.
//!
//! Everything is a [`Field`](fgm_core::Field) of `fgm-core`: a value at a point (`eval`), at many
//! points (`eval_into`), a range over a box (`bounds`, by interval arithmetic, so that whoever looks
//! for a contour can skip where there is none), and a layer (`at_z`, in which all that depends on
//! the height alone is computed once).
//!
//! # The cast
//!
//! | group | items |
//! |---|---|
//! | formulas | [`Expr`], read from text; [`ExprField`], compiled; [`ExprError`], which points at the place |
//! | solids | [`Sphere`], [`Cuboid`], [`Cylinder`], [`Cone`], [`Torus`], [`Capsule`], [`HalfSpace`], [`Extrusion`]; `MeshDistance` with the feature `mesh` |
//! | of solids | [`Union`], [`Intersection`], [`Difference`], their smooth kinds, [`Offset`], [`Shell`], [`Transformed`] |
//! | materials | [`VolumeFractions`] from weights; [`MaterialRegions`], [`PlacedMaterial`], [`Convolved`] of materials |
//! | all together | [`Design`] |
//!
//! # Conventions
//!
//! Millimetres and radians, `f64`. Distances are negative inside. What is shared is an `Arc`:
//! [`SharedField`], [`SharedMaterial`]. NaN is never hidden: it passes through every operation, a
//! field that may be NaN in a box answers [`Interval::EVERYTHING`](fgm_core::Interval::EVERYTHING)
//! there, and a mixture that depends on it is an error that names the point.
//!
//! The same input gives the same bits: one at a time or many at a time, on every machine. For that
//! elementary functions are the crate's own or `libm`'s, and no multiplication is fused with an
//! addition.
//!
//! # Example
//!
//! A ball of two materials, one turning into the other along x:
//!
//! ```
//! use std::sync::Arc;
//! use fgm_core::{Bounds3, MaterialField, Point3};
//! use fgm_field::{Design, Expr, FractionMode, Geometry, Material, Sphere, VolumeFractions};
//!
//! let weights = [Expr::parse("(x + 10) / 20")?, Expr::parse("1 - (x + 10) / 20")?];
//! let design = Design {
//!     name: "ball".into(),
//!     geometry: Geometry::Field(Arc::new(Sphere { radius: 10.0 })),
//!     materials: ["red", "white"].map(|name| Material { name: name.into(), color: None }).into(),
//!     fractions: Arc::new(VolumeFractions::from_exprs(&weights, None, FractionMode::Probability)?),
//!     bounds: Bounds3::new(Point3::splat(-10.0), Point3::splat(10.0)),
//!     density: None,
//! };
//! let mixture = design.fractions.mixture(Point3::new(5.0, 0.0, 0.0))?;
//! assert_eq!(mixture.fractions(), [0.75, 0.25]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod design;
mod error;
mod expr;
mod expr_field;
mod material;
mod math;
mod sampled;
mod solid;
mod tape;

pub use design::{Design, Geometry, Material, USUAL_DENSITY};
pub use error::FieldError;
pub use expr::{Arity, Expr, ExprError, ExprErrorKind};
pub use expr_field::ExprField;
pub use material::{
    Convolved, FractionMode, MaterialRegions, PlacedMaterial, Region, SharedMaterial,
    VolumeFractions,
};
#[cfg(feature = "mesh")]
pub use solid::MeshDistance;
pub use solid::{
    Capsule, Cone, Cuboid, Cylinder, Difference, Extrusion, HalfSpace, Intersection, Offset,
    Placed, Shell, SmoothDifference, SmoothIntersection, SmoothUnion, Sphere, Torus, Transformed,
    Union,
};

/// A field that several owners and threads share.
pub type SharedField = std::sync::Arc<dyn fgm_core::Field + Send + Sync>;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
