use std::collections::VecDeque;

use fgm_core::{Bounds3, Mixture, Role};
use fgm_gcode::{DialectName, Line, Machine, MachineKind};

use super::{ReplayOptions, heads::Heads, motors::Motors, place::Place, tags, tags::Tag};
use crate::{Event, FaultKind, Faults, Layer};

/// Filament of a machine that is not known, mm.
const USUAL_DIAMETER: f64 = 1.75;
/// Least temperature for extrusion of a machine that is not known, °C.
const USUAL_LEAST: f64 = 170.0;
/// Beads this much higher than those before begin a layer where no tags do, mm.
const RISE: f64 = 1e-3;

/// What a firmware remembers from line to line: the part of a [`Replay`](crate::Replay) that
/// needs no file.
///
/// Lines go in, [`Event`]s come out.
#[derive(Clone, Debug)]
pub struct Follower {
    pub(super) machine: Known,
    pub(super) place: Place,
    pub(super) motors: Motors,
    pub(super) heads: Heads,
    pub(super) bead: BeadTags,
    pub(super) layers: Layers,
    pub(super) faults: Faults,
    pub(super) line: u64,
    /// `M220`.
    pub(super) speed_factor: f64,
    /// `M302` lets the machine extrude cold.
    pub(super) cold_allowed: bool,
    pub(super) arc_tolerance: f64,
    /// Section of the filament, mm²; 1 where E is a volume.
    pub(super) area: f64,
    changes: Changes,
    pub(super) out: VecDeque<Event>,
}

/// What is needed of the machine.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub(super) kind: Option<MachineKind>,
    pub(super) dialect: Option<DialectName>,
    pub(super) bed: Option<Bounds3>,
    pub(super) least_celsius: f64,
    pub(super) max_bead_area: Option<f64>,
    pub(super) filament_area: f64,
    /// Temperatures of the first and the second material of a foaming filament, °C.
    foaming: Option<(f64, f64)>,
    /// What `G10` pulls back, mm, and how fast, mm/s.
    pub(super) retraction: (f64, f64),
}

/// What the comments say of the beads after them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BeadTags {
    pub(super) role: Option<Role>,
    pub(super) width: Option<f64>,
    pub(super) height: Option<f64>,
}

/// Which layer it is.
#[derive(Clone, Debug, Default)]
pub(super) struct Layers {
    pub(super) now: Option<u32>,
    /// Layers begin at tags only.
    tagged: bool,
    /// A tag was seen whose layer has not been told yet.
    pending: bool,
    z: Option<f64>,
    /// Height of the beads of this layer and of the one below, mm.
    top: Option<f64>,
    below: f64,
}

/// How often the state changed since the print began.
#[derive(Clone, Copy, Debug, Default)]
struct Changes {
    /// By the comments, where there are any.
    tagged: Option<u64>,
    color: Option<u32>,
    /// By what differs from bead to bead.
    seen: u64,
    last: Option<(u16, Mixture)>,
}

impl Follower {
    /// Nothing done yet.
    pub fn new(options: &ReplayOptions) -> Self {
        let machine = options.machine.as_ref();
        let known = Known::new(machine);
        Self {
            place: Place::new(known.bed.as_ref()),
            motors: Motors::new(machine),
            heads: Heads::new(),
            bead: BeadTags::default(),
            layers: Layers { tagged: options.tagged_layers, ..Layers::default() },
            faults: Faults::new(options.faults),
            line: 0,
            speed_factor: 1.0,
            cold_allowed: false,
            arc_tolerance: options.arc_tolerance.clamp(1e-4, 1.0),
            area: known.filament_area,
            changes: Changes::default(),
            out: VecDeque::new(),
            machine: known,
        }
    }

    /// Follows a line.
    #[inline]
    pub fn line(&mut self, line: &Line<'_>) {
        self.line += 1;
        if let Some(command) = &line.command {
            self.command(command);
        } else if let Some(tag) = line.comment.and_then(tags::read) {
            self.tag(tag);
        }
    }

    /// What a line brought about, in order; none when everything was given out.
    #[inline]
    pub fn next_event(&mut self) -> Option<Event> {
        self.out.pop_front()
    }

    /// What was wrong so far.
    pub fn faults(&self) -> &Faults {
        &self.faults
    }

    /// Changes of colour since the first one: by `;COLOR:` comments where there are any, else by
    /// the head or mixture in which bead follows bead, from the first layer on.
    pub fn changes(&self) -> u64 {
        self.changes.tagged.unwrap_or(self.changes.seen)
    }

