use std::collections::VecDeque;

use fgm_core::{Motion, Point2, Role, bead};

/// Pieces shorter than this are not split off, mm: no machine could place them.
const SHORTEST: f64 = 1e-4;

/// Motions held back, each with the volume extruded before and after it, so that something can be
/// put between them at any volume.
///
/// Everything extruded counts, across paths and layers; a bead's volume is its length times
/// [`bead::area`] times its role's flow.
#[derive(Clone, Debug)]
pub struct MotionQueue {
    flow: [f64; Role::ALL.len()],
    held: VecDeque<Held>,
    at: Option<Point2>,
    height: f64,
    /// Everything extruded so far, mm³.
    total: f64,
}

/// A motion that something may still have to come before.
#[derive(Clone, Copy, Debug)]
struct Held {
    motion: Motion,
    /// Where an extrusion begins.
    from: Point2,
    /// What was extruded before and after it, mm³.
    start: f64,
    end: f64,
}

impl Default for MotionQueue {
    fn default() -> Self {
        Self {
            flow: [1.0; Role::ALL.len()],
            held: VecDeque::new(),
            at: None,
            height: 0.0,
            total: 0.0,
        }
    }
}

impl MotionQueue {
    /// Counts the beads of a role with a factor, as they are extruded.
    pub fn set_flow(&mut self, role: Role, factor: f64) {
        self.flow[role as usize] = factor;
    }

    /// Everything extruded by the motions taken so far, mm³.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Takes a motion; gives the volume that it extrudes, mm³.
    pub fn push(&mut self, motion: Motion) -> f64 {
        let start = self.total;
        let mut from = self.at.unwrap_or_default();
        match motion {
            Motion::Layer { height, .. } => self.height = height,
            Motion::Travel { to } => self.at = Some(to),
            Motion::Rise { .. } | Motion::Color(_) | Motion::Command(_) => {}
            Motion::Extrude { to, width, role } => {
                from = self.at.replace(to).unwrap_or(to);
                let area = bead::area(width, self.height) * self.flow[role as usize];
                let volume = from.distance(to) * area;
                // What is no number is left to the writer, which says where it is.
                if volume.is_finite() {
                    self.total += volume;
                }
            }
        }
        self.held.push_back(Held { motion, from, start, end: self.total });
        self.total - start
    }

    /// Emits the motions that end at the volume `due` or before.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn release<E>(
        &mut self,
        due: f64,
        emit: &mut impl FnMut(Motion) -> Result<(), E>,
    ) -> Result<(), E> {
        while self.held.front().is_some_and(|held| held.end <= due) {
            if let Some(held) = self.held.pop_front() {
                emit(held.motion)?;
            }
        }
        Ok(())
    }

    /// As [`release`](Self::release), and of the motion that `due` lies in emits the part before
    /// it. The place is exact to the volume of 0.0001 mm of bead.
    ///
    /// # Errors
    /// Those of `emit`.
    pub fn release_exactly<E>(
        &mut self,
        due: f64,
        emit: &mut impl FnMut(Motion) -> Result<(), E>,
    ) -> Result<(), E> {
        self.release(due, emit)?;
        let Some(front) = self.held.front_mut().filter(|held| held.start < due) else {
            return Ok(());
        };
        let Motion::Extrude { to, width, role } = front.motion else { return Ok(()) };
        let share = (due - front.start) / (front.end - front.start);
        let length = front.from.distance(to);
        if share * length < SHORTEST {
            return Ok(());
        }
        if (1.0 - share) * length < SHORTEST {
            emit(front.motion)?;
            self.held.pop_front();
            return Ok(());
        }
        let middle = front.from.lerp(to, share);
        (front.from, front.start) = (middle, due);
        emit(Motion::Extrude { to: middle, width, role })
    }
}
