//! One proposal: what is shown, what is written, where it stands in the list.

use fdcc::language::vocabulary;
use fdcc::language::{Definition, Kind};
use fdcc_grammar::words::Word;
use lsp_types::{CompletionItem, CompletionItemKind, InsertTextFormat, MarkupContent, MarkupKind};

/// What could be written.
pub struct Proposal {
    label: String,
    kind: CompletionItemKind,
    detail: Option<String>,
    doc: Option<String>,
    /// What is written instead of the label: with places to go on at, where the client knows these,
    /// and without.
    snippet: Option<String>,
    plain: Option<String>,
    /// Names first, then functions, then words.
    rank: char,
}

impl Proposal {
    /// In the words of the protocol.
    pub fn shown(self, snippets: bool) -> CompletionItem {
        let is_snippet = snippets && self.snippet.is_some();
        let documentation =
            self.doc.map(|value| MarkupContent { kind: MarkupKind::Markdown, value }.into());
        CompletionItem {
            sort_text: Some(format!("{}{}", self.rank, self.label)),
            label: self.label,
            kind: Some(self.kind),
            detail: self.detail,
            documentation,
            insert_text: if is_snippet { self.snippet } else { self.plain },
            insert_text_format: is_snippet.then_some(InsertTextFormat::Snippet),
            ..CompletionItem::default()
        }
    }
}

/// A word as it is.
pub fn plain(label: &str) -> Proposal {
    Proposal {
        label: label.into(),
        kind: CompletionItemKind::Value,
        detail: None,
        doc: None,
        snippet: None,
        plain: None,
        rank: '2',
    }
}

/// A word of the language.
pub fn keyword(label: &str) -> Proposal {
    Proposal { kind: CompletionItemKind::Keyword, rank: '4', ..plain(label) }
}

/// A word that begins something with braces.
pub fn word(label: &str) -> Proposal {
    let snippet = match label {
        "piecewise" => "piecewise {\n  ${1:x <= 0} => ${2:0}\n  otherwise => ${3:1}\n}",
        _ => "match ${1:slip} { below => ${2:0}, above => ${3:1} }",
    };
    Proposal { snippet: Some(snippet.into()), ..keyword(label) }
}

/// A unit, with what it is in SI.
pub fn unit(label: &str) -> Proposal {
    Proposal { kind: CompletionItemKind::Unit, detail: vocabulary::unit(label), ..plain(label) }
}

/// A key of the method.
pub fn own(label: &str, takes: &str) -> Proposal {
    Proposal { kind: CompletionItemKind::Property, detail: Some(takes.into()), ..plain(label) }
}

/// A function of the language.
pub fn function(it: vocabulary::Function) -> Proposal {
    Proposal {
        kind: CompletionItemKind::Function,
        detail: Some(format!("{}({})", it.name, it.arguments.join(", "))),
        doc: Some(it.doc.into()),
        snippet: Some(format!("{}($1)", it.name)),
        rank: '3',
        ..plain(it.name)
    }
}

/// Something that the model declares.
pub fn name(it: &Definition, unit: Option<&str>) -> Proposal {
    let unit = unit.map_or(String::new(), |unit| format!(", {unit}"));
    Proposal {
        kind: kind(it.kind),
        detail: Some(format!("{}{unit}", it.kind.word())),
        rank: '1',
        ..plain(&it.name)
    }
}

fn kind(kind: Kind) -> CompletionItemKind {
    match kind {
        Kind::Const | Kind::Param => CompletionItemKind::Constant,
        Kind::Function => CompletionItemKind::Function,
        Kind::Part | Kind::Column => CompletionItemKind::Field,
        Kind::Surface => CompletionItemKind::Interface,
        Kind::Phase | Kind::Model => CompletionItemKind::Module,
        Kind::Jump => CompletionItemKind::Event,
        _ => CompletionItemKind::Variable,
    }
}

/// What a line of a block begins with, with what follows it.
pub fn entry(it: Proposal, follows: &str) -> Proposal {
    Proposal { plain: Some(format!("{}{follows}", it.label)), snippet: None, ..it }
}

