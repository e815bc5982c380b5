use std::io;

use fgm_core::{Point2, Point3, Role, bead};

use super::Writer;
use crate::{Fixed, GcodeError, Move};

/// What the beads have in common until one differs.
#[derive(Clone, Debug)]
pub(super) struct Bead {
    height: f64,
    /// None where the next bead has to work everything out.
    known: Option<(f64, Role)>,
    /// mm³ of bead, and of filament, a mm.
    volume: f64,
    fed: f64,
    /// Thousandths of a hundredth of a mm of filament, as written in E, a mm.
    units: f64,
    speed: f64,
    feedrate: u32,
    /// The state's flow, and the part of it that E has.
    pub(super) state_flow: f64,
    folded: f64,
    /// What E still owes, in units of its last decimal.
    owed: f64,
    /// Turns a minute of an auger, as the bead needs them and as told last.
    turns: Option<u32>,
    told_turns: Option<u32>,
    /// The fan's share of full speed, as told last.
    pub(super) told_fan: f64,
    /// Last tags written.
    tag_role: Option<Role>,
    tag_width: Option<Fixed<3>>,
}

impl Default for Bead {
    fn default() -> Self {
        Self {
            height: 0.0,
            known: None,
            volume: 0.0,
            fed: 0.0,
            units: 0.0,
            speed: 0.0,
            feedrate: 0,
            state_flow: 1.0,
            folded: 1.0,
            owed: 0.0,
            turns: None,
            told_turns: None,
            told_fan: 0.0,
            tag_role: None,
            tag_width: None,
        }
    }
}

impl Bead {
    /// Units of E's last decimal in a mm.
    const E_UNITS: f64 = 1e5;

    pub(super) fn layer(&mut self, height: f64) {
        (self.height, self.known) = (height, None);
    }

    pub(super) fn state(&mut self, flow: f64, folds: bool) {
        (self.state_flow, self.folded) = (flow, if folds { flow } else { 1.0 });
        self.forget();
    }

    /// The next bead is worked out anew.
    pub(super) fn forget(&mut self) {
        self.known = None;
    }

    /// E for a length; the rest of the rounding is owed.
    #[inline]
    fn feed(&mut self, length: f64) -> Result<Fixed<5>, GcodeError> {
        let exact = self.owed + length * self.units;
        let units = Fixed::<0>::round(exact)?.units();
        self.owed = exact - units as f64;
        Ok(Fixed::from_units(units))
    }
}

/// The name of a role in the tags of the PrusaSlicer family.
const fn tag(role: Role) -> &'static str {
    match role {
        Role::OuterWall => "External perimeter",
        Role::InnerWall => "Perimeter",
        Role::SlightOverhang | Role::HalfOverhang | Role::FullOverhang => "Overhang perimeter",
        Role::Infill | Role::PurgeInfill => "Internal infill",
        Role::SolidInfill | Role::BottomSkin => "Solid infill",
        Role::TopSkin => "Top solid infill",
        Role::Bridge => "Bridge infill",
        Role::GapFill => "Gap fill",
        Role::Skirt => "Skirt/Brim",
        Role::Support => "Support material",
        Role::PurgeTower => "Wipe tower",
    }
}

/// mm/s as mm/min, at least 1.
fn feedrate(speed: f64) -> u32 {
    (speed * 60.0).round().clamp(1.0, 1e9) as u32
}

impl<W: io::Write> Writer<W> {
    /// A bead.
    pub(super) fn extrude(&mut self, to: Point2, width: f64, role: Role) -> Result<(), GcodeError> {
        let to = self.position.place(to)?;
        let from = self.position.at.ok_or(GcodeError::NoStart)?;
        if self.bead.known != Some((width, role)) {
            self.set_bead(width, role)?;
        }
        let delta = to - from;
        let length = delta.length();
        let (x, y) = (Fixed::round(to.x)?, Fixed::round(to.y)?);
        self.count_bead(length, role);
        self.position.at = Some(to);
        self.position.climb.advance(length);
        if self.position.x == Some(x) && self.position.y == Some(y) {
            self.bead.owed += length * self.bead.units;
            return Ok(());
        }
        self.settle(from)?;
        self.tags(width, role)?;
        let e = self.bead.feed(length)?;
        let below = self.position.bead_z;
        let z = self.bead_z()?;
        self.go(Some((x, y)), (z != below).then_some(z), Some(e), self.bead.feedrate);
        let (below, z) = (below.value(), z.value());
        let extents = &mut self.summary.extents;
        extents.min = extents.min.min(from.min(to).extend(below));
        extents.max = extents.max.max(from.max(to).extend(z));
        self.summary.moves += 1;
        let delta = delta.extend(z - below);
        self.time.push(delta, self.bead.speed, self.options.limits.acceleration);
        Ok(())
    }

