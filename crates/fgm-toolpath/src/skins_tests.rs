use super::*;
use crate::region_shapes::*;
use proptest::prelude::*;

fn areas(s: &Skins) -> [f64; 3] {
    [&s.top, &s.bottom, &s.sparse].map(|r| region::area(r))
}

#[test]
fn neighbours_decide() {
    let here = [rectangle(0.0, 0.0, 10.0, 10.0)];
    let full = [rectangle(-1.0, -1.0, 12.0, 12.0)];
    let half = [rectangle(-1.0, -1.0, 6.0, 12.0)];
    let most = [rectangle(-1.0, -1.0, 10.8, 12.0)];
    let none: [Polygon; 0] = [];
    type Layers<'a> = &'a [&'a [Polygon]];
    let cases: [(&str, Layers<'_>, Layers<'_>, [f64; 3]); 8] = [
        ("inside", &[&full, &full], &[&full, &full], [0.0, 0.0, 100.0]),
        ("top layer", &[&none, &none], &[&full], [100.0, 0.0, 0.0]),
        ("below the top", &[&full, &none], &[&full], [100.0, 0.0, 0.0]),
        ("bottom layer", &[&full], &[&none], [0.0, 100.0, 0.0]),
        ("only layer", &[&none], &[&none], [100.0, 0.0, 0.0]),
        ("step", &[&full, &half], &[&full], [50.0, 0.0, 50.0]),
        ("both", &[&half], &[&half], [50.0, 0.0, 50.0]),
        ("sliver", &[&most], &[], [0.0, 0.0, 100.0]),
    ];
    for (name, above, below, expected) in cases {
        let out = areas(&skins(&here, above, below));
        for (got, want) in out.iter().zip(expected) {
            assert!((got - want).abs() < 1e-2, "{name}: {out:?}");
        }
    }
    assert_eq!(areas(&skins(&here, &[], &[]))[2], 100.0);
    assert_eq!(skins(&[], &[&none], &[&none]), Skins::default());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn skins_share_out_the_inside(
        a in 2.0..9.0f64, b in 2.0..9.0f64, c in 2.0..9.0f64, shift in -4.0..4.0f64, k in 2u32..7,
    ) {
        let disc = |r: f64, x: f64| {
            let wave = move |t: f64| r * (1.0 + 0.2 * (f64::from(k) * t).sin());
            [Polygon::simple(radial(fgm_core::Point2::new(x, 0.0), 90, wave))]
        };
        let (here, above, below) = (disc(a, 0.0), disc(b, shift), disc(c, -shift));
        let out = skins(&here, &[&above], &[&below]);
        let sum: f64 = areas(&out).iter().sum();
        prop_assert!((sum - here[0].area()).abs() < 1e-2, "{} {}", sum, here[0].area());
        for (p, q) in [(&out.top, &out.bottom), (&out.top, &out.sparse), (&out.bottom, &out.sparse)] {
            prop_assert!(region::area(&region::intersection(p, q)) < 1e-3);
        }
        prop_assert!(region::area(&region::intersection(&out.top, &above)) < 1e-3);
    }
}
