use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::Warning;
use crate::problem::MAX_TEXT_BYTES;

/// Colours by name that need no palette: those of HTML, as a design's author means them.
const USUAL: [(&str, [u8; 3]); 16] = [
    ("black", [0, 0, 0]),
    ("white", [255, 255, 255]),
    ("gray", [128, 128, 128]),
    ("grey", [128, 128, 128]),
    ("red", [220, 30, 30]),
    ("green", [30, 160, 60]),
    ("blue", [30, 80, 200]),
    ("yellow", [245, 210, 20]),
    ("orange", [240, 130, 20]),
    ("purple", [130, 50, 160]),
    ("pink", [240, 130, 180]),
    ("cyan", [0, 180, 220]),
    ("magenta", [210, 0, 130]),
    ("brown", [120, 70, 30]),
    ("gold", [212, 175, 55]),
    ("silver", [192, 192, 192]),
];

/// The colours of materials, from a JSON file beside the design.
#[derive(Debug, Default)]
pub(crate) struct Palette {
    /// Where the colours came from; none for the usual ones.
    file: Option<PathBuf>,
    colors: BTreeMap<String, [u8; 3]>,
}

#[derive(Deserialize)]
struct PaletteFile {
    /// A file without it is some other JSON, such as a report.
    materials: Option<Vec<Entry>>,
}

#[derive(Deserialize)]
struct Entry {
    name: String,
    r: f64,
    g: f64,
    b: f64,
}

impl Palette {
    /// The palette of a design: `<design>.json` beside it, else `materials.json`, else
    /// `palette.json` in its folder; the first that holds a list `materials`.
    ///
    /// Colours are only shown, never printed, so nothing that is wrong with a palette stops the
    /// design: it becomes a warning.
    pub(crate) fn find(design: Option<&Path>, folder: &Path, warnings: &mut Vec<Warning>) -> Self {
        let own = design.map(|path| path.with_extension("json"));
        let others = ["materials.json", "palette.json"].map(|name| folder.join(name));
        for file in own.into_iter().chain(others) {
            let Ok(meta) = fs::metadata(&file) else { continue };
            let text = if meta.len() > MAX_TEXT_BYTES {
                Err(format!("more than {MAX_TEXT_BYTES} bytes"))
            } else {
                fs::read_to_string(&file).map_err(|error| error.to_string())
            };
            match text.and_then(|text| Self::parse(&text, &file, warnings)) {
                Ok(Some(palette)) => return palette,
                Ok(None) => {}
                Err(reason) => warnings.push(Warning::Palette { file, reason }),
            }
        }
        Self::default()
    }

    fn parse(text: &str, file: &Path, warnings: &mut Vec<Warning>) -> Result<Option<Self>, String> {
        let read: PaletteFile = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let Some(entries) = read.materials else { return Ok(None) };
        let mut colors = BTreeMap::new();
        for Entry { name, r, g, b } in entries {
            if colors.contains_key(&name) {
                warnings.push(Warning::DuplicateMaterial {
                    file: file.to_path_buf(),
                    at: None,
                    name,
                });
                continue;
            }
            let color = [r, g, b].map(|v| v.round().clamp(0.0, 255.0) as u8);
            colors.insert(name, color);
        }
        Ok(Some(Self { file: Some(file.to_path_buf()), colors }))
    }

    /// The colour of a material; warns where there is a palette that does not know it.
    pub(crate) fn color(&self, name: &str, warnings: &mut Vec<Warning>) -> Option<[u8; 3]> {
        if let Some(color) = self.colors.get(name) {
            return Some(*color);
        }
        if let Some(file) = &self.file {
            warnings.push(Warning::NoColor { file: file.clone(), name: name.to_string() });
        }
        let usual = USUAL.iter().find(|(usual, _)| name.eq_ignore_ascii_case(usual));
        usual.map(|(_, color)| *color)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_a_name_counts_and_other_json_is_passed_over() {
        let mut warnings = Vec::new();
        let text = r#"{"materials": [
            {"name": "blue", "r": 1, "g": 2, "b": 300, "a": 255, "id": 7},
            {"name": "blue", "r": 9, "g": 9, "b": 9}, {"name": "void", "r": 0, "g": 0, "b": 0, "a": 0}]}"#;
        let palette = Palette::parse(text, Path::new("p.json"), &mut warnings).unwrap().unwrap();
        assert_eq!(palette.color("blue", &mut warnings), Some([1, 2, 255]));
        assert_eq!(palette.color("Red", &mut warnings), Some([220, 30, 30]));
        assert_eq!(palette.color("steel", &mut warnings), None);
        let told: Vec<_> = warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "p.json: material `blue` is named twice; the first counts",
                "p.json: no colour for material `Red`",
                "p.json: no colour for material `steel`",
            ]
        );
        let other = Palette::parse(r#"{"layers": 3}"#, Path::new("p.json"), &mut warnings);
        assert!(other.unwrap().is_none());
        let wrong = Palette::parse("{\"materials\":\n[{]}", Path::new("p.json"), &mut warnings);
        assert!(wrong.unwrap_err().contains("line 2 column 3"));
    }
}
