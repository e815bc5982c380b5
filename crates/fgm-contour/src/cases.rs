//! The sixteen cases of marching squares.
//!
//! Corners are numbered 0 bottom left, 1 bottom right, 2 top right, 3 top left; edges 0 bottom,
//! 1 right, 2 top, 3 left. Bit `c` of a case says that corner `c` is at the level or above it.
//! Segments run from edge to edge with the lower side on their left.

/// A segment from one edge of a cell to another.
pub(crate) type Link = (u8, u8);

/// The segments of a case. The saddles, 5 and 10, stand here with their centre below the level.
const CASES: [&[Link]; 16] = [
    &[],
    &[(3, 0)],
    &[(0, 1)],
    &[(3, 1)],
    &[(1, 2)],
    &[(3, 0), (1, 2)],
    &[(0, 2)],
    &[(3, 2)],
    &[(2, 3)],
    &[(2, 0)],
    &[(0, 1), (2, 3)],
    &[(2, 1)],
    &[(1, 3)],
    &[(1, 0)],
    &[(0, 3)],
    &[],
];

/// Case 5 with its centre at the level or above: the two low corners are cut off.
const SADDLE_5_ABOVE: &[Link] = &[(1, 0), (3, 2)];
/// Case 10 with its centre at the level or above.
const SADDLE_10_ABOVE: &[Link] = &[(0, 3), (2, 1)];

/// Whether a case has two segments, which the value at the saddle decides between.
pub(crate) fn is_saddle(case: u8) -> bool {
    case == 5 || case == 10
}

/// The segments of a case; `above` says whether the centre of a saddle is at the level or above.
pub(crate) const fn links(case: u8, above: bool) -> &'static [Link] {
    match (case, above) {
        (5, true) => SADDLE_5_ABOVE,
        (10, true) => SADDLE_10_ABOVE,
        _ => CASES[(case & 15) as usize],
    }
}

/// The asymptotic decider: whether the bilinear interpolant of a cell is at `level` or above it
/// where its two asymptotes meet. Corners in the order 0 to 3.
///
/// That value does not depend on the level, so that of two levels the lower is above its saddle
/// where the higher is, rounding or not, and their lines do not cross.
///
/// After Nielson and Hamann, "The asymptotic decider", IEEE Visualization 1991.
pub(crate) fn saddle_is_above(corners: [f64; 4], level: f64) -> bool {
    let [a, b, c, d] = corners;
    let (b, c, d) = (b - a, c - a, d - a);
    // At a saddle the divisor is not 0: a and c are on one side of the level, b and d on the
    // other. The comparison is false for what infinite values give, which separates them.
    a + b * d / (b + d - c) >= level
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edges on which segments start and end. Walking round the cell anticlockwise, the cell
    /// is on the left; a line that enters it with the low side on its left comes in where the
    /// border rises and leaves where it falls.
    fn expected(case: u8) -> (Vec<u8>, Vec<u8>) {
        let above = |corner: u8| case >> (corner % 4) & 1 == 1;
        let crossed =
            |from: bool| (0..4).filter(|&e| above(e) == from && above(e + 1) != from).collect();
        (crossed(false), crossed(true))
    }

    #[test]
    fn every_case_and_saddle_answer_joins_each_crossing_once() {
        for case in 0..16 {
            for above in [false, true] {
                let (mut starts, mut ends): (Vec<u8>, Vec<u8>) =
                    links(case, above).iter().copied().unzip();
                starts.sort_unstable();
                ends.sort_unstable();
                assert_eq!((starts, ends), expected(case), "case {case}, saddle {above}");
            }
        }
    }

    #[test]
    fn a_quarter_turn_turns_the_segments() {
        for case in 0..16_u8 {
            let turned = (case << 1 | case >> 3) & 15;
            for above in [false, true] {
                let mut a: Vec<Link> =
                    links(case, above).iter().map(|l| ((l.0 + 1) % 4, (l.1 + 1) % 4)).collect();
                let mut b = links(turned, above).to_vec();
                a.sort_unstable();
                b.sort_unstable();
                assert_eq!(a, b, "case {case} turned is {turned}");
            }
        }
    }

    #[test]
    fn swapping_above_and_below_reverses_the_segments() {
        for case in 0..16_u8 {
            for above in [false, true] {
                let mut a: Vec<Link> = links(case, above).iter().map(|l| (l.1, l.0)).collect();
                let mut b = links(!case & 15, !above).to_vec();
                a.sort_unstable();
                b.sort_unstable();
                assert_eq!(a, b, "case {case}, saddle {above}");
            }
        }
    }

    #[test]
    fn the_low_side_is_on_the_left_in_every_case() {
        // Edge middles and corners of the unit cell; the left of each segment must hold only low
        // corners next to its ends, the right only high ones.
        let middle = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)];
        let corner = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        for case in 0..16_u8 {
            for above in [false, true] {
                for &(from, to) in links(case, above) {
                    let (p, q): ((f64, f64), (f64, f64)) =
                        (middle[usize::from(from)], middle[usize::from(to)]);
                    for edge in [from, to] {
                        for c in [edge, (edge + 1) % 4] {
                            let r: (f64, f64) = corner[usize::from(c)];
                            let side = (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
                            assert_eq!(side < 0.0, case >> c & 1 == 1, "case {case} {above}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_decider_answers_as_the_bilinear_centre_does() {
        // For equal opposite corners the asymptotes meet in the middle.
        for (high, low, above) in [(3.0, -1.0, true), (1.0, -3.0, false), (1.0, -1.0, true)] {
            assert_eq!(saddle_is_above([high, low, high, low], 0.0), above);
            assert_eq!(saddle_is_above([low, high, low, high], 0.0), above);
        }
        // Not where the average of the corners is: -0.25 here, though the saddle is above.
        assert!(saddle_is_above([1.0, -4.0, 2.5, -0.5], 0.0));
        assert!(!saddle_is_above([f64::INFINITY, -1.0, f64::INFINITY, -1.0], 0.0));
    }
}
