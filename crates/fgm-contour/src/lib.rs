//! Contours of planar fields, grids and triangle meshes: rings and polylines, on the true curve, with sharp corners.
