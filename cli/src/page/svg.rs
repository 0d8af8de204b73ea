//! Plots of a solution for papers, as SVG: the same figures as those of its page, drawn by
//! plotters.

use super::arrays::Array;
use super::curves::{Piece, Point, pieces, points, range, under};
use super::drawing::times;
use super::figures::{Curve, Figure, Kind, Limit};
use super::json::Json;
use super::maps;
use super::plots::Portrait;
use super::strips::strips;
use super::units::{Unit, of_time};
use crate::output::number::significant;
use plotters::prelude::*;

/// Coordinates are whole numbers: there are this many for a pixel.
pub(super) const FINE: i32 = 4;
pub(super) const WIDTH: i32 = 640;
const HEIGHT: i32 = 210;
/// Of a plot of one signal over another.
const TALL: i32 = 400;
const LEFT: i32 = 64;
const BELOW: i32 = 40;
const FONT: i32 = 13;
const MARGIN: i32 = 10;

pub(super) const PLAN: RGBColor = RGBColor(31, 95, 168);
/// Of several signals in one plot: those of the page.
const HUES: [RGBColor; 4] =
    [PLAN, RGBColor(194, 65, 12), RGBColor(20, 113, 61), RGBColor(124, 58, 237)];
const MEASURED: RGBColor = RGBColor(26, 29, 33);
const REPLAY: RGBColor = RGBColor(194, 65, 12);
pub(super) const LIMIT: RGBColor = RGBColor(179, 38, 30);
pub(super) const HELD: RGBColor = RGBColor(226, 160, 18);
const GRID: RGBColor = RGBColor(222, 225, 230);
const INK: RGBColor = RGBColor(60, 66, 74);

type ChartPoint = (f64, f64);
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
pub(super) type Chart<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

/// What is drawn in one plot.
struct Plot {
    titles: [String; 2],
    ranges: [[f64; 2]; 2],
    curves: Vec<Traced>,
    /// Measurements, with how they are drawn.
    points: Vec<(Kind, Vec<Point>)>,
    /// Lines from one point to another.
    limits: Vec<[ChartPoint; 2]>,
    /// Spans of the first axis that are coloured.
    shaded: Vec<[f64; 2]>,
    /// Lines behind which a condition is violated.
    borders: Vec<Piece>,
}

/// What is drawn over time.
pub enum Row<'f> {
    Curves(&'f Figure),
    Map(&'f Array),
}

impl Row<'_> {
    fn height(&self) -> i32 {
        match self {
            Row::Curves(_) => HEIGHT,
            Row::Map(_) => maps::HEIGHT,
        }
    }
}

/// Figures of a document over time, and arrays of them, one below the other.
pub fn over_time(document: &Json, figures: &[Figure], rows: &[Row]) -> String {
    let time = of_time(document);
    let across = times(std::slice::from_ref(document)).map(|it| it / time.si);
    canvas([WIDTH, rows.iter().map(Row::height).sum()], |area| {
        let mut rest = area.clone();
        for row in rows {
            let (own, below) = rest.split_vertically(row.height() * FINE);
            match row {
                Row::Curves(figure) => {
                    plot_over_time(document, figure, across, &time).draw(&own)?
                }
                Row::Map(array) => {
                    maps::draw(&own, array, (document, figures), (across, &time))?;
                }
            }
            rest = below;
        }
        Ok(())
    })
}

