//! How the table of settings becomes types, defaults and a list.

/// One line of the list of settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SettingInfo {
    /// The section of the settings file.
    pub section: &'static str,
    /// The key in its section.
    pub key: &'static str,
    /// The unit, or the kind of value.
    pub unit: &'static str,
    /// The default, as the settings file would say it, or where it comes from.
    pub default: &'static str,
    /// What it does.
    pub help: &'static str,
}
/// Makes [`Settings`](super::Settings), its sections, their defaults and the list of all of them.
macro_rules! settings {
    ($(
        #[doc = $section_doc:literal]
        $section:ident: $Section:ident {
            $( #[doc = $doc:literal] $key:ident: $type:ty = $default:expr, $shown:literal, $unit:literal; )*
        }
    )*) => {
        /// All settings of a slice. Every key may be left out of a file; unknown keys are errors.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct Settings {
            $( #[doc = $section_doc] pub $section: $Section, )*
            /// Changes to the printer's profile, laid over it.
            #[serde(skip_serializing_if = "toml::Table::is_empty")]
            pub machine: toml::Table,
        }

        $(
            #[doc = $section_doc]
            #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
            #[serde(default, deny_unknown_fields)]
            pub struct $Section {
                $( #[doc = $doc] pub $key: $type, )*
            }

            impl Default for $Section {
                fn default() -> Self {
                    Self { $( $key: $default, )* }
                }
            }
        )*

        /// The settings in the order of the file, for listing.
        pub const SETTINGS: &[SettingInfo] = &[$($(
            SettingInfo {
                section: stringify!($section),
                key: stringify!($key),
                unit: $unit,
                default: $shown,
                help: $doc,
            },
        )*)*];
    };
}

pub(super) use settings;
