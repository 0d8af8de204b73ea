//! FDC0303: a surface that attracts, but is one-sided Lipschitz only in other coordinates or in
//! another metric.

use super::Subject;
use crate::surfaces::coordinates::{Coordinates, Parts, coordinates, vector};
use crate::surfaces::holding::holding;
use crate::surfaces::words::tidy;
use crate::syntax::text::{self, number};
use fdcc_grammar::{Code, Diagnostic};

impl Subject<'_, '_, '_> {
    /// Says which, and that nothing need be changed.
    pub(super) fn other_coordinates(&mut self) -> Option<Diagnostic> {
        let parts = Parts::new(&mut self.local);
        let found = coordinates(&mut self.local, self.view, &parts);
        let [moved, turning] = [parts.moved(), parts.turning()].map(|states| self.vectors(states));
        let (message, reason) = self.message(&found, &moved)?;
        let [first, second] = labels(&found, &moved, &turning);
        let (attracts, held) = (self.attracts(), self.held(&found));
        let joint = if matches!(found, Coordinates::Unknown) { "; " } else { ", and " };
        let help =
            format!("nothing to change. The surface attracts: {attracts}{joint}{reason}{held}");
        let diagnostic = Diagnostic::new(Code::OtherCoordinates, message, self.function(), first);
        let diagnostic = match self.place {
            Some(place) => diagnostic.label(place.term.span, second),
            None => diagnostic,
        };
        Some(diagnostic.help(help))
    }

    /// The vectors that states belong to, each once.
    fn vectors(&self, states: Vec<usize>) -> String {
        let mut names: Vec<&str> =
            states.into_iter().map(|state| vector(self.view, state)).collect();
        names.dedup();
        names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
    }

    /// In which coordinates the test holds, and why that is enough; nothing where it holds in those
    /// of the model.
    fn message(&mut self, found: &Coordinates, moved: &str) -> Option<(String, String)> {
        let name = self.name().to_string();
        Some(match found {
            Coordinates::Own => return None,
            Coordinates::Metric(weights) => {
                let metric = self.metric(weights);
                (
                    format!("`{name}` is one-sided Lipschitz in another metric"),
                    format!(
                        "in the metric of the kinetic energy the test of Lemma 3.1 holds:\nsay so \
                         with `metric {metric}`."
                    ),
                )
            }
            Coordinates::Replaced(state) => {
                let state = &self.view.states[*state].place.name;
                let message = format!(
                    "`{name}` is one-sided Lipschitz with `{name}` as a coordinate in place of \
                     `{state}`"
                );
                (message, "in these\ncoordinates the test of Lemma 3.1 holds.".into())
            }
            Coordinates::Frame { across } => {
                let frame = self.frame(*across);
                (
                    format!(
                        "`{name}` is one-sided Lipschitz in body-frame velocities, not in \
                          {moved}"
                    ),
                    frame,
                )
            }
            Coordinates::Unknown => (
                format!("`{name}` attracts, but is not one-sided Lipschitz in these coordinates"),
                "solutions are unique all the same: formulas (3.5) and (3.6)\ndo not depend on \
                 coordinates."
                    .into(),
            ),
        })
    }

    /// `grad . jump = -2*muN = -8 everywhere`.
    fn attracts(&mut self) -> String {
        let jump = self.local.jump;
        let size = self.local.prover().range(&self.local.graph, jump);
        let text = self.text(jump);
        match tidy(size.lower) == tidy(size.upper) && text.parse::<f64>().is_err() {
            true => format!("grad . jump = {text} = {} everywhere", number(tidy(size.lower))),
            false => format!("grad . jump = {text}"),
        }
    }

    /// `v1: m1, v2: m2`.
    fn metric(&mut self, weights: &[(usize, crate::expressions::graph::ExprId)]) -> String {
        let weights: Vec<String> = weights
            .iter()
            .map(|&(state, weight)| {
                format!("{}: {}", self.view.states[state].place.name, self.text(weight))
            })
            .collect();
        weights.join(", ")
    }

    /// The velocities of the frame, as they were written or written out.
    fn frame(&mut self, across: crate::expressions::graph::ExprId) -> String {
        let normal = self.written().map_or_else(|| self.name().to_string(), text::expr);
        let form = self.local.form(across);
        let negative = form.scaled(-1.0, &Vec::new());
        let written = self.facts.meaning.written.iter().find_map(|&(expr, id)| {
            let known =
                |input: u32| self.local.input_of(self.view.symbols[input as usize]).is_some();
            let fits = self.view.graph.inputs_of(&[id]).into_iter().all(known);
            let copy = fits.then(|| self.local.import(self.view, id))?;
            let own = self.local.form(copy);
            (own == form || own == negative).then(|| text::expr(expr))
        });
        let tangential = written.unwrap_or_else(|| self.text(across));
        format!("with\nv_t = {tangential}, v_n = {normal} the test of Lemma 3.1 holds.")
    }

    /// When it is held, as another line.
    fn held(&mut self, found: &Coordinates) -> String {
        let own = match found {
            Coordinates::Frame { across } => vec![("v_t".to_string(), *across)],
            _ => Vec::new(),
        };
        let name = self.name().to_string();
        match holding(&mut self.local, self.view, &own) {
            Some(condition) if condition != "always" => {
                format!("\n`{name}` is held while {condition}. See `fdcc explain FDC0303`.")
            }
            _ => String::new(),
        }
    }
}

/// What the surface moves with, and what the jump acts on.
fn labels(found: &Coordinates, moved: &str, turning: &str) -> [String; 2] {
    if turning.is_empty() {
        return ["this surface has a gradient".into(), "and the jump is not parallel to it".into()];
    }
    let does = if matches!(found, Coordinates::Frame { .. }) { "turns" } else { "moves" };
    [
        format!("this surface also {does} with {turning}"),
        format!("but the jump acts on {moved} only, so it is not parallel to the gradient"),
    ]
}
