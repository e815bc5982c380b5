use std::fmt::Write as _;

const INKS: [&str; 4] = ["#1f5fa8", "#c0501d", "#3a8a3a", "#999999"];
/// Where the axes lie in the picture of 640 by 360.
const LEFT: f64 = 60.0;
const RIGHT: f64 = 610.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 310.0;

/// From where to where, with a number at every step.
#[derive(Clone, Copy)]
pub(crate) struct Axis {
    /// What it shows.
    pub(crate) label: &'static str,
    /// Its ends.
    pub(crate) range: (f64, f64),
    /// Steps that are numbered.
    pub(crate) steps: u32,
    /// Decimals of the numbers.
    pub(crate) decimals: usize,
}

/// Curves over an axis, as an SVG.
pub(crate) struct Plot {
    /// Across.
    pub(crate) x: Axis,
    /// Upwards.
    pub(crate) y: Axis,
    /// Whether the points are shown.
    pub(crate) dots: bool,
    /// Names and points.
    pub(crate) curves: Vec<(String, Vec<(f64, f64)>)>,
}

impl Axis {
    /// Numbers and their shares of the axis.
    fn marks(self) -> impl Iterator<Item = (String, f64)> {
        let (from, to) = self.range;
        (0..=self.steps).map(move |i| {
            let share = f64::from(i) / f64::from(self.steps);
            (format!("{:.*}", self.decimals, from + (to - from) * share), share)
        })
    }

    fn share(self, value: f64) -> f64 {
        (value - self.range.0) / (self.range.1 - self.range.0)
    }
}

impl Plot {
    /// The picture.
    pub(crate) fn svg(&self) -> Result<String, std::fmt::Error> {
        let across = |share: f64| LEFT + share * (RIGHT - LEFT);
        let up = |share: f64| BOTTOM - share * (BOTTOM - TOP);
        let mut svg = String::from(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 360\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"640\" height=\"360\" fill=\"white\"/>\n",
        );
        for (number, share) in self.y.marks() {
            let (y, base) = (up(share), up(share) + 4.0);
            writeln!(svg, "<path d=\"M{LEFT} {y}H{RIGHT}\" stroke=\"#ddd\"/>")?;
            writeln!(svg, "<text x=\"52\" y=\"{base}\" text-anchor=\"end\">{number}</text>")?;
        }
        for (number, share) in self.x.marks() {
            let x = across(share);
            writeln!(svg, "<text x=\"{x}\" y=\"328\" text-anchor=\"middle\">{number}</text>")?;
        }
        writeln!(
            svg,
            "<path d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" stroke=\"black\"/>"
        )?;
        writeln!(svg, "<text x=\"335\" y=\"350\" text-anchor=\"middle\">{}</text>", self.x.label)?;
        writeln!(svg, "<text x=\"62\" y=\"18\">{}</text>", self.y.label)?;
        let mut key = RIGHT;
        for ((name, curve), ink) in self.curves.iter().zip(INKS).rev() {
            let places: Vec<(f64, f64)> = curve
                .iter()
                .map(|&(x, y)| (across(self.x.share(x)), up(self.y.share(y))))
                .collect();
            let points: Vec<String> =
                places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            let points = points.join(" ");
            writeln!(
                svg,
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"2\"/>"
            )?;
            for (x, y) in places.iter().filter(|_| self.dots) {
                writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{ink}\"/>")?;
            }
            writeln!(
                svg,
                "<text x=\"{key}\" y=\"34\" text-anchor=\"end\" fill=\"{ink}\">{name}</text>"
            )?;
            key -= 7.0 * name.len() as f64 + 16.0;
        }
        svg.push_str("</svg>\n");
        Ok(svg)
    }
}