    /// Says that line `line` is the next one's predecessor, where lines were read elsewhere.
    pub fn skip_to(&mut self, line: u64) {
        self.line = line;
    }

    fn tag(&mut self, tag: Tag) {
        match tag {
            Tag::Layer => {
                self.layers.tagged = true;
                self.layers.pending = true;
                (self.layers.z, self.bead.height) = (None, None);
            }
            Tag::Z(z) => self.layers.z = Some(z),
            Tag::Height(height) => self.bead.height = Some(height),
            Tag::Width(width) => self.bead.width = Some(width),
            Tag::Role(role) => self.bead.role = role,
            Tag::Color(index, mixture) => {
                self.motors.name(mixture);
                let changed = self.changes.color.replace(index).is_some_and(|was| was != index);
                *self.changes.tagged.get_or_insert(0) += u64::from(changed);
            }
        }
    }

    /// Tells a layer that has begun before anything is done in it.
    #[inline]
    pub(super) fn begin_layer(&mut self) {
        if !self.layers.pending {
            return;
        }
        self.layers.pending = false;
        let index = self.layers.now.map_or(0, |now| now.saturating_add(1));
        self.layers.now = Some(index);
        let (z, height) = (self.layers.z, self.bead.height);
        self.layers.rise(z);
        self.out.push_back(Event::Layer(Layer { index, z, height }));
    }

    /// The layer's height for a bead at `z`, which may begin a layer.
    #[inline]
    pub(super) fn bead_height(&mut self, z: f64) -> f64 {
        let layers = &mut self.layers;
        if !layers.tagged && layers.top.is_none_or(|top| z > top + RISE) {
            let index = layers.now.map_or(0, |now| now.saturating_add(1));
            layers.now = Some(index);
            layers.rise(Some(z));
            self.out.push_back(Event::Layer(Layer { index, z: Some(z), height: None }));
        } else if layers.top.is_none() && layers.now.is_some() {
            layers.rise(Some(z));
        }
        let layers = &self.layers;
        let rise = || layers.top.map_or(z, |top| top - layers.below).max(1e-3);
        self.bead.height.unwrap_or_else(rise)
    }

    /// Counts the change between a bead and the one before it.
    #[inline]
    pub(super) fn count_change(&mut self, head: u16, mixture: &Mixture) {
        if self.layers.now.is_none() || self.changes.last == Some((head, *mixture)) {
            return;
        }
        let first = self.changes.last.replace((head, *mixture)).is_none();
        self.changes.seen += u64::from(!first);
    }

    /// The mixture that is commanded; a foaming filament's is its temperature.
    #[inline]
    pub(super) fn mixture(&mut self) -> Option<Mixture> {
        match self.machine.foaming {
            None => self.motors.mixture(),
            Some(_) => {
                let celsius = self.heads.now().celsius;
                self.machine.foamed(celsius.unwrap_or(0.0))
            }
        }
    }

    pub(super) fn fault(&mut self, kind: FaultKind, message: impl FnOnce() -> String) {
        self.faults.add(kind, self.line, message);
    }
}

impl Layers {
    /// The tops of the beads lie higher from here on.
    fn rise(&mut self, z: Option<f64>) {
        if let Some(top) = self.top.take() {
            self.below = top;
        }
        self.top = z;
    }
}

impl Known {
    fn new(machine: Option<&Machine>) -> Self {
        let usual = std::f64::consts::FRAC_PI_4 * USUAL_DIAMETER * USUAL_DIAMETER;
        let foams = machine.filter(|m| m.kind == MachineKind::Foaming);
        Self {
            kind: machine.map(|m| m.kind),
            dialect: machine.map(|m| m.dialect.name),
            bed: machine.map(|m| m.bed.bounds()),
            least_celsius: machine.map_or(USUAL_LEAST, |m| m.temperature.min_extrusion),
            max_bead_area: machine.and_then(|m| m.max_bead_area),
            filament_area: machine.map_or(usual, |m| m.filament_area() / m.feed_factor()),
            foaming: foams.map(|m| (m.foaming.low, m.foaming.high)),
            retraction: machine.map_or((1.0, 35.0), |m| (m.retraction.length, m.retraction.speed)),
        }
    }

    /// The mixture of a foaming filament at a temperature.
    fn foamed(&self, celsius: f64) -> Option<Mixture> {
        let (low, high) = self.foaming?;
        crate::foam::mixture(low, high, celsius)
    }

    /// Whether `T<n>` picks another head, not a mixture of the same one.
    pub(super) fn has_heads(&self) -> bool {
        self.kind.is_none_or(|kind| kind == MachineKind::ToolChanger)
    }
}
