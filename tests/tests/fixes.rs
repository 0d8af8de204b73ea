//! Repairs: what becomes of wrong models (`tests/tests/fixes/`), and that no repair makes any text
//! of the repository worse.

use fdcc_compiler::{analyze, repair};
use fdcc_grammar::{Diagnostic, repaired};
use fdcc_tests::fuzzed::assert_repairs_end;
use fdcc_tests::{Block, blocks, documents};

/// A model `fdc`, and what it becomes: `fdc fixed` if that is certain, `fdc unsafe` if it is
/// likely.
#[test]
fn wrong_models_become_the_right_ones() {
    for (name, document) in documents("tests/tests/fixes", "md") {
        let mut wrong: Option<Block> = None;
        for block in blocks(&document).into_iter().filter(|it| it.tag.starts_with("fdc")) {
            let place = format!("{name}.md:{} {}", block.line, block.heading);
            match (block.tag.as_str(), &wrong) {
                ("fdc", _) => wrong = Some(block),
                ("fdc fixed", Some(wrong)) => {
                    expect(&repair(&wrong.text, false), &block.text, &place)
                }
                ("fdc unsafe", Some(wrong)) => {
                    expect(&repair(&wrong.text, true), &block.text, &place)
                }
                _ => panic!("{place}: a wrong model comes first"),
            }
        }
    }
}

fn expect(found: &str, expected: &str, place: &str) {
    assert!(found == expected, "{place}\n{found}");
}

#[test]
fn repairing_twice_changes_nothing_and_no_text_becomes_harder_to_read() {
    for text in texts() {
        assert_repairs_end(&text);
    }
}

/// A repair can be applied, says what it does, and its finding is gone or has moved on.
#[test]
fn each_repair_is_one() {
    for text in texts() {
        for found in analyze(&text).diagnostics {
            for repair in &found.fixes {
                let single = Diagnostic { fixes: vec![repair.clone()], ..found.clone() };
                let repaired =
                    repaired(&text, &[single], true).expect("a repair changes something");
                assert!(!repair.title.is_empty());
                let is_still_there = analyze(&repaired).diagnostics.contains(&found);
                assert!(!is_still_there, "{found:#?}\n{text}\n---\n{repaired}");
            }
        }
    }
}

/// Every model of the repository, most of them wrong.
fn texts() -> Vec<String> {
    let folders = [
        "docs/reference",
        "docs/diagnostics",
        "tests/tests/syntax",
        "tests/tests/semantics",
        "tests/tests/fixes",
    ];
    let of_folder =
        |folder| documents(folder, "md").into_iter().flat_map(|(_, document)| blocks(&document));
    folders.into_iter().flat_map(of_folder).map(|block| block.text).collect()
}
