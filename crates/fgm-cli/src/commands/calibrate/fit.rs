//! Polynomials by least squares.

/// The coefficients, from the constant up, of the polynomial of a degree that comes nearest to
/// points; none for fewer different places than coefficients.
///
/// The places are scaled to -1 to 1 and the normal equations solved there by elimination with
/// pivots; the result is multiplied out again. At temperatures around 200 the powers themselves
/// would leave no digits.
pub(super) fn polynomial(points: &[(f64, f64)], degree: usize) -> Option<Vec<f64>> {
    let ends = points
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p.0), hi.max(p.0)));
    let mut places: Vec<f64> = points.iter().map(|p| p.0).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    if places.len() <= degree {
        return None;
    }
    let (middle, half) = (0.5 * (ends.0 + ends.1), (0.5 * (ends.1 - ends.0)).max(1e-9));
    let count = degree + 1;
    let mut rows = vec![vec![0.0; count + 1]; count];
    for (x, y) in points {
        let x = (x - middle) / half;
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, cell) in row.iter_mut().enumerate().take(count) {
                *cell += x.powi((i + j) as i32);
            }
            row[count] += y * x.powi(i as i32);
        }
    }
    let scaled = eliminate(rows)?;
    // sum of c_k ((x - m) / h)^k, by Horner on polynomials.
    let mut result = vec![0.0; count];
    for c in scaled.iter().rev() {
        let mut next = vec![0.0; count];
        for (k, r) in result.iter().enumerate() {
            next[k] -= r * middle / half;
            if k + 1 < count {
                next[k + 1] += r / half;
            }
        }
        next[0] += c;
        result = next;
    }
    Some(result)
}

/// Solves rows of a square matrix with its right side.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let count = rows.len();
    for k in 0..count {
        let pivot = (k..count).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-12 {
            return None;
        }
        let (done, left) = rows.split_at_mut(k + 1);
        for row in left {
            let factor = row[k] / done[k][k];
            for (cell, above) in row.iter_mut().zip(&done[k]) {
                *cell -= factor * above;
            }
        }
    }
    let mut result = vec![0.0; count];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| rows[k][j] * result[j]).sum();
        result[k] = (rows[k][count] - known) / rows[k][k];
    }
    Some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_polynomials_come_back() {
        for flow in [
            vec![-77.814, 1.13374, -5.37075e-3, 8.35479e-6],
            vec![15.9560, -1.38401e-1, 3.09637e-4],
            vec![0.75],
        ] {
            let at = |t: f64| flow.iter().rev().fold(0.0, |sum, c| sum * t + c);
            let points: Vec<(f64, f64)> =
                (0..8).map(|i| 190.0 + 5.0 * f64::from(i)).map(|t| (t, at(t))).collect();
            let found = polynomial(&points, flow.len() - 1).unwrap();
            let close = found.iter().zip(&flow).all(|(a, b)| (a - b).abs() < 1e-7 * b.abs());
            assert!(close, "{found:?} {flow:?}");
        }
        assert_eq!(polynomial(&[(190.0, 1.0), (190.0, 0.9)], 1), None);
        assert_eq!(polynomial(&[], 0), None);
    }
}
