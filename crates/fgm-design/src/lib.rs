//! Graded designs from files: .vcad, STL, OBJ and 3MF to a signed distance and volume fractions.
