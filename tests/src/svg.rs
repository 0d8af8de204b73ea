//! Figures for the pages in `docs/method/`: curves over two axes, as SVG.
//!
//! ```text
//! Figure::new(Axis::new("h").logarithmic(), Axis::new("error"))
//!     .line("explicit", &points).dots("paper", &others).svg()
//! ```
//!
//! Same curves, same bytes: a figure is compared with the one under version control.

mod axis;

use std::fmt::Write;

pub use axis::Axis;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 420.0;
const LEFT: f64 = 72.0;
const RIGHT: f64 = 600.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 372.0;

/// Colours that also the colour-blind tell apart (M. Okabe, K. Ito).
const COLOURS: [&str; 7] =
    ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

#[derive(Clone, Copy, PartialEq)]
enum Stroke {
    Line,
    Dashed,
    Dots,
}

struct Curve {
    name: String,
    stroke: Stroke,
    points: Vec<[f64; 2]>,
}

/// Curves over two axes, with a legend beside them.
pub struct Figure {
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
}

impl Figure {
    /// Axes without curves.
    pub fn new(x: Axis, y: Axis) -> Self {
        Figure { x, y, curves: Vec::new() }
    }

    /// A line through points; a point that is not finite leaves a gap.
    pub fn line(self, name: &str, points: &[[f64; 2]]) -> Self {
        self.with(name, Stroke::Line, points)
    }

    /// A dashed line through points, for what the others are compared with.
    pub fn dashed(self, name: &str, points: &[[f64; 2]]) -> Self {
        self.with(name, Stroke::Dashed, points)
    }

    /// Points alone.
    pub fn dots(self, name: &str, points: &[[f64; 2]]) -> Self {
        self.with(name, Stroke::Dots, points)
    }

    fn with(mut self, name: &str, stroke: Stroke, points: &[[f64; 2]]) -> Self {
        self.curves.push(Curve { name: name.into(), stroke, points: points.to_vec() });
        self
    }

    /// The figure as a file.
    pub fn svg(&self) -> String {
        let coordinate = |i: usize| {
            self.curves.iter().flat_map(move |curve| curve.points.iter().map(move |p| p[i]))
        };
        let (x, y) = (self.x.fitted(coordinate(0)), self.y.fitted(coordinate(1)));
        let frame = Frame { x: &x, y: &y };
        let curves: String = self
            .curves
            .iter()
            .enumerate()
            .map(|(at, curve)| frame.curve(curve, COLOURS[at % 7]))
            .collect();
        let legend: String =
            self.curves.iter().enumerate().map(|(at, curve)| legend(at, curve)).collect();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"white\"/>\n\
             <clipPath id=\"frame\"><rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" \
             height=\"{}\"/></clipPath>\n\
             {}<g clip-path=\"url(#frame)\" fill=\"none\" stroke-width=\"1.5\" \
             stroke-linejoin=\"round\">\n{curves}</g>\n{legend}</svg>\n",
            RIGHT - LEFT,
            BOTTOM - TOP,
            frame.axes(),
        )
    }
}

/// Where numbers are drawn.
struct Frame<'f> {
    x: &'f Axis,
    y: &'f Axis,
}

impl Frame<'_> {
    fn place(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        (LEFT + (RIGHT - LEFT) * self.x.part(x), BOTTOM - (BOTTOM - TOP) * self.y.part(y))
    }

    fn axes(&self) -> String {
        let mut text = String::new();
        for (value, label) in self.x.ticks() {
            let x = LEFT + (RIGHT - LEFT) * self.x.part(value);
            text += &rule(&format!("M{x:.1} {TOP}V{BOTTOM}"), "#dddddd");
            text += &words(x, BOTTOM + 18.0, "middle", &label);
        }
        for (value, label) in self.y.ticks() {
            let y = BOTTOM - (BOTTOM - TOP) * self.y.part(value);
            text += &rule(&format!("M{LEFT} {y:.1}H{RIGHT}"), "#dddddd");
            text += &words(LEFT - 7.0, y + 4.5, "end", &label);
        }
        text += &rule(&format!("M{LEFT} {TOP}V{BOTTOM}H{RIGHT}V{TOP}Z"), "#666666");
        text += &words(0.5 * (LEFT + RIGHT), HEIGHT - 10.0, "middle", &self.x.label);
        let (x, y) = (16.0, 0.5 * (TOP + BOTTOM));
        let turned =
            format!("<text transform=\"translate({x} {y}) rotate(-90)\" text-anchor=\"middle\">");
        text + &turned + &escaped(&self.y.label) + "</text>\n"
    }

    fn curve(&self, curve: &Curve, colour: &str) -> String {
        let places = curve.points.iter().map(|&point| self.place(point));
        if curve.stroke == Stroke::Dots {
            return places
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .map(|(x, y)| {
                    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.4\" fill=\"{colour}\"/>\n")
                })
                .collect();
        }
        let mut path = String::new();
        let mut command = 'M';
        for (x, y) in places {
            if x.is_finite() && y.is_finite() {
                write!(path, "{command}{x:.1} {y:.1}").expect("a string takes everything");
                command = 'L';
            } else {
                command = 'M';
            }
        }
        format!("<path d=\"{path}\" stroke=\"{colour}\"{}/>\n", dashes(curve.stroke))
    }
}

fn legend(at: usize, curve: &Curve) -> String {
    let (colour, y) = (COLOURS[at % 7], TOP + 12.0 + 20.0 * at as f64);
    let (from, to) = (RIGHT + 12.0, RIGHT + 34.0);
    let sample = match curve.stroke {
        Stroke::Dots => {
            format!(
                "<circle cx=\"{}\" cy=\"{y}\" r=\"2.4\" fill=\"{colour}\"/>\n",
                0.5 * (from + to)
            )
        }
        stroke => format!(
            "<path d=\"M{from} {y}H{to}\" stroke=\"{colour}\" stroke-width=\"1.5\"{}/>\n",
            dashes(stroke)
        ),
    };
    sample + &words(to + 6.0, y + 4.5, "start", &curve.name)
}

fn dashes(stroke: Stroke) -> &'static str {
    if stroke == Stroke::Dashed { " stroke-dasharray=\"6 4\"" } else { "" }
}

fn rule(path: &str, colour: &str) -> String {
    format!("<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\"/>\n")
}

fn words(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
