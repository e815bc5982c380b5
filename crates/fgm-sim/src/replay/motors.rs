//! Which motors turn with the flow, and how much: mixtures, virtual tools, heads.

use fgm_core::{MAX_MATERIALS, Mixture};
use fgm_gcode::{Command, DialectName, Machine, MachineKind};

/// Motors that a head may have: eight filaments and what turns before them.
const MOTORS: usize = 16;
/// Virtual tools and heads that are told apart.
const TOOLS: usize = 256;

/// One weight a motor, and how many were given.
#[derive(Clone, Copy, Debug, Default)]
struct Weights {
    values: [f64; MOTORS],
    count: usize,
}

impl Weights {
    fn set(&mut self, motor: usize, weight: f64) -> Option<()> {
        *self.values.get_mut(motor)? = weight;
        self.count = self.count.max(motor + 1);
        Some(())
    }

    /// From `0.25:0.75`.
    fn list(text: &[u8]) -> Option<Self> {
        let mut weights = Self::default();
        for (motor, word) in text.split(|&b| b == b':').enumerate() {
            let value: f64 = std::str::from_utf8(word.trim_ascii()).ok()?.parse().ok()?;
            if !(value.is_finite() && value >= 0.0) {
                return None;
            }
            weights.set(motor, value)?;
        }
        Some(weights)
    }
}

/// A command told something that makes no sense.
pub(super) struct BadWeights;

/// What the machine is told about its mixture.
#[derive(Clone, Debug)]
pub(super) struct Motors {
    kind: Option<MachineKind>,
    /// Motors that turn with every flow, before the filaments'.
    leading: usize,
    /// Filaments or heads; 0 where the machine is not known.
    inputs: usize,
    /// Repetier takes a weight at once, the others when it is committed.
    immediate: bool,
    staged: Weights,
    tools: Vec<Option<Weights>>,
    active: usize,
    /// The mixture of each head of a tool changer, as the comments tell it.
    heads: Vec<Option<Mixture>>,
    /// The mixture that the last comment named.
    named: Option<Mixture>,
    current: Option<Mixture>,
}

impl Motors {
    pub(super) fn new(machine: Option<&Machine>) -> Self {
        let mut motors = Self {
            kind: machine.map(|m| m.kind),
            leading: machine.map_or(0, |m| m.dialect.leading_weights.len()),
            inputs: machine.map_or(0, |m| m.inputs),
            immediate: machine.is_some_and(|m| m.dialect.name == DialectName::Repetier),
            staged: Weights::default(),
            tools: vec![None; 1],
            active: 0,
            heads: Vec::new(),
            named: None,
            current: None,
        };
        motors.update();
        motors
    }

    /// What is commanded; none where no motor would turn.
    #[inline]
    pub(super) fn mixture(&self) -> Option<Mixture> {
        self.current
    }

    /// A comment names the mixture of the command after it.
    pub(super) fn name(&mut self, mixture: Option<Mixture>) {
        self.named = mixture;
    }

    /// `T<n>`.
    pub(super) fn select(&mut self, tool: u32) {
        self.active = (tool as usize).min(TOOLS - 1);
        if self.heads.len() <= self.active {
            self.heads.resize(self.active + 1, None);
        }
        if let Some(named) = self.named.take() {
            self.heads[self.active] = Some(named);
        }
        self.update();
    }

    /// `M163 S<motor> P<weight>`.
    pub(super) fn stage(&mut self, command: &Command<'_>) -> Result<(), BadWeights> {
        let motor = command.value(b'S').unwrap_or(0.0);
        let weight = command.value(b'P').unwrap_or(0.0);
        if !(weight.is_finite() && weight >= 0.0 && (0.0..MOTORS as f64).contains(&motor)) {
            return Err(BadWeights);
        }
        self.staged.set(motor as usize, weight).ok_or(BadWeights)?;
        if self.immediate {
            self.commit(self.active, self.staged);
        }
        Ok(())
    }

    /// `M164 S<tool>`.
    pub(super) fn store(&mut self, command: &Command<'_>) -> Result<(), BadWeights> {
        let tool = self.tool(command.value(b'S'))?;
        self.commit(tool, self.staged);
        Ok(())
    }

    /// `M165 A<weight> B<weight> ...`: letters left out count as 0.
    pub(super) fn direct(&mut self, command: &Command<'_>) -> Result<(), BadWeights> {
        let mut weights = Weights { count: self.leading + self.inputs, ..Weights::default() };
        for word in command.words() {
            let Some(motor) = b"ABCDHI".iter().position(|l| *l == word.letter) else { continue };
            let weight = word.value.filter(|w| w.is_finite() && *w >= 0.0).ok_or(BadWeights)?;
            weights.set(motor, weight).ok_or(BadWeights)?;
        }
        self.commit(self.active, weights);
        Ok(())
    }

    /// `M567 P<tool> E<a:b:c>`.
    pub(super) fn ratios(&mut self, command: &Command<'_>) -> Result<(), BadWeights> {
        let tool = self.tool(command.value(b'P'))?;
        let list = command.arguments.iter().position(|b| b.eq_ignore_ascii_case(&b'E'));
        let Some(list) = list else { return Ok(()) };
        let text = &command.arguments[list + 1..];
        let end = text.iter().position(u8::is_ascii_alphabetic).unwrap_or(text.len());
        let weights = Weights::list(text[..end].trim_ascii()).ok_or(BadWeights)?;
        self.commit(tool, weights);
        Ok(())
    }

    /// `SET_MIXING_EXTRUDER FACTORS=a:b:c`.
    pub(super) fn factors(&mut self, command: &Command<'_>) -> Result<(), BadWeights> {
        let Some(text) = command.named_value("FACTORS") else { return Ok(()) };
        self.commit(self.active, Weights::list(text).ok_or(BadWeights)?);
        Ok(())
    }

    fn tool(&self, value: Option<f64>) -> Result<usize, BadWeights> {
        let tool = value.unwrap_or(self.active as f64);
        if (0.0..TOOLS as f64).contains(&tool) { Ok(tool as usize) } else { Err(BadWeights) }
    }

    fn commit(&mut self, tool: usize, weights: Weights) {
        if self.tools.len() <= tool {
            self.tools.resize(tool + 1, None);
        }
        self.tools[tool] = Some(weights);
        self.update();
    }

    /// Works out the mixture that is commanded now.
    fn update(&mut self) {
        let mixes = match self.kind {
            Some(kind) => kind == MachineKind::Mixing,
            // An unknown machine mixes once it is told a mixture.
            None => self.tools.iter().any(Option::is_some),
        };
        if mixes {
            let inputs = self.inputs.min(MAX_MATERIALS);
            self.current = match self.tools.get(self.active).copied().flatten() {
                None => Mixture::pure(0, inputs.max(1)).ok(),
                Some(weights) => {
                    let count =
                        if inputs > 0 { inputs } else { weights.count.clamp(1, MAX_MATERIALS) };
                    let filaments = weights.values.get(self.leading..self.leading + count);
                    filaments.and_then(|w| Mixture::from_weights(w).ok())
                }
            };
            return;
        }
        let named = self.heads.get(self.active).copied().flatten();
        let heads = self.inputs.max(self.active + 1).clamp(1, MAX_MATERIALS);
        self.current = named.or_else(|| Mixture::pure(self.active.min(heads - 1), heads).ok());
    }
}
