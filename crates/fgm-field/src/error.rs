use fgm_core::MAX_MATERIALS;

/// Why a field cannot be made.
///
/// Texts that are no expressions have an error of their own, [`ExprError`](crate::ExprError), with
/// the place in the text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// A design needs 2 to [`MAX_MATERIALS`] materials.
    #[error("{count} materials, where 2 to {MAX_MATERIALS} are possible")]
    MaterialCount {
        /// How many were given.
        count: usize,
    },
    /// A material that is not one of the design's.
    #[error("material {material} of {count}, counted from 0")]
    NoSuchMaterial {
        /// Which.
        material: usize,
        /// How many there are.
        count: usize,
    },
    /// A region whose mixtures have another number of materials than the first region's.
    #[error("region {region} has {found} materials, where the first has {expected}")]
    RegionMaterials {
        /// Which, from 0.
        region: usize,
        /// The first region's.
        expected: usize,
        /// This one's.
        found: usize,
    },
    /// Material regions without any region.
    #[error("no region")]
    NoRegion,
    /// A transform that flattens space or holds NaN.
    #[error("the transform cannot be undone: its determinant is {determinant}")]
    SingularTransform {
        /// The determinant of its linear part.
        determinant: f64,
    },
    /// A kernel without samples, or with more than are possible.
    #[error("a kernel of {count} samples, where 1 to {limit} are possible")]
    KernelSize {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A kernel weight that is negative or not finite, or all of them zero.
    #[error(
        "kernel weight {weight} at sample {sample}; weights are finite, not negative, and not all 0"
    )]
    KernelWeight {
        /// Which, from 0.
        sample: usize,
        /// Its weight.
        weight: f64,
    },
    /// A mesh that has no triangle, or a coordinate or index that is none.
    #[error("no distance to this mesh: {reason}")]
    Mesh {
        /// What is wrong with it.
        reason: &'static str,
    },
}
