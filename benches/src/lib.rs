//! Benchmarks of the fgm workspace; see the files beside.
