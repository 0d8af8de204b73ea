//! Keys of the method: what each does and what it costs.

use crate::context::Context;
use fdcc::language::Grid;
use fdcc::language::vocabulary::{self, Setting};

/// What a key does, and what its value costs in this model.
pub fn told(context: &Context<'_>, key: &str) -> Option<String> {
    let Setting { takes, doc, .. } =
        vocabulary::settings().into_iter().find(|it| it.name == key)?;
    let mut text = format!("`{key}`: {takes}\n\n{doc}");
    if let Some(grid) =
        context.without_mistakes().and_then(|it| it.grid()).filter(|it| it.step.is_finite())
    {
        text += &costs(key, &grid);
    }
    Some(text)
}

/// In numbers of this model, with the duration of its guess.
fn costs(key: &str, grid: &Grid) -> String {
    let Grid { intervals, unknowns, step, sigma } = *grid;
    let against = |power: i32| sigma.map(|sigma| short(step / sigma.powi(power)));
    match key {
        "N" | "steps" => {
            let unknowns = unknowns.map_or(String::new(), |it| format!("{it} unknowns, "));
            let ratio = against(1).map_or(String::new(), |it| format!(", h/sigma = {it}"));
            format!("\n\n{intervals} intervals: {unknowns}h = {}{ratio}", short(step))
        }
        "sigma" => against(1).zip(against(2)).map_or(String::new(), |(first, second)| {
            let h = short(step);
            format!(
                "\n\nh = {h}, h/sigma = {first}, h/sigma^2 = {second}: gradients converge if \
                     these go to 0, the last one where a surface is held."
            )
        }),
        _ => String::new(),
    }
}

/// Three digits are enough to judge.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    rounded.to_string()
}
