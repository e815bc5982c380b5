use super::*;
use proptest::prelude::*;
use std::sync::LazyLock;

fn mixture(weights: &[f64]) -> Mixture {
    Mixture::from_weights(weights).unwrap()
}

/// A band as text: `3`, or `3+4`.
fn told(band: Band) -> String {
    if band.is_pure() {
        return band.first.0.to_string();
    }
    format!("{}+{}", band.first.0, band.second.0)
}

/// Every palette worth trying, without an overlap.
static PALETTES: LazyLock<Vec<Palette>> = LazyLock::new(|| {
    let divided = [(2, 1), (2, 2), (2, 7), (2, 16), (2, 256), (3, 1), (3, 4), (3, 9), (3, 256)];
    let more = [(4, 1), (4, 5), (4, 15), (4, 34), (5, 31), (6, 22), (8, 45)];
    let divided = divided.into_iter().chain(more);
    let divided = divided.filter_map(|(n, colors)| Palette::new(n, colors).ok());
    divided.chain((2..=8).map(|n| Palette::pure(n).unwrap())).collect()
});

#[test]
fn bands_of_two_materials() {
    let plain = || Palette::new(2, 4).unwrap();
    let zipped = plain().with_overlap(0.1).unwrap();
    for (fraction, want, want_zipped) in [
        (0.0, "0", "0"),
        (0.19, "0", "0"),
        (0.21, "0", "0+1"),
        (0.25, "1", "0+1"),
        (0.29, "1", "0+1"),
        (0.31, "1", "1"),
        (0.5, "2", "1+2"),
        (0.99, "3", "3"),
        (1.0, "3", "3"),
    ] {
        let mixture = mixture(&[fraction, 1.0 - fraction]);
        assert_eq!(told(plain().band(&mixture)), want, "{fraction}");
        assert_eq!(told(zipped.band(&mixture)), want_zipped, "{fraction} zipped");
    }
    assert_eq!(plain().levels(0), [0.25, 0.5, 0.75]);
    assert!(plain().levels(1).is_empty() && plain().levels(2).is_empty());
    assert!(plain().state(ColorId(1)).distance(&mixture(&[0.375, 0.625])) < 1e-15);
    assert_eq!(plain().state(ColorId(99)), plain().state(ColorId(3)));
    assert_eq!(plain().half_band(), 0.125);
}

#[test]
fn the_triangle_of_nine() {
    let palette = Palette::new(3, 9).unwrap();
    let thirds = |m: [f64; 3]| m.map(|f| (f * 9.0).round() as i32);
    let states: Vec<_> = (0..9)
        .map(|i| {
            let state = palette.state(ColorId(i));
            thirds([state.fractions()[0], state.fractions()[1], state.fractions()[2]])
        })
        .collect();
    assert_eq!(
        states,
        [
            [1, 1, 7],
            [2, 2, 5],
            [1, 4, 4],
            [2, 5, 2],
            [1, 7, 1],
            [4, 4, 1],
            [5, 2, 2],
            [4, 1, 4],
            [7, 1, 1],
        ]
    );
    for material in 0..3 {
        assert_eq!(palette.levels(material), [1.0 / 3.0, 2.0 / 3.0]);
    }
    // On a common corner of cells, and at the corners of the triangle.
    for weights in [[1.0, 1.0, 1.0], [1.0, 2.0, 0.0], [0.0, 1.0, 2.0]] {
        let state = palette.state(palette.band(&mixture(&weights)).first);
        assert!(state.distance(&mixture(&weights)) <= palette.half_band() + 1e-9);
    }
    assert_eq!(told(palette.band(&mixture(&[0.0, 0.0, 1.0]))), "0");
    assert_eq!(told(palette.band(&mixture(&[1.0, 0.0, 0.0]))), "8");
}

#[test]
fn pure_palettes_take_the_greatest_fraction() {
    let plain = Palette::pure(3).unwrap();
    let zipped = plain.clone().with_overlap(0.1).unwrap();
    for (weights, want, want_zipped) in [
        ([1.0, 0.0, 0.0], "0", "0"),
        ([0.2, 0.2, 0.6], "2", "2"),
        ([0.4, 0.2, 0.4], "0", "0+2"),
        ([0.44, 0.0, 0.56], "2", "2"),
        ([0.46, 0.0, 0.54], "2", "0+2"),
        ([1.0, 1.0, 1.0], "0", "0+1"),
    ] {
        assert_eq!(told(plain.band(&mixture(&weights))), want, "{weights:?}");
        assert_eq!(told(zipped.band(&mixture(&weights))), want_zipped, "{weights:?} zipped");
    }
    assert_eq!(plain.boundaries().len(), 3);
    assert_eq!(plain.boundaries()[0], Boundary::Difference { a: 0, b: 1, by: 0.0 });
    assert_eq!(zipped.boundaries()[1], Boundary::Difference { a: 0, b: 1, by: 0.1 });
    let two = Palette::pure(2).unwrap();
    assert_eq!(two.levels(0), [0.5]);
    assert_eq!(two.state(ColorId(0)).fractions(), [1.0, 0.0]);
}

