use super::*;
use crate::{ClipperInset, region_shapes::*};

fn fill(face: &Polygon) -> (Vec<Path>, f64, Cover) {
    let face = std::slice::from_ref(face);
    let paths = against(face, &AgainstOptions::new(WIDTH, HEIGHT), &ClipperInset::default());
    let volume = volume(&paths) / (face[0].area() * HEIGHT);
    let cover = cover(face, &paths, 0.03);
    (paths, volume, cover)
}

#[test]
fn probe() {
    for w in 0..26 {
        let w = 1.0 + 0.2 * f64::from(w);
        let straight = band(40.0, |_| 0.0, |_| w);
        let (p, v, c) = fill(&straight);
        println!("straight {w:.1}: volume {v:.4} {c:.4?} {}", p.len());
        let wavy =
            band(60.0, |x| (x * 0.3).sin(), |x| (x * 0.3).sin() + w + 0.4 * (x * 0.17).sin());
        let (p, v, c) = fill(&wavy);
        println!("wavy {w:.1}: volume {v:.4} {c:.4?} {}", p.len());
    }
    let wedge = band(60.0, |_| 0.0, |x| 0.2 + x * 0.02);
    let (p, v, c) = fill(&wedge);
    println!("wedge: volume {v:.4} {c:.4?} {}", p.len());
    for p in &p {
        println!(
            "{} {:.3} {:.2} {:?} {:?}",
            p.closed,
            p.width,
            p.length(),
            p.points[0],
            p.points[p.points.len() - 1]
        );
    }
}
