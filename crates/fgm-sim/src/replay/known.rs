//! The commands that firmwares have.

use fgm_gcode::{Code, Command};

/// Numbers of the `G` commands that Marlin, RepRapFirmware, Klipper, Repetier or Prusa's firmware
/// has and that are either followed here or change nothing about what is laid down.
const G: &[(u32, u32)] =
    &[(0, 4), (10, 12), (17, 17), (20, 21), (27, 35), (60, 61), (76, 76), (80, 81), (90, 92)];

/// The same for `M`.
const M: &[(u32, u32)] = &[
    (0, 1),
    (3, 5),
    (7, 10),
    (16, 18),
    (20, 37),
    (42, 43),
    (48, 48),
    (73, 87),
    (92, 93),
    (98, 129),
    (135, 135),
    (140, 145),
    (149, 150),
    (154, 156),
    (163, 166),
    (190, 193),
    (200, 211),
    (217, 218),
    (220, 221),
    (226, 233),
    (240, 240),
    (250, 262),
    (280, 282),
    (290, 293),
    (300, 310),
    (350, 360),
    (374, 381),
    (400, 430),
    (470, 472),
    (486, 486),
    (500, 512),
    (524, 524),
    (540, 599),
    (600, 605),
    (665, 675),
    (701, 713),
    (750, 757),
    (808, 808),
    (851, 876),
    (900, 918),
    (928, 929),
    (951, 951),
    (997, 999),
];

/// Klipper's and Kalico's own commands that do not move the head.
const NAMES: &[&str] = &[
    "ACTIVATE_EXTRUDER",
    "BED_MESH_CLEAR",
    "BED_MESH_PROFILE",
    "EXCLUDE_OBJECT",
    "EXCLUDE_OBJECT_DEFINE",
    "EXCLUDE_OBJECT_END",
    "EXCLUDE_OBJECT_START",
    "RESPOND",
    "SET_DISPLAY_TEXT",
    "SET_FAN_SPEED",
    "SET_HEATER_TEMPERATURE",
    "SET_LED",
    "SET_MIXING_EXTRUDER",
    "SET_PIN",
    "SET_PRESSURE_ADVANCE",
    "SET_PRINT_STATS_INFO",
    "SET_RETRACTION",
    "SET_VELOCITY_LIMIT",
    "TEMPERATURE_WAIT",
    "TURN_OFF_HEATERS",
];

/// Klipper's own commands that move the head to where this cannot know.
const MOVING: &[&str] = &[
    "BED_MESH_CALIBRATE",
    "BED_TILT_CALIBRATE",
    "DELTA_CALIBRATE",
    "PROBE",
    "QUAD_GANTRY_LEVEL",
    "SCREWS_TILT_CALCULATE",
    "Z_TILT_ADJUST",
];

fn within(ranges: &[(u32, u32)], number: u32) -> bool {
    ranges.iter().any(|(first, last)| (*first..=*last).contains(&number))
}

/// Whether a firmware has this command.
pub(super) fn is_known(command: &Command<'_>) -> bool {
    match command.code {
        Code::Letter { letter: b'G', number, .. } => within(G, number),
        Code::Letter { letter: b'M', number, .. } => within(M, number),
        // Heads; `P0` parks one on the Prusa XL.
        Code::Letter { letter: b'T' | b'P', .. } => true,
        Code::Letter { .. } => false,
        Code::Name(name) => {
            let is = |known: &&str| name.eq_ignore_ascii_case(known.as_bytes());
            NAMES.iter().chain(MOVING).any(is)
                // Prusa's multi-material unit asks for a head.
                || matches!(name, b"T?" | b"Tx" | b"Tc")
        }
    }
}

/// Whether the head may be anywhere after this extended command: a macro of the user's is no
/// different from a levelling.
pub(super) fn may_move(command: &Command<'_>) -> bool {
    match command.code {
        Code::Name(name) => !NAMES.iter().any(|k| name.eq_ignore_ascii_case(k.as_bytes())),
        Code::Letter { .. } => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_gcode::Line;

    #[test]
    fn known_and_unknown() {
        for (line, known, moves) in [
            ("G1 X1", true, false),
            ("G5 X1 I2", false, false),
            ("M862.3 P \"XL\"", true, false),
            ("M1234", false, false),
            ("T0 S1 L0 D0", true, false),
            ("P0 S1", true, false),
            ("turn_off_heaters", true, false),
            ("QUAD_GANTRY_LEVEL", true, true),
            ("PRINT_START BED=60", false, true),
            ("hello", false, true),
            ("Q3", false, false),
        ] {
            let line = Line::parse(line.as_bytes());
            let command = line.command.unwrap();
            assert_eq!((is_known(&command), may_move(&command)), (known, moves), "{command:?}");
        }
    }
}