/// What is drawn where nobody says what: states and controls, arrays of them in one map.
pub fn usual<'f>(figures: &'f [Figure], arrays: &'f [Array]) -> Vec<Row<'f>> {
    let row =
        |(at, figure): (usize, &'f Figure)| match arrays.iter().find(|it| it.figures.contains(&at))
        {
            Some(array) => (array.figures[0] == at).then_some(Row::Map(array)),
            None => Some(Row::Curves(figure)),
        };
    figures.iter().enumerate().filter(|it| it.1.is_usual()).filter_map(row).collect()
}

fn plot_over_time(document: &Json, figure: &Figure, across: [f64; 2], time: &Unit) -> Plot {
    let curves = curves(document, figure);
    let points: Vec<_> = figure.curves.iter().filter(|it| it.kind.is_measured()).collect();
    let points: Vec<_> =
        points.iter().map(|it| (it.kind, self::points(document, figure, it))).collect();
    let of_lines = curves.iter().flat_map(|(_, _, pieces)| pieces.iter().flatten());
    let of_points = points.iter().flat_map(|it| &it.1);
    let ends = of_points.flat_map(|it| it.bar.unwrap_or([it.value; 2]));
    let zero = points.iter().any(|it| it.0 == Kind::Stems).then_some(0.0);
    let values = of_lines.map(|it| it.1).chain(ends).chain(zero);
    let si = figure.unit.si;
    let limits: Vec<f64> = figure.limits.iter().map(|it| it.value / si).collect();
    let ends = |it: &Limit| {
        let [from, to] = [it.from, it.to].map(|time_in_si| time_in_si.map(|it| it / time.si));
        [(from.unwrap_or(across[0]), it.value / si), (to.unwrap_or(across[1]), it.value / si)]
    };
    Plot {
        titles: [titled("t", time), titled(&figure.signal(), &figure.unit)],
        ranges: [across, range(values, &limits, figure.rounding / si)],
        limits: figure.limits.iter().map(ends).collect(),
        shaded: held(document, time.si),
        borders: Vec::new(),
        points,
        curves,
    }
}

/// How a curve is drawn, its colour, and its pieces between its jumps.
type Traced = (Kind, usize, Vec<Piece>);

/// One figure over another.
pub fn over_another(document: &Json, of: &Figure, over: &Figure) -> String {
    drawn(&plane(document, &[of], over))
}

/// A picture that the model asks for, with its borders.
pub fn portrait(document: &Json, figures: &[Figure], asked: &Portrait) -> String {
    let of: Vec<&Figure> = asked.of.iter().map(|at| &figures[*at]).collect();
    let over = &figures[asked.over];
    let mut plot = plane(document, &of, over);
    let [x, y] = [over.unit.si, of[0].unit.si];
    let point =
        |it: &Json| Some((it.list().first()?.number()? / x, it.list().get(1)?.number()? / y));
    let segment = |it: &Json| it.list().iter().filter_map(point).collect::<Piece>();
    for (_, keys) in &asked.borders {
        plot.borders.extend(under(document, keys).list().iter().map(segment));
    }
    if asked.is_to_scale {
        plot.ranges = to_scale(plot.ranges);
    }
    let [[left, right], [low, high]] = plot.ranges;
    let is_inside = |(x, y): &(f64, f64)| left < *x && *x < right && low < *y && *y < high;
    plot.borders.retain(|piece| piece.iter().all(is_inside));
    drawn(&plot)
}

/// The ranges in which one unit is as long on both axes.
fn to_scale(ranges: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let pixels = [WIDTH - LEFT - 2 * MARGIN, TALL - BELOW - 2 * MARGIN].map(f64::from);
    let size = |axis: usize| (ranges[axis][1] - ranges[axis][0]) / pixels[axis];
    let largest = size(0).max(size(1));
    [0, 1].map(|axis| {
        let middle = 0.5 * (ranges[axis][0] + ranges[axis][1]);
        let half = 0.5 * largest * pixels[axis];
        [middle - half, middle + half]
    })
}

/// Figures over another one.
fn plane(document: &Json, of: &[&Figure], over: &Figure) -> Plot {
    let xs = curves(document, over);
    let paired = |((kind, _, ys), (_, _, xs)): (&Traced, &Traced), hue: usize| {
        let pairs = xs.iter().zip(ys);
        let piece =
            |(xs, ys): (&Piece, &Piece)| xs.iter().zip(ys).map(|(x, y)| (x.1, y.1)).collect();
        (*kind, hue, pairs.map(piece).collect())
    };
    let all = of.iter().enumerate().map(|(hue, figure)| {
        let ys = curves(document, figure);
        ys.iter().zip(&xs).map(|pair| paired(pair, hue)).collect::<Vec<Traced>>()
    });
    let curves: Vec<Traced> = all.flatten().collect();
    let points = || curves.iter().flat_map(|(_, _, pieces)| pieces.iter().flatten());
    let title = of.iter().map(|it| titled(&it.signal(), &it.unit)).collect::<Vec<_>>().join(", ");
    Plot {
        titles: [titled(&over.signal(), &over.unit), title],
        ranges: [
            range(points().map(|it| it.0), &[], over.rounding / over.unit.si),
            range(points().map(|it| it.1), &[], of[0].rounding / of[0].unit.si),
        ],
        points: Vec::new(),
        limits: Vec::new(),
        shaded: Vec::new(),
        borders: Vec::new(),
        curves,
    }
}

fn curves(document: &Json, figure: &Figure) -> Vec<Traced> {
    let traced = |curve: &Curve| {
        (curve.kind, curve.hue.unwrap_or_default(), pieces(document, figure, curve))
    };
    figure.curves.iter().filter(|it| !it.kind.is_measured()).map(traced).collect()
}

pub(super) fn titled(name: &str, unit: &Unit) -> String {
    if unit.name.is_empty() { name.to_owned() } else { format!("{name} [{}]", unit.name) }
}

/// When any surface is held.
fn held(document: &Json, second: f64) -> Vec<[f64; 2]> {
    let strips = strips(std::slice::from_ref(document), 0);
    let surfaces = strips.iter().filter(|strip| strip.of == "surface");
    let spans = surfaces.flat_map(|strip| &strip.spans).filter(|span| span.mode == "held");
    spans.map(|span| [span.from / second, span.to / second]).collect()
}

fn drawn(plot: &Plot) -> String {
    canvas([WIDTH, TALL], |area| plot.draw(area))
}

/// A picture of so many pixels.
pub(super) fn canvas(size: [i32; 2], draw: impl FnOnce(&Area) -> Drawn) -> String {
    let fine = size.map(|it| (it * FINE) as u32);
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (fine[0], fine[1])).into_drawing_area();
        let drawn = area.fill(&WHITE).and_then(|()| draw(&area));
        drawn.expect("a text takes everything");
    }
    let [width, height] = size;
    let fine = format!("width=\"{}\" height=\"{}\"", fine[0], fine[1]);
    text.replacen(&fine, &format!("width=\"{width}\" height=\"{height}\""), 1)
}

