//! FDC0502: a sweep that does not take the step to 0 fast enough against the width of the layer.
//!
//! Gradients of a smoothed model converge to the true ones where `h/sigma -> 0` if surfaces are
//! only crossed (Theorem 5.2), and where `h/sigma^2 -> 0` if one is held (Theorem 6.1). Which of
//! them a surface is, is proved where that can be; otherwise the guess shows it.

use super::Preflight;
use super::layer::{Layer, short};
use crate::model::Swept;
use crate::surfaces::View;
use crate::surfaces::class::{Class, class};
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic};
use fdcc_runtime::problem::Grid;

/// The lists that matter, and what the ratio is made of.
struct Lists<'m> {
    sigma: Vec<f64>,
    intervals: Option<Vec<f64>>,
    /// The list that could mend it.
    place: &'m Swept,
}

/// Reports a sweep over sigma along which the ratio that has to vanish grows.
pub(super) fn check(preflight: &mut Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let Some(lists) = lists(preflight) else { return };
    let falls = lists.sigma.len() > 1 && lists.sigma.windows(2).all(|pair| pair[1] < pair[0]);
    if !falls || preflight.points.is_empty() {
        return;
    }
    let mut layers = preflight.layers();
    let view = View::of_model(preflight.model, &preflight.numbers);
    // What is proved about a surface goes before what the guess shows.
    layers.iter_mut().for_each(|layer| match class(&view, layer.surface) {
        Some(Class::Held) => (layer.is_held, layer.is_proved) = (true, true),
        Some(Class::Crossed { .. } | Class::Apart) => {
            (layer.is_held, layer.is_proved) = (false, true)
        }
        _ => {}
    });
    let Some(layer) = layers.iter().find(|it| it.is_held).or(layers.first()) else { return };
    let step = |row: usize| preflight.duration / lists.intervals(preflight, row);
    let ratios: Vec<f64> = lists
        .sigma
        .iter()
        .enumerate()
        .map(|(row, sigma)| step(row) / sigma.powi(layer.power()))
        .collect();
    if ratios.windows(2).all(|pair| pair[1] > pair[0] * (1.0 + 1e-9)) {
        found.push(too_slow(preflight, layer, &lists, &ratios));
    }
}

fn lists<'m>(preflight: &Preflight<'m>) -> Option<Lists<'m>> {
    let sweep = &preflight.model.sweep;
    let find = |name: &str| sweep.iter().find(|swept| swept.place.name == name);
    let numbers = |swept: &Swept| {
        swept.values.iter().map(|value| value.parse().ok()).collect::<Option<Vec<f64>>>()
    };
    let place = find("N").or(find("sigma"))?;
    // With `N = auto` the grid follows the layer by itself.
    let intervals = match find("N") {
        Some(swept) => Some(numbers(swept)?),
        None if preflight.model.method.grid == Grid::Auto => return None,
        None => None,
    };
    Some(Lists { sigma: numbers(find("sigma")?)?, intervals, place })
}

impl Lists<'_> {
    /// N in a row; a list of one value holds for all rows.
    fn intervals(&self, preflight: &Preflight<'_>, row: usize) -> f64 {
        let swept = self.intervals.as_ref().and_then(|values| values.get(row).or(values.first()));
        swept.copied().unwrap_or(preflight.model.method.intervals() as f64)
    }
}

impl Layer {
    /// The power of sigma that the step has to be small against.
    fn power(&self) -> i32 {
        if self.is_held { 2 } else { 1 }
    }
}

fn too_slow(
    preflight: &Preflight<'_>,
    layer: &Layer,
    lists: &Lists<'_>,
    ratios: &[f64],
) -> Diagnostic {
    let (ratio, what) = match layer.is_held {
        true => ("h/sigma^2", "on a held surface"),
        false => ("h/sigma", "across a surface"),
    };
    let message = format!("this sweep lets {ratio} grow, so gradients {what} need not converge");
    let shown: Vec<String> = ratios.iter().map(|ratio| digits(*ratio)).collect();
    let duration = preflight.free_duration().map_or(String::new(), |name| {
        format!(" (with {name} = {} from the guess)", preflight.time_text(preflight.duration))
    });
    let label = format!("{ratio} = {}{duration}", shown.join(", "));
    let power = layer.power() + 1;
    let first = lists.intervals(preflight, 0);
    let better =
        lists.sigma.iter().map(|sigma| (first * (lists.sigma[0] / sigma).powi(power)).round());
    let better = better.map(number).collect::<Vec<_>>().join(", ");
    let what = match (layer.is_held, layer.is_proved) {
        (true, true) => "held wherever it is met, and Theorem 6.1 asks for h = o(sigma^2)",
        (true, false) => "held for part of the run, and Theorem 6.1 asks for h = o(sigma^2)",
        (false, _) => "crossed, and Theorem 5.2 asks for h = o(sigma)",
    };
    let why = format!("`{}` is {what}.", layer.name);
    let otherwise = match layer.is_held {
        true => "\nFor surfaces that are only crossed, h = o(sigma) is enough (Theorem 5.2).",
        false => "",
    };
    Diagnostic::new(Code::SweepTooSlow, message, lists.place.values_span, label).help(format!(
        "{why}\nuse N = {better} (h ~ sigma^{power}), or `N = auto` to let fdcc choose.{otherwise}"
    ))
}

/// Two digits behind the point, or three that count where it is small.
fn digits(value: f64) -> String {
    if value >= 0.1 { format!("{value:.2}") } else { number(short(value)) }
}
