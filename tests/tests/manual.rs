//! The language reference is true and complete: `docs/reference/` as tests.
//!
//! A block tagged `fdc` is a model, `fdc more` is checked together with the first model of its page
//! (items have no order). Each gives exactly the diagnostics that its comments claim, and compiles
//! unless it claims an error. `later` in the tag says that `check` understands it and that `solve`
//! answers FDC0603.

use fdcc_compiler::builtins::{self, Domain, Notation, Row, Smoothness};
use fdcc_compiler::{check, compile_chain};
use fdcc_grammar::{Code, Diagnostic, Severity, parse};
use fdcc_tests::models::analyze;
use fdcc_tests::{blocks, documents, repository, unclaimed};
use std::fs;

mod places;

/// A model of the reference.
struct Example {
    place: String,
    text: String,
    is_later: bool,
}

fn examples() -> Vec<Example> {
    documents("docs/reference", "md")
        .iter()
        .flat_map(|(name, page)| examples_of(name, page))
        .collect()
}

fn examples_of(name: &str, page: &str) -> Vec<Example> {
    let models: Vec<_> =
        blocks(page).into_iter().filter(|block| block.tag.starts_with("fdc")).collect();
    let whole = models
        .iter()
        .find(|block| !block.tag.contains("more"))
        .map_or("", |block| &block.text)
        .to_owned();
    let example = |block: fdcc_tests::Block| Example {
        place: format!("docs/reference/{name}.md:{}", block.line),
        is_later: block.tag.contains("later"),
        text: if block.tag.contains("more") {
            format!("{whole}\n{}", block.text)
        } else {
            block.text
        },
    };
    models.into_iter().map(example).collect()
}

fn diagnostics(text: &str) -> Vec<Diagnostic> {
    let parsed = parse(text);
    if parsed.diagnostics.is_empty() { analyze(text).diagnostics } else { parsed.diagnostics }
}

