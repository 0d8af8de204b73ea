//! FDC0312: a surface whose function does not change along a motion, or never its sign.

use super::Subject;
use crate::check::facts::Facts;
use crate::model::{Ball, Symbol};
use crate::surfaces::{Local, View};
use crate::syntax::text;
use fdcc_grammar::{Code, Diagnostic, Span};

impl Subject<'_, '_, '_> {
    /// The finding, where the function is proved to stay the same, or on one side of 0.
    pub fn constant(&mut self) -> Option<Diagnostic> {
        let psi = self.view.surfaces[self.at].1?;
        let what = format!("surface `{}` never changes sides", self.name());
        if !self.local.is_constant(self.view, &reset(self.facts)) {
            let has_one_sign = self.local.has_one_sign();
            return has_one_sign.then(|| told(what, self.function(), "never 0".into()));
        }
        let symbols = &self.facts.meaning.symbols;
        let is_param = |input: u32| matches!(symbols[input as usize], Symbol::Param(_));
        let is_fixed = self.facts.meaning.graph.inputs_of(&[psi]).into_iter().all(is_param);
        let value = is_fixed.then(|| self.facts.meaning.numeric(psi));
        let label = match value.filter(|it| it.is_finite()) {
            Some(value) => format!("always {}", text::number(value)),
            None => "the same at all times".into(),
        };
        Some(told(what, self.function(), label))
    }
}

/// The finding about the vector of a `Dir`, where all of its components stay the same.
pub(super) fn vector(facts: &Facts<'_, '_>, view: &View<'_>, ball: &Ball) -> Option<Diagnostic> {
    let reset = reset(facts);
    let is_constant =
        |at| Local::new(view, at).is_some_and(|mut local| local.is_constant(view, &reset));
    let place = &ball.place;
    ball.surfaces.clone().all(is_constant).then(|| {
        let what = format!("`Dir({})` never changes its direction", place.name);
        told(what, place.span, "the same at all times".into())
    })
}

/// The states that jumps reset.
fn reset(facts: &Facts<'_, '_>) -> Vec<usize> {
    facts.meaning.model.jumps.iter().flat_map(|jump| &jump.resets).map(|it| it.0).collect()
}

fn told(what: String, span: Span, label: String) -> Diagnostic {
    Diagnostic::new(Code::ConstantSurface, what, span, label).help(
        "a surface depends on states that move, or on time; for a choice that is made once, write \
         a `param`",
    )
}
