//! G-code for graded parts: dialects, machines, look-ahead for dead volume, a fast writer and a reader.
