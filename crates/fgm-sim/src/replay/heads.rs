//! What each head is told and how much of its filament is pulled back.

/// Heads that are told apart.
const HEADS: usize = 256;

/// One head.
#[derive(Clone, Copy, Debug)]
pub(super) struct Head {
    /// The temperature it is told, °C; none before the first command.
    pub(super) celsius: Option<f64>,
    /// Factor on every E, from `M221`.
    pub(super) flow: f64,
    /// mm of filament pulled back by moves of E.
    retracted: f64,
    /// mm pulled back by `G10`, which `G11` pushes again.
    firmware: f64,
}

impl Default for Head {
    fn default() -> Self {
        Self { celsius: None, flow: 1.0, retracted: 0.0, firmware: 0.0 }
    }
}

impl Head {
    /// How much filament is pulled back, mm.
    pub(super) fn retracted(&self) -> f64 {
        self.retracted + self.firmware
    }

    /// Feeds `by` mm of filament (pulls back where negative); what comes out of the nozzle, mm.
    #[inline]
    pub(super) fn feed(&mut self, by: f64) -> f64 {
        self.retracted -= by;
        if self.retracted >= 0.0 {
            return 0.0;
        }
        let out = -self.retracted;
        self.retracted = 0.0;
        // What the firmware pulled back is filled before anything comes out.
        let fills = out.min(self.firmware);
        self.firmware -= fills;
        out - fills
    }

    /// `G10`.
    pub(super) fn pull(&mut self, length: f64) {
        self.firmware = length;
    }

    /// `G11`.
    pub(super) fn push(&mut self) {
        self.firmware = 0.0;
    }
}

/// All heads, and the one in use.
#[derive(Clone, Debug)]
pub(super) struct Heads {
    heads: Vec<Head>,
    active: usize,
}

impl Heads {
    pub(super) fn new() -> Self {
        Self { heads: vec![Head::default()], active: 0 }
    }

    /// The number of the head in use.
    pub(super) fn active(&self) -> u16 {
        self.active as u16
    }

    pub(super) fn select(&mut self, head: u32) {
        self.active = (head as usize).min(HEADS - 1);
        self.get(self.active as u32);
    }

    /// The head in use.
    #[inline]
    pub(super) fn now(&mut self) -> &mut Head {
        // `select` made it.
        &mut self.heads[self.active]
    }

    /// A head by its number.
    pub(super) fn get(&mut self, head: u32) -> &mut Head {
        let head = (head as usize).min(HEADS - 1);
        if self.heads.len() <= head {
            self.heads.resize(head + 1, Head::default());
        }
        &mut self.heads[head]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pulled_back_is_filled_first() {
        let mut head = Head::default();
        assert_eq!(head.feed(2.0), 2.0);
        assert_eq!(head.feed(-1.0), 0.0);
        assert_eq!(head.retracted(), 1.0);
        assert_eq!(head.feed(1.5), 0.5);
        head.pull(3.0);
        assert_eq!((head.feed(2.0), head.retracted()), (0.0, 1.0));
        head.push();
        assert_eq!(head.feed(2.0), 2.0);
    }
}
