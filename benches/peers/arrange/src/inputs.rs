use fgm_arrange::generators;
use fgm_core::Point2;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Steps of the lattice in a mm.
const STEPS: f64 = 1e6;

/// Writes every input into a folder.
pub fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    // Steps of the sampled grid that give about 20,000 and 100,000 segments.
    for (name, step) in [("layer-20k", 0.66), ("layer-100k", 0.132)] {
        let lines = generators::layer(step, 15).into_iter().map(|line| {
            let mut points = line.points;
            if line.closed {
                points.extend(points.first().copied());
            }
            points
        });
        save(folder, name, &lines.collect::<Vec<_>>())?;
    }
    save(folder, "random-2000", &random_segments(2000))?;
    Ok(())
}

fn save(folder: &Path, name: &str, lines: &[Vec<Point2>]) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for line in lines {
        for p in line {
            write!(text, "{:.0} {:.0} ", p.x * STEPS, p.y * STEPS)?;
        }
        text.push('\n');
    }
    let segments: usize = lines.iter().map(|line| line.len() - 1).sum();
    println!("{name}: {} lines, {segments} segments", lines.len());
    Ok(fs::write(folder.join(name).with_extension("txt"), text)?)
}

/// Reads what [`write`] wrote, in mm.
pub fn read(file: &Path) -> Result<Vec<Vec<Point2>>, Box<dyn Error>> {
    let text = fs::read_to_string(file)?;
    let line = |line: &str| {
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let point = |xy: &[f64]| Point2::new(xy[0], xy[1]) / STEPS;
        numbers.map(|numbers| numbers.chunks_exact(2).map(point).collect())
    };
    Ok(text.lines().map(line).collect::<Result<_, _>>()?)
}

/// Segments between random points of a square of 100 mm, at least 50 mm long.
fn random_segments(count: usize) -> Vec<Vec<Point2>> {
    let mut state = 1u64;
    // SplitMix64 (Steele, Lea and Flood 2014).
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 * 100.0 - 50.0
    };
    let mut point = || Point2::new(random(), random());
    let mut segments = Vec::new();
    while segments.len() < count {
        let (a, b) = (point(), point());
        if a.distance(b) >= 50.0 {
            segments.push(vec![a, b]);
        }
    }
    segments
}
