use std::path::Path;

use fgm_core::Point3;
use glam::DAffine3;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::package::part_name;
use crate::problem::MAX_TRIANGLES;
use crate::{DesignError, Problem};

/// The units a model may be in, and their length in mm.
const UNITS: [(&str, f64); 6] = [
    ("micron", 1e-3),
    ("millimeter", 1.0),
    ("centimeter", 10.0),
    ("inch", 25.4),
    ("foot", 304.8),
    ("meter", 1000.0),
];

/// What one part of a 3MF file says: its objects and, in the root part, what is to be built.
#[derive(Debug)]
pub(super) struct Model {
    /// Millimetres in a unit.
    pub(super) unit: f64,
    /// By their ids.
    pub(super) objects: Vec<Object>,
    pub(super) items: Vec<Instance>,
}

impl Model {
    /// The object with this id; the first where a file uses one twice.
    pub(super) fn object(&self, id: u32) -> Option<&Object> {
        let at = self.objects.partition_point(|o| o.id < id);
        self.objects.get(at).filter(|o| o.id == id)
    }
}

#[derive(Debug, Default)]
pub(super) struct Object {
    pub(super) id: u32,
    /// Support structures, which are not part of the design.
    pub(super) support: bool,
    pub(super) vertices: Vec<Point3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) components: Vec<Instance>,
}

/// An object at a place.
#[derive(Clone, Debug)]
pub(super) struct Instance {
    pub(super) object: u32,
    /// The part that holds the object, where it is another one (the production extension).
    pub(super) part: Option<String>,
    pub(super) transform: DAffine3,
    pub(super) printable: bool,
}

