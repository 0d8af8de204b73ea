//! `phase run for each csv("runs*.csv") ...`: a text in which the phase is written out for each
//! file that matches, as `run[1]`, `run[2]` and so on; in each `run` is the data of its file.
//!
//! All of them stand at the place of the one that was written, so what is said of it is said once.

use super::Files;
use super::pattern::{is_pattern, matches, natural_order};
use crate::syntax::each::{numbered, unnumbered};
use crate::syntax::walk;
use fdcc_grammar::ast::{self, Each, ExprKind, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};
use std::borrow::Cow;

/// Each is a phase of one problem, and all of them are checked whenever the text changes.
const MOST_FILES: usize = 500;

/// Of files that do not fit for the same reason, or of names in a help, so many are told.
const MOST_TOLD: usize = 3;

/// The text with a phase for each file; tells patterns that no file matches.
pub(crate) fn written_out<'t>(
    tree: &'t ast::Model,
    files: Option<&dyn Files>,
    found: &mut Vec<Diagnostic>,
) -> Cow<'t, ast::Model> {
    if !tree.items.iter().any(|item| each(item).is_some()) {
        return Cow::Borrowed(tree);
    }
    let mut items = Vec::new();
    for item in &tree.items {
        let ItemKind::Phase { name, like, each: Some(each), items: own } = &item.kind else {
            items.push(item.clone());
            continue;
        };
        let names = files.map(|files| matching(each, files));
        let names = match names {
            Some(Ok(names)) => names,
            Some(Err(diagnostic)) => {
                found.push(diagnostic);
                unread(tree, name, each)
            }
            None => unread(tree, name, each),
        };
        for (at, file) in names.into_iter().enumerate() {
            let own: Vec<Item> =
                std::iter::once(rows(name, each, file)).chain(own.clone()).collect();
            let name = Ident { name: numbered(&name.name, at + 1), span: name.span };
            let (like, each) = (like.clone(), Some(each.clone()));
            let kind = ItemKind::Phase { name, like, each, items: own };
            items.push(Item { kind, span: item.span });
        }
    }
    Cow::Owned(ast::Model { items, ..tree.clone() })
}

fn each(item: &Item) -> Option<&Each> {
    match &item.kind {
        ItemKind::Phase { each, .. } => each.as_ref(),
        _ => None,
    }
}

/// The data set of a phase.
fn rows(name: &Ident, each: &Each, file: String) -> Item {
    let Each { file_span, columns, .. } = each.clone();
    let span = columns.last().map_or(file_span, |last| file_span.to(last.0.span));
    Item { kind: ItemKind::Data { name: name.clone(), file, file_span, columns }, span }
}

/// The names of the files, as people count.
fn matching(each: &Each, files: &dyn Files) -> Result<Vec<String>, Diagnostic> {
    let pattern = each.file.as_str();
    if !is_pattern(pattern) {
        return Ok(vec![pattern.to_owned()]);
    }
    let told = |message: String, label: String| {
        Diagnostic::new(Code::DataFile, message, each.file_span, label)
    };
    let listed = files.names(pattern).map_err(|reason| {
        told(format!("files that match `{pattern}` cannot be looked for"), reason).help(WHERE)
    })?;
    let mut names: Vec<String> = listed.into_iter().filter(|it| matches(pattern, it)).collect();
    names.sort_by(|a, b| natural_order(a, b));
    names.dedup();
    match names.len() {
        0 => Err(told(format!("no file matches `{pattern}`"), "there is no such file".into())
            .help(format!("{WHERE}{}", others(pattern, files)))),
        count if count > MOST_FILES => Err(told(
            format!("{count} files match `{pattern}`"),
            format!("more than {MOST_FILES} experiments"),
        )
        .help("let the pattern match fewer of them")),
        _ => Ok(names),
    }
}

const WHERE: &str = "data files stand in the folder of the model, or below the one of `--data DIR`";

/// What stands in the folder of a pattern, for one that was mistyped.
fn others(pattern: &str, files: &dyn Files) -> String {
    let all = match pattern.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/*.csv"),
        None => "*.csv".into(),
    };
    let mut names = files.names(&all).unwrap_or_default();
    names.retain(|name| matches(&all, name));
    names.sort_by(|a, b| natural_order(a, b));
    names.dedup();
    let more = names.len().saturating_sub(MOST_TOLD);
    names.truncate(MOST_TOLD);
    match more {
        _ if names.is_empty() => String::new(),
        0 => format!("; there is `{}`", names.join("`, `")),
        _ => format!("; there is `{}`, and {more} more", names.join("`, `")),
    }
}

/// As many phases as the text speaks of, where no file can be read: they are checked all the same.
fn unread(tree: &ast::Model, name: &Ident, each: &Each) -> Vec<String> {
    let mut count = 1;
    for value in tree.items.iter().flat_map(walk::expressions) {
        walk::visit(value, &mut |inner| {
            if let ExprKind::Index(base, at) = &inner.kind
                && matches!(&base.kind, ExprKind::Name(it) if *it == name.name)
            {
                count = count.max(*at).min(MOST_FILES);
            }
        });
    }
    vec![each.file.clone(); count]
}

/// Whether a data set waits for files, which has been told.
pub(super) fn is_waiting(each: Option<&Each>, file: &str) -> bool {
    each.is_some_and(|each| is_pattern(&each.file) && each.file == file)
}

/// Leaves one of the findings that say the same of each phase, and a few of those that are about
/// the files; they are in the order of the text.
pub(crate) fn told_once(tree: &ast::Model, found: &mut Vec<Diagnostic>) {
    let families = tree.items.iter().filter(|item| each(item).is_some());
    let families: Vec<Span> = families.map(|item| item.span).collect();
    if families.is_empty() {
        return;
    }
    let is_inside =
        |place: Span| families.iter().any(|own| own.start <= place.start && place.end <= own.end);
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut more = 0;
    for it in found.drain(..) {
        let is_of = |other: &&Diagnostic| (other.span(), other.code) == (it.span(), it.code);
        let same = kept.iter().rev().take_while(is_of);
        let is_as = |same_as: fn(&str) -> String| {
            same.clone().any(|other| same_as(&other.message) == same_as(&it.message))
        };
        let (count, is_told, is_of_other) =
            (same.clone().count(), is_as(unnumbered), is_as(reason));
        if count == 0 {
            say_how_many(&mut kept, &mut more);
        }
        match is_inside(it.span()) {
            true if is_told => {}
            true if is_of_other || count >= MOST_TOLD => more += 1,
            _ => kept.push(it),
        }
    }
    say_how_many(&mut kept, &mut more);
    *found = kept;
}

/// A message about a file, ``` `runs1.csv`: there is no column `x` ```, without its name.
fn reason(message: &str) -> String {
    let of_file = message.strip_prefix('`').and_then(|it| it.split_once("`: "));
    unnumbered(of_file.map_or(message, |it| it.1))
}

/// Adds to the last finding how many like it are not told.
fn say_how_many(kept: &mut [Diagnostic], more: &mut usize) {
    if let Some(last) = kept.last_mut().filter(|_| *more > 0) {
        let help = last.help.take().map_or(String::new(), |help| format!("{help}; "));
        let more =
            if *more == 1 { "1 more file has".into() } else { format!("{more} more files have") };
        last.help = Some(format!("{help}{more} the same mistake"));
    }
    *more = 0;
}
