//! Scalar fields in space: expressions compiled to a tape with interval bounds, primitives, CSG, mesh distance, and volume fractions that sum to one.
