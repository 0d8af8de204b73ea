//! FDC0302 and FDC0312 for the vector of a `Dir`: it stays the same, or it pushes away from 0 in
//! every direction, so what leaves it is not determined.

use super::uses::Use;
use crate::check::facts::Facts;
use crate::model::{Ball, Symbol};
use crate::surfaces::View;
use crate::surfaces::ball::LocalBall;
use crate::surfaces::class::Class;
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic, Severity};

/// Reports every `Dir` that acts along its vector and not against it.
pub(super) fn check(
    facts: &Facts<'_, '_>,
    view: &View<'_>,
    uses: &[Use<'_>],
    found: &mut Vec<Diagnostic>,
) {
    for ball in view.balls {
        if let Some(constant) = super::constant::vector(facts, view, ball) {
            found.push(constant);
            continue;
        }
        let place = uses.iter().find(|it| it.surface == ball.place.name);
        match LocalBall::new(view, ball).map(|mut it| it.classify()) {
            Some(Class::Repelling) => found.push(repelling(ball, place)),
            Some(Class::RepellingFor(choice)) => found.push(for_some(view, ball, place, &choice)),
            _ => {}
        }
    }
}

/// Whatever the control.
fn repelling(ball: &Ball, place: Option<&Use<'_>>) -> Diagnostic {
    let name = &ball.place.name;
    let message = format!("`Dir({name})` pushes solutions away from 0 in every direction");
    let span = place.map_or(ball.place.span, |place| place.term.span);
    let mut found = Diagnostic::new(
        Code::Repelling,
        message,
        span,
        format!("acts along `{name}`, not against it"),
    );
    found.fixes.extend(place.and_then(|place| place.flip()));
    let friction = match place.and_then(|place| place.flipped()) {
        Some(equation) => format!(" For friction the sign is negative: `{equation}`."),
        None => String::new(),
    };
    found.help(format!(
        "where `{name}` is 0 the state may leave in any direction or stay: the solution is not \
         unique and no gradient exists.{friction}"
    ))
}

/// For some values of controls and unknowns.
fn for_some(
    view: &View<'_>,
    ball: &Ball,
    place: Option<&Use<'_>>,
    choice: &[(Symbol, f64)],
) -> Diagnostic {
    let mut found = repelling(ball, place);
    let values: Vec<String> = choice
        .iter()
        .map(|&(symbol, value)| format!("{} = {}", view.name(symbol), number(value)))
        .collect();
    found.message += " for some controls";
    found.labels[0].text +=
        &format!("; for example at {} it outweighs the rest", values.join(", "));
    found.severity = Severity::Warning;
    found.fixes.clear();
    found
}
