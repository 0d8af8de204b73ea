//! FDC0201, FDC0202, FDC0204: where a set may stand. `in` takes a set, `=` a value; constraints and
//! objectives take values only.

use crate::check::facts::{Facts, left_side};
use crate::resolve::elaborator::Role;
use crate::resolve::elaborator::value::{SetForm, SetUse};
use crate::syntax::text;
use fdcc_grammar::ast::{Equation, EquationRelation};
use fdcc_grammar::{Code, Diagnostic, Fix};

/// Reports sets where a value is needed, and `in` where there is no set.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let told = facts.told();
    for usage in &facts.meaning.usages {
        match (usage.role, usage.traits.sets.first()) {
            (Role::Equation(equation), Some(set))
                if equation.relation == EquationRelation::Equal =>
            {
                found.push(equality(equation, set))
            }
            (Role::Equation(equation), None) if equation.relation == EquationRelation::In => {
                if !told.is_within(equation.right.span) {
                    found.push(no_set(equation));
                }
            }
            (Role::Equation(_), _) | (_, None) => {}
            (role, Some(set)) => found.push(needs_a_value(facts, &role, set)),
        }
    }
}

fn equality(equation: &Equation, set: &SetUse) -> Diagnostic {
    let surface = &set.surface;
    let at_zero = match set.form {
        SetForm::Sgn => "the interval [-1, 1]",
        SetForm::Dir => "the unit ball",
        SetForm::Match => "anything between the two",
    };
    let label = format!("a single value when {surface} != 0, {at_zero} when {surface} == 0");
    let why = match set.form {
        SetForm::Match => "",
        _ => "\nWhen the block sticks, the friction force is whatever keeps it still.",
    };
    Diagnostic::new(
        Code::SetEquality,
        "the right side is a set, so `=` cannot hold",
        equation.relation_span,
        "use `in` here",
    )
    .label(set.span, label)
    .help(format!("write `{} in {}`{why}", left_side(equation), text::expr(&equation.right)))
    .fix(Fix::certain("write `in`").replace(equation.relation_span, "in"))
}

fn no_set(equation: &Equation) -> Diagnostic {
    let repaired = format!("{} = {}", left_side(equation), text::expr(&equation.right));
    Diagnostic::new(
        Code::NoSet,
        "`in` before a right side that is no set",
        equation.relation_span,
        "`=` says the same",
    )
    .help(format!("write `{repaired}`: without `Sgn`, `Dir` or `match` there is one value"))
    .fix(Fix::certain("write `=`").replace(equation.relation_span, "="))
}

fn needs_a_value(facts: &Facts<'_, '_>, role: &Role<'_>, set: &SetUse) -> Diagnostic {
    let message = format!("{} uses a set-valued function", role.describe());
    let label = format!(
        "undefined while `{}` is held at 0, which happens for whole time spans",
        set.surface
    );
    let mut found = Diagnostic::new(Code::SetValuedHere, message, set.span, label);
    let declared =
        facts.meaning.scope.find(&set.surface).map(|at| facts.meaning.scope.declarations[at]);
    if let Some(declared) = declared {
        found = found.label(declared.name.span, "surface declared here");
    }
    let psi = match declared.map(|it| &it.item.kind) {
        Some(fdcc_grammar::ast::ItemKind::Surface { value, .. }) => text::expr(value),
        _ => set.surface.to_string(),
    };
    let (whole, size) = match set.form {
        SetForm::Sgn => (format!("Sgn({})", set.surface), "abs"),
        SetForm::Dir => (format!("Dir({})", set.surface), "norm"),
        SetForm::Match => (format!("match {} {{ ... }}", set.surface), "abs"),
    };
    found.help(format!(
        "for friction work write `integral(mu * N * {size}({psi}))`: the same number, and \
         continuous\n\
         for the friction force that acts, name it: `let f = selected({whole})`"
    ))
}
