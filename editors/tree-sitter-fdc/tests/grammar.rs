//! The grammar accepts every model that the compiler accepts, sees the same items, and gives the
//! trees of `test/corpus/`.
//!
//! The models are written out to `target/editors/models` by the example `editor_texts` of
//! `fdcc-tests`.

use std::fs;
use std::path::{Path, PathBuf};
use tree_sitter::{InputEdit, Node, Parser, Point, Query, Tree};
use tree_sitter_fdc::{LANGUAGE, QUERIES};

fn parse(text: &str) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&LANGUAGE.into()).expect("the versions fit");
    parser.parse(text, None).expect("nothing stops it")
}

fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries =
        fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.expect("the folder can be read").path());
    paths.filter(|path| path.extension().is_some_and(|it| it == extension)).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("the file is text")
}

/// Words that begin items in a tree: what `editor_texts` writes for the compiler.
fn item_words(node: Node<'_>, text: &str, words: &mut Vec<String>) {
    let mut cursor = node.walk();
    // What a phase is like, and for what it stands, are parts of its head.
    let is_item = |child: &Node<'_>| child.is_named() && !matches!(child.kind(), "like" | "each");
    for child in node.children(&mut cursor).filter(is_item) {
        let first = child.child(0);
        if let (Some(first), "file" | "phase" | "ERROR") = (first, node.kind()) {
            let word = || format!("{} {}", first.start_byte(), &text[first.byte_range()]);
            words.extend((!first.is_named()).then(word));
        }
        if child.kind() == "phase" {
            item_words(child, text, words);
        }
    }
}

#[test]
fn every_model_is_read_and_has_the_same_items() {
    let models = files("../../target/editors/models", "fdc");
    assert!(models.len() > 500, "write the models out first");
    let mut problems = Vec::new();
    for path in models {
        let (text, expected) = (read(&path), read(&path.with_extension("words")));
        let tree = parse(&text);
        let mut words = Vec::new();
        item_words(tree.root_node(), &text, &mut words);
        if tree.root_node().has_error() {
            problems.push(format!("{}: not accepted", path.display()));
        } else if words != expected.lines().collect::<Vec<_>>() {
            problems.push(format!("{}: other items: {words:?}", path.display()));
        }
    }
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

/// A model is typed: after each character the tree is mended, and it is the tree of the text as if
/// read at once.
#[test]
fn typing_gives_the_tree_of_the_text() {
    let text = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/stacked.fdc"));
    let mut parser = Parser::new();
    parser.set_language(&LANGUAGE.into()).expect("the versions fit");
    let (mut tree, mut at) = (parse(""), Point::new(0, 0));
    for (start, character) in text.char_indices() {
        let end = start + character.len_utf8();
        let after = if character == '\n' {
            Point::new(at.row + 1, 0)
        } else {
            Point::new(at.row, at.column + character.len_utf8())
        };
        tree.edit(&InputEdit {
            start_byte: start,
            old_end_byte: start,
            new_end_byte: end,
            start_position: at,
            old_end_position: at,
            new_end_position: after,
        });
        tree = parser.parse(&text[..end], Some(&tree)).expect("nothing stops it");
        at = after;
    }
    assert_eq!(tree.root_node().to_sexp(), parse(&text).root_node().to_sexp());
}

/// Where the text ends in the middle of an item, the items before it are what they were.
#[test]
fn the_items_before_an_unfinished_one_stay() {
    for path in files("../../models", "fdc") {
        let text = read(&path);
        let words = |part: &str| {
            let mut words = Vec::new();
            item_words(parse(part).root_node(), part, &mut words);
            words
        };
        // Those of a phase that is not closed are not looked at.
        let outer = |word: &String| text[..place(word)].ends_with('\n');
        let whole: Vec<String> = words(&text).into_iter().filter(outer).collect();
        for pair in whole.windows(2) {
            let (start, next) = (place(&pair[0]), place(&pair[1]));
            let expected: Vec<&String> =
                whole.iter().take_while(|word| place(word) < start).collect();
            for end in (start..next).filter(|&end| text.is_char_boundary(end)) {
                let found = words(&text[..end]);
                let missing: Vec<_> =
                    expected.iter().filter(|word| !found.contains(word)).collect();
                assert!(missing.is_empty(), "{}: {missing:?} in\n{}", path.display(), &text[..end]);
            }
        }
    }
}

fn place(word: &str) -> usize {
    word.split(' ').next().and_then(|at| at.parse().ok()).expect("a word has its place")
}

#[test]
fn queries_name_what_there_is() {
    for (name, query) in QUERIES {
        Query::new(&LANGUAGE.into(), query).unwrap_or_else(|error| panic!("{name}.scm: {error}"));
    }
}

/// `===` title `===` text `---` tree, as `tree-sitter test` reads it.
#[test]
fn the_corpus_has_its_trees() {
    let mut cases = 0;
    for path in files("test/corpus", "txt") {
        let document = read(&path);
        let parts: Vec<&str> =
            document.split("\n===\n").flat_map(|part| part.split("===\n")).collect();
        let titled = parts.iter().filter(|part| !part.trim().is_empty()).collect::<Vec<_>>();
        for pair in titled.chunks(2) {
            let [title, case] = pair else { panic!("{}: a title without a case", path.display()) };
            let (text, expected) =
                case.split_once("\n---\n").expect("text and tree are parted by ---");
            let found = parse(text.trim_start_matches('\n')).root_node().to_sexp();
            let words: Vec<_> = expected.split_whitespace().collect();
            let expected = words.join(" ").replace(" )", ")");
            assert_eq!(found, expected, "{}: {title}", path.display());
            cases += 1;
        }
    }
    assert!(cases > 5, "there are cases");
}
