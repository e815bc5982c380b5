//! What slicers say in comments.

use fgm_core::{MAX_MATERIALS, Mixture, Role};

/// A comment that tells something about the beads after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tag {
    Layer,
    Z(f64),
    Height(f64),
    Width(f64),
    /// What the beads are for; none for a word that is not known.
    Role(Option<Role>),
    /// The colour's index and its mixture.
    Color(u32, Option<Mixture>),
}

/// The names of roles in PrusaSlicer's family, in Cura and in Bambu's family.
const ROLES: [(&str, Role); 40] = [
    ("External perimeter", Role::OuterWall),
    ("Perimeter", Role::InnerWall),
    ("Overhang perimeter", Role::OuterWall),
    ("Internal infill", Role::Infill),
    ("Solid infill", Role::SolidInfill),
    ("Top solid infill", Role::TopSkin),
    ("Ironing", Role::TopSkin),
    ("Bridge infill", Role::Bridge),
    ("Gap fill", Role::GapFill),
    ("Skirt", Role::Skirt),
    ("Skirt/Brim", Role::Skirt),
    ("Support material", Role::Support),
    ("Support material interface", Role::Support),
    ("Wipe tower", Role::PurgeTower),
    ("WALL-OUTER", Role::OuterWall),
    ("WALL-INNER", Role::InnerWall),
    ("FILL", Role::Infill),
    ("SKIN", Role::SolidInfill),
    ("SKIRT", Role::Skirt),
    ("SUPPORT", Role::Support),
    ("SUPPORT-INTERFACE", Role::Support),
    ("PRIME-TOWER", Role::PurgeTower),
    ("Outer wall", Role::OuterWall),
    ("Inner wall", Role::InnerWall),
    ("Overhang wall", Role::OuterWall),
    ("Sparse infill", Role::Infill),
    ("Internal solid infill", Role::SolidInfill),
    ("Bottom surface", Role::BottomSkin),
    ("Top surface", Role::TopSkin),
    ("Bridge", Role::Bridge),
    ("Internal Bridge", Role::Bridge),
    ("Gap infill", Role::GapFill),
    ("Brim", Role::Skirt),
    ("Support", Role::Support),
    ("Support interface", Role::Support),
    ("Support transition", Role::Support),
    ("Prime tower", Role::PurgeTower),
    ("Solid support", Role::Support),
    ("RAFT", Role::Support),
    ("Raft", Role::Support),
];

/// Reads a comment; none for one that says nothing about beads.
pub(super) fn read(comment: &[u8]) -> Option<Tag> {
    let comment = comment.trim_ascii();
    // Most comments are other ones: the first letter sorts them out.
    if !matches!(comment.first(), Some(b'L' | b'Z' | b'H' | b'W' | b'T' | b'C' | b'F')) {
        return None;
    }
    if comment == b"LAYER_CHANGE" || comment == b"CHANGE_LAYER" {
        return Some(Tag::Layer);
    }
    let colon = comment.iter().position(|&b| b == b':')?;
    let (name, value) = (&comment[..colon], comment[colon + 1..].trim_ascii());
    match name {
        b"LAYER" => Some(Tag::Layer),
        b"Z" | b"Z_HEIGHT" => number(value).map(Tag::Z),
        b"HEIGHT" | b"LAYER_HEIGHT" => number(value).filter(|h| *h > 0.0).map(Tag::Height),
        b"WIDTH" | b"LINE_WIDTH" => number(value).filter(|w| *w > 0.0).map(Tag::Width),
        b"TYPE" | b"FEATURE" => {
            let known = ROLES.iter().find(|(name, _)| name.as_bytes() == value);
            Some(Tag::Role(known.map(|(_, role)| *role)))
        }
        b"COLOR" => color(value),
        _ => None,
    }
}

fn number(text: &[u8]) -> Option<f64> {
    let value: f64 = std::str::from_utf8(text).ok()?.parse().ok()?;
    (value.abs() <= super::GREATEST).then_some(value)
}

/// `COLOR:3 0.25 0.75`.
fn color(text: &[u8]) -> Option<Tag> {
    let mut words = text.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
    let index = std::str::from_utf8(words.next()?).ok()?.parse().ok()?;
    let mut weights = [0.0; MAX_MATERIALS];
    let mut count = 0;
    for word in words {
        *weights.get_mut(count)? = number(word)?;
        count += 1;
    }
    Some(Tag::Color(index, Mixture::from_weights(&weights[..count]).ok()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_of_several_slicers() {
        for (comment, expected) in [
            ("LAYER_CHANGE", Some(Tag::Layer)),
            (" CHANGE_LAYER", Some(Tag::Layer)),
            ("LAYER:-2", Some(Tag::Layer)),
            ("Z:0.2", Some(Tag::Z(0.2))),
            (" Z_HEIGHT: 0.4", Some(Tag::Z(0.4))),
            ("HEIGHT:0.2", Some(Tag::Height(0.2))),
            ("HEIGHT:-1", None),
            ("WIDTH:0.45", Some(Tag::Width(0.45))),
            ("WIDTH:nan", None),
            ("TYPE:External perimeter", Some(Tag::Role(Some(Role::OuterWall)))),
            ("TYPE:WALL-INNER", Some(Tag::Role(Some(Role::InnerWall)))),
            (" FEATURE: Sparse infill", Some(Tag::Role(Some(Role::Infill)))),
            ("TYPE:Custom", Some(Tag::Role(None))),
            ("COLOR:3", Some(Tag::Color(3, None))),
            ("COLOR:x 1", None),
            ("TIME_ELAPSED:9.5", None),
            ("wall: 3", None),
            ("", None),
        ] {
            assert_eq!(read(comment.as_bytes()), expected, "{comment}");
        }
        let mixture = Mixture::from_weights(&[0.25, 0.75]).ok();
        assert_eq!(read(b"COLOR:1 0.25 0.75"), Some(Tag::Color(1, mixture)));
    }
}
