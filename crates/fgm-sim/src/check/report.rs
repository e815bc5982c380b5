use serde::Serialize;

use crate::{Fault, FaultKind, FidelityFigures, Figures, LayerFigures};

/// What a check found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// Lines of the file.
    pub lines: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// The model of the machine in words.
    pub model: String,
    /// What is wrong, counted.
    pub fault_count: u64,
    /// The same by kind, those that occur.
    pub fault_kinds: Vec<(FaultKind, u64)>,
    /// The first of each kind.
    pub faults: Vec<Fault>,
    /// Changes of colour after the first one.
    pub state_changes: u64,
    /// Totals of the print.
    pub totals: Figures,
    /// Mass of the filament fed, g, the start's included.
    pub mass_g: f64,
    /// Mass of what purge towers and the start take, g.
    pub purge_g: f64,
    /// The composition against the design's; none without a design.
    pub fidelity: Option<FidelityFigures>,
    /// Coverage over all measured layers; none where it was not measured.
    pub coverage: Option<CoverageFigures>,
    /// Coverage of each measured layer.
    pub layers: Vec<LayerFigures>,
}

/// Coverage over several layers, weighed by area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CoverageFigures {
    /// Layers measured.
    pub layers: usize,
    /// Share of the covered area which more than one pass covers.
    pub overlap: f64,
    /// Share of the design's area that is covered; none without a design.
    pub coverage: Option<f64>,
    /// Covered area outside the design, as a share of the design's.
    pub outside: Option<f64>,
    /// Volume laid down, as a share of the design's.
    pub filled: Option<f64>,
    /// Volume of the design in the measured layers: area times height, mm³.
    pub design_mm3: Option<f64>,
    /// The measured layer with the least coverage, from 1.
    pub least_covered: Option<u32>,
}

impl CoverageFigures {
    /// Over some layers; none where there are none.
    pub fn over(layers: &[LayerFigures]) -> Option<Self> {
        if layers.is_empty() {
            return None;
        }
        let sum = |value: &dyn Fn(&LayerFigures) -> f64| layers.iter().map(value).sum::<f64>();
        let covered = sum(&|l| l.covered_mm2);
        let designed = layers.iter().all(|l| l.design_mm2.is_some());
        let area = |l: &LayerFigures| l.design_mm2.unwrap_or(0.0);
        let whole = sum(&area);
        let volume = sum(&|l| area(l) * l.height);
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let by_area = |value: fn(&LayerFigures) -> Option<f64>| {
            designed.then(|| share(sum(&|l| value(l).unwrap_or(0.0) * area(l)), whole))
        };
        let least = layers.iter().filter(|l| area(l) > 0.0).min_by(|a, b| {
            let of = |l: &LayerFigures| l.coverage.unwrap_or(1.0);
            of(a).total_cmp(&of(b))
        });
        Some(Self {
            layers: layers.len(),
            overlap: share(sum(&|l| l.overlap * l.covered_mm2), covered),
            coverage: by_area(|l| l.coverage),
            outside: by_area(|l| l.outside),
            filled: designed.then(|| share(sum(&|l| l.volume_mm3), volume)),
            design_mm3: designed.then_some(volume),
            least_covered: least.map(|l| l.layer),
        })
    }
}
