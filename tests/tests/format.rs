//! The canonical layout: what it looks like (`tests/tests/format/`), and that it changes nothing
//! but blanks, over every model of the repository and over random layouts of them.

use fdcc_grammar::{comments, format};
use fdcc_tests::layout::assert_only_the_layout_changes;
use fdcc_tests::random::Random;
use fdcc_tests::{Block, blocks, documents};

/// Pairs of blocks `fdc` and `fdc formatted` under one heading.
#[test]
fn layouts_are_those_of_the_documents() {
    for (name, document) in documents("tests/tests/format", "md") {
        let models: Vec<Block> =
            blocks(&document).into_iter().filter(|it| it.tag.starts_with("fdc")).collect();
        for pair in models.chunks(2) {
            let [before, after] = pair else {
                panic!("{name}.md: a model has no formatted partner")
            };
            assert_eq!(
                (before.tag.as_str(), after.tag.as_str()),
                ("fdc", "fdc formatted"),
                "{name}.md:{}",
                before.line
            );
            let found = format(&before.text).expect("the model can be read");
            assert!(found == after.text, "{name}.md:{} {}\n{found}", before.line, before.heading);
            assert_eq!(format(&found).expect("it still can"), found);
        }
    }
}

#[test]
fn models_have_the_canonical_layout() {
    for (name, text) in documents("models", "fdc") {
        assert!(format(&text).as_ref() == Ok(&text), "run `fdcc fmt models/{name}.fdc`");
    }
}

#[test]
fn a_text_with_mistakes_is_left_alone() {
    assert!(format("param a =\nparam b = 1").is_err());
    assert_eq!(format("# nothing\n\n\n\n# at all").as_deref(), Ok("# nothing\n\n# at all\n"));
    assert_eq!(format("").as_deref(), Ok(""));
}

#[test]
fn line_ends_are_kept_and_a_byte_order_mark_is_not() {
    assert_eq!(format("param a=1\r\nparam b=2").as_deref(), Ok("param a = 1\r\nparam b = 2\r\n"));
    assert_eq!(format("\u{FEFF}param a=1\n").as_deref(), Ok("param a = 1\n"));
}

#[test]
fn formatting_changes_only_the_layout() {
    texts().iter().for_each(|text| assert_only_the_layout_changes(text));
}

#[test]
fn random_layouts_come_out_with_the_same_meaning() {
    let mut random = Random::new(7);
    for text in texts().iter().filter(|text| text.len() < 5_000) {
        for _ in 0..10 {
            assert_only_the_layout_changes(&shaken(text, &mut random));
        }
    }
}

/// Every model of the repository, right or wrong.
fn texts() -> Vec<String> {
    let folders = [
        "docs/reference",
        "docs/diagnostics",
        "tests/tests/syntax",
        "tests/tests/semantics",
        "tests/tests/format",
    ];
    let of_folder =
        |folder| documents(folder, "md").into_iter().flat_map(|(_, document)| blocks(&document));
    let in_documents = folders.into_iter().flat_map(of_folder).map(|block| block.text);
    documents("models", "fdc").into_iter().map(|(_, text)| text).chain(in_documents).collect()
}

/// The same words with other blanks, line breaks and comments between them.
fn shaken(text: &str, random: &mut Random) -> String {
    const GAPS: [&str; 8] =
        [" ", "  ", "\n", "\n\n\n", " # remark\n", "\n# alone\n", "\n\n  # apart\n\n", "\t"];
    let covered = comments(text);
    let mut shaken = String::new();
    for (at, character) in text.char_indices() {
        let in_comment = covered.iter().any(|span| span.range().contains(&at));
        match character {
            ' ' if !in_comment && random.below(6) == 0 => shaken += GAPS[random.below(GAPS.len())],
            '\n' if !covered.iter().any(|span| span.end as usize == at) && random.below(4) == 0 => {
                shaken.push(' ')
            }
            _ => shaken.push(character),
        }
    }
    shaken
}
