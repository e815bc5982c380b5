use crate::Machine;

macro_rules! profiles {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../printers/", $name, ".toml")))),*]
    };
}

/// Names and texts of the profiles that come with the crate.
const PROFILES: [(&str, &str); 10] = profiles![
    "generic-mixing",
    "geeetech-mizar-m",
    "geeetech-a20m",
    "prusa-xl-5t",
    "prusa-mk4s-lw-pla",
    "prusa-mk4s-varioshore-tpu",
    "snmf-4",
    "duet-mixing",
    "klipper-toolchanger",
    "kalico-mixing",
];

impl Machine {
    /// A profile that comes with the crate; none for another name.
    ///
    /// ```
    /// use fgm_gcode::Machine;
    /// assert_eq!(Machine::builtin("prusa-xl-5t").and_then(|m| m.max_colors()), Some(5));
    /// assert!(Machine::builtin("no-such-printer").is_none());
    /// ```
    pub fn builtin(name: &str) -> Option<Self> {
        // The profiles' tests read every one of them.
        Self::from_toml(Self::builtin_toml(name)?).ok()
    }

    /// The names of the profiles that come with the crate.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        PROFILES.iter().map(|(name, _)| *name)
    }

    /// The text of a profile that comes with the crate, to be copied and changed.
    pub fn builtin_toml(name: &str) -> Option<&'static str> {
        PROFILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
    }
}
