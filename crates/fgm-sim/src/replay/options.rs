use fgm_gcode::Machine;

/// How G-code is followed.
#[derive(Clone, Debug)]
pub struct ReplayOptions {
    /// The machine that the G-code is for. Where it is not known there is no bed to leave, any
    /// command for a mixture is understood, and `T` picks a head.
    pub machine: Option<Machine>,
    /// Arcs become chords that stay this close to them, mm.
    pub arc_tolerance: f64,
    /// Whether layers begin at tags only, not at greater heights; set for G-code whose slicer is
    /// known to write them.
    pub tagged_layers: bool,
    /// So many faults of each kind are kept with their lines.
    pub faults: usize,
}

impl Default for ReplayOptions {
    fn default() -> Self {
        Self { machine: None, arc_tolerance: 0.005, tagged_layers: false, faults: 10 }
    }
}