/// The items as they are begun; `$0` is where the cursor ends.
const SNIPPETS: &[(&str, &str)] = &[
    ("model", "model ${1:name}"),
    ("param", "param ${1:p} = ${2:1}"),
    ("const", "const ${1:c} = ${2:1}"),
    ("let", "let ${1:name} = ${2:1}"),
    ("signal", "signal ${1:r} = ${2:0}"),
    ("fn", "fn ${1:f}(${2:x}) = ${3:x}"),
    ("data", "data ${1:obs} = csv(\"${2:file.csv}\") columns ${3:t} [${4:s}], ${5:x}"),
    ("free", "free ${1:T} in [${2:0.1}, ${3:10}] guess ${4:1}"),
    ("time", "time ${1:t} in [${2:0}, ${3:1}]"),
    ("state", "state ${1:x} start ${2:0}"),
    ("control", "control ${1:u} in [${2:-1}, ${3:1}]"),
    ("surface", "surface ${1:slip} = ${2:x}"),
    ("dynamics", "dynamics {\n  ${1:x}' = ${2:0}\n}"),
    ("metric", "metric ${1:x}: ${2:1}"),
    (
        "jump",
        "jump ${1:bounce} on ${2:ground} ${3:falling} at most ${4:1} {\n  ${5:v} := ${6:-v}\n}",
    ),
    ("start", "start ${1:x} == ${2:0}"),
    ("end", "end ${1:x} == ${2:0}"),
    ("at", "at ${1:0.5}: ${2:x} == ${3:0}"),
    ("path", "path ${1:name}: ${2:x} <= ${3:1}"),
    ("minimize", "minimize ${1:integral(u^2)}"),
    ("maximize", "maximize ${1:x(end)}"),
    ("fit", "fit ${1:obs}: ${2:x} sd ${3:0.1}"),
    ("guess", "guess {\n  ${1:x} = ${2:t}\n}"),
    ("phase", "phase ${1:name} {\n  time ${2:t} in [${3:0}, ${4:1}]\n  $0\n}"),
    ("link", "link ${1:first} -> ${2:second} {\n  ${3:x} := ${3:x}\n}"),
    ("method", "method {\n  grid N = ${1:100} scheme ${2:implicit_euler}\n}"),
    ("sweep", "sweep {\n  ${1:sigma} = ${2:0.1, 0.05}\n}"),
    ("report", "report {\n  ${1:name} = ${2:x}\n}"),
    ("plot", "plot ${1:path}: ${2:y} over ${3:x}"),
    ("expect", "expect {\n  ${1:x(end)} == ${2:0} within ${3:1e-6}\n}"),
];

/// An item, by the word that begins it.
pub fn item(it: &Word) -> Proposal {
    let snippet = SNIPPETS.iter().find(|row| row.0 == it.text).map(|row| row.1.to_owned());
    Proposal {
        detail: it.item.as_ref().map(|form| form.noun.to_owned()),
        doc: it.item.as_ref().map(|form| format!("```fdc\n{}\n```", form.example)),
        snippet,
        ..keyword(it.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A snippet with its places filled in as proposed.
    fn filled(snippet: &str) -> String {
        let mut text = String::new();
        let mut rest = snippet.replace("$0", "");
        while let Some(at) = rest.find("${") {
            let (colon, end) =
                (rest[at..].find(':').expect("a default"), rest[at..].find('}').expect("an end"));
            text += &(rest[..at].to_owned() + &rest[at + colon + 1..at + end]);
            rest = rest[at + end + 1..].to_owned();
        }
        text + &rest
    }

    #[test]
    fn every_item_has_a_snippet_that_can_be_read() {
        for it in fdcc_grammar::words::items() {
            let snippet =
                item(it).snippet.unwrap_or_else(|| panic!("SNIPPETS needs `{}`", it.text));
            let text = filled(&snippet);
            let parsed = fdcc_grammar::parse(&text);
            let errors: Vec<_> = parsed
                .diagnostics
                .iter()
                .filter(|it| it.severity == fdcc_grammar::Severity::Error)
                .collect();
            assert!(errors.is_empty(), "{text}: {errors:?}");
        }
    }
}
