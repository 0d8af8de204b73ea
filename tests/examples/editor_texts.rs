//! Writes every model of the repository that the grammar accepts to a folder, for the grammars of
//! the editors to read.
//!
//! Beside each `NAME.fdc` stands `NAME.words`: the place in bytes and the text of each word that
//! begins an item.

use fdcc_grammar::ast::{Item, ItemKind};
use fdcc_grammar::parse;
use fdcc_tests::blocks;
use fdcc_tests::sources::sources;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let folder: PathBuf = env::args().nth(1).expect("usage: editor_texts FOLDER").into();
    fs::create_dir_all(&folder).expect("the folder can be made");
    let accepted = models().into_iter().filter(|(_, text)| parse(text).diagnostics.is_empty());
    let written = accepted.map(|(name, text)| {
        let path = folder.join(name);
        fs::write(path.with_extension("words"), words(&text))
            .expect("the folder can be written to");
        fs::write(path.with_extension("fdc"), text).expect("the folder can be written to");
    });
    println!("{} models", written.count());
}

/// Name and text of every model, and of every block of a document that shows one.
fn models() -> Vec<(String, String)> {
    let all = sources().into_iter().flat_map(|source| {
        let name = source.path.rsplit_once('.').map_or("", |(name, _)| name).replace('/', "-");
        let shown = if source.path.ends_with(".md") { blocks(&source.text) } else { Vec::new() };
        let shown = shown.into_iter().filter(|block| block.tag.starts_with("fdc"));
        let shown: Vec<_> =
            shown.map(|block| (format!("{name}-{}", block.line), block.text)).collect();
        let whole = source.path.ends_with(".fdc").then_some((name, source.text));
        whole.into_iter().chain(shown)
    });
    all.collect()
}

/// The words that begin items, one on each line.
fn words(text: &str) -> String {
    let tree = parse(text).tree;
    let name = tree.name.map(|name| {
        text[..name.span.range().start].rfind("model").expect("`model` precedes a name")
    });
    let mut starts: Vec<usize> = name.into_iter().collect();
    collect(&tree.items, &mut starts);
    let word = |at: &usize| {
        let word: String = text[*at..].chars().take_while(|it| it.is_ascii_alphabetic()).collect();
        format!("{at} {word}\n")
    };
    starts.iter().map(word).collect()
}

fn collect(items: &[Item], starts: &mut Vec<usize>) {
    for item in items {
        starts.push(item.span.range().start);
        if let ItemKind::Phase { items, .. } = &item.kind {
            collect(items, starts);
        }
    }
}