    /// The height that the bead rises to.
    #[inline]
    fn bead_z(&mut self) -> Result<Fixed<3>, GcodeError> {
        let position = &mut self.position;
        if position.bead_z != position.layer_z {
            position.bead_z = position.place_z(position.climb.z())?;
        }
        Ok(position.bead_z)
    }

    fn count_bead(&mut self, length: f64, role: Role) {
        let volume = length * self.bead.volume;
        self.fed += length * self.bead.fed;
        let summary = &mut self.summary;
        summary.extrude_mm += length;
        summary.extruded_mm3 += volume;
        if role.is_part() {
            summary.part_mm3 += volume;
        } else if role == Role::PurgeTower {
            summary.purge_mm3 += volume;
        }
    }

    /// Works out what a bead of another width or role needs.
    fn set_bead(&mut self, width: f64, role: Role) -> Result<(), GcodeError> {
        let (bead, options) = (&mut self.bead, &self.options);
        let area = bead::area(width, bead.height);
        if !(area > 0.0 && area.is_finite()) {
            return Err(GcodeError::NoBead { width, height: bead.height });
        }
        if let Some(limit) = self.machine.max_bead_area.filter(|limit| area > *limit) {
            return Err(GcodeError::BeadTooLarge { width, height: bead.height, area, limit });
        }
        let filament = self.machine.filament_area();
        bead.volume = area * options.flow[role as usize];
        bead.fed = bead.volume * bead.state_flow;
        let factor = self.machine.feed_factor();
        bead.units = bead.volume * bead.folded * factor / filament * Bead::E_UNITS;
        let (state, first) = (Some(&self.heads.state), self.summary.layers <= 1);
        let usual = self.machine.bead_speed(role, bead.fed, state, first);
        bead.speed = self.pace.speed(role, usual);
        bead.feedrate = feedrate(bead.speed);
        bead.turns = self.machine.auger.turns(bead.speed * bead.fed);
        bead.known = Some((width, role));
        Ok(())
    }

    /// What comes before a bead where it changes: an auger's speed, `;TYPE:`, `;WIDTH:`, the fan for
    /// bridges and overhangs.
    #[inline]
    fn tags(&mut self, width: f64, role: Role) -> Result<(), GcodeError> {
        if let Some(turns) = self.bead.turns.filter(|_| self.bead.turns != self.bead.told_turns) {
            self.bead.told_turns = Some(turns);
            self.text.line(&self.machine.auger.command.replace("{rpm}", &turns.to_string()));
        }
        if self.bead.tag_role != Some(role) {
            let last = self.bead.tag_role.replace(role);
            if last.map(tag) != Some(tag(role)) {
                self.dialect.comment(&format!("TYPE:{}", tag(role)), &mut self.text);
            }
            self.role_fan(role);
        }
        let width = Fixed::round(width)?;
        if self.bead.tag_width != Some(width) {
            self.bead.tag_width = Some(width);
            self.tag.clear();
            self.tag.extend_from_slice(b"WIDTH:");
            width.write_trimmed(&mut self.tag);
            let text = std::str::from_utf8(&self.tag).unwrap_or_default();
            self.dialect.comment(text, &mut self.text);
        }
        Ok(())
    }

    /// The fan for bridges and what hangs over.
    fn role_fan(&mut self, role: Role) {
        let fan = &self.options.fan;
        let share = fan.of(role);
        if self.summary.layers > u64::from(fan.from_layer) && self.bead.told_fan != share {
            self.bead.told_fan = share;
            self.dialect.fan(share, &mut self.text);
        }
    }

    /// Moves without extrusion, from place to place.
    #[inline]
    pub(super) fn end_travel(&mut self) -> Result<(), GcodeError> {
        if self.travel.is_empty() { Ok(()) } else { self.travel_all() }
    }

    fn travel_all(&mut self) -> Result<(), GcodeError> {
        let places = std::mem::take(&mut self.travel);
        let known = self.position.x.is_some() && self.position.y.is_some();
        let mut length = if known && self.position.at.is_some() { 0.0 } else { f64::INFINITY };
        let mut at = self.position.at;
        for &to in &places {
            length += at.replace(to).map_or(0.0, |at| at.distance(to));
        }
        let mut begun = false;
        for to in places {
            let (x, y) = (Fixed::round(to.x)?, Fixed::round(to.y)?);
            if self.position.x == Some(x) && self.position.y == Some(y) {
                self.position.at = Some(to);
                continue;
            }
            if !std::mem::replace(&mut begun, true) {
                let retraction = &self.options.retraction;
                if length >= retraction.min_travel {
                    self.retract(retraction.length)?;
                    self.lift(self.hop())?;
                } else {
                    self.lift(0.0)?;
                }
            }
            self.travel_to(to, x, y);
        }
        Ok(())
    }

