//! FDC0406: constraints and objectives should be twice continuously differentiable.

use super::{hidden_jump, joints};
use crate::check::facts::Facts;
use crate::check::facts::view_of;
use crate::resolve::elaborator::knots::{Knot, Site};
use crate::resolve::elaborator::value::KnotUse;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::surfaces::Order;
use crate::syntax::{text, walk};
use fdcc_grammar::ast::{Condition, ExprKind};
use fdcc_grammar::{Code, Diagnostic, Fix};
use std::cell::LazyCell;

/// Reports the worst knot of each `piecewise` in a path constraint, an end condition or the
/// objective.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let meaning = &facts.meaning;
    let view = LazyCell::new(|| view_of(meaning));
    for usage in &meaning.usages {
        if !matches!(usage.role, Role::Path(..) | Role::Objective | Role::Boundary(_)) {
            continue;
        }
        for place in &usage.traits.knots {
            let Some(site) = meaning.sites.get(&place.site) else { continue };
            let orders = site
                .knots
                .iter()
                .map(|knot| (joints::order(meaning, &view, usage, site, knot), knot));
            if let Some((Order::Times(times @ 0..2), knot)) = orders.min_by_key(|it| it.0) {
                found.push(Kink { site, knot, times, place, role: &usage.role }.told(meaning));
            }
        }
    }
}

/// A knot in something that should be smooth, which is `times` times continuously differentiable
/// there.
struct Kink<'k, 'a> {
    site: &'k Site<'a>,
    knot: &'k Knot<'a>,
    times: u32,
    place: &'k KnotUse,
    role: &'k Role<'a>,
}

impl Kink<'_, '_> {
    fn told(&self, meaning: &Elaborator<'_>) -> Diagnostic {
        let Kink { site, knot, times, place, role } = self;
        let message = format!("{} is C^{times} but not C^{}", role.describe(), times + 1);
        let what = ["value", "first derivative", "second derivative"][knot.order];
        let [left, right] = knot.limits.map(text::number);
        let at = hidden_jump::knot_text(knot);
        let label = format!("{what} jumps from {left} to {right} at {at}");
        let found = Diagnostic::new(Code::NotSmooth, message, knot.arm.guard_span, label);
        let found =
            if place.used == site.expr.span { found } else { found.label(place.used, "used here") };
        let name = hidden_jump::owner(meaning, site).unwrap_or("piecewise { ... }");
        let fix = Fix::likely("round the knot").insert(place.used.start, "blend(");
        found.fix(fix.insert(place.used.end, format!(", {WIDTH})"))).help(format!(
            "Newton steps lose speed near {at}. Join the pieces with a cubic, or write \
             `blend({name}, {WIDTH})` to round the knot over a width of {WIDTH}.{}",
            about_abs(role)
        ))
    }
}

/// The width that is proposed.
const WIDTH: f64 = 0.05;

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
