//! Names in all open texts.

use crate::context::Context;
use crate::features::symbols::kind;
use crate::state::State;
use fdcc::language::{Definition, Kind};
use lsp_types::{BaseSymbolInformation, SymbolInformation, WorkspaceSymbolParams};

/// `workspace/symbol`: declared names that hold what was typed, whatever its case.
pub fn symbols(state: &State, params: &WorkspaceSymbolParams) -> Vec<SymbolInformation> {
    let wanted = params.query.to_lowercase();
    let mut found = Vec::new();
    for document in state.documents.all() {
        let context = Context { state, document };
        let all = &context.snapshot().names().definitions;
        let is_inner = |it: &Definition| matches!(it.kind, Kind::Argument | Kind::Row);
        let fits = |it: &&Definition| !is_inner(it) && it.name.to_lowercase().contains(&wanted);
        found.extend(all.iter().filter(fits).map(|it| symbol(&context, all, it)));
    }
    found
}

fn symbol(context: &Context<'_>, all: &[Definition], it: &Definition) -> SymbolInformation {
    let container_name = it.within.map(|outer| all[outer].name.clone());
    let named = BaseSymbolInformation {
        name: it.name.clone(),
        kind: kind(it.kind),
        tags: None,
        container_name,
    };
    SymbolInformation::new(None, context.location(it.span), named)
}
