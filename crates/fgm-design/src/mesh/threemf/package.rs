use std::io::{Cursor, Read};
use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::Event;
use zip::ZipArchive;
use zip::result::ZipError;

use crate::problem::MAX_MESH_BYTES;
use crate::{DesignError, Problem};

/// Where the model usually is; taken where the archive does not say.
const USUAL_PART: &str = "3D/3dmodel.model";
/// How the type of the relation ends that leads to the model.
const MODEL_RELATION: &str = "/3dmodel";

/// The parts of a 3MF archive.
pub(super) struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    file: &'a Path,
    /// Bytes that may still be unpacked: an archive of a few kilobytes can hold terabytes.
    left: u64,
}

impl<'a> Package<'a> {
    pub(super) fn open(bytes: &'a [u8], file: &'a Path) -> Result<Self, DesignError> {
        let archive = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| DesignError::file(file, Problem::Zip { error }))?;
        Ok(Self { archive, file, left: MAX_MESH_BYTES })
    }

    /// The name of the part that holds the build.
    pub(super) fn root_part(&mut self) -> Result<String, DesignError> {
        if self.name_of("_rels/.rels").is_some() {
            let relations = self.read("_rels/.rels")?;
            if let Some(target) = model_target(&relations) {
                return Ok(part_name(&target).to_string());
            }
        }
        Ok(USUAL_PART.to_string())
    }

    /// A part's text.
    pub(super) fn read(&mut self, part: &str) -> Result<String, DesignError> {
        let name = self.name_of(part).unwrap_or_else(|| part.to_string());
        let zip = |error| DesignError::file(self.file, Problem::Zip { error });
        let entry = self.archive.by_name(&name).map_err(zip)?;
        // The size is a promise of the archive's; a lie must not cost memory.
        let mut bytes = Vec::with_capacity(entry.size().min(self.left).min(64 << 20) as usize);
        entry
            .take(self.left + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| zip(ZipError::Io(error)))?;
        let Some(left) = self.left.checked_sub(bytes.len() as u64) else {
            return Err(DesignError::FileTooLarge {
                path: self.file.join(part),
                limit: MAX_MESH_BYTES,
            });
        };
        self.left = left;
        // Byte-order marks and UTF-16 do not occur: the format demands UTF-8 or UTF-16, and no
        // program known writes the latter.
        String::from_utf8(bytes).map_err(|error| {
            let offset = error.utf8_error().valid_up_to() as u64;
            let what = "not UTF-8 text".to_string();
            DesignError::file(self.file, Problem::Model { part: part.to_string(), offset, what })
        })
    }

    /// A part's name as the archive spells it: part names do not mind upper and lower case.
    fn name_of(&self, part: &str) -> Option<String> {
        let names = || self.archive.file_names().flatten();
        names()
            .find(|n| n == part)
            .or_else(|| names().find(|n| n.eq_ignore_ascii_case(part)))
            .map(|n| n.to_string())
    }
}

/// A part's name without the slash before it.
pub(super) fn part_name(path: &str) -> &str {
    path.trim_start_matches('/')
}

/// The target of the first relation to a model; none where the text is no list of relations.
fn model_target(relations: &str) -> Option<String> {
    let mut reader = Reader::from_str(relations);
    loop {
        match reader.read_event().ok()? {
            Event::Start(e) | Event::Empty(e) if e.local_name().as_ref() == "Relationship" => {
                let value = |key| e.try_get_attribute(key).ok().flatten().map(|a| a.value);
                if value("Type").is_some_and(|t| t.ends_with(MODEL_RELATION)) {
                    return value("Target").map(std::borrow::Cow::into_owned);
                }
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}
