//! What may be written next, by what stands before the cursor.

mod items;
mod names;

use crate::client::Failure;
use crate::context::Context;
use crate::features::cursor::{CursorContext, Open};
use fdcc::language::Kind;
use fdcc::language::vocabulary;
use fdcc_grammar::words::{self, inner_words};
use items::{Proposal, entry, item, keyword, own, plain, word};
use lsp_types::{CompletionList, CompletionParams, CompletionResponse};
use names::Scope;

/// `textDocument/completion`
pub fn completion(
    context: &Context<'_>,
    params: CompletionParams,
) -> Result<Option<CompletionResponse>, Failure> {
    let offset = context.offset(params.text_document_position_params.position) as usize;
    let place = CursorContext::at_end_of(&context.snapshot().text.text[..offset]);
    let scope = Scope::new(context, place.phase);
    let is_blank = params.context.and_then(|it| it.trigger_character).is_some_and(|it| it == " ");
    let proposals = match (place.is_silent, is_blank) {
        (true, _) => Vec::new(),
        // Nobody wants a list at every blank.
        (false, true) => after_word(&place, &scope).unwrap_or_default(),
        (false, false) => proposals(&place, &scope),
    };
    let snippets = context.state.agreed.snippets;
    let items = proposals.into_iter().map(|it| it.shown(snippets)).collect();
    Ok(Some(CompletionList { is_incomplete: false, items, ..CompletionList::default() }.into()))
}

fn proposals(place: &CursorContext<'_>, scope: &Scope) -> Vec<Proposal> {
    if place.back(0) == "." {
        return scope.parts(place);
    }
    if let Some(found) = place.inside().and_then(|open| in_brackets(place, open, scope)) {
        return found;
    }
    if let Some(found) = after_word(place, scope) {
        return found;
    }
    let begins = place.begins_line || place.back(0) == "{" || place.back(0) == "}";
    match place.block() {
        _ if place.is_among_items() && begins => words::items().map(item).collect(),
        Some(block) if begins => entries(block, scope),
        Some("method") => {
            ["kernel", "steps", "scheme", "lagged"].into_iter().map(keyword).collect()
        }
        _ => expression(place, scope),
    }
}

/// Brackets in which only certain things stand.
fn in_brackets(place: &CursorContext<'_>, open: &Open<'_>, scope: &Scope) -> Option<Vec<Proposal>> {
    let is_first = place.back(0) == "(";
    match (open.bracket, open.before) {
        ('[', "in" | "=" | ",") => None,
        ('[', _) if open.is_close && open.before.ends_with(|c: char| c.is_alphabetic()) => {
            Some(Vec::new())
        }
        ('[', _) => Some(vocabulary::units().into_iter().map(items::unit).collect()),
        ('(', "Sgn" | "sliding") if is_first => Some(scope.proposals(|kind| kind == Kind::Surface)),
        ('(', "lagged") => Some(scope.proposals(|kind| kind == Kind::State)),
        ('(', _) if place.item == "fn" && !place.before.contains(&"=") => Some(Vec::new()),
        _ => None,
    }
}

/// Words after which only certain things stand.
fn after_word(place: &CursorContext<'_>, scope: &Scope) -> Option<Vec<Proposal>> {
    let surfaces = || Some(scope.proposals(|kind| kind == Kind::Surface));
    let taken = |key| Some(vocabulary::setting_words(key).iter().map(|it| plain(it)).collect());
    match (place.back(1), place.back(0)) {
        (_, "match") => surfaces(),
        (_, "on" | "hold") if place.item == "jump" => surfaces(),
        ("on", _) if place.item == "jump" => {
            Some(["falling", "rising"].into_iter().map(keyword).collect())
        }
        (_, "link") | ("-", ">") if place.item == "link" => {
            Some(scope.proposals(|kind| kind == Kind::Phase))
        }
        (_, key @ ("kernel" | "scheme")) if place.item == "method" => taken(key),
        (key, "=") if place.block() == Some("method") => {
            taken(key).filter(|it: &Vec<Proposal>| !it.is_empty())
        }
        (_, "fit") if place.item == "fit" => Some(scope.proposals(|kind| kind == Kind::Data)),
        (_, "with") if place.item == "plot" => Some(scope.proposals(|kind| kind == Kind::Path)),
        (_, word @ ("signal" | "plot")) if place.item == word => Some(Vec::new()),
        (_, "metric") => Some(scope.proposals(|kind| kind == Kind::State)),
        // Here a name is made up.
        (
            _,
            "model" | "param" | "const" | "let" | "fn" | "data" | "state" | "control" | "surface"
            | "phase" | "jump" | "time",
        ) => Some(Vec::new()),
        (before, "free") if before != "start" => Some(Vec::new()),
        _ => None,
    }
}

/// What a line of a block begins with.
fn entries(block: &str, scope: &Scope) -> Vec<Proposal> {
    let kinds = |kinds: &'static [Kind]| scope.proposals(move |kind| kinds.contains(&kind));
    match block {
        "dynamics" => kinds(&[Kind::State]).into_iter().map(|it| entry(it, "' = ")).collect(),
        "guess" => kinds(&[Kind::State, Kind::Control, Kind::Free])
            .into_iter()
            .map(|it| entry(it, " = "))
            .collect(),
        "jump" | "link" => kinds(&[Kind::State]).into_iter().map(|it| entry(it, " := ")).collect(),
        "sweep" => {
            let settings = vocabulary::settings().into_iter().map(|it| own(it.name, &it.takes));
            kinds(&[Kind::Param]).into_iter().chain(settings).map(|it| entry(it, " = ")).collect()
        }
        "method" => {
            let blocks = ["smooth", "grid", "continue"].into_iter().map(keyword);
            let keys = vocabulary::settings().into_iter().filter(|it| it.name != "continue");
            blocks.chain(keys.map(|it| entry(own(it.name, &it.takes), " = "))).collect()
        }
        "match" => ["below", "above"].into_iter().map(|it| entry(keyword(it), " => ")).collect(),
        "piecewise" => vec![entry(keyword("otherwise"), " => ")],
        "expect" => expression(&CursorContext::default(), scope),
        _ => Vec::new(),
    }
}

/// Anything that has a value, and the words that go on with the item.
fn expression(place: &CursorContext<'_>, scope: &Scope) -> Vec<Proposal> {
    let is_value = |kind| {
        !matches!(
            kind,
            Kind::Model
                | Kind::Jump
                | Kind::Path
                | Kind::Report
                | Kind::Plot
                | Kind::Part
                | Kind::Column
        )
    };
    let mut all = scope.proposals(is_value);
    all.extend(scope.locals(place));
    all.extend(vocabulary::functions().into_iter().map(items::function));
    all.extend(vocabulary::NUMBERS.iter().map(|it| plain(it.0)));
    all.extend(["piecewise", "match"].into_iter().map(word));
    if place.is_among_items() {
        all.extend(inner_words(place.item).iter().map(|it| keyword(it)));
    }
    if place.back(0) == "(" {
        all.extend(["start", "end"].into_iter().map(keyword));
    }
    all
}
