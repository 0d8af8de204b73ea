//! Kinks of models with phases: each phase is a model of its own, but for the unknowns that all
//! phases share.

use super::{Kinks, Without};
use crate::model::{Free, Model, Place, Range};

/// The whole in which each phase is without its kinks; nothing where none has any.
pub(super) fn without(whole: &Model, kinks: Kinks, is_true: bool) -> Option<Model> {
    let has_objective = |model: &Model| model.objective.is_some();
    let mut in_links = whole.links.iter().map(|it| it.objective.is_some());
    let is_asked = whole.phases.iter().any(|it| has_objective(&it.model)) || in_links.any(|it| it);
    if !is_asked || !whole.not_yet.is_empty() {
        return None;
    }
    let (mut own, mut declared, mut is_changed) = (whole.clone(), 0, false);
    for at in 0..own.phases.len() {
        let Some(mut made) = Without::of(&own.phases[at].model, kinks, is_true, declared) else {
            continue;
        };
        let known = own.frees.len();
        let places: Vec<Place> =
            made.own.frees[known..].iter().map(|it| it.place.clone()).collect();
        declared += made.all.len();
        is_changed = true;
        std::mem::swap(&mut own.phases[at].model, &mut made.own);
        let others = own.phases.iter_mut().enumerate().filter(|it| it.0 != at);
        let mut others: Vec<&mut Model> = others.map(|it| &mut it.1.model).collect();
        places.iter().for_each(|place| others.iter_mut().for_each(|it| share(it, place)));
        places.iter().for_each(|place| share(&mut own, place));
    }
    is_changed.then_some(own)
}

/// Declares an unknown of another phase, which is at least 0.
fn share(model: &mut Model, place: &Place) {
    let [lower, upper] = [0.0, f64::INFINITY].map(|it| model.graph.number(it));
    let range = Range { lower, upper };
    model.frees.push(Free { place: place.clone(), range, guess: None });
}
