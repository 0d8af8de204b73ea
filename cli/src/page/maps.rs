//! An array as colours over time and index, as SVG.

use super::arrays::{Array, value_at};
use super::colours::{SCALE, colour, draw_scale};
use super::curves::Piece;
use super::figures::Figure;
use super::json::Json;
use super::svg::{Area, Drawn, FINE, WIDTH, chart, draw_axes, titled};
use super::units::Unit;
use plotters::prelude::*;

/// In pixels.
pub const HEIGHT: i32 = 300;
/// Of the time, for each of which a row has a colour.
const PARTS: usize = 240;
/// Colours between which nobody sees a difference are one.
const SHADES: f64 = 128.0;

/// Draws it over the times `across`, which are shown in a unit.
pub fn draw(
    area: &Area,
    array: &Array,
    (document, figures): (&Json, &[Figure]),
    (across, time): ([f64; 2], &Unit),
) -> Drawn {
    let (map, scale) = area.split_horizontally((WIDTH - SCALE) * FINE);
    let rows = array.rows(std::slice::from_ref(document), figures);
    let lowest = array.first as f64 - 0.5;
    let ranges = [across, [lowest, lowest + rows.len() as f64]];
    let mut chart = chart(&map, ranges)?;
    let titles = [titled("t", time), format!("index of {}", array.name)];
    draw_axes(&mut chart, ranges, &titles)?;
    // From the top down, each row and each span to the end of what is drawn later: between
    // neighbours that end where the next one begins there would be a fine line.
    let bottom = ranges[1][0];
    for (at, row) in rows.iter().enumerate().rev() {
        let top = lowest + at as f64 + 1.0;
        let spans = spans(row, array.range, across).into_iter();
        let cell = |(from, shade): (f64, Option<f64>)| {
            let style = shade.map_or(WHITE, |it| colour(it, [0.0, 1.0])).filled();
            Rectangle::new([(from, bottom), (across[1], top)], style)
        };
        chart.draw_series(spans.map(cell))?;
    }
    draw_scale(&scale, &titled(&array.signal(), &array.unit), array.range, HEIGHT)
}

/// When a row has a colour, from its time on, as a part of the range of values; nothing in gaps.
fn spans(row: &[Piece], [low, high]: [f64; 2], across: [f64; 2]) -> Vec<(f64, Option<f64>)> {
    let width = (across[1] - across[0]) / PARTS as f64;
    let shade = |value: f64| {
        let part = if high > low { (value - low) / (high - low) } else { 0.5 };
        (part * SHADES).round() / SHADES
    };
    let mut all: Vec<(f64, Option<f64>)> = Vec::new();
    for part in 0..PARTS {
        let from = across[0] + width * part as f64;
        let now = value_at(row, from + 0.5 * width).map(shade);
        if all.last().is_none_or(|it| it.1 != now) {
            all.push((from, now));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_is_one_span_and_a_gap_is_one() {
        let row = [vec![(0.0, 5.0), (1.0, 5.0)], vec![(2.0, 7.0), (4.0, 7.0)]];
        let all = spans(&row, [5.0, 7.0], [0.0, 4.0]);
        let shades: Vec<_> = all.iter().map(|it| it.1).collect();
        assert_eq!(shades, [Some(0.0), None, Some(1.0)]);
        assert_eq!(all[0].0, 0.0);
        assert!((all[1].0 - 1.0).abs() < 0.02 && (all[2].0 - 2.0).abs() < 0.02, "{all:?}");
    }
}
