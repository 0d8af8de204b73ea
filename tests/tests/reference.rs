//! The pages of `docs/diagnostics/` are true: each wrong model gives its diagnostic, each right one
//! gives nothing.

use fdcc_grammar::{Code, Diagnostic, Severity, parse};
use fdcc_tests::{blocks, documents};

#[test]
fn every_diagnostic_has_a_page_and_every_page_a_diagnostic() {
    let pages: Vec<String> =
        documents("docs/diagnostics", "md").into_iter().map(|(name, _)| name).collect();
    let codes: Vec<String> = Code::ALL.iter().map(Code::to_string).collect();
    assert_eq!(pages, codes);
}

#[test]
fn pages_have_the_title_of_their_diagnostic() {
    for (name, page) in documents("docs/diagnostics", "md") {
        let code: Code = name.parse().expect("a page is named after its code");
        let title = format!("# {name}: {}", code.title());
        assert_eq!(page.lines().next(), Some(title.as_str()));
    }
}

/// Why comes first, in more than a line, then the wrong model and the right one.
#[test]
fn pages_say_why_and_show_both_models() {
    for (name, page) in documents("docs/diagnostics", "md") {
        let headings: Vec<&str> =
            page.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        assert_eq!(headings, ["Wrong", "Right"], "{name}");
        let why = page.split("\n## ").next().unwrap_or_default();
        assert!(why.split_whitespace().count() > 25, "{name}: say why");
    }
}

#[test]
fn wrong_models_give_their_diagnostic_and_right_models_give_none() {
    for (name, page) in documents("docs/diagnostics", "md") {
        let models = blocks(&page).into_iter().filter(|block| block.tag.starts_with("fdc"));
        let headings: Vec<_> = models.map(|model| (model.heading.clone(), model)).collect();
        let of = |wanted: &str| {
            headings
                .iter()
                .filter(|(heading, _)| heading == wanted)
                .map(|(_, model)| model)
                .collect::<Vec<_>>()
        };
        let (wrong, right) = (of("Wrong"), of("Right"));
        assert!(!wrong.is_empty() && !right.is_empty(), "{name} has a wrong and a right model");
        for model in wrong.iter().filter(|model| model.tag == "fdc") {
            let found = check(&written_out(&model.text));
            let is_it = |diagnostic: &Diagnostic| diagnostic.code.as_str() == name;
            assert!(found.iter().any(is_it), "{name}.md:{}: {found:#?}", model.line);
            let others: Vec<_> =
                found.iter().filter(|it| !is_it(it) && it.severity == Severity::Error).collect();
            assert!(others.is_empty(), "{name}.md:{}: {others:#?}", model.line);
        }
        for model in right {
            let found = check(&model.text);
            let spoken: Vec<_> = found.iter().filter(|it| it.severity > Severity::Advice).collect();
            assert!(spoken.is_empty(), "{name}.md:{}: {spoken:#?}", model.line);
        }
    }
}

/// What cannot stand on a page stands for itself: a control character, and a sum that is too long.
fn written_out(text: &str) -> String {
    text.replace('␀', "\0").replace('…', &"1 + ".repeat(60_000))
}

/// Like `fdcc check`: the meaning is looked at where the syntax is right.
fn check(text: &str) -> Vec<Diagnostic> {
    let parsed = parse(text);
    if !parsed.diagnostics.is_empty() {
        return parsed.diagnostics;
    }
    fdcc_tests::models::analyze(text).diagnostics
}
