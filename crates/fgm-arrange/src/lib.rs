//! Planar arrangements of polylines: noding with snap rounding, half-edges, faces with holes, labels and point location.