pub(super) type Drawn = Result<(), Failed>;

impl Plot {
    fn draw(&self, area: &Area) -> Drawn {
        let [_, [low, high]] = self.ranges;
        let mut chart = chart(area, self.ranges)?;
        let shade = HELD.mix(0.15).filled();
        chart.draw_series(
            self.shaded.iter().map(|[from, to]| Rectangle::new([(*from, low), (*to, high)], shade)),
        )?;
        draw_axes(&mut chart, self.ranges, &self.titles)?;
        for limit in self.limits.iter().filter(|it| (low..=high).contains(&it[0].1)) {
            dashed(&mut chart, limit, LIMIT)?;
        }
        for border in &self.borders {
            line(&mut chart, border, LIMIT)?;
        }
        for (kind, hue, pieces) in &self.curves {
            for piece in pieces {
                match kind {
                    Kind::Replay => dashed(&mut chart, piece, REPLAY)?,
                    _ => line(&mut chart, piece, HUES[hue % HUES.len()])?,
                }
            }
        }
        self.points.iter().try_for_each(|(kind, points)| measured(&mut chart, *kind, points))
    }
}

/// Measurements with their error bars; what remains of them as lines from 0.
fn measured(chart: &mut Chart, kind: Kind, points: &[Point]) -> Drawn {
    let thin = MEASURED.stroke_width(FINE as u32);
    for point in points {
        let end = if kind == Kind::Stems { Some([0.0, point.value]) } else { point.bar };
        let ends = end.map(|it| it.map(|value| (point.time, value)));
        chart.draw_series(ends.map(|it| PathElement::new(it, thin)))?;
    }
    let dot = |it: &Point| Circle::new((it.time, it.value), 2 * FINE, MEASURED.filled());
    chart.draw_series(points.iter().map(dot)).map(|_| ())
}

