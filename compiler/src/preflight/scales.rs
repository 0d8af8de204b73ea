//! FDC0504: states whose sizes are many orders of magnitude apart.
//!
//! The size of a state is read off its bounds, or else off its guess. The solver scales equations,
//! not states: its tolerance means the same for all of them.

use super::Preflight;
use super::layer::short;
use crate::model::Symbol;
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic};

/// A ratio of sizes that is worth a word.
const EXTREME: f64 = 1e8;

/// Reports the largest and the smallest state if they are extremely far apart.
pub(super) fn check(preflight: &Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let states = 0..preflight.model.states.len();
    let sizes = || states.clone().filter_map(|at| Some((at, size(preflight, at)?)));
    let Some((large, most)) = sizes().max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    let Some((small, least)) = sizes().min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    if most / least < EXTREME {
        return;
    }
    let place = |at: usize| &preflight.model.states[at].place;
    let message =
        format!("`{}` and `{}` are of very different sizes", place(large).name, place(small).name);
    let shown = |value: f64| format!("about {} in SI units", number(short(value)));
    let diagnostic = Diagnostic::new(Code::Scales, message, place(large).span, shown(most));
    let diagnostic = match place(large).span == place(small).span {
        true => diagnostic,
        false => diagnostic.label(place(small).span, shown(least)),
    };
    found.push(diagnostic.help(format!(
        "their ratio is {:e}, and one tolerance cannot fit both; write `{}` as a multiple of a \
         typical size",
        short(most / least),
        place(large).name
    )));
}

/// The largest absolute value between finite bounds, or along the guess; none where it is 0 or
/// unknown.
fn size(preflight: &Preflight<'_>, state: usize) -> Option<f64> {
    let range = preflight.model.states[state].range;
    let bounds =
        [range.lower, range.upper].map(|it| preflight.numbers.value(preflight.model, it).abs());
    let bounded = bounds[0].max(bounds[1]);
    let input = preflight.model.input_of(Symbol::State(state))? as usize;
    let guessed = preflight.points.iter().map(|inputs| inputs[input].abs()).fold(0.0, f64::max);
    let size = if bounded.is_finite() { bounded } else { guessed };
    (size > 0.0 && size.is_finite()).then_some(size)
}
