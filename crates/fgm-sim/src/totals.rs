use fgm_core::{Bounds3, MAX_MATERIALS, Role};
use fgm_gcode::{Machine, MachineKind, TimeEstimate};
use serde::Serialize;

use crate::{Event, Piece};

/// What a print comes to, counted as it streams by.
///
/// The print is what lies between the beginning of the first layer and the last bead; what a start
/// template purges is counted apart.
#[derive(Clone, Debug)]
pub struct Totals {
    figures: Figures,
    kind: Option<MachineKind>,
    acceleration: [f64; 2],
    swap_seconds: f64,
    time: TimeEstimate,
    head: Option<u16>,
    /// Travels since the last bead: they count once another bead follows.
    pending: Pending,
}

#[derive(Clone, Copy, Debug, Default)]
struct Pending {
    count: u64,
    length: f64,
}

/// The figures of [`Totals`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Layers begun.
    pub layers: u32,
    /// Beads along a line.
    pub beads: u64,
    /// Moves without extrusion.
    pub travels: u64,
    /// Laid down along lines, mm³; foam as it lies there.
    pub extruded_mm3: f64,
    /// Of it, by beads of the part itself.
    pub part_mm3: f64,
    /// Of it, by purge towers.
    pub purge_mm3: f64,
    /// Length of the beads, mm.
    pub extrude_mm: f64,
    /// Length of the moves in the plane without extrusion, mm.
    pub travel_mm: f64,
    /// Filament fed, what is pushed out in place included, mm³.
    pub fed_mm3: f64,
    /// The same for each input: filaments of a mixing machine, heads of a tool changer.
    pub filament_mm3: Vec<f64>,
    /// Filament fed before the first layer, mm³.
    pub start_mm3: f64,
    /// Estimated time, s; of the start what the profile says (`template.start_seconds`).
    pub print_time_s: f64,
    /// Least corner of the beads, on the bed, mm; none without beads.
    pub min_mm: Option<[f64; 3]>,
    /// Greatest corner of the beads.
    pub max_mm: Option<[f64; 3]>,
    #[serde(skip)]
    extents: Bounds3,
}

impl Totals {
    /// Nothing yet; times by the machine's accelerations where it is known.
    pub fn new(machine: Option<&Machine>) -> Self {
        let usual = Machine::default();
        let known = machine.unwrap_or(&usual);
        let mut time = TimeEstimate::new(&known.motion);
        time.dwell(known.template.start_seconds);
        Self {
            figures: Figures::new(),
            kind: machine.map(|m| m.kind),
            acceleration: [known.motion.acceleration, known.motion.travel_acceleration],
            swap_seconds: known.tool_change.seconds,
            time,
            head: None,
            pending: Pending::default(),
        }
    }

    /// Counts what the machine does.
    #[inline]
    pub fn event(&mut self, event: &Event) {
        match event {
            Event::Layer(layer) => self.figures.layers = layer.index.saturating_add(1),
            Event::Bead(bead) if bead.layer.is_some() => {
                let delta = bead.to - bead.from;
                let length = delta.length();
                if length > 0.0 {
                    self.time.push(delta, length / bead.seconds, self.acceleration[0]);
                } else {
                    self.time.dwell(bead.seconds);
                }
                if self.head.replace(bead.head).is_some_and(|was| was != bead.head) {
                    self.time.dwell(self.swap_seconds);
                }
                let pending = std::mem::take(&mut self.pending);
                self.figures.travels += pending.count;
                self.figures.travel_mm += pending.length;
            }
            Event::Travel(travel) if self.figures.layers > 0 => {
                let delta = travel.to - travel.from;
                let speed = delta.length() / travel.seconds;
                if travel.known {
                    self.time.push(delta, speed, self.acceleration[1]);
                }
                let length = travel.length();
                self.pending.count += u64::from(length > 0.0);
                self.pending.length += length;
            }
            Event::Pause { seconds, filament } if self.figures.layers > 0 => {
                if *filament == 0.0 {
                    self.time.dwell(*seconds);
                } else {
                    self.time.push_filament(*filament, filament.abs() / seconds);
                }
            }
            _ => {}
        }
    }

    /// Counts what is laid down.
    #[inline]
    pub fn piece(&mut self, piece: &Piece) {
        let figures = &mut self.figures;
        if piece.layer.is_none() {
            figures.start_mm3 += piece.fed;
            return;
        }
        figures.fed_mm3 += piece.fed;
        count_filament(&mut figures.filament_mm3, self.kind, piece);
        let length = piece.length();
        if length == 0.0 {
            return;
        }
        figures.beads += 1;
        figures.extrude_mm += length;
        figures.extruded_mm3 += piece.volume;
        if piece.is_part() {
            figures.part_mm3 += piece.volume;
        } else if piece.role == Some(Role::PurgeTower) {
            figures.purge_mm3 += piece.volume;
        }
        let extents = &mut figures.extents;
        extents.min = extents.min.min(piece.from.min(piece.to));
        extents.max = extents.max.max(piece.from.max(piece.to));
    }

    /// The figures of what was counted.
    pub fn figures(&self) -> Figures {
        let extents = self.figures.extents;
        let corner = |p: fgm_core::Point3| (!extents.is_empty()).then(|| p.to_array());
        Figures {
            print_time_s: self.time.seconds(),
            min_mm: corner(extents.min),
            max_mm: corner(extents.max),
            ..self.figures.clone()
        }
    }
}

/// Adds a piece's filament to its inputs.
#[inline]
fn count_filament(filament: &mut Vec<f64>, kind: Option<MachineKind>, piece: &Piece) {
    let mixes = match kind {
        Some(kind) => kind == MachineKind::Mixing,
        None => piece.commanded.materials() > 1 && piece.head == 0,
    };
    let heads = if kind == Some(MachineKind::Foaming) { 0 } else { usize::from(piece.head) };
    let inputs = if mixes { piece.commanded.materials().min(MAX_MATERIALS) } else { heads + 1 };
    if filament.len() < inputs {
        filament.resize(inputs, 0.0);
    }
    if mixes {
        for (sum, share) in filament.iter_mut().zip(piece.commanded.fractions()) {
            *sum += piece.fed * share;
        }
    } else {
        filament[heads] += piece.fed;
    }
}

impl Figures {
    fn new() -> Self {
        Self {
            layers: 0,
            beads: 0,
            travels: 0,
            extruded_mm3: 0.0,
            part_mm3: 0.0,
            purge_mm3: 0.0,
            extrude_mm: 0.0,
            travel_mm: 0.0,
            fed_mm3: 0.0,
            filament_mm3: Vec::new(),
            start_mm3: 0.0,
            print_time_s: 0.0,
            min_mm: None,
            max_mm: None,
            extents: Bounds3::EMPTY,
        }
    }
}
