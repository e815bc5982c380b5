use fgm_core::{Bounds3, Point3};

/// Where the nozzle can go: a box.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Bed {
    /// Least corner, mm: usually 0, 0, 0; negative x and y where the origin is in the middle.
    pub origin: [f64; 3],
    /// Width, depth and height, mm.
    pub size: [f64; 3],
}

impl Default for Bed {
    fn default() -> Self {
        Self { origin: [0.0; 3], size: [250.0; 3] }
    }
}

impl Bed {
    /// The box in the machine's coordinates.
    pub fn bounds(&self) -> Bounds3 {
        let min = Point3::from_array(self.origin);
        Bounds3::new(min, min + Point3::from_array(self.size))
    }

    /// The offset that centres a design over the bed and stands it on it:
    /// `bed position = design position + offset`.
    pub fn centering(&self, design: &Bounds3) -> Point3 {
        let (bed, part) = (self.bounds(), design.center());
        Point3::new(
            bed.center().x - part.x,
            bed.center().y - part.y,
            bed.min.z.max(0.0) - design.min.z,
        )
    }
}
