//! Commands other than moves.

use fgm_gcode::{Code, Command, DialectName};

use super::{Follower, GREATEST, known};
use crate::{Event, FaultKind, event::Heat, replay::motors::BadWeights};

impl Follower {
    /// Follows a command.
    #[inline]
    pub(super) fn command(&mut self, command: &Command<'_>) {
        match command.code {
            Code::Letter { letter: b'G', number, minor } => match number {
                0 | 1 if minor == 0 => self.linear(command),
                _ => self.g(command, number, minor),
            },
            Code::Letter { letter: b'M', number, .. } => self.m(command, number),
            Code::Letter { letter: b'T', number, .. } => self.tool(number),
            _ => self.other(command),
        }
    }

    fn g(&mut self, command: &Command<'_>, number: u32, minor: u32) {
        match number {
            2 | 3 => self.arc(command, number == 2),
            4 => self.dwell(command),
            10 if !command.words().any(|w| matches!(w.letter, b'P' | b'L' | b'R' | b'X')) => {
                let (length, speed) = self.machine.retraction;
                self.heads.now().pull(length);
                self.out.push_back(Event::Pause { seconds: length / speed, filament: -length });
            }
            10 => self.tool_temperature(command),
            11 => {
                let (length, speed) = self.machine.retraction;
                self.heads.now().push();
                self.out.push_back(Event::Pause { seconds: length / speed, filament: length });
            }
            20 => self.place.unit = 25.4,
            21 => self.place.unit = 1.0,
            28 => self.place.home([b'X', b'Y', b'Z'].map(|axis| command.has(axis))),
            90 | 91 => {
                self.place.absolute = number == 90;
                // Marlin and its kin mean E, too; these do not.
                let apart =
                    matches!(self.machine.dialect, Some(DialectName::RepRap | DialectName::Kalico));
                if !apart {
                    self.place.absolute_e = number == 90;
                }
            }
            92 if minor == 1 => self.place.uncall(),
            92 => self.call(command),
            _ => self.other(command),
        }
    }

    fn m(&mut self, command: &Command<'_>, number: u32) {
        let mixed = match number {
            82 | 83 => {
                self.place.absolute_e = number == 82;
                Ok(())
            }
            104 | 109 => {
                self.nozzle_temperature(command, number == 109);
                Ok(())
            }
            400 => {
                self.out.push_back(Event::Pause { seconds: 0.0, filament: 0.0 });
                Ok(())
            }
            163 => self.motors.stage(command),
            164 => self.motors.store(command),
            165 => self.motors.direct(command),
            567 => self.motors.ratios(command),
            200 => {
                let volumetric = command.value(b'D').is_some_and(|d| d > 0.0);
                self.area = if volumetric { 1.0 } else { self.machine.filament_area };
                Ok(())
            }
            220 => {
                if let Some(percent) = self.number(command, b'S') {
                    self.speed_factor = (percent / 100.0).clamp(0.01, 100.0);
                }
                Ok(())
            }
            221 => {
                self.flow(command);
                Ok(())
            }
            302 => {
                let allowed = command.value(b'P').map(|p| p > 0.0);
                let least = command.value(b'S').map(|s| s <= 0.0);
                self.cold_allowed = allowed.or(least).unwrap_or(self.cold_allowed);
                Ok(())
            }
            568 => {
                self.tool_temperature(command);
                Ok(())
            }
            _ => {
                self.other(command);
                Ok(())
            }
        };
        self.check_weights(command, &mixed);
    }

    fn check_weights(&mut self, command: &Command<'_>, done: &Result<(), BadWeights>) {
        if done.is_err() {
            self.fault(FaultKind::BadNumber, || format!("a mixture from `{}`", text(command)));
        }
    }

    /// `T<n>`.
    fn tool(&mut self, number: u32) {
        self.motors.select(number);
        if self.machine.has_heads() {
            self.heads.select(number);
        }
    }

    /// What only has to be known, or is Klipper's.
    #[cold]
    fn other(&mut self, command: &Command<'_>) {
        if command.is_named("SET_MIXING_EXTRUDER") {
            let done = self.motors.factors(command);
            return self.check_weights(command, &done);
        }
        if command.is_named("TURN_OFF_HEATERS") {
            let head = self.heads.active();
            return self.heat(u32::from(head), 0.0, false);
        }
        if command.is_named("SET_HEATER_TEMPERATURE") {
            return self.heater(command);
        }
        if command.is_named("ACTIVATE_EXTRUDER") {
            if let Some(head) = command.named_value("EXTRUDER").and_then(extruder) {
                self.tool(head);
            }
            return;
        }
        if known::may_move(command) {
            self.place.known = [false; 3];
        }
        if !known::is_known(command) {
            self.fault(FaultKind::UnknownCommand, || format!("`{}`", text(command)));
        }
    }

