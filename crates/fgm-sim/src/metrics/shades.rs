//! Mixtures as colours, and how different they look.

use fgm_core::{MAX_MATERIALS, Mixture};
use palette::{IntoColor, Lab, Srgb, color_difference::Ciede2000, white_point::D65};

/// Steps of the table for two materials: between them colours are interpolated, which is off by
/// less than 1e-4 of a difference that can be seen.
const STEPS: usize = 4096;

/// How mixtures of materials look: their materials' colours, mixed by volume.
#[derive(Clone, Debug)]
pub struct Shades {
    colors: [[f64; 3]; MAX_MATERIALS],
    /// For two materials the colours of evenly spaced mixtures, by the share of the second.
    table: Vec<[f64; 3]>,
}

impl Shades {
    /// From one colour (red, green, blue) a material; materials without one are grey.
    pub fn new(colors: &[[u8; 3]]) -> Self {
        let mut all = [[128.0; 3]; MAX_MATERIALS];
        for (slot, color) in all.iter_mut().zip(colors) {
            *slot = color.map(f64::from);
        }
        let mut shades = Self { colors: all, table: Vec::new() };
        shades.table = (0..=STEPS)
            .map(|i| {
                let share = i as f64 / STEPS as f64;
                shades.lab_of(&[1.0 - share, share])
            })
            .collect();
        shades
    }

    /// Red, green and blue of a mixture.
    pub fn rgb(&self, mixture: &Mixture) -> [u8; 3] {
        self.blend(mixture.fractions()).map(|channel| channel.round() as u8)
    }

    /// CIEDE2000 between two mixtures: 1 is about the least that can be seen.
    ///
    /// ```
    /// use fgm_core::Mixture;
    /// use fgm_sim::Shades;
    /// let shades = Shades::new(&[[0, 0, 0], [255, 255, 255]]);
    /// let (black, white) = (Mixture::pure(0, 2)?, Mixture::pure(1, 2)?);
    /// assert!((shades.difference(&black, &white) - 100.0).abs() < 1e-3);
    /// assert_eq!(shades.difference(&white, &white), 0.0);
    /// # Ok::<(), fgm_core::MixtureError>(())
    /// ```
    #[inline]
    pub fn difference(&self, a: &Mixture, b: &Mixture) -> f64 {
        if a == b {
            return 0.0;
        }
        difference(self.lab(a.fractions()), self.lab(b.fractions()))
    }

    #[inline]
    fn lab(&self, fractions: &[f64]) -> [f64; 3] {
        let two = fractions.len() >= 2 && fractions[2..].iter().all(|f| *f == 0.0);
        if !two {
            return self.lab_of(fractions);
        }
        let at = fractions[1].clamp(0.0, 1.0) * STEPS as f64;
        let below = (at as usize).min(STEPS - 1);
        let (a, b) = (&self.table[below], &self.table[below + 1]);
        std::array::from_fn(|i| a[i] + (b[i] - a[i]) * (at - below as f64))
    }

    fn lab_of(&self, fractions: &[f64]) -> [f64; 3] {
        let [r, g, b] = self.blend(fractions).map(|channel| channel / 255.0);
        let lab: Lab<D65, f64> = Srgb::new(r, g, b).into_color();
        [lab.l, lab.a, lab.b]
    }

    fn blend(&self, fractions: &[f64]) -> [f64; 3] {
        std::array::from_fn(|channel| {
            let parts = self.colors.iter().zip(fractions).map(|(c, f)| c[channel] * f);
            parts.sum::<f64>().clamp(0.0, 255.0)
        })
    }
}

/// CIEDE2000 of two colours of the L*a*b* space.
fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    let lab = |[l, a, b]: [f64; 3]| Lab::<D65, f64>::new(l, a, b);
    lab(a).difference(lab(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sharma, Wu and Dalal, "The CIEDE2000 color-difference formula", table 1.
    const SHARMA: [([f64; 3], [f64; 3], f64); 34] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, 2.8361, -74.0200], [50.0, 0.0, -82.7485], 3.4412),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0009], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0010], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0011], 7.2195),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0012], 7.2195),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0009, -2.4900], 4.8045),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0010, -2.4900], 4.8045),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0011, -2.4900], 4.7461),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.9030),
        ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
        ([50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 3.2972, 0.0], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 3.2592, 0.3350], 1.0000),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864], 1.2630),
        ([61.2901, 3.7196, -5.3901], [61.4292, 2.2480, -4.9620], 1.8731),
        ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901], 1.8645),
        ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
        ([36.4612, 47.8580, 18.3852], [36.2715, 50.5065, 21.2231], 1.4146),
        ([90.8027, -2.0831, 1.4410], [91.1528, -1.6435, 0.0447], 1.4441),
        ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
        ([6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286], 0.6377),
        ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn the_published_differences() {
        for (a, b, expected) in SHARMA {
            let found = difference(a, b);
            assert!((found - expected).abs() < 1e-4, "{a:?} {b:?}: {found} {expected}");
        }
    }

    #[test]
    fn two_materials_by_table_as_directly() {
        let shades = Shades::new(&[[30, 90, 200], [250, 210, 40]]);
        for i in 0..100 {
            let share = (f64::from(i) + 0.37) / 100.0;
            let fractions = [1.0 - share, share];
            assert!(difference(shades.lab(&fractions), shades.lab_of(&fractions)) < 1e-4);
        }
        let even = Mixture::from_weights(&[1.0, 1.0]).unwrap();
        assert_eq!(shades.rgb(&even), [140, 150, 120]);
    }
}
