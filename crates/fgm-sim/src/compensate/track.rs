use fgm_core::{ColorId, MAX_MATERIALS, Mixture};

/// A command: from a volume on the machine is told a mixture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Told {
    /// Everything extruded before it, mm³; minus infinity for what is told before all.
    pub(super) at: f64,
    pub(super) mixture: Mixture,
    /// The colour whose state this is; none for a mixture between or beyond the palette's.
    pub(super) color: Option<ColorId>,
}

/// Commands in their order, none nearer to the one before than the shortest segment.
#[derive(Clone, Debug)]
pub(super) struct Track {
    told: Vec<Told>,
    shortest: f64,
}

impl Track {
    /// Begins with what is told before anything is extruded.
    pub(super) fn new(first: Told, shortest: f64) -> Self {
        Self { told: vec![Told { at: f64::NEG_INFINITY, ..first }], shortest }
    }

    /// Begins as another one is at a volume, and goes on from there.
    pub(super) fn after(&self, volume: f64) -> Self {
        Self { told: self.told[self.index(volume)..].to_vec(), shortest: self.shortest }
    }

    /// The commands before a volume.
    pub(super) fn before(&self, volume: f64) -> Self {
        let mut track = self.clone();
        track.truncate(volume);
        track
    }

    pub(super) fn told(&self) -> &[Told] {
        &self.told
    }

    /// Adds a command, not before the one added last. One that comes too soon waits until the
    /// segment before it is long enough; one that comes while another waits takes its place.
    pub(super) fn tell(&mut self, next: Told) {
        let Some(last) = self.told.last_mut() else { return };
        let mut at = next.at;
        if at <= last.at {
            // It takes the other's place, which may make it no change at all.
            (last.mixture, last.color) = (next.mixture, next.color);
            let len = self.told.len();
            if len > 1 && self.told[len - 2].mixture == next.mixture {
                self.told.pop();
            }
            return;
        }
        if last.mixture == next.mixture {
            return;
        }
        // A thousandth is rounding: the next would otherwise wait for a whole segment.
        if at - last.at < self.shortest * 0.999 {
            at = last.at + self.shortest;
        }
        self.told.push(Told { at, ..next });
    }

    /// Which command counts at a volume.
    pub(super) fn index(&self, volume: f64) -> usize {
        self.told.partition_point(|t| t.at <= volume).saturating_sub(1)
    }

    /// What counts at a volume.
    pub(super) fn at(&self, volume: f64) -> Told {
        self.told[self.index(volume)]
    }

    /// Drops the commands at a volume and after it.
    pub(super) fn truncate(&mut self, volume: f64) {
        let keep = self.told.partition_point(|t| t.at < volume).max(1);
        self.told.truncate(keep);
    }

    /// Drops the commands that no longer count at a volume.
    pub(super) fn forget(&mut self, volume: f64) {
        self.told.drain(..self.index(volume));
    }

    /// The mean command of each of `count` cells from the volume `from` on, in `components` rows
    /// of `stride`.
    pub(super) fn average(
        &self,
        (from, cell): (f64, f64),
        count: usize,
        stride: usize,
        components: usize,
        out: &mut [f64],
    ) {
        let mut index = self.index(from);
        for i in 0..count {
            let (start, end) = (from + i as f64 * cell, from + (i + 1) as f64 * cell);
            let mut sum = [0.0; MAX_MATERIALS];
            let mut at = start;
            loop {
                let next = self.told.get(index + 1).map_or(f64::INFINITY, |t| t.at);
                let until = next.min(end);
                let part = (until - at).max(0.0) / cell;
                for (sum, f) in sum.iter_mut().zip(self.told[index].mixture.fractions()) {
                    *sum += part * f;
                }
                if next > end {
                    break;
                }
                (at, index) = (until.max(at), index + 1);
            }
            for (component, value) in sum.iter().enumerate().take(components) {
                out[component * stride + i] = *value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(at: f64, share: f64) -> Told {
        let mixture = Mixture::from_weights(&[share, 1.0 - share]).unwrap();
        Told { at, mixture, color: None }
    }

    fn shown(track: &Track) -> Vec<(f64, f64)> {
        track.told().iter().map(|t| (t.at, t.mixture.fractions()[0])).collect()
    }

    #[test]
    fn segments_are_as_long_as_they_have_to_be() {
        let mut track = Track::new(told(0.0, 0.0), 1.0);
        for (at, share) in
            [(2.0, 0.5), (2.0, 0.25), (2.4, 0.5), (2.8, 0.75), (3.0, 0.75), (5.0, 1.0), (5.5, 0.0)]
        {
            track.tell(told(at, share));
        }
        let first = f64::NEG_INFINITY;
        assert_eq!(shown(&track), [(first, 0.0), (2.0, 0.25), (3.0, 0.75), (5.0, 1.0), (6.0, 0.0)]);
        // What waits can still be called off.
        track.tell(told(5.7, 1.0));
        assert_eq!(shown(&track).len(), 4);
        assert_eq!(track.at(3.0).mixture.fractions()[0], 0.75);
        assert_eq!(track.at(-1.0).mixture.fractions()[0], 0.0);
        let mut cells = [0.0; 4];
        track.average((2.5, 1.0), 4, 4, 1, &mut cells);
        assert_eq!(cells, [0.5, 0.75, 0.875, 1.0]);
        track.forget(4.0);
        track.truncate(5.0);
        assert_eq!(shown(&track), [(3.0, 0.75)]);
    }
}