#[test]
fn what_cannot_be_is_refused() {
    let division = |below, above, materials, colors| {
        Err(PaletteError::Division { materials, colors, below, above })
    };
    for (materials, colors, want) in [
        (0, 4, Err(PaletteError::Materials { count: 0 })),
        (1, 4, Err(PaletteError::Materials { count: 1 })),
        (9, 4, Err(PaletteError::Materials { count: 9 })),
        (2, 0, Err(PaletteError::Colors { colors: 0 })),
        (2, 257, Err(PaletteError::Colors { colors: 257 })),
        (2, 256, Ok(256)),
        (3, 10, division(9, Some(16), 3, 10)),
        (3, 255, division(225, Some(256), 3, 255)),
        (4, 6, division(5, Some(15), 4, 6)),
        (8, 200, division(165, None, 8, 200)),
    ] {
        assert_eq!(Palette::new(materials, colors).map(|p| p.colors()), want);
    }
    assert_eq!(Palette::pure(1).map(|_| ()), Err(PaletteError::Materials { count: 1 }));
    let text = Palette::new(3, 10).unwrap_err().to_string();
    assert!(text.ends_with("the nearest numbers are 9 and 16"), "{text}");

    for (palette, limit) in
        [(Palette::new(2, 4), 0.25), (Palette::new(3, 9), 1.0 / 3.0), (Palette::pure(5), 0.5)]
    {
        let palette = palette.unwrap();
        for overlap in [-0.01, f64::NAN, limit, 1.0, f64::INFINITY] {
            let got = palette.clone().with_overlap(overlap).map(|_| ());
            assert!(
                matches!(got, Err(PaletteError::Overlap { limit: l, .. }) if l == limit),
                "{got:?}"
            );
        }
        assert!(palette.clone().with_overlap(limit * 0.999).is_ok());
        assert_eq!(palette.with_overlap(0.0).unwrap().overlap(), 0.0);
    }
}

#[test]
fn every_colour_is_its_own_and_printed_once() {
    for palette in PALETTES.iter() {
        let ids: Vec<_> = (0..palette.colors() as u16).map(ColorId).collect();
        for overlap in [0.0, 0.2, 0.6].map(|share| share * palette.band_width()) {
            let zipped = palette.clone().with_overlap(overlap).unwrap();
            // A simplex's centroid is nearer to its facets: a wide overlap may reach it.
            if palette.materials() == 2 || overlap < 0.25 * palette.band_width() {
                assert!(ids.iter().all(|&id| zipped.band(&zipped.state(id)) == Band::pure(id)));
            }
        }
        let mut back = palette.order(3);
        back.reverse();
        assert_eq!(palette.order(0), back);
        let mut sorted = back.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, ids);
        // No step leads further than to a cell that touches.
        let states: Vec<_> = back.iter().map(|id| palette.state(*id)).collect();
        let touch = if palette.half_band() >= 0.5 { 1.0 } else { palette.band_width() };
        assert!(states.windows(2).all(|w| w[0].distance(&w[1]) <= touch + 1e-12));
    }
}

#[test]
fn the_edges_of_an_overlap_stand_its_width_apart() {
    for palette in PALETTES.iter() {
        let overlap = palette.band_width() * 0.3;
        let zipped = palette.clone().with_overlap(overlap).unwrap();
        for material in 0..palette.materials() {
            let (plain, zipped) = (palette.levels(material), zipped.levels(material));
            assert_eq!(zipped.len(), 2 * plain.len());
            for (level, edges) in plain.iter().zip(zipped.chunks(2)) {
                assert!((edges[1] - edges[0] - overlap).abs() < 1e-15);
                assert!((edges[0] + edges[1] - 2.0 * level).abs() < 1e-15);
            }
            assert!(zipped.is_sorted());
        }
    }
}

/// On which side of every boundary a mixture lies.
fn sides(palette: &Palette, mixture: &Mixture) -> Vec<bool> {
    let f = mixture.fractions();
    palette
        .boundaries()
        .iter()
        .map(|boundary| match *boundary {
            Boundary::Level { material, value } => f[material] > value,
            Boundary::Difference { a, b, by } => f[a] - f[b] > by,
        })
        .collect()
}

