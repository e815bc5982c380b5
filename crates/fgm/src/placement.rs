use fgm_core::Bounds3;

use crate::error::SliceError;

/// Room the part may lack to the bed's size and still count as fitting, mm.
const SLACK: f64 = 1e-6;

/// That a part of this size fits into what the machine reaches.
pub(crate) fn check(part: &Bounds3, bed: &Bounds3, printer: &str) -> Result<(), SliceError> {
    let over = part.size() - bed.size();
    let (axis, over) = [('x', over.x), ('y', over.y), ('z', over.z)]
        .into_iter()
        .fold(('x', f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most });
    if over <= SLACK {
        return Ok(());
    }
    Err(SliceError::TooLarge {
        part: Box::new(*part),
        bed: Box::new(*bed),
        printer: printer.to_owned(),
        axis,
        over,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Point3;

    fn cube(side: f64) -> Bounds3 {
        Bounds3::new(Point3::splat(-0.5 * side), Point3::splat(0.5 * side))
    }

    #[test]
    fn a_large_part_is_told_by_how_much() {
        let bed = Bounds3::new(Point3::ZERO, Point3::new(200.0, 100.0, 150.0));
        assert!(check(&cube(100.0), &bed, "p").is_ok());
        let error = check(&cube(130.5), &bed, "p").unwrap_err().to_string();
        assert!(error.contains("too large by 30.50 mm in y"), "{error}");
    }
}
