//! Every feature, as data: a text with a mark, a request, and the answer as a person would note it
//! down.
//!
//! In `server/tests/cases/`, under each heading: a model in a block `fdc`, with `|` where the
//! cursor is (twice for a range), then a block for each request. `UPDATE=1` writes the answers
//! anew, to be read before they are kept.

mod client;
mod shown;

use client::{Client, URI};
use fdcc_tests::{Block, blocks, documents, repository};
use serde_json::{Value, json};
use shown::shown;

/// A model and its marks.
struct Marked {
    text: String,
    /// Offsets of the marks.
    marks: Vec<usize>,
}

impl Marked {
    fn read(text: &str) -> Marked {
        let pieces: Vec<&str> = text.split('|').collect();
        let marks =
            (1..pieces.len()).map(|at| pieces[..at].iter().map(|it| it.len()).sum()).collect();
        Marked { text: pieces.concat(), marks }
    }

    fn position(&self, offset: usize) -> Value {
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let column = before[start..].encode_utf16().count();
        json!({ "line": before.matches('\n').count(), "character": column })
    }

    fn cursor(&self) -> Value {
        self.position(self.marks.first().copied().unwrap_or(0))
    }

    fn range(&self) -> Value {
        let all = [0, self.text.len()];
        let marks: &[usize] = if self.marks.is_empty() { &all } else { &self.marks };
        json!({ "start": self.position(marks[0]), "end": self.position(marks[marks.len() - 1]) })
    }
}

/// The method behind the tag of a block, and what it takes beside the text.
fn request(tag: &str, marked: &Marked) -> (&'static str, Value) {
    let (word, rest) = tag.split_once(' ').unwrap_or((tag, ""));
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let place = || json!({ "position": marked.cursor() });
    match word {
        "diagnostics" => ("textDocument/diagnostic", json!({})),
        "definition" => ("textDocument/definition", place()),
        "references" => (
            "textDocument/references",
            json!({ "position": marked.cursor(), "context": { "includeDeclaration": true } }),
        ),
        "highlights" => ("textDocument/documentHighlight", place()),
        "prepare" => ("textDocument/prepareRename", place()),
        "rename" => {
            ("textDocument/rename", json!({ "position": marked.cursor(), "newName": rest }))
        }
        "symbols" => ("textDocument/documentSymbol", json!({})),
        "folding" => ("textDocument/foldingRange", json!({})),
        "selection" => ("textDocument/selectionRange", json!({ "positions": [marked.cursor()] })),
        "tokens" => ("textDocument/semanticTokens/full", json!({})),
        "tokens-of-range" => {
            ("textDocument/semanticTokens/range", json!({ "range": marked.range() }))
        }
        "format" => ("textDocument/formatting", json!({ "options": options })),
        "format-range" => {
            ("textDocument/rangeFormatting", json!({ "range": marked.range(), "options": options }))
        }
        "format-typed" => {
            let typed = if rest == "enter" { "\n" } else { rest };
            let params = json!({ "position": marked.cursor(), "ch": typed, "options": options });
            ("textDocument/onTypeFormatting", params)
        }
        "actions" => {
            let only: Vec<&str> = rest.split_whitespace().collect();
            let context = if only.is_empty() {
                json!({ "diagnostics": [] })
            } else {
                json!({ "diagnostics": [], "only": only })
            };
            ("textDocument/codeAction", json!({ "range": marked.range(), "context": context }))
        }
        "hover" => ("textDocument/hover", place()),
        "completion" => ("textDocument/completion", place()),
        "signature" => ("textDocument/signatureHelp", place()),
        "hints" => ("textDocument/inlayHint", json!({ "range": marked.range() })),
        "lens" => ("textDocument/codeLens", json!({})),
        _ => panic!("no request is called `{tag}`"),
    }
}

fn answer(client: &mut Client, tag: &str, marked: &Marked) -> String {
    let (method, mut params) = request(tag, marked);
    params["textDocument"] = json!({ "uri": URI });
    match client.answer(method, params).response_result {
        Ok(result) => shown(tag, &result, &marked.text),
        Err(error) => format!("error: {}\n", error.message),
    }
}

/// The blocks of a document with their answers put in.
fn answered(document: &str) -> Vec<(Block, String)> {
    let mut client =
        Client::start(json!({ "textDocument": { "diagnostic": { "relatedInformation": true } } }));
    let mut marked = Marked { text: String::new(), marks: Vec::new() };
    let mut all = Vec::new();
    for block in blocks(document) {
        let text = if let Some(before) = block.tag.strip_prefix("fdc") {
            marked = Marked::read(&block.text);
            // `fdc then`: the text was something else before.
            if before.is_empty() {
                client.open(URI, &marked.text);
            } else {
                client.change(URI, 2, json!([{ "text": marked.text }]));
            }
            block.text.clone()
        } else {
            answer(&mut client, &block.tag, &marked)
        };
        all.push((block, text));
    }
    assert!(client.end());
    all
}

#[test]
fn every_request_is_answered_as_noted() {
    let update = std::env::var_os("UPDATE").is_some();
    let mut wrong = Vec::new();
    for (name, document) in documents("server/tests/cases", "md") {
        let mut renewed = document.clone();
        // From the end, so that lines keep their numbers.
        for (block, text) in
            answered(&document).into_iter().rev().filter(|(block, text)| block.text != *text)
        {
            wrong.push(format!(
                "{name}.md:{}: {}\n--- noted\n{}--- answered\n{text}",
                block.line, block.heading, block.text
            ));
            let mut lines: Vec<&str> = renewed.lines().collect();
            lines.splice(block.line..block.line + block.text.lines().count(), text.lines());
            renewed = lines.join("\n") + "\n";
        }
        if update {
            std::fs::write(repository().join(format!("server/tests/cases/{name}.md")), renewed)
                .expect("it can be written");
        }
    }
    wrong.reverse();
    assert!(update || wrong.is_empty(), "\n{}", wrong.join("\n"));
}
