//! The cells into which the planes `f_i = j / k` cut the mixtures of `n` materials.
//!
//! A mixture `f` lies in the cell of the whole parts `a_i = floor(k f_i)`. They sum to `k - m`,
//! where `m`, the sum of the rests, is 1 to `n - 1`; the cell is a hypersimplex, a triangle for
//! `n = 3`, a tetrahedron (`m` = 1 or 3) or an octahedron (`m` = 2) for `n = 4`. Its centroid is
//! `f_i = (a_i + m / n) / k`. Two cells share a facet where one whole part differs, by 1.

use fgm_core::MAX_MATERIALS;

/// Whole parts, `a_i`; 0 past the materials.
pub(crate) type Cell = [u16; MAX_MATERIALS];

/// How many cells there are: the sum of `C(k - m + n - 1, n - 1)` over the possible `m`.
pub(crate) fn count(materials: usize, k: usize) -> usize {
    (1..materials.min(k + 1)).map(|m| choose(k - m + materials - 1, materials - 1)).sum()
}

fn choose(n: usize, r: usize) -> usize {
    (0..r).fold(1, |product, i| product * (n - i) / (i + 1))
}

/// The sum of the rests, `m`; not in `1..materials` for what is not a cell.
pub(crate) fn rest(cell: &Cell, k: usize) -> i64 {
    k as i64 - cell.iter().map(|&a| i64::from(a)).sum::<i64>()
}

/// Whether such a cell is there.
pub(crate) fn exists(cell: &Cell, materials: usize, k: usize) -> bool {
    (1..materials as i64).contains(&rest(cell, k))
}

/// Every cell, in lexical order.
pub(crate) fn all(materials: usize, k: usize) -> Vec<Cell> {
    let mut cells = Vec::with_capacity(count(materials, k));
    let mut cell = [0; MAX_MATERIALS];
    extend(&mut cell, 0, materials, k, &mut cells);
    cells
}

fn extend(cell: &mut Cell, at: usize, materials: usize, k: usize, cells: &mut Vec<Cell>) {
    if at == materials {
        if exists(cell, materials, k) {
            cells.push(*cell);
        }
        return;
    }
    for a in 0..k - cell[..at].iter().map(|&a| usize::from(a)).sum::<usize>() {
        cell[at] = a as u16;
        extend(cell, at + 1, materials, k, cells);
    }
    cell[at] = 0;
}

/// The centroid, times `k n`, which makes it whole.
pub(crate) fn centroid(cell: &Cell, materials: usize, k: usize) -> [i64; MAX_MATERIALS] {
    let (n, m) = (materials as i64, rest(cell, k));
    std::array::from_fn(|i| if i < materials { n * i64::from(cell[i]) + m } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        for (materials, want) in [
            (2, [1, 2, 3, 4, 5]),
            (3, [1, 4, 9, 16, 25]),
            (4, [1, 5, 15, 34, 65]),
            (8, [1, 9, 45, 165, 495]),
        ] {
            for (k, want) in (1..).zip(want) {
                assert_eq!(count(materials, k), want, "{materials} materials, {k} parts");
                assert_eq!(all(materials, k).len(), want);
            }
        }
    }

    #[test]
    fn a_triangle_of_four() {
        let cells: Vec<_> = all(3, 2).iter().map(|c| [c[0], c[1], c[2]]).collect();
        assert_eq!(cells, [[0, 0, 0], [0, 0, 1], [0, 1, 0], [1, 0, 0]]);
        assert_eq!(centroid(&all(3, 2)[1], 3, 2)[..3], [1, 1, 4]);
    }
}
