//! FDC0406: constraints and objectives should be twice continuously differentiable.

use super::{Facts, hidden_jump};
use crate::resolve::elaborator::{Elaborator, Role};
use crate::resolve::knots::{Knot, Site};
use crate::resolve::value::KnotUse;
use crate::resolve::{text, walk};
use fdcc_grammar::ast::{Condition, ExprKind, ItemKind};
use fdcc_grammar::{Code, Diagnostic};

/// Reports the worst knot of each `piecewise` in a path constraint, an end condition or the objective.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let meaning = &facts.meaning;
    for piece in &meaning.pieces {
        if !matches!(piece.role, Role::Path(..) | Role::Objective | Role::Boundary(_)) {
            continue;
        }
        for place in &piece.traits.knots {
            let Some(site) = meaning.sites.get(&place.site) else { continue };
            let worst = site.knots.iter().min_by_key(|knot| knot.order);
            if let Some(knot) = worst.filter(|knot| knot.order > 0) {
                found.push(kink(meaning, site, knot, place, &piece.role));
            }
        }
    }
}

fn kink(
    meaning: &Elaborator<'_>,
    site: &Site<'_>,
    knot: &Knot<'_>,
    place: &KnotUse,
    role: &Role<'_>,
) -> Diagnostic {
    let message = format!("{} is C^{} but not C^{}", role.describe(), knot.order - 1, knot.order);
    let derivative = if knot.order == 1 { "first" } else { "second" };
    let [left, right] = knot.limits.map(text::number);
    let at = hidden_jump::knot_text(knot);
    let label = format!("{derivative} derivative jumps from {left} to {right} at {at}");
    let found = Diagnostic::new(Code::NotSmooth, message, knot.arm.guard_span, label);
    let found = if place.used == place.site { found } else { found.label(place.used, "used here") };
    let join = format!("Newton steps lose speed near {at}. Join the pieces with a cubic");
    let blend = match function(meaning, site) {
        Some(name) => format!(", or write\n`blend({name}, 0.05)` to round the knot over a width of 0.05."),
        None => ".".into(),
    };
    found.help(format!("{join}{blend}{}", about_abs(role)))
}

/// The function that holds the pieces, if it is one.
fn function<'a>(meaning: &Elaborator<'a>, site: &Site<'_>) -> Option<&'a str> {
    let item = meaning.scope.declarations[site.owner?].item;
    matches!(item.kind, ItemKind::Fn { .. }).then(|| hidden_jump::owner(meaning, site)).flatten()
}

/// Those who know that `abs` has a kink may suspect it.
fn about_abs(role: &Role<'_>) -> &'static str {
    match role {
        Role::Path(_, condition) if has_abs(condition) => {
            "\n(`abs(e) <= c` is fine: fdcc reads it as -c <= e <= c.)"
        }
        _ => "",
    }
}

fn has_abs(condition: &Condition) -> bool {
    let is_abs = |kind: &ExprKind| matches!(kind, ExprKind::Name(name) if name == "abs");
    let sides = std::iter::once(&condition.first).chain(condition.rest.iter().map(|it| &it.1));
    sides.into_iter().any(|side| {
        let mut found = false;
        walk::visit(side, &mut |expr| found |= is_abs(&expr.kind));
        found
    })
}
