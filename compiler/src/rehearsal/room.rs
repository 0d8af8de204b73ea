//! FDC0503: a smoothing width that leaves no room outside the layer.
//!
//! Where the guess stays inside `|psi| <= sigma`, the solver sees a linear damper and no friction. A guess that lies on
//! the surface says nothing: it may be held.

use super::layer::short;
use super::{Rehearsal, Sigma};
use crate::resolve::text::number;
use fdcc_grammar::{Code, Diagnostic};

/// Deviations from the surface, relative to sigma, that count as moving and yet as inside the layer.
const INSIDE: std::ops::RangeInclusive<f64> = 1e-2..=0.5;

/// Reports the first surface that the guess moves off without leaving its layer.
pub(super) fn check(rehearsal: &Rehearsal<'_>, found: &mut Vec<Diagnostic>) {
    let Some(sigma) = rehearsal.sigma() else { return };
    let has_guess = rehearsal.model.states.iter().any(|state| state.guess.is_some());
    if !has_guess {
        return;
    }
    for surface in &rehearsal.model.surfaces {
        let distances = rehearsal.along(surface.psi);
        let farthest = distances.into_iter().map(f64::abs).fold(0.0, f64::max);
        if INSIDE.contains(&(farthest / sigma.width)) {
            found.push(no_room(&surface.place.name, farthest, &sigma));
            return;
        }
    }
}

fn no_room(surface: &str, farthest: f64, sigma: &Sigma) -> Diagnostic {
    let shown = |value: f64| number(short(value / sigma.scale));
    let unit = sigma.unit.replace(['[', ']'], "");
    let message = "`sigma` has no room: the whole run is inside the smoothed layer";
    let label = format!("in the guess, abs({surface}) <= {}{unit} throughout", shown(farthest));
    let narrow = shown(farthest / 10.0);
    Diagnostic::new(Code::NoRoom, message, sigma.span, label).help(format!(
        "the solver would see a linear damper, not friction. Start with sigma = {narrow}{}.",
        sigma.unit
    ))
}
