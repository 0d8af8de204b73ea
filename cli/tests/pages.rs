//! The pages of the reference, the recipes and the tutorial say what the commands say: each block
//! tagged `console` is a command and what it prints.
//!
//! The models of a page are files by their names, and its table is the data that its model reads.
//! Numbers count as the same if they agree to six digits, or are rounding; iterations and seconds
//! are not compared. With UPDATE=1 the pages are written anew.

use crate::common::{fdcc, folder, stdout};
use std::fs;
use std::path::{Path, PathBuf};

/// The blocks of a page with their tags.
fn blocks(page: &str) -> Vec<(String, String)> {
    let fences = page.split("\n```").skip(1).step_by(2);
    fences
        .filter_map(|block| block.split_once('\n'))
        .map(|(tag, text)| (tag.into(), text.to_owned() + "\n"))
        .collect()
}

fn model_name(text: &str) -> Option<&str> {
    text.lines().find_map(|line| line.strip_prefix("model ")).map(str::trim)
}

/// Whether a word is printed as the page has it.
fn is_same(printed: &str, written: &str) -> bool {
    let number = |word: &str| word.trim_matches(['(', ')', ',']).parse::<f64>().ok();
    match (number(printed), number(written)) {
        (Some(a), Some(b)) => {
            let are_rounding = a.abs().max(b.abs()) < ROUNDING;
            are_rounding || (a - b).abs() <= 1e-6 * b.abs().max(1e-6)
        }
        _ => printed == written,
    }
}

/// Errors of this size are those of the last digits.
const ROUNDING: f64 = 1e-5;

/// The words of a line but for what may change without a change of the answer: iterations and
/// seconds, which have a column in a table and a line in a verdict.
fn compared<'l>(line: &'l str, header: &str) -> Vec<&'l str> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let is_unit = |word: &&str| word.starts_with('[') || word.ends_with(']');
    let columns: Vec<&str> = header.split_whitespace().filter(|word| !is_unit(word)).collect();
    let is_effort = |at: usize| match columns.get(at) {
        _ if line.contains("optimality error") => at == 0 || at + 2 == words.len(),
        _ if line == header => false,
        column => matches!(column, Some(&"iterations" | &"seconds")),
    };
    (0..words.len()).filter(|at| !is_effort(*at)).map(|at| words[at]).collect()
}

fn are_same(printed: &str, written: &str) -> bool {
    let header = written.lines().next().unwrap_or_default();
    let is_line = |(a, b): (&str, &str)| {
        let [a, b] = [compared(a, header), compared(b, header)];
        a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| is_same(a, b))
    };
    printed.lines().count() == written.lines().count()
        && printed.lines().zip(written.lines()).all(is_line)
}

/// What a command of a page prints now.
fn printed(folder: &Path, command: &str) -> String {
    let words = command.trim_start_matches("$ fdcc ").split(' ');
    let arguments: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
    stdout(&fdcc(folder, &arguments, ""))
}

/// The files that the blocks of a page are.
fn files(blocks: &[(String, String)]) -> Vec<(String, &[u8])> {
    let data = blocks.iter().flat_map(|(_, text)| text.split("csv(\"").nth(1));
    let data = data.filter_map(|it| it.split('"').next()).next().unwrap_or_default();
    let file = |(tag, text): &'_ (String, String)| match tag.as_str() {
        "csv" => Some(data.to_owned()),
        tag if tag.starts_with("fdc") => Some(format!("{}.fdc", model_name(text)?)),
        _ => None,
    };
    blocks.iter().filter_map(|it| Some((file(it)?, it.1.as_bytes()))).collect()
}

#[test]
fn commands_print_what_the_pages_say() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let folders = ["reference", "recipes"].map(|it| docs.join(it));
    let entries = folders.iter().flat_map(|it| fs::read_dir(it).expect("the folder is there"));
    let mut pages: Vec<PathBuf> = entries.map(|it| it.expect("a page").path()).collect();
    pages.push(docs.join("tutorial.md"));
    let mut commands = 0;
    for path in pages {
        let page = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let mut text = fs::read_to_string(&path).expect("a page can be read");
        let blocks = blocks(&text);
        let files = files(&blocks);
        let files: Vec<(&str, &[u8])> =
            files.iter().map(|(name, text)| (name.as_str(), *text)).collect();
        let folder = folder(&format!("page_{page}"), &files);
        for (_, block) in blocks.iter().filter(|(tag, _)| tag == "console") {
            let (command, written) = block.split_once('\n').expect("a command and its output");
            let printed = printed(&folder, command);
            commands += 1;
            if !are_same(&printed, written) {
                assert!(is_updated(), "{page}: {command} prints\n{printed}");
                text = text.replace(block, &format!("{command}\n{printed}"));
            }
        }
        if is_updated() {
            fs::write(&path, text).expect("a page can be written");
        }
    }
    assert!(commands >= 30, "the pages are read");
}

fn is_updated() -> bool {
    std::env::var_os("UPDATE").is_some()
}

#[test]
fn efforts_are_not_compared_and_all_else_is() {
    let table = "mu  objective [N^2 s]  iterations  seconds  status\n0.2  101.5  80  0.2  solved\n";
    assert!(are_same(&table.replace("80  0.2", "70  9.9"), table));
    assert!(!are_same(&table.replace("101.5", "101.6"), table));
    assert!(!are_same(&table.replace("solved", "stopped"), table));
    let verdict = " 98 iterations   optimality error 1.0e-11   1.146 s\n";
    assert!(are_same(&verdict.replace("98", "99").replace("1.146", "2"), verdict));
    assert!(!are_same(&verdict.replace("1.0e-11", "1.0e-02"), verdict));
}
