//! What the tests of whole slices share: designs, settings, and a look at the written G-code that
//! owes nothing to the planner.

#![allow(
    dead_code,
    unreachable_pub,
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "each test uses its part"
)]

use std::path::{Path, PathBuf};

use fgm::{
    ColorCount, Quiet, Report, Settings, Slicer, Strategy,
    core::{Point2, Point3},
    design::{self, LoadOptions},
    field::Design,
    gcode::{Machine, Reader},
};

/// A design from text.
pub fn parse(source: &str) -> Design {
    design::parse_vcad(source, Path::new("."), &LoadOptions::default()).unwrap().design
}

/// A design of `designs/`.
pub fn builtin(name: &str) -> Design {
    let file = format!("{}/../../designs/{name}.vcad", env!("CARGO_MANIFEST_DIR"));
    design::load(Path::new(&file), &LoadOptions::default()).unwrap().design
}

/// A real model with a fraction, where the folder of models is at hand.
pub fn model(file: &str, fraction: &str) -> Option<Design> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = std::env::var_os("FGM_MODELS").map_or(beside, PathBuf::from);
    let path = folder.join(file);
    if !path.exists() {
        println!("skipped: {} is not here (FGM_MODELS names its folder)", path.display());
        return None;
    }
    let options = LoadOptions { fractions: vec![fraction.into()], ..LoadOptions::default() };
    Some(design::load(&path, &options).unwrap().design)
}

/// The default settings with a strategy and a number of colours.
pub fn settings(strategy: Strategy, colors: usize) -> Settings {
    let mut settings = Settings::default();
    settings.slice.strategy = strategy;
    settings.palette.colors = Some(ColorCount::Count(colors));
    settings
}

/// Slices on a built-in printer.
pub fn slice(design: &Design, printer: &str, settings: &Settings) -> (Report, Vec<u8>) {
    let machine = Machine::builtin(printer).unwrap();
    let mut gcode = Vec::new();
    let report = Slicer::new(design, &machine, settings).slice(&mut gcode, &Quiet).unwrap();
    (report, gcode)
}

/// A bead as the G-code lays it, in the design's coordinates.
#[derive(Clone, Debug)]
pub struct Bead {
    pub from: Point2,
    pub to: Point2,
    /// Of the bead's top.
    pub z: f64,
    pub height: f64,
    pub width: f64,
    /// Filament fed, mm³.
    pub volume: f64,
    /// Of the first material, as commanded.
    pub fraction: f64,
    pub color: usize,
    pub role: String,
    /// From 0, in the order of the file.
    pub layer: usize,
}

impl Bead {
    pub fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    pub fn is_tower(&self) -> bool {
        self.role == "Wipe tower"
    }
}

/// What a G-code file lays down, and the extrusion at which each state was commanded.
pub struct Deposit {
    pub beads: Vec<Bead>,
    /// (colour, volume extruded before the command, mm³).
    pub commands: Vec<(usize, f64)>,
}

/// Reads G-code back.
pub fn deposit(gcode: &[u8]) -> Deposit {
    let filament = std::f64::consts::FRAC_PI_4 * 1.75 * 1.75;
    let mut deposit = Deposit { beads: Vec::new(), commands: Vec::new() };
    let (mut at, mut offset) = (Point3::ZERO, Point3::ZERO);
    let (mut width, mut height, mut role) = (0.0, 0.0, String::new());
    let (mut color, mut fraction, mut layers, mut extruded) = (0, 0.0, 0, 0.0);
    let mut reader = Reader::new(gcode);
    while let Some(line) = reader.next_line().unwrap() {
        let comment = line.comment.map(|c| String::from_utf8_lossy(c).into_owned());
        if let Some((key, value)) = comment.as_deref().and_then(|c| c.split_once([':', '='])) {
            let numbers: Vec<f64> = value.split_whitespace().flat_map(str::parse).collect();
            match key.trim() {
                "design_offset" => offset = Point3::from_slice(&numbers),
                "WIDTH" => width = numbers[0],
                "HEIGHT" => height = numbers[0],
                "TYPE" => role = value.trim().to_owned(),
                "COLOR" => {
                    (color, fraction) = (numbers[0] as usize, numbers[1]);
                    deposit.commands.push((color, extruded));
                }
                _ => {}
            }
        }
        layers += usize::from(comment.as_deref() == Some("LAYER_CHANGE"));
        let Some(command) = line.command.filter(|c| c.is(b'G', 0) || c.is(b'G', 1)) else {
            continue;
        };
        let axis = |letter, at| command.value(letter).unwrap_or(at);
        let to = Point3::new(axis(b'X', at.x), axis(b'Y', at.y), axis(b'Z', at.z));
        let e = axis(b'E', 0.0);
        if layers > 0 && e > 0.0 && to.truncate() != at.truncate() {
            extruded += e * filament;
            deposit.beads.push(Bead {
                from: at.truncate() - offset.truncate(),
                to: to.truncate() - offset.truncate(),
                z: to.z - offset.z,
                height,
                width,
                volume: e * filament,
                fraction,
                color,
                role: role.clone(),
                layer: layers - 1,
            });
        }
        at = to;
    }
    deposit
}

/// Eq. 1 of the gradient-slicing paper.
pub fn eq1(p: Point2) -> f64 {
    (1.0 + (0.02 * p.x + 0.03 * p.y).sin() * (0.03 * p.x - 0.02 * p.y).cos()) / 2.0
}