/// Reads a part. `text` is its XML.
pub(super) fn parse(text: &str, part: &str, file: &Path) -> Result<Model, DesignError> {
    let mut reader = Reader::from_str(text);
    let mut parser = Parser {
        model: Model { unit: 1.0, objects: Vec::new(), items: Vec::new() },
        prefix: None,
        in_object: false,
        triangles: 0,
    };
    let at = |offset: u64, what: String| {
        DesignError::file(file, Problem::Model { part: part.to_string(), offset, what })
    };
    loop {
        let offset = reader.buffer_position();
        let event = reader.read_event().map_err(|error| {
            let offset = reader.error_position();
            DesignError::file(file, Problem::Xml { part: part.to_string(), offset, error })
        })?;
        match event {
            Event::Start(e) | Event::Empty(e) => {
                parser.element(&e).map_err(|what| at(offset, what))?;
            }
            Event::End(e) if parser.is_core(e.name().0) == Some("object") => {
                parser.in_object = false;
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if parser.prefix.is_none() {
        return Err(at(0, "no `model` element".to_string()));
    }
    parser.model.objects.sort_by_key(|o| o.id);
    Ok(parser.model)
}

struct Parser {
    model: Model,
    /// What stands before the colon in the names of the core's elements, colon included. Elements
    /// of extensions have another prefix, and some have the same names (`vertex`).
    prefix: Option<String>,
    in_object: bool,
    triangles: usize,
}

impl Parser {
    /// A name without the core's prefix; none where it is not one of the core's.
    fn is_core<'n>(&self, name: &'n str) -> Option<&'n str> {
        let rest = name.strip_prefix(self.prefix.as_deref()?)?;
        (!rest.contains(':')).then_some(rest)
    }

    fn element(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let name = e.name();
        if self.prefix.is_none() {
            let prefix = name.0.strip_suffix("model").filter(|p| p.is_empty() || p.ends_with(':'));
            let Some(prefix) = prefix else {
                return Err(format!("expected a `model` element, found `{}`", name.0));
            };
            self.prefix = Some(prefix.to_string());
            return self.unit(e);
        }
        match self.is_core(name.0) {
            Some("vertex") => self.vertex(e),
            Some("triangle") => self.triangle(e),
            Some("object") => self.object(e),
            Some("component") => {
                let instance = instance(e)?;
                self.current("component")?.components.push(instance);
                Ok(())
            }
            Some("item") => {
                self.model.items.push(instance(e)?);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn unit(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let mut found = Ok(());
        attributes(e, |key, value| {
            if key == "unit" {
                match UNITS.iter().find(|(name, _)| *name == value) {
                    Some((_, mm)) => self.model.unit = *mm,
                    None => found = Err(format!("unknown unit `{value}`")),
                }
            }
        })?;
        found
    }

    fn object(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let mut object = Object::default();
        let mut id = None;
        attributes(e, |key, value| match key {
            "id" => id = value.parse().ok(),
            "type" => object.support = value == "support",
            _ => {}
        })?;
        object.id = id.ok_or("an object without a number as its `id`")?;
        self.model.objects.push(object);
        self.in_object = !e.is_empty();
        Ok(())
    }

    fn current(&mut self, what: &str) -> Result<&mut Object, String> {
        let object = self.model.objects.last_mut().filter(|_| self.in_object);
        object.ok_or_else(|| format!("a {what} outside of an object"))
    }

    fn vertex(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let mut p = Point3::NAN;
        attributes(e, |key, value| {
            let number = || value.trim().parse().unwrap_or(f64::NAN);
            match key {
                "x" => p.x = number(),
                "y" => p.y = number(),
                "z" => p.z = number(),
                _ => {}
            }
        })?;
        let object = self.current("vertex")?;
        if !p.is_finite() {
            let index = object.vertices.len();
            return Err(format!("vertex {index} of object {} has no finite x, y, z", object.id));
        }
        object.vertices.push(p);
        Ok(())
    }

    fn triangle(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let mut t = [None; 3];
        attributes(e, |key, value| {
            let number = || value.trim().parse::<u32>().ok();
            match key {
                "v1" => t[0] = number(),
                "v2" => t[1] = number(),
                "v3" => t[2] = number(),
                _ => {}
            }
        })?;
        self.triangles += 1;
        if self.triangles > MAX_TRIANGLES {
            return Err(format!("more than {MAX_TRIANGLES} triangles"));
        }
        let object = self.current("triangle")?;
        let index = object.triangles.len();
        let ([Some(a), Some(b), Some(c)], count) = (t, object.vertices.len()) else {
            return Err(format!("triangle {index} of object {} has no v1, v2, v3", object.id));
        };
        if [a, b, c].iter().any(|&v| v as usize >= count) {
            return Err(format!(
                "triangle {index} of object {} uses a vertex beyond its {count}",
                object.id
            ));
        }
        object.triangles.push([a, b, c]);
        Ok(())
    }
}

/// A `component` or an `item`.
fn instance(e: &BytesStart<'_>) -> Result<Instance, String> {
    let (mut object, mut part) = (None, None);
    let (mut transform, mut printable) = (Ok(DAffine3::IDENTITY), true);
    attributes(e, |key, value| match key {
        "objectid" => object = value.trim().parse().ok(),
        "transform" => transform = parse_transform(value),
        // Written by the PrusaSlicer family.
        "printable" => printable = value != "0",
        _ if key.ends_with(":path") => part = Some(part_name(value).to_string()),
        _ => {}
    })?;
    let object = object.ok_or("a component or item without a number as its `objectid`")?;
    Ok(Instance { object, part, transform: transform?, printable })
}

/// Twelve numbers: the rows of a 4 x 3 matrix that a row vector (x, y, z, 1) is multiplied by.
fn parse_transform(text: &str) -> Result<DAffine3, String> {
    let mut rows = [0.0; 12];
    let mut words = text.split_ascii_whitespace();
    for slot in &mut rows {
        *slot = words.next().and_then(|w| w.parse().ok()).unwrap_or(f64::NAN);
    }
    if words.next().is_some() || rows.iter().any(|v| !v.is_finite()) {
        return Err(format!("a transform is twelve numbers, not `{text}`"));
    }
    // Rows for a row vector are columns for a column vector.
    Ok(DAffine3::from_cols_array(&rows))
}

fn attributes(e: &BytesStart<'_>, mut each: impl FnMut(&str, &str)) -> Result<(), String> {
    for attribute in e.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| error.to_string())?;
        each(attribute.key.0, &attribute.value);
    }
    Ok(())
}
