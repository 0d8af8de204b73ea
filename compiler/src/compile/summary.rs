//! The problem as understood, for `fdcc show`: names, sizes, bounds, surfaces.

use super::dump::{differentiated, over_symbols};
use crate::differentiate::Differentiated;
use crate::expressions::graph::ExprId;
use crate::lower::{LoweredProblem, VectorFunction};
use crate::model::numbers::Numbers;
use crate::model::{Model, Place, Range};
use crate::surfaces::report::surfaces;
use crate::surfaces::smoothness::smoothness;
use crate::surfaces::{Order, Smoothness, SurfaceReport};
use crate::symbols::text;
use std::fmt::Write;

/// The problem as understood.
pub(super) fn summary(model: &Model, lowered: &LoweredProblem, numbers: &Numbers) -> String {
    let mut text = format!("model {}\n", model.name);
    let units = (!model.is_in_si()).then(|| "as declared; formulas in SI".to_owned());
    section(&mut text, "units", units.into_iter());
    section(&mut text, "time", ends(model).into_iter());
    let named = |place: &Place, range: Range| text::ranged(model, numbers, place, range);
    section(&mut text, "states", model.states.iter().map(|it| named(&it.place, it.range)));
    let controls = model.controls.iter().map(|it| named(&it.place, it.range));
    section(&mut text, "controls", controls);
    section(&mut text, "free", (0..model.frees.len()).map(|at| text::free(model, numbers, at)));
    section(&mut text, "params", (0..model.params.len()).map(|at| text::param(model, numbers, at)));
    section(&mut text, "surfaces", surfaces(model, numbers).iter().flat_map(surface_lines));
    let rough = smoothness(model, numbers).into_iter().filter(|it| it.order != Order::Always);
    section(&mut text, "smoothness", rough.map(|it| smoothness_line(model, it)));
    section(&mut text, "path", model.path.iter().map(|it| text::condition(model, numbers, it)));
    section(&mut text, "boundary", model.boundary.iter().map(|it| it.place.name.clone()));
    let at_times = model.at_times.iter().flat_map(|it| &it.rows);
    section(&mut text, "at times", at_times.map(|it| it.place.name.clone()));
    let objective: Vec<(String, ExprId)> =
        model.objective.iter().map(|it| (it.0.name.clone(), it.1)).collect();
    section(&mut text, "objective", over_symbols(model, &objective).lines().map(str::to_string));
    section(&mut text, "functions", differentiated(lowered).1.iter().map(sizes));
    text
}

/// The first and the last time.
fn ends(model: &Model) -> Vec<String> {
    let end = |(name, at): (&str, ExprId)| match model.graph.as_number(at) {
        Some(time) => text::time(model, name, time),
        None => over_symbols(model, &[(name.into(), at)]).trim_end().to_owned(),
    };
    let ends = ["t0", "tf"].into_iter().zip(model.interval).map(end);
    ends.flat_map(|it| it.lines().map(str::to_owned).collect::<Vec<_>>()).collect()
}

/// What is known about a surface, a line for each.
fn surface_lines(surface: &SurfaceReport) -> Vec<String> {
    let mut lines = vec![format!("{} = {}", surface.place.name, surface.function)];
    let mut line = |title: &str, text: &str| lines.push(format!("  {title:<9}{text}"));
    if !surface.gradient.is_empty() {
        line("gradient", &surface.gradient.join(", "));
        line("jump", &surface.jump);
    }
    line("class", &surface.meaning);
    surface.holding.iter().for_each(|condition| line("held if", condition));
    lines
}

/// `y_cl is C^2 at x == pi`.
fn smoothness_line(model: &Model, it: Smoothness) -> String {
    let knots: Vec<String> = it.knots.iter().map(|knot| text::place(model, knot)).collect();
    format!("{} {} at {}", it.name, it.order, knots.join(", "))
}

fn section(text: &mut String, title: &str, lines: impl Iterator<Item = String>) {
    let mut title = title;
    for line in lines {
        writeln!(text, "{title:<10} {line}").expect("writing to a string cannot fail");
        title = "";
    }
}

fn sizes(function: &Differentiated) -> String {
    let VectorFunction { name, outputs, by, .. } = &function.function;
    let (jacobian, hessian) = (function.jacobian.0.entries.len(), function.hessian.0.entries.len());
    match by.is_empty() {
        true => format!("{name}: {}", counted(outputs.len())),
        false => format!(
            "{name}: {}, Jacobian {jacobian} of {} entries, Hessian {hessian} of {}",
            counted(outputs.len()),
            outputs.len() * by.len(),
            by.len() * (by.len() + 1) / 2
        ),
    }
}

fn counted(outputs: usize) -> String {
    if outputs == 1 { "1 output".into() } else { format!("{outputs} outputs") }
}
