//! Solids: primitives, combinations, transforms.

mod csg;
mod extrusion;
#[cfg(feature = "mesh")]
mod mesh;
mod primitives;
pub(crate) mod transform;

pub use csg::{
    Difference, Intersection, Offset, Shell, SmoothDifference, SmoothIntersection, SmoothUnion,
    Union,
};
pub use extrusion::Extrusion;
#[cfg(feature = "mesh")]
pub use mesh::MeshDistance;
pub use primitives::{Capsule, Cone, Cuboid, Cylinder, HalfSpace, Sphere, Torus};
pub use transform::{Placed, Transformed};
