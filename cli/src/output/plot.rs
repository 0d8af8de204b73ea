//! One signal over time as an SVG figure, with the times at which a surface is held shaded.

use super::document::Document;
use super::number::significant;
use std::fmt::Write;

const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 150.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = WIDTH - 20.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = HEIGHT - 22.0;

/// Where values are drawn.
struct Axes {
    time: [f64; 2],
    value: [f64; 2],
}

impl Axes {
    fn new(time: &[f64], values: &[f64]) -> Self {
        Axes { time: range(time, 0.0), value: range(values, 0.05) }
    }

    fn x(&self, t: f64) -> f64 {
        LEFT + (RIGHT - LEFT) * (t - self.time[0]) / (self.time[1] - self.time[0])
    }

    fn y(&self, value: f64) -> f64 {
        TOP + (BOTTOM - TOP) * (self.value[1] - value) / (self.value[1] - self.value[0])
    }
}

/// The range of the finite values, widened by a fraction of itself; never empty.
fn range(values: &[f64], margin: f64) -> [f64; 2] {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    match high - low {
        width if width > 0.0 && width.is_finite() => [low - margin * width, high + margin * width],
        _ if low.is_finite() => [low - low.abs().max(1.0), low + low.abs().max(1.0)],
        _ => [-1.0, 1.0],
    }
}

/// A figure with its caption. `befores` are values just before jumps, with the places of those
/// after them.
pub fn plot(document: &Document, name: &str, values: &[f64], befores: &[(usize, f64)]) -> String {
    let all: Vec<f64> =
        values.iter().copied().chain(befores.iter().map(|before| before.1)).collect();
    let time: Vec<f64> = document.time.iter().map(|t| document.units.scaled("time", *t)).collect();
    let axes = Axes::new(&time, &all);
    format!(
        "<figure><figcaption>{}</figcaption><svg width=\"{WIDTH}\" height=\"{HEIGHT}\">{}{}\
         <path class=\"signal\" d=\"{}\"/></svg></figure>\n",
        escape(name),
        shades(document, &axes),
        ticks(&axes, &document.units.unit("time")),
        path(&time, values, befores, &axes)
    )
}

fn shades(document: &Document, axes: &Axes) -> String {
    let surfaces = document.surfaces.0.iter();
    let spans = surfaces.flat_map(|(name, spans)| spans.iter().map(move |span| (name, span)));
    let held = spans.filter(|(_, span)| span.mode == "held");
    let shade = |(name, span): (&String, &super::document::Span)| {
        let [x, end] = [span.from, span.to].map(|t| axes.x(document.units.scaled("time", t)));
        let (width, height) = (end - x, BOTTOM - TOP);
        let title = format!("<title>{} is held</title>", escape(name));
        format!(
            "<rect class=\"held\" x=\"{x:.1}\" y=\"{TOP}\" width=\"{width:.1}\" \
             height=\"{height}\">{title}</rect>"
        )
    };
    held.map(shade).collect()
}

/// Times carry their unit, values have it in the caption.
fn ticks(axes: &Axes, unit: &str) -> String {
    let three = |[low, high]: [f64; 2]| {
        let middle = 0.5 * (low + high);
        // Rounding is no value worth a label.
        [low, if middle.abs() < 1e-6 * (high - low) { 0.0 } else { middle }, high]
    };
    let values = three(axes.value).map(|value| {
        let (x, y, text) = (LEFT - 6.0, axes.y(value), significant(value, 3));
        let line = format!("<path class=\"axis\" d=\"M{LEFT} {y:.1}H{RIGHT}\"/>");
        format!("{line}<text x=\"{x}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>", y + 4.0)
    });
    let times = three(axes.time).map(|t| {
        let (x, y, text) = (axes.x(t), HEIGHT - 6.0, significant(t, 4) + unit);
        format!("<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{text}</text>")
    });
    values.concat() + &times.concat()
}

/// A polyline through grid values; steps for a signal that has one value per interval. A value that
/// is not finite leaves a gap, a jump has both of its sides.
fn path(time: &[f64], values: &[f64], befores: &[(usize, f64)], axes: &Axes) -> String {
    let is_stepwise = values.len() < time.len();
    let mut path = String::new();
    let mut command = 'M';
    let before = |k: usize| {
        befores.iter().filter(move |before| before.0 == k).map(move |before| (k, before.1))
    };
    for (k, value) in
        values.iter().enumerate().flat_map(|(k, value)| before(k).chain([(k, *value)]))
    {
        if !value.is_finite() || !time[k].is_finite() {
            command = 'M';
            continue;
        }
        let (x, y) = (axes.x(time[k]), axes.y(value));
        write!(path, "{command}{x:.1} {y:.1}").expect("a string takes everything");
        if is_stepwise {
            write!(path, "H{:.1}", axes.x(time[k + 1])).expect("a string takes everything");
        }
        command = 'L';
    }
    path
}

/// Text between tags.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
