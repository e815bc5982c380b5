use fgm_core::Point3;
use serde::Serialize;

/// Classes of the histogram that the percentile is read from.
const CLASSES: usize = 4096;

/// Errors by how much volume has them, in bounded memory.
///
/// Mean, root mean square and greatest are exact; the percentile is within `range / 4096`.
#[derive(Clone, Debug)]
pub struct Spread {
    range: f64,
    weight: f64,
    sum: f64,
    squares: f64,
    classes: Vec<f64>,
    worst: Option<Worst>,
}

/// The greatest error, and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// The error.
    pub error: f64,
    /// The line of the file, from 1.
    pub line: u64,
    /// The layer, from 1.
    pub layer: u32,
    /// Where, in the design's coordinates, mm.
    pub at: [f64; 3],
}

/// The figures of a [`Spread`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SpreadFigures {
    /// Mean error.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// What 95 % of the volume do not exceed.
    pub percentile_95: f64,
    /// The greatest error with its place; none without samples.
    pub worst: Option<Worst>,
}

impl Spread {
    /// Errors of 0 to `range`; greater ones count as that for the percentile.
    pub fn new(range: f64) -> Self {
        let classes = vec![0.0; CLASSES];
        Self { range, weight: 0.0, sum: 0.0, squares: 0.0, classes, worst: None }
    }

    /// Adds an error that a volume has. What is no number, or has no volume, is left out.
    #[inline]
    pub fn add(&mut self, error: f64, volume: f64, line: u64, layer: u32, at: Point3) {
        if !(volume > 0.0 && error.is_finite()) {
            return;
        }
        self.weight += volume;
        self.sum += volume * error;
        self.squares += volume * error * error;
        let class = (error / self.range * CLASSES as f64) as usize;
        self.classes[class.min(CLASSES - 1)] += volume;
        if self.worst.is_none_or(|worst| error > worst.error) {
            let at = at.to_array();
            self.worst = Some(Worst { error, line, layer: layer.saturating_add(1), at });
        }
    }

    /// The figures so far; all 0 without samples.
    pub fn figures(&self) -> SpreadFigures {
        if self.weight == 0.0 {
            return SpreadFigures::default();
        }
        SpreadFigures {
            mean: self.sum / self.weight,
            rms: (self.squares / self.weight).sqrt(),
            percentile_95: self.percentile(0.95),
            worst: self.worst,
        }
    }

    /// The error that a share of the volume does not exceed.
    pub fn percentile(&self, share: f64) -> f64 {
        let mut left = share * self.weight;
        for (class, volume) in self.classes.iter().enumerate() {
            left -= volume;
            if left <= 0.0 {
                let greatest = self.worst.map_or(0.0, |worst| worst.error);
                return ((class + 1) as f64 / CLASSES as f64 * self.range).min(greatest);
            }
        }
        self.worst.map_or(0.0, |worst| worst.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_sorting(errors in prop::collection::vec((0.0..1.2f64, 0.0..3.0f64), 1..200)) {
            let mut spread = Spread::new(1.0);
            for (i, (error, volume)) in errors.iter().enumerate() {
                spread.add(*error, *volume, i as u64, 0, Point3::ZERO);
            }
            let figures = spread.figures();
            let volume: f64 = errors.iter().map(|e| e.1).sum();
            let mean = errors.iter().map(|e| e.0 * e.1).sum::<f64>() / volume;
            prop_assert!((figures.mean - mean).abs() < 1e-9);
            let mut sorted = errors.clone();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut left = 0.95 * volume;
            let exact = sorted.iter().find(|e| { left -= e.1; left <= 1e-12 }).unwrap().0.min(1.0);
            prop_assert!((figures.percentile_95 - exact).abs() < 1.1 / CLASSES as f64 + 1e-9
                || exact == 1.0, "{} {}", figures.percentile_95, exact);
            let worst = errors.iter().filter(|e| e.1 > 0.0).fold(0.0, |m, e| f64::max(m, e.0));
            prop_assert_eq!(figures.worst.map_or(0.0, |w| w.error), worst);
        }
    }

    #[test]
    fn nothing_and_no_numbers() {
        let mut spread = Spread::new(1.0);
        spread.add(f64::NAN, 1.0, 1, 0, Point3::ZERO);
        spread.add(0.5, 0.0, 1, 0, Point3::ZERO);
        assert_eq!(spread.figures(), SpreadFigures::default());
    }
}
