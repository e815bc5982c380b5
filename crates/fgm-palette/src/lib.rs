//! Palettes: mixture space divided into colours, with print orders of least change and zipper overlaps.
