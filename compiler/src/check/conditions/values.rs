//! FDC0408: a parameter needs a value, in the text or from the command line.

use crate::check::facts::Facts;
use crate::model::numbers::missing_value;
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::ItemKind;

/// Reports parameters without a value.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    for item in &facts.items {
        if let ItemKind::Param { name, value: None, .. } = &item.kind {
            found.push(missing_value(&name.name, name.span));
        }
    }
}