proptest! {
    #[test]
    fn an_overlap_of_the_place_that_is_the_same_everywhere_is_the_palettes_own(
        weights in prop::collection::vec(0.01..1.0f64, 2..5),
        k in 1..5usize, pure: bool, share in 0.0..0.97f64,
    ) {
        let materials = weights.len();
        let plain = if pure {
            Palette::pure(materials).unwrap()
        } else {
            let mut counts = (1..=MAX_COLORS).filter_map(|n| Palette::new(materials, n).ok());
            counts.nth(k).unwrap()
        };
        let overlap = share * plain.band_width();
        let mixture = mixture(&weights);
        let half = |measure| match measure {
            Measure::Fraction { .. } => 0.5 * overlap,
            Measure::Difference { .. } => overlap,
        };
        let found = plain.band_within(&mixture, half);
        prop_assert_eq!(found, plain.clone().with_overlap(overlap).unwrap().band(&mixture));
        // However far is asked for, no more than two colours overlap.
        let wide = plain.band_within(&mixture, |_| f64::INFINITY);
        let most = plain.clone().with_overlap(0.98 * plain.band_width()).unwrap();
        prop_assert_eq!(wide, most.band(&mixture));
    }

    #[test]
    fn mixtures_lie_within_half_a_band_of_their_colour(
        weights in prop::collection::vec(prop_oneof![0.0..1.0f64, Just(0.0), Just(0.5)], 8),
        which in any::<prop::sample::Index>(),
        share in prop_oneof![Just(0.0), 0.0..0.99f64],
    ) {
        let palette = PALETTES[which.index(PALETTES.len())].clone();
        let overlap = share * palette.band_width();
        let palette = palette.with_overlap(overlap).unwrap();
        let Ok(mixture) = Mixture::from_weights(&weights[..palette.materials()]) else {
            return Ok(());
        };
        let band = palette.band(&mixture);
        prop_assert!(band.second.index() < palette.colors());
        let most = if band.is_pure() { 0.0 } else { 2.0 * overlap };
        for id in [band.first, band.second] {
            let distance = palette.state(id).distance(&mixture);
            prop_assert!(distance <= palette.half_band() + most + 1e-9, "{distance} {band:?}");
        }
        if overlap == 0.0 {
            prop_assert!(band.is_pure());
        }
    }

    #[test]
    fn bands_change_at_boundaries_only(
        a in prop::collection::vec(0.0..1.0f64, 8),
        b in prop::collection::vec(0.0..1.0f64, 8),
        near in 0.0..1.0f64,
        which in any::<prop::sample::Index>(),
        share in prop_oneof![Just(0.0), 0.0..0.99f64],
    ) {
        let palette = PALETTES[which.index(PALETTES.len())].clone();
        let overlap = share * palette.band_width();
        let palette = palette.with_overlap(overlap).unwrap();
        let n = palette.materials();
        let towards: Vec<_> = a.iter().zip(&b).map(|(a, b)| a + (b - a) * near * near).collect();
        let (Ok(a), Ok(b)) = (Mixture::from_weights(&a[..n]), Mixture::from_weights(&towards[..n]))
        else {
            return Ok(());
        };
        if sides(&palette, &a) == sides(&palette, &b) {
            prop_assert_eq!(palette.band(&a), palette.band(&b));
        }
    }
}

#[test]
fn the_colours_that_occur_are_ordered_by_least_change() {
    let ids = |numbers: &[u16]| numbers.iter().copied().map(ColorId).collect::<Vec<_>>();
    let two = Palette::new(2, 16).unwrap();
    assert_eq!(two.order_of(&ids(&[9, 3, 3, 12, 40]), 0), ids(&[3, 9, 12]));
    assert_eq!(two.order_of(&ids(&[9, 3, 12]), 1), ids(&[12, 9, 3]));
    let all: Vec<ColorId> = (0..16).map(ColorId).collect();
    for palette in [two, Palette::new(3, 16).unwrap()] {
        assert_eq!(palette.order_of(&all, 4), palette.order(4));
        assert_eq!(palette.order_of(&[], 0), []);
    }
    let mut better = 0;
    for (materials, colors) in [(3, 64), (4, 34), (5, 21)] {
        let palette = Palette::new(materials, colors).unwrap();
        let sum = |order: &[ColorId]| -> f64 {
            order.windows(2).map(|w| palette.state(w[0]).distance(&palette.state(w[1]))).sum()
        };
        for seed in 0..40_u64 {
            let occurs = |i: &u16| (u64::from(*i) * 7919 + seed * 104_729) % 13 < 4;
            let used: Vec<ColorId> = (0..colors as u16).filter(occurs).map(ColorId).collect();
            let order = palette.order_of(&used, 0);
            assert!(sum(&order) <= sum(&used) + 1e-9);
            better += usize::from(sum(&order) < sum(&used) - 1e-9);
            let mut back = palette.order_of(&used, 1);
            back.reverse();
            assert_eq!(order, back);
        }
    }
    assert!(better > 60, "{better}");
}
