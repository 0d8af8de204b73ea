//! What a check may look at, and what checks say in the same words.

use crate::resolve::elaborator::{Elaborator, Role};
use crate::surfaces::{View, view};
use crate::syntax::text;
use fdcc_grammar::ast::{self, Equation, Ident, Item};
use fdcc_grammar::{Diagnostic, Severity, Span};
use std::collections::HashMap;

/// What a check may look at: the items of a phase and what they turned out to mean.
pub(crate) struct Facts<'a, 'e> {
    /// The items of the phase.
    pub items: Vec<&'a Item>,
    /// The name of the phase, if there are several.
    pub phase: Option<&'a Ident>,
    /// What they mean.
    pub meaning: &'e mut Elaborator<'a>,
    /// The whole tree.
    pub tree: &'a ast::Model,
}

impl Facts<'_, '_> {
    /// The mistakes that have been told already.
    pub fn told(&self) -> Told {
        let errors = self.meaning.diagnostics.iter().filter(|it| it.severity == Severity::Error);
        let mut spans: Vec<Span> = errors.map(Diagnostic::span).collect();
        spans.sort_unstable_by_key(|span| span.start);
        Told(spans)
    }
}

/// Where mistakes have been told, in the order of the text.
pub(crate) struct Told(Vec<Span>);

impl Told {
    /// Whether there is one inside a span, so that more about it would be noise.
    pub fn is_within(&self, span: Span) -> bool {
        let first = self.0.partition_point(|it| it.start < span.start);
        self.0[first..].iter().take_while(|it| it.start <= span.end).any(|it| it.end <= span.end)
    }
}

impl Role<'_> {
    /// In the words of a message.
    pub fn describe(&self) -> String {
        match self {
            Role::Equation(_) => "the dynamics".into(),
            Role::Path(Some(name), _) => format!("path constraint `{}`", name.name),
            Role::Path(None, _) => "a path constraint".into(),
            Role::Objective => "the objective".into(),
            Role::Boundary(word) => format!("a condition at {word}"),
            Role::Surface(name) => format!("surface `{}`", name.name),
            Role::Report(name) => format!("report `{}`", name.name),
            Role::Number(what) => (*what).into(),
        }
    }
}

/// The model so far.
pub(crate) fn view_of<'m>(meaning: &'m Elaborator<'_>) -> View<'m> {
    let states = &meaning.model.states;
    let view = View {
        graph: &meaning.graph,
        symbols: &meaning.symbols,
        states,
        controls: &meaning.model.controls,
        frees: &meaning.model.frees,
        surfaces: meaning.surfaces.iter().map(|it| (&it.place, it.psi)).collect(),
        balls: &meaning.balls,
        path: &meaning.model.path,
        interval: meaning.interval,
        params: &meaning.model.params,
        values: meaning.param_values.clone(),
        has_rate: (0..states.len()).map(|at| meaning.known_rates.contains(&at)).collect(),
        moved: view::moved(&meaning.graph, &meaning.symbols, states, meaning.surfaces.len()),
        metric: &meaning.model.metric,
        sums: HashMap::new(),
        names: &meaning.model.names,
        arguments: &[],
    };
    view.with_sums()
}

/// `m * v'`.
pub(crate) fn left_side(equation: &Equation) -> String {
    match &equation.factor {
        Some(factor) => format!("{} * {}'", text::expr(factor), equation.state.name),
        None => format!("{}'", equation.state.name),
    }
}
