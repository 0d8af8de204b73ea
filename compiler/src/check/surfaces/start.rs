//! FDC0305: the start lies on a surface.

use super::Subject;
use crate::expressions::graph::{ExprId, evaluate};
use crate::model::Symbol;
use fdcc_grammar::{Code, Diagnostic};

impl Subject<'_, '_, '_> {
    /// If all that the surface depends on has a number at the start, and it is 0 there.
    pub(super) fn start_on_surface(&self) -> Option<Diagnostic> {
        let view = self.view;
        let value = |symbol: &Symbol| match *symbol {
            Symbol::Time => view.number(view.interval[0]),
            Symbol::Param(at) => view.values[at],
            Symbol::State(at) => view.states[at].start.map_or(f64::NAN, |start| view.number(start)),
            _ => f64::NAN,
        };
        let point: Vec<f64> = self.local.symbols.iter().map(value).collect();
        let slopes = self.local.gradient.iter().map(|it| it.1);
        let roots: Vec<ExprId> = std::iter::once(self.local.psi).chain(slopes).collect();
        let values = evaluate(&self.local.graph, &roots, &point, &[]);
        if values[0].is_nan() || values[0].abs() > 1e-12 {
            return None;
        }
        // The state that could move off the surface is to be looked at.
        let steep = values[1..].iter().position(|slope| *slope != 0.0).unwrap_or(0);
        let state = &view.states[self.local.gradient.get(steep)?.0];
        let span = self.start(&state.place.name)?.span;
        let name = self.name();
        let message = format!("the start lies on surface `{name}`");
        let t = view.number(view.interval[0]);
        let label = format!("here {name} == 0 at t = {}", crate::syntax::text::number(t));
        Some(
            Diagnostic::new(Code::StartOnSurface, message, span, label)
                .label(self.function(), "the surface")
                .help(
                    "the state at t = 0 is fixed, so no derivative with respect to it is needed: \
                     harmless.\n\
                 If you free it, the gradient results (Theorems 5.2 and 6.1) no longer apply at t \
                 = 0.",
                ),
        )
    }
}
