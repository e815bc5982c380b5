use std::time::Instant;

/// What one library made of one input.
pub struct Report {
    pub library: &'static str,
    pub input: String,
    pub seconds: f64,
    pub vertices: Option<usize>,
    pub edges: Option<usize>,
    pub faces: usize,
    pub area: f64,
}

/// The shortest time of some runs, and the last result; dropping results is not timed.
pub fn fastest<T>(runs: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut once = || {
        let start = Instant::now();
        let result = run();
        (start.elapsed().as_secs_f64(), result)
    };
    let (mut least, mut result) = once();
    for _ in 1..runs {
        drop(result);
        let (seconds, next) = once();
        (least, result) = (least.min(seconds), next);
    }
    (least, result)
}

impl Report {
    /// One line: library, input, ms, MB at most, vertices, edges, faces, mm².
    pub fn print(&self) {
        let count = |n: Option<usize>| n.map_or("-".into(), |n| n.to_string());
        println!(
            "{:22} {:12} {:9.2} ms {:6.0} MB {:>8} V {:>8} E {:>8} F {:.9} mm2",
            self.library,
            self.input,
            self.seconds * 1e3,
            peak(),
            count(self.vertices),
            count(self.edges),
            self.faces,
            self.area,
        );
    }
}

/// The most memory that this process ever held, MB, as Linux tells it; 0 elsewhere.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.unwrap_or(0.0) * 1024.0 / 1e6
}
