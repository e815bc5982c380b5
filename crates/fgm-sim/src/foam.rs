//! Foaming filament: its share of the second material is its temperature.

use fgm_core::Mixture;

/// The mixture at a temperature: linear between all of the first material at `low` and all of the
/// second at `high`, °C.
pub(crate) fn mixture(low: f64, high: f64, celsius: f64) -> Option<Mixture> {
    let span = high - low;
    let share = if span == 0.0 { 0.0 } else { ((celsius - low) / span).clamp(0.0, 1.0) };
    Mixture::from_weights(&[1.0 - share, share]).ok()
}
