//! Orders of least change for a few of a palette's colours.

/// Up to so many, the order is the best there is (Held and Karp, 1962): `2^n n²` steps.
pub(crate) const EXACT: usize = 10;
/// Sweeps of improvement over an order; it seldom takes more than a few.
const SWEEPS: usize = 32;
/// Smaller gains are rounding.
const LEAST_GAIN: f64 = 1e-12;

/// The numbers 0 to before `count` in an order in which the sum of the changes from each to the next
/// is least, for up to [`EXACT`] of them; for more, one that no turn of a stretch and no move of one
/// number shortens. Of equal ones, one near the order of the numbers; it begins with the lesser of
/// its ends.
pub(crate) fn least_change(count: usize, change: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    let length = |order: &[usize]| order.windows(2).map(|w| change(w[0], w[1])).sum::<f64>();
    if count <= EXACT {
        let best = exact(count, &change);
        // The order of the numbers is kept where none is better.
        if length(&best) < length(&order) - LEAST_GAIN {
            order = best;
        }
    } else {
        improve(&mut order, &change);
    }
    if order.first() > order.last() {
        order.reverse();
    }
    order
}

/// The order of least sum, by the least sum over every set of numbers that ends with each of them.
fn exact(count: usize, change: &impl Fn(usize, usize) -> f64) -> Vec<usize> {
    if count == 0 {
        return Vec::new();
    }
    let all = (1_usize << count) - 1;
    let at = |set: usize, last: usize| set * count + last;
    let mut least = vec![f64::INFINITY; (all + 1) * count];
    let mut before = vec![0_u8; (all + 1) * count];
    for last in 0..count {
        least[at(1 << last, last)] = 0.0;
    }
    for set in 1..=all {
        for last in (0..count).filter(|last| set >> last & 1 == 1) {
            let so_far = least[at(set, last)];
            for next in (0..count).filter(|next| set >> next & 1 == 0) {
                let to = at(set | 1 << next, next);
                let sum = so_far + change(last, next);
                if sum < least[to] {
                    (least[to], before[to]) = (sum, last as u8);
                }
            }
        }
    }
    let ends = (0..count).min_by(|&a, &b| least[at(all, a)].total_cmp(&least[at(all, b)]));
    let (mut set, mut last) = (all, ends.unwrap_or(0));
    let mut order = Vec::with_capacity(count);
    loop {
        order.push(last);
        let next = usize::from(before[at(set, last)]);
        set &= !(1 << last);
        if set == 0 {
            return order;
        }
        last = next;
    }
}

/// Shortens an order whose ends are free by 2-opt and or-opt moves until none gains.
fn improve(order: &mut [usize], change: &impl Fn(usize, usize) -> f64) {
    let n = order.len();
    let step = |order: &[usize], a: Option<usize>, b: usize| {
        let ends = a.and_then(|a| order.get(a)).zip(order.get(b));
        ends.map_or(0.0, |(a, b)| change(*a, *b))
    };
    for _ in 0..SWEEPS {
        let mut shorter = false;
        for i in 0..n {
            for j in i + 1..n {
                let before = i.checked_sub(1);
                let now = step(order, before, i) + step(order, Some(j), j + 1);
                let then = step(order, before, j) + step(order, Some(i), j + 1);
                if then < now - LEAST_GAIN {
                    order[i..=j].reverse();
                    shorter = true;
                }
            }
            for j in (0..=n).filter(|&j| j < i || j > i + 1) {
                let (before, left) = (i.checked_sub(1), j.checked_sub(1));
                let now =
                    step(order, before, i) + step(order, Some(i), i + 1) + step(order, left, j);
                let then =
                    step(order, before, i + 1) + step(order, left, i) + step(order, Some(i), j);
                if then < now - LEAST_GAIN {
                    if j > i {
                        order[i..j].rotate_left(1);
                    } else {
                        order[j..=i].rotate_right(1);
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
    use proptest::prelude::*;

    fn sum(order: &[usize], points: &[(f64, f64)]) -> f64 {
        order.windows(2).map(|w| distance(points, w[0], w[1])).sum()
    }

    fn distance(points: &[(f64, f64)], a: usize, b: usize) -> f64 {
        (points[a].0 - points[b].0).abs().max((points[a].1 - points[b].1).abs())
    }

    fn each_order(order: &mut [usize], from: usize, see: &mut dyn FnMut(&[usize])) {
        if from == order.len() {
            return see(order);
        }
        for i in from..order.len() {
            order.swap(from, i);
            each_order(order, from + 1, see);
            order.swap(from, i);
        }
    }

    fn points(most: usize) -> impl Strategy<Value = Vec<(f64, f64)>> {
        prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 0..most)
    }

    proptest! {
        #[test]
        fn a_few_come_in_the_best_order(points in points(7)) {
            let found = least_change(points.len(), |a, b| distance(&points, a, b));
            let mut least = f64::INFINITY;
            let mut order: Vec<usize> = (0..points.len()).collect();
            each_order(&mut order, 0, &mut |order| least = least.min(sum(order, &points)));
            prop_assert!(sum(&found, &points) <= least + 1e-9);
            prop_assert!(found.first() <= found.last());
        }

        #[test]
        fn many_come_in_a_better_order(points in points(40)) {
            let found = least_change(points.len(), |a, b| distance(&points, a, b));
            let given: Vec<usize> = (0..points.len()).collect();
            prop_assert!(sum(&found, &points) <= sum(&given, &points) + 1e-9);
            let mut sorted = found;
            sorted.sort_unstable();
            prop_assert_eq!(sorted, given);
        }
    }

    #[test]
    fn what_is_in_order_stays() {
        for count in [0, 1, 2, 9, 10, 11, 30] {
            let along = |a: usize, b: usize| (a as f64 - b as f64).abs();
            assert!(least_change(count, along).into_iter().eq(0..count), "{count}");
            assert!(least_change(count, |_, _| 1.0).into_iter().eq(0..count), "{count}");
        }
    }
}
