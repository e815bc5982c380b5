//! The slicer for graded materials as one library: from a design to G-code, in parallel, streaming, with progress and cancellation.
