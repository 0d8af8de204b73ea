//! The colours of values in maps, and the scale that says which is which.

use super::svg::{Area, Drawn, FINE};
use crate::output::number::significant;
use plotters::prelude::*;

/// The colours of viridis at even distances: they keep their order in grey and for the colour
/// blind.
pub const COLOURS: [[u8; 3]; 5] =
    [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

/// Of the scale of colours beside a map.
pub const SCALE: i32 = 120;
const STEPS: usize = 60;

/// From dark to bright.
pub fn colour(value: f64, [low, high]: [f64; 2]) -> RGBColor {
    let part = if high > low { (value - low) / (high - low) } else { 0.5 };
    let place = part * (COLOURS.len() - 1) as f64;
    let before = (place as usize).min(COLOURS.len() - 2);
    let [red, green, blue] = [0, 1, 2].map(|at| {
        let [a, b] = [before, before + 1].map(|it| f64::from(COLOURS[it][at]));
        (a + (b - a) * (place - before as f64)).round() as u8
    });
    RGBColor(red, green, blue)
}

/// Draws which colour is which value, below the words `of`.
pub fn draw_scale(area: &Area, of: &str, [low, high]: [f64; 2], height: i32) -> Drawn {
    if low > high {
        return Ok(());
    }
    let font = ("sans-serif", 13 * FINE).into_font();
    let (left, top, height) = (8 * FINE, 34 * FINE, (height - 90) * FINE);
    // Each to the end of all: between neighbours there would be fine lines.
    let below = top + height;
    for step in 0..STEPS {
        let above = top + height * step as i32 / STEPS as i32;
        let value = high - (high - low) * (step as f64 + 0.5) / STEPS as f64;
        let style = colour(value, [low, high]).filled();
        area.draw(&Rectangle::new([(left, above), (left + 18 * FINE, below)], style))?;
    }
    let text = |words: String, y: i32| area.draw(&Text::new(words, (left, y), font.clone()));
    text(of.to_owned(), 3 * FINE)?;
    text(significant(high, 5), top - 16 * FINE)?;
    text(significant(low, 5), top + height + 4 * FINE)
}