type Failed = DrawingAreaErrorKind<std::io::Error>;

pub(super) fn chart<'a, 'b>(
    area: &'a Area<'b>,
    [[left, right], [low, high]]: [[f64; 2]; 2],
) -> Result<Chart<'a, 'b>, Failed> {
    ChartBuilder::on(area)
        .margin(MARGIN * FINE)
        .x_label_area_size(BELOW * FINE)
        .y_label_area_size(LEFT * FINE)
        .build_cartesian_2d(left..right, low..high)
}

pub(super) fn draw_axes(
    chart: &mut Chart,
    ranges: [[f64; 2]; 2],
    [across, up]: &[String; 2],
) -> Drawn {
    let font = ("sans-serif", FONT * FINE).into_font().color(&INK);
    let [across_label, up_label] = ranges.map(|range| move |it: &f64| label(*it, range));
    chart
        .configure_mesh()
        .label_style(font.clone())
        .axis_desc_style(font)
        .axis_style(GRID.stroke_width(FINE as u32))
        .bold_line_style(GRID.stroke_width(FINE as u32))
        .light_line_style(TRANSPARENT)
        .x_labels(8)
        .y_labels(6)
        .x_label_formatter(&across_label)
        .y_label_formatter(&up_label)
        .x_desc(across)
        .y_desc(up)
        .draw()
}

/// Of a tick: 0 where nothing but rounding is left, with as many digits as tell it from the others.
fn label(value: f64, [low, high]: [f64; 2]) -> String {
    let is_zero = value.abs() < 1e-9 * (high - low);
    let lost = (low.abs().max(high.abs()) / (high - low)).log10().ceil();
    let digits = if lost.is_finite() { (lost as usize + 3).clamp(5, 12) } else { 5 };
    significant(if is_zero { 0.0 } else { value }, digits)
}

pub(super) fn line(chart: &mut Chart, points: &[ChartPoint], colour: RGBColor) -> Drawn {
    let style = colour.stroke_width(2 * FINE as u32);
    chart.draw_series(LineSeries::new(points.iter().copied(), style)).map(|_| ())
}

fn dashed(chart: &mut Chart, points: &[ChartPoint], colour: RGBColor) -> Drawn {
    let (style, size) = (colour.stroke_width(FINE as u32 * 3 / 2), 6 * FINE as u32);
    chart.draw_series(DashedLineSeries::new(points.iter().copied(), size, size, style)).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    /// Coordinates are whole numbers of 32 bits, which a far limit exceeds.
    #[test]
    fn zero_is_a_round_number() {
        let of = |value| label(value, [-0.25, 0.25]);
        assert_eq!([of(-2.8e-17), of(0.1), of(1e-3)], ["0", "0.1", "0.001"]);
    }

    #[test]
    fn ticks_are_told_apart() {
        let of = |value| label(value, [-32.9785, -32.9784]);
        assert_eq!([of(-32.97845), of(-32.97842)], ["-32.97845", "-32.97842"]);
    }

    #[test]
    fn limits_far_away_are_left_out() {
        let text = r#"{"time":[0,1],"states":{"x":[0,1]},"bounds":{"x":[-1e30,1.2]}}"#;
        let document = [serde_json::from_str(text).expect("it is JSON")];
        let figures = figures(&document);
        let svg = over_time(&document[0], &figures, &[Row::Curves(&figures[0])]);
        let limit = format!("#{:02X}{:02X}{:02X}", LIMIT.0, LIMIT.1, LIMIT.2);
        let height = |line: &str| {
            let points = line.split("points=\"").nth(1).expect("a line has points");
            points.split([',', ' ']).nth(1).map(str::to_owned)
        };
        let dashes = svg.lines().filter(|line| line.contains(&limit));
        let mut heights: Vec<_> = dashes.map(height).collect();
        heights.dedup();
        assert_eq!(heights.len(), 1, "one of two limits: {svg}");
    }
}
