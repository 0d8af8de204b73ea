//! FDC0405: every state needs an equation.

use crate::check::facts::Facts;
use fdcc_grammar::ast::ItemKind;
use fdcc_grammar::{Code, Diagnostic};
use std::collections::HashSet;

/// Reports states that no equation moves.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let equations = facts.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Dynamics { equations } => Some(equations),
        _ => None,
    });
    let moved: HashSet<&str> =
        equations.flatten().map(|equation| equation.state.name.as_str()).collect();
    for item in &facts.items {
        if let ItemKind::State { name, .. } = &item.kind
            && !moved.contains(name.name.as_str())
        {
            let name_ = &name.name;
            let label = format!("declared as a state, but there is no `{name_}' = ...`");
            let diagnostic = Diagnostic::new(
                Code::NoEquation,
                format!("`{name_}` has no equation"),
                name.span,
                label,
            );
            found.push(diagnostic.help(format!(
                "add `{name_}' = ...` to `dynamics`, or declare it as `control {name_}` or `param \
                 {name_}`"
            )));
        }
    }
}