    /// `SET_HEATER_TEMPERATURE HEATER=extruder1 TARGET=210`.
    fn heater(&mut self, command: &Command<'_>) {
        let head = command.named_value("HEATER").and_then(extruder);
        let target = command.named_value("TARGET").unwrap_or(b"0");
        let celsius = std::str::from_utf8(target).ok().and_then(|t| t.parse().ok());
        match (head, celsius) {
            (Some(head), Some(celsius)) => self.heat(head, celsius, false),
            (Some(_), None) => self.bad_number(command),
            (None, _) => {}
        }
    }

    /// `M104`, `M109`.
    fn nozzle_temperature(&mut self, command: &Command<'_>, wait: bool) {
        let Some(celsius) = self.number(command, b'S').or_else(|| self.number(command, b'R'))
        else {
            return;
        };
        let head = command.value(b'T').filter(|_| self.machine.has_heads());
        let head = head.map_or(u32::from(self.heads.active()), |head| head.max(0.0) as u32);
        self.heat(head, celsius, wait);
    }

    /// RepRapFirmware's `G10 P<tool> S<celsius>` and `M568`.
    fn tool_temperature(&mut self, command: &Command<'_>) {
        let Some(celsius) = self.number(command, b'S') else { return };
        let head = command.value(b'P').filter(|_| self.machine.has_heads());
        let head = head.map_or(u32::from(self.heads.active()), |head| head.max(0.0) as u32);
        self.heat(head, celsius, false);
    }

    fn heat(&mut self, head: u32, celsius: f64, wait: bool) {
        self.heads.get(head).celsius = Some(celsius);
        let head = head.min(u32::from(u16::MAX)) as u16;
        self.out.push_back(Event::Heat(Heat { head, celsius, wait }));
    }

    /// `M221 S<percent> [T<head>]`.
    fn flow(&mut self, command: &Command<'_>) {
        let Some(percent) = self.number(command, b'S') else { return };
        let head = command.value(b'T').filter(|_| self.machine.has_heads());
        let head = head.map_or(u32::from(self.heads.active()), |head| head.max(0.0) as u32);
        self.heads.get(head).flow = (percent / 100.0).clamp(0.0, 100.0);
    }

    /// `G4 P<ms>` or `S<s>`.
    fn dwell(&mut self, command: &Command<'_>) {
        let milliseconds = self.number(command, b'P').map(|ms| ms / 1000.0);
        let seconds = self.number(command, b'S').or(milliseconds).unwrap_or(0.0);
        self.out.push_back(Event::Pause { seconds: seconds.max(0.0), filament: 0.0 });
    }

    /// `G92`.
    fn call(&mut self, command: &Command<'_>) {
        let mut named = false;
        for word in command.words() {
            let Some(value) = word.value.filter(|v| v.abs() <= GREATEST) else {
                self.bad_number(command);
                continue;
            };
            match word.letter {
                b'E' => self.place.e = value * self.place.unit,
                letter @ b'X'..=b'Z' => self.place.call(usize::from(letter - b'X'), value),
                _ => continue,
            }
            named = true;
        }
        if !named && command.arguments.is_empty() {
            // Alone it calls the place the origin of every axis.
            (0..3).for_each(|axis| self.place.call(axis, 0.0));
            self.place.e = 0.0;
        }
    }

    /// The number after a letter; a letter without one is a fault.
    fn number(&mut self, command: &Command<'_>, letter: u8) -> Option<f64> {
        if !command.has(letter) {
            return None;
        }
        let value = command.value(letter).filter(|v| v.abs() <= GREATEST);
        if value.is_none() {
            self.bad_number(command);
        }
        value
    }

    #[cold]
    pub(super) fn bad_number(&mut self, command: &Command<'_>) {
        self.fault(FaultKind::BadNumber, || format!("`{}`", text(command)));
    }
}

/// The number of Klipper's `extruder`, `extruder1`, ...; none for another heater.
fn extruder(name: &[u8]) -> Option<u32> {
    let number = std::str::from_utf8(name).ok()?.strip_prefix("extruder")?;
    if number.is_empty() { Some(0) } else { number.parse().ok() }
}

/// A command for a message: printable, not too long.
fn text(command: &Command<'_>) -> String {
    let code = match command.code {
        Code::Letter { letter, number, minor: 0 } => format!("{}{number}", char::from(letter)),
        Code::Letter { letter, number, minor } => {
            format!("{}{number}.{minor}", char::from(letter))
        }
        Code::Name(name) => String::from_utf8_lossy(name).into_owned(),
    };
    let whole = format!("{code} {}", String::from_utf8_lossy(command.arguments));
    let clean = whole.trim_end().chars().map(|c| if c.is_control() { '?' } else { c });
    let mut shown: String = clean.clone().take(60).collect();
    if clean.count() > 60 {
        shown.push_str("...");
    }
    shown
}