#[test]
fn every_model_gives_exactly_the_diagnostics_it_claims() {
    let problems = examples().into_iter().flat_map(|example| {
        let problems = unclaimed(&example.text, &diagnostics(&example.text));
        problems.into_iter().map(move |problem| format!("{}: {problem}", example.place))
    });
    let problems: Vec<String> = problems.collect();
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

#[test]
fn models_compile_unless_the_page_says_that_they_cannot_be_solved_yet() {
    for example in examples() {
        if diagnostics(&example.text).iter().any(|it| it.severity == Severity::Error) {
            continue;
        }
        let model = analyze(&example.text).model.expect("a model without errors has a meaning");
        let codes: Vec<Code> =
            compile_chain(&model).err().unwrap_or_default().iter().map(|it| it.code).collect();
        let expected: &[Code] = if example.is_later { &[Code::NotYet] } else { &[] };
        assert_eq!(codes, expected, "{}", example.place);
    }
}

/// Every line of the table of places: it is read as the line beside it, or refused with the code
/// that stands there.
#[test]
fn plain_numbers_are_read_as_the_table_of_places_says() {
    let page = fs::read_to_string(repository().join("docs/reference/units.md"))
        .expect("the page is there");
    let is_base = |block: &fdcc_tests::Block| block.text.starts_with("model places");
    let base = blocks(&page).into_iter().find(is_base).expect("the model is there").text;
    let (_, table) = page.split_once("| line | is read as |").expect("the table is there");
    let rows: Vec<[&str; 2]> = table.lines().filter_map(places::row).collect();
    assert!(rows.len() > 40, "the table is read");
    let problems: Vec<String> =
        rows.iter().filter_map(|row| places::problem(&base, *row)).collect();
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

/// Every variant and every optional part of the syntax tree occurs in some model.
#[test]
fn every_construct_of_the_tree_has_an_example() {
    let trees: String =
        examples().iter().map(|example| format!("{:?}\n", parse(&example.text).tree)).collect();
    let missing: Vec<String> =
        constructs().into_iter().filter(|construct| !trees.contains(construct)).collect();
    assert!(missing.is_empty(), "write an example in docs/reference for {missing:?}");
}

/// `Variant`, or `part: Some(` for an optional part, as they are declared in the tree and print in
/// `Debug`.
fn constructs() -> Vec<String> {
    let tree =
        fs::read_to_string(repository().join("grammar/src/ast.rs")).expect("the tree is there");
    let (mut found, mut in_enum) = (Vec::new(), false);
    for line in tree.lines() {
        in_enum = line.starts_with("pub enum") || in_enum && line != "}";
        let variant = line
            .strip_prefix("    ")
            .filter(|rest| in_enum && rest.starts_with(char::is_uppercase));
        found.extend(
            variant
                .and_then(|rest| rest.split(|c: char| !c.is_alphanumeric()).next())
                .map(str::to_owned),
        );
        let optional = line.split(": Option<").collect::<Vec<_>>();
        let names = optional[..optional.len() - 1]
            .iter()
            .filter_map(|before| before.split([' ', ',']).next_back());
        found.extend(names.map(|name| format!("{name}: Some(")));
    }
    assert!(found.len() > 50, "the tree is read: {found:?}");
    found
}

/// Every keyword and every sign of the grammar occurs in some model.
#[test]
fn every_word_of_the_grammar_has_an_example() {
    let grammar = fs::read_to_string(repository().join("grammar/src/fdc.pest"))
        .expect("the grammar is there");
    let texts: String = examples().iter().map(|example| without_comments(&example.text)).collect();
    let words: Vec<&str> = texts.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let keywords: Vec<&str> = grammar
        .lines()
        .filter(|line| line.starts_with("kw_"))
        .filter_map(|line| line.split('"').nth(1))
        .collect();
    assert!(keywords.len() > 40, "the grammar is read");
    let missing: Vec<&&str> = keywords.iter().filter(|word| !words.contains(word)).collect();
    assert!(missing.is_empty(), "write an example in docs/reference for {missing:?}");
    let signs =
        ["<=", ">=", "==", "<", ">", "+", "-", "*", "/", "^", ":=", "->", "=>", "'", "[", "{", "("];
    assert!(signs.iter().all(|sign| texts.contains(sign)));
}

fn without_comments(text: &str) -> String {
    text.lines().map(|line| format!("{}\n", line.split('#').next().unwrap_or_default())).collect()
}

/// `UPDATE=1 cargo test --release --test all manual::` writes the page anew.
#[test]
fn the_page_of_functions_is_that_of_the_table() {
    let path = repository().join("docs/reference/functions.md");
    let page = functions_page();
    if std::env::var_os("UPDATE").is_some() {
        fs::write(&path, &page).expect("the page can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(written, page, "docs/reference/functions.md is out of date: run with UPDATE=1");
}

const FUNCTIONS_HEAD: &str = "\
# Operators and functions

<!-- Written from the table in compiler/src/expressions/graph/builtins.rs; change it there, then
     `UPDATE=1 cargo test --release --test all manual::`. -->

All of them take numbers. `+`, `-` and `abs` take vectors as well, component by component, and `*` \
and `/` a vector with a
number. What is about vectors stands in [expressions](expressions.md), sets in \
[surfaces](surfaces.md).

";

fn functions_page() -> String {
    let rows = builtins::ALL
        .iter()
        .map(|builtin| builtin.row())
        .filter(|row| row.notation != Notation::Internal);
    let lines = rows.map(|row| {
        format!("| `{}` | {} | {} | {} |\n", written(row), row.doc, domain(row), smoothness(row))
    });
    let table: String = lines.collect();
    format!(
        "{FUNCTIONS_HEAD}| written | is | has a value for | derivatives \
         |\n|---|---|---|---|\n{table}"
    )
}

fn written(row: &Row) -> String {
    match (row.notation, row.arity) {
        (Notation::Infix(_), _) => format!("a {} b", row.name),
        (Notation::Prefix, _) => format!("{}a", row.name),
        (_, 1) => format!("{}(a)", row.name),
        _ => format!("{}(a, b)", row.name),
    }
}

fn domain(row: &Row) -> String {
    let operand = |at: usize| ["a", "b"][at];
    match row.domain {
        Domain::All => "all numbers".into(),
        Domain::NonNegative(at) => format!("{} >= 0", operand(at)),
        Domain::Positive(at) => format!("{} > 0", operand(at)),
        Domain::NonZero(at) => format!("{} not 0", operand(at)),
        Domain::Unit(at) => format!("-1 <= {} <= 1", operand(at)),
    }
}

fn smoothness(row: &Row) -> &'static str {
    match row.smoothness {
        Smoothness::Jump => "a jump",
        Smoothness::Kink => "a kink",
        Smoothness::Analytic => "all",
    }
}

/// The examples in the table are equations between numbers, such as `sqrt(9) = 3`.
#[test]
fn examples_of_functions_are_true() {
    let docs = builtins::ALL
        .iter()
        .map(|builtin| builtin.row())
        .filter(|row| row.notation != Notation::Internal);
    for row in docs {
        let equation = row.doc.split('`').find(|text| text.contains(" = "));
        let (left, right) =
            equation.and_then(|text| text.split_once(" = ")).expect("a row has an example");
        let [left, right] = [left, right].map(value_of);
        assert!((left - right).abs() <= 1e-15, "{}: {}: {left} is not {right}", row.name, row.doc);
    }
}

fn value_of(expression: &str) -> f64 {
    let text = format!(
        "param value = {expression}\ntime t in [0, 1]\nstate x start value\ndynamics {{ x' = 1 }}"
    );
    let model =
        check(&parse(&text).tree).model.unwrap_or_else(|| panic!("{expression} is understood"));
    model.params[0]
        .value
        .and_then(|value| model.graph.as_number(value))
        .expect("a constant is a number")
}

/// The page of the command line names every command and every option that is declared in
/// cli/src/commands.
#[test]
fn the_page_of_the_command_line_is_complete() {
    let page = fs::read_to_string(repository().join("docs/reference/command-line.md"))
        .expect("the page is there");
    for (name, text) in documents("cli/src/commands", "rs").iter().filter(|(name, _)| name != "mod")
    {
        let is_command = text.contains("pub fn run(self)");
        assert!(
            !is_command || page.contains(&format!("\n## `fdcc {name}")),
            "command-line.md needs a section for `fdcc {name}`"
        );
        for option in options(text) {
            assert!(
                page.contains(&format!("`{option}")),
                "command-line.md needs `{option}` of cli/src/commands/{name}.rs"
            );
        }
    }
}

/// `--time-limit` for a field `time_limit` below `#[arg(long ...)]`, or the name that stands there.
fn options(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let is_option = |pair: &&[&str]| pair[0].starts_with("#[arg(") && names_long(pair[0]);
    let field = |line: &str| {
        line.trim_start_matches("pub ").split(':').next().unwrap_or_default().replace('_', "-")
    };
    let given =
        |attribute: &str| Some(attribute.split_once("long = \"")?.1.split('"').next()?.to_owned());
    lines
        .windows(2)
        .filter(is_option)
        .map(|pair| format!("--{}", given(pair[0]).unwrap_or_else(|| field(pair[1]))))
        .collect()
}

fn names_long(attribute: &str) -> bool {
    attribute.split(|c: char| !c.is_alphanumeric()).any(|word| word == "long")
}
