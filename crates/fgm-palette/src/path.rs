//! Print orders of least change: a path that visits every cell once.

use crate::{
    cells::{self, Cell},
    tour,
};

/// Sweeps of improvement over a path; it seldom takes more than a few.
const SWEEPS: usize = 32;

/// Every cell once, in an order that changes the mixture little from one to the next, from the
/// least of material 0 on.
///
/// - 2 materials: along the gradient.
/// - 3 materials: row by row, back and forth. No path of common sides exists for more than one
///   row, since triangles that point one way outnumber the others; this one leaves them only from
///   row to row, `k - 1` times, which is the least possible.
/// - More: the best there is for few cells; else nearest first, then 2-opt and or-opt moves until
///   none shortens it.
pub(crate) fn path(materials: usize, k: usize) -> Vec<Cell> {
    match materials {
        2 => (0..k).map(|a| cell(&[a, k - 1 - a])).collect(),
        3 => snake(k),
        _ => {
            let cells = cells::all(materials, k);
            if cells.len() <= tour::EXACT {
                let step = |a: usize, b: usize| change(&cells[a], &cells[b], materials, k) as f64;
                let order = tour::least_change(cells.len(), step);
                return order.into_iter().map(|i| cells[i]).collect();
            }
            let mut path = nearest_first(cells, materials, k);
            improve(&mut path, materials, k);
            path
        }
    }
}

fn cell(parts: &[usize]) -> Cell {
    std::array::from_fn(|i| parts.get(i).map_or(0, |&a| a as u16))
}

fn snake(k: usize) -> Vec<Cell> {
    let mut path = Vec::with_capacity(k * k);
    for row in 0..k {
        let first = path.len();
        for a in 0..k - row {
            path.push(cell(&[row, a, k - 1 - row - a]));
            if a + 1 < k - row {
                path.push(cell(&[row, a, k - 2 - row - a]));
            }
        }
        if row % 2 == 1 {
            path[first..].reverse();
        }
    }
    path
}

/// The greatest change of a fraction between two cells' centroids, times `k n`.
fn change(a: &Cell, b: &Cell, materials: usize, k: usize) -> i64 {
    let (a, b) = (cells::centroid(a, materials, k), cells::centroid(b, materials, k));
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).max().unwrap_or_default()
}

fn nearest_first(mut left: Vec<Cell>, materials: usize, k: usize) -> Vec<Cell> {
    let mut path = Vec::with_capacity(left.len());
    let mut at = 0;
    while !left.is_empty() {
        let last = left.remove(at);
        path.push(last);
        let near = left.iter().enumerate();
        at = near.min_by_key(|(_, c)| change(&last, c, materials, k)).map_or(0, |(i, _)| i);
    }
    path
}

/// Shortens a path that keeps its first cell.
fn improve(path: &mut [Cell], materials: usize, k: usize) {
    let n = path.len();
    let step = |path: &[Cell], a: usize, b: usize| match (path.get(a), path.get(b)) {
        (Some(a), Some(b)) => change(a, b, materials, k),
        // The path ends freely.
        _ => 0,
    };
    for _ in 0..SWEEPS {
        let mut shorter = false;
        for i in 1..n {
            for j in i + 1..n {
                let now = step(path, i - 1, i) + step(path, j, j + 1);
                if step(path, i - 1, j) + step(path, i, j + 1) < now {
                    path[i..=j].reverse();
                    shorter = true;
                }
            }
            for j in (1..n).filter(|&j| j + 1 < i || j > i + 1) {
                let now = step(path, i - 1, i) + step(path, i, i + 1) + step(path, j - 1, j);
                let then = step(path, i - 1, i + 1) + step(path, j - 1, i) + step(path, i, j);
                if then < now {
                    if j > i {
                        path[i..j].rotate_left(1);
                    } else {
                        path[j..=i].rotate_right(1);
                    }
                    shorter = true;
                }
            }
        }
        if !shorter {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many steps change the mixture by how much, times `k n`.
    fn steps(materials: usize, k: usize) -> Vec<(i64, usize)> {
        let path = path(materials, k);
        let mut all = path.clone();
        all.sort_unstable();
        assert_eq!(all, cells::all(materials, k), "{materials} materials, {k} parts");
        let mut steps: Vec<_> =
            path.windows(2).map(|w| change(&w[0], &w[1], materials, k)).collect();
        steps.sort_unstable();
        let counts = steps.chunk_by(|a, b| a == b).map(|run| (run[0], run.len()));
        counts.collect()
    }

    #[test]
    fn triangles_leave_common_sides_only_between_rows() {
        assert_eq!(steps(3, 1), []);
        for k in 2..=16 {
            assert_eq!(steps(3, k), [(2, k * k - k), (3, k - 1)], "{k} rows");
        }
    }

    #[test]
    fn two_materials_step_by_a_band() {
        assert_eq!(steps(2, 16), [(2, 15)]);
    }

    #[test]
    fn more_materials_seldom_leave_common_facets() {
        for (materials, k) in [(4, 1), (4, 2), (4, 3), (4, 4), (5, 2), (5, 3), (6, 3), (8, 3)] {
            let steps = steps(materials, k);
            let least = materials as i64 - 1;
            // Never further than to a cell that touches.
            assert!(steps.iter().all(|(change, _)| *change <= least + 1), "{steps:?}");
        }
    }
}
