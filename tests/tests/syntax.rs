//! What the parser understands and what it says about the rest. The cases are documents in `tests/syntax/`.

use fdcc_grammar::{Code, Diagnostic, Parse, SourceFile, parse};
use fdcc_tests::{blocks, documents, repository, unclaimed};

#[test]
fn documents_claim_every_diagnostic() {
    for (name, document) in documents("tests/tests/syntax", "md") {
        for block in blocks(&document).iter().filter(|block| block.tag == "fdc") {
            let problems = unclaimed(&block.text, &parse(&block.text).diagnostics);
            assert!(problems.is_empty(), "{name}.md:{} {}\n{}", block.line, block.heading, problems.join("\n"));
        }
    }
}

#[test]
fn models_parse_without_a_word() {
    for (name, text) in documents("models", "fdc") {
        let parse = parse(&text);
        assert!(parse.diagnostics.is_empty(), "{name}: {:#?}", parse.diagnostics);
        assert_eq!(parse.tree.name.expect("every model has a name").name, name);
    }
}

#[test]
fn line_ends_tabs_and_byte_order_marks_change_nothing() {
    for (name, text) in documents("models", "fdc") {
        let counts = |text: &str| {
            let Parse { tree, diagnostics } = parse(text);
            (tree.docs, tree.items.len(), diagnostics)
        };
        let expected = counts(&text);
        for variant in [text.replace('\n', "\r\n"), text.replace("  ", "\t"), format!("\u{FEFF}{text}")] {
            assert_eq!(counts(&variant), expected, "{name}");
        }
    }
}

/// The cases of group 00 in the table of messages: message, severity, places, texts and help.
#[test]
fn messages_are_those_of_the_table() {
    let path = repository().join("tests/reference/diagnostics.json");
    let table = std::fs::read_to_string(path).expect("the table is there");
    let cases: serde_json::Value = serde_json::from_str(&table).expect("the table is JSON");
    let cases = cases.as_array().expect("the table is a list");
    let syntax: Vec<_> = cases.iter().filter(|case| text(case, "code").starts_with("FDC00")).collect();
    assert!(!syntax.is_empty());
    for case in syntax {
        let source = text(case, "src");
        let diagnostics = parse(source).diagnostics;
        let [found] = &diagnostics[..] else { panic!("one diagnostic is expected: {diagnostics:#?}") };
        assert_eq!(found.code.as_str(), text(case, "code"));
        assert_eq!(found.message, text(case, "msg"));
        assert_eq!(format!("{:?}", found.severity).to_lowercase(), text(case, "sev"));
        assert_eq!(found.help.as_deref(), Some(text(case, "help")));
        assert_eq!(labels(source, found), expected_labels(case));
    }
}

fn text<'v>(value: &'v serde_json::Value, key: &str) -> &'v str {
    value[key].as_str().expect("the table has text here")
}

fn labels(source: &str, diagnostic: &Diagnostic) -> Vec<(String, String)> {
    let source = SourceFile::new("model.fdc", source);
    diagnostic.labels.iter().map(|label| (source.slice(label.span).to_owned(), label.text.clone())).collect()
}

fn expected_labels(case: &serde_json::Value) -> Vec<(String, String)> {
    let labels = case["labels"].as_array().expect("a case has labels");
    let part = |label: &serde_json::Value, at: usize| label[at].as_str().expect("a label has two texts").to_owned();
    labels.iter().map(|label| (part(label, 0), part(label, 1))).collect()
}

#[test]
fn a_broken_piece_costs_only_itself() {
    let text = "param a = 1\nparam b =\nstate x start\nstat y start 0\ndynamics {\n  x' = a b\n  y' = 1\n}\nend x == 1\n";
    let Parse { tree, diagnostics } = parse(text);
    let codes: Vec<Code> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
    assert_eq!(codes, [Code::Unfinished, Code::Unfinished, Code::UnknownItem, Code::MissingOperator]);
    let kinds: Vec<String> = tree.items.iter().map(|item| format!("{:?}", item.kind)).collect();
    assert_eq!(kinds.len(), 3, "{kinds:?}");
    assert!(kinds[1].contains("\"y\"") && !kinds[1].contains("\"x\""), "the good equation stays: {}", kinds[1]);
}
