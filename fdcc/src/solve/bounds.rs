//! FDC0401 once all parameters have values: `check` sees those of the model, not those of the
//! command line.

use fdcc_grammar::{Code, Diagnostic, Label, Span};
use fdcc_runtime::problem::{Bounds, Origin, Problem};

/// All bounds that leave no room, as one finding: they usually have one cause.
pub(super) fn empty(problem: &Problem) -> Option<Diagnostic> {
    let mut labels: Vec<Label> = all(problem)
        .filter(|(_, bounds)| !has_room(bounds))
        .map(|(origin, bounds)| label(&origin, bounds))
        .collect();
    labels.sort_by_key(|label| label.span);
    let first = labels.first()?.clone();
    let mut diagnostic =
        Diagnostic::new(Code::EmptyBounds, "these bounds leave no room", first.span, first.text);
    diagnostic.labels.extend(labels.into_iter().skip(1));
    Some(diagnostic.help("look at the values of the parameters that they use"))
}

/// Every pair of bounds and what it belongs to.
fn all(problem: &Problem) -> impl Iterator<Item = (Origin, Bounds)> {
    let variables =
        problem.states.iter().chain(&problem.controls).map(|it| (it.origin.clone(), it.bounds));
    let unknowns = problem.unknowns.iter();
    let unknowns = unknowns.map(|it| (problem.parameters[it.parameter].origin.clone(), it.bounds));
    let path =
        problem.path_bounds.iter().enumerate().map(|(i, bounds)| (problem.path.origin(i), *bounds));
    let boundary = problem.boundary_bounds.iter().enumerate();
    let boundary = boundary.map(|(i, bounds)| (problem.boundary.origin(i + 1), *bounds));
    let starts = problem.states.iter().zip(&problem.start);
    let starts =
        starts.filter_map(|(it, start)| Some((it.origin.clone(), Bounds::fixed((*start)?))));
    variables.chain(starts).chain(unknowns).chain(path).chain(boundary)
}

/// Not so either if one of them is not a number.
fn has_room(bounds: &Bounds) -> bool {
    bounds.lower <= bounds.upper && bounds.lower < f64::INFINITY && bounds.upper > f64::NEG_INFINITY
}

fn label(origin: &Origin, bounds: Bounds) -> Label {
    let (start, end) = origin.span;
    let text =
        format!("`{}` would have to be in [{}, {}]", origin.label, bounds.lower, bounds.upper);
    Label { span: Span { start, end }, text }
}