    /// Moves in the plane, and counts the way from the last known position.
    fn travel_to(&mut self, to: Point2, x: Fixed<3>, y: Fixed<3>) {
        let speed = self.options.speeds.travel;
        let from = self.position.written;
        self.go(Some((x, y)), None, None, feedrate(speed));
        if let (Some(from), Some(to)) = (from, self.position.written) {
            // As written, so that who reads the file finds the same.
            self.summary.travel_mm += from.distance(to);
        }
        if let Some(at) = self.position.at.replace(to) {
            let delta = to - at;
            self.time.push(delta.extend(0.0), speed, self.options.limits.travel_acceleration);
        }
        self.summary.moves += 1;
    }

    /// Makes the nozzle ready for a bead from `from`: there, at its height, with filament in it.
    #[inline]
    fn settle(&mut self, from: Point2) -> Result<(), GcodeError> {
        let position = &self.position;
        if position.x.is_none() || position.y.is_none() {
            // A change of heads took the nozzle away.
            let (x, y) = (Fixed::round(from.x)?, Fixed::round(from.y)?);
            let to = self.position.at.replace(from);
            self.lift(self.hop())?;
            self.travel_to(from, x, y);
            self.position.at = to;
        }
        if self.position.z != Some(self.position.bead_z) {
            self.go_z(self.position.bead_z);
        }
        let retracted = std::mem::take(self.heads.retracted());
        if retracted > 0.0 { self.pull(retracted) } else { Ok(()) }
    }

    /// Pulls the filament back, up to `length` in all.
    pub(super) fn retract(&mut self, length: f64) -> Result<(), GcodeError> {
        let by = length - *self.heads.retracted();
        if by <= 0.0 {
            return Ok(());
        }
        *self.heads.retracted() += by;
        self.pull(-by)
    }

    fn pull(&mut self, by: f64) -> Result<(), GcodeError> {
        let speed = self.options.retraction.speed;
        let fed = by * self.machine.feed_factor();
        self.go(None, None, Some(Fixed::round(fed)?), feedrate(speed));
        self.time.push_filament(by, speed);
        Ok(())
    }

    /// How far above the layer to travel: after a change of heads, as high as before it.
    fn hop(&self) -> f64 {
        let usual = self.options.retraction.z_hop;
        let swapped = self.is_tool_changer() && self.position.z.is_none();
        if swapped { usual.max(self.machine.tool_change.z_hop) } else { usual }
    }

    /// Brings the nozzle at least `hop` above the beads.
    pub(super) fn lift(&mut self, hop: f64) -> Result<(), GcodeError> {
        let z = Fixed::round(self.position.clamp_z(self.position.bead_z.value() + hop))?;
        if self.position.z.is_none_or(|now| now < z) {
            self.go_z(z);
        }
        Ok(())
    }

    fn go_z(&mut self, z: Fixed<3>) {
        let speed = self.options.speeds.z;
        let from = self.position.z;
        self.go(None, Some(z), None, feedrate(speed));
        self.position.max_z = self.position.max_z.max(z);
        let by = z.value() - from.map_or(z.value(), Fixed::value);
        self.time.push(Point3::new(0.0, 0.0, by), speed, self.options.limits.travel_acceleration);
    }

    /// Writes a move with the words that change.
    #[inline]
    fn go(
        &mut self,
        plane: Option<(Fixed<3>, Fixed<3>)>,
        z: Option<Fixed<3>>,
        e: Option<Fixed<5>>,
        feedrate: u32,
    ) {
        let position = &mut self.position;
        let mut to = Move { z, e, ..Move::default() };
        if let Some((x, y)) = plane {
            to.x = (position.x != Some(x)).then_some(x);
            to.y = (position.y != Some(y)).then_some(y);
            (position.x, position.y) = (Some(x), Some(y));
            position.written = Some(Point2::new(x.value(), y.value()));
        }
        if z.is_some() {
            position.z = z;
        }
        if position.feedrate != feedrate {
            position.feedrate = feedrate;
            to.feedrate = Some(feedrate);
        }
        self.dialect.linear(&to, &mut self.text);
    }
}
