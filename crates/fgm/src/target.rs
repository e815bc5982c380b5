//! What the deposit is to be along each bead, where commands are chosen for it.

use fgm_core::{Climb, MAX_MATERIALS, MaterialField, Mixture, Motion, Point2, Point3, Role};
use fgm_field::Design;

use crate::{choice::Aim, heights::Heights, purge::PurgeInto, settings::Settings};

/// The most samples of a bead.
const MOST: f64 = 1e5;

/// The design's mixtures, bead by bead.
pub(crate) struct Target<'a> {
    material: &'a dyn MaterialField,
    /// Whether all of the part is aimed at the design, or only what takes the old colour: that has
    /// no colour of its own to be compared with.
    all: bool,
    /// Between samples, mm, at most.
    step: f64,
    at: Point2,
    climb: Climb,
    points: Vec<Point3>,
    /// Fractions of the points, material by material.
    fractions: Vec<f64>,
    mixtures: Vec<Mixture>,
}

impl<'a> Target<'a> {
    /// None where the paths' colours are what all of the deposit is to be.
    pub(crate) fn of(design: &'a Design, settings: &Settings) -> Option<Self> {
        let all = settings.aim() == Aim::Design;
        (all || settings.purge.into == PurgeInto::Infill).then(|| Self {
            material: design.fractions.as_ref(),
            all,
            step: settings.contour.cell,
            at: Point2::ZERO,
            climb: Climb::default(),
            points: Vec::new(),
            fractions: Vec::new(),
            mixtures: Vec::new(),
        })
    }

    /// The mixtures along a bead of the part, each over an equal share of its length, in a layer
    /// cut at the height `cut`; none for any other motion, nor where the design has none. On a layer
    /// that rises they are those of as much below the cut as there is left to rise.
    pub(crate) fn along(&mut self, motion: &Motion, cut: f64) -> &[Mixture] {
        self.mixtures.clear();
        let left = self.climb.left();
        self.climb.follow(motion);
        match *motion {
            Motion::Travel { to } => self.at = to,
            Motion::Extrude { to, role, .. } => {
                let from = std::mem::replace(&mut self.at, to);
                let aimed = role == Role::PurgeInfill || (self.all && role.is_part());
                let heights = Heights { from: cut - left, to: cut - self.climb.left() };
                if aimed && self.sample(from, to, heights).is_none() {
                    self.mixtures.clear();
                }
            }
            Motion::Layer { .. } | Motion::Rise { .. } | Motion::Color(_) | Motion::Command(_) => {}
        }
        &self.mixtures
    }

    /// Takes the mixtures between two points; none where one of them is not valid.
    fn sample(&mut self, from: Point2, to: Point2, heights: Heights) -> Option<()> {
        let count = (from.distance(to) / self.step).ceil().clamp(1.0, MOST) as usize;
        let share = |i: usize| (i as f64 + 0.5) / count as f64;
        self.points.clear();
        let place = |i: usize| from.lerp(to, share(i)).extend(heights.at(share(i)));
        self.points.extend((0..count).map(place));
        let materials = self.material.materials().min(MAX_MATERIALS);
        self.fractions.resize(materials * count, 0.0);
        for (material, out) in self.fractions.chunks_mut(count).take(materials).enumerate() {
            self.material.fraction(material).eval_into(&self.points, out);
        }
        for i in 0..count {
            let mut weights = [0.0; MAX_MATERIALS];
            for (material, weight) in weights.iter_mut().take(materials).enumerate() {
                *weight = self.fractions[material * count + i];
            }
            self.mixtures.push(Mixture::from_weights(&weights[..materials]).ok()?);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bead_is_to_be_what_the_design_is_along_it() {
        let source =
            "fgrade([\"x/10 + 1e-18 sqrt(5 - x)\", \"1 - x/10\"], [\"a\", \"b\"]) { cube(20); }";
        let design = fgm_design::parse_vcad(source, ".".as_ref(), &Default::default()).unwrap();
        let settings = Settings::default();
        let mut target = Target::of(&design.design, &settings).unwrap();
        let bead = |x, role| Motion::Extrude { to: Point2::new(x, 0.0), width: 0.4, role };
        target.along(&Motion::Travel { to: Point2::new(1.0, 0.0) }, 0.0);
        let shares: Vec<f64> = target
            .along(&bead(2.0, Role::Infill), 0.0)
            .iter()
            .map(|mixture| mixture.fractions()[0])
            .collect();
        assert!(shares.len() == 2 && (shares[0] - 0.125).abs() < 1e-12, "{shares:?}");
        assert!((shares[1] - 0.175).abs() < 1e-12, "{shares:?}");
        // A layer that rises: half of the way up, and then all of it.
        let high = "fgrade([\"z/10\", \"1 - z/10\"], [\"a\", \"b\"]) { cube(20); }";
        let high = fgm_design::parse_vcad(high, ".".as_ref(), &Default::default()).unwrap();
        let mut rising = Target::of(&high.design, &settings).unwrap();
        rising.along(&Motion::Layer { index: 1, z: 5.5, height: 1.0 }, 5.0);
        rising.along(&Motion::Rise { from: 4.5, length: 2.0 }, 5.0);
        rising.along(&Motion::Travel { to: Point2::ZERO }, 5.0);
        for (x, wanted) in [(0.5, 0.4125), (1.0, 0.4375), (2.0, 0.475), (2.5, 0.5)] {
            let along = rising.along(&bead(x, Role::OuterWall), 5.0);
            let mean: f64 = along.iter().map(|mixture| mixture.fractions()[0]).sum();
            assert!((mean / along.len() as f64 - wanted).abs() < 1e-12, "{x}: {along:?}");
        }
        // Neither a tower's nor one that leaves the design's mixtures.
        assert!(target.along(&bead(3.0, Role::PurgeTower), 0.0).is_empty());
        assert!(target.along(&bead(6.0, Role::Infill), 0.0).is_empty());
        let mut zipped = settings;
        zipped.palette.zipper = crate::Zipper::Share(0.05);
        assert!(Target::of(&design.design, &zipped).is_none());
        zipped.purge.into = PurgeInto::Infill;
        let mut target = Target::of(&design.design, &zipped).unwrap();
        assert!(target.along(&bead(2.0, Role::Infill), 0.0).is_empty());
        assert!(!target.along(&bead(2.5, Role::PurgeInfill), 0.0).is_empty());
        zipped.purge.into = PurgeInto::Tower;
        zipped.compensation.aim = Some(Aim::Design);
        assert!(Target::of(&design.design, &zipped).is_some());
    }
}
