//! The pages of the reference say what the commands say: each block tagged `console` is a command
//! and what it prints.
//!
//! The models of a page are files by their names. Numbers count as the same if they agree to six
//! digits, or are rounding.

mod common;

use common::{fdcc, folder, stdout};
use std::fs;
use std::path::Path;

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
        (Some(a), Some(b)) => (a - b).abs() <= 1e-6 * b.abs().max(1e-6),
        _ => printed == written,
    }
}

fn check(folder: &Path, page: &str, block: &str) {
    let (command, written) = block.split_once('\n').expect("a command and its output");
    let words = command.trim_start_matches("$ fdcc ").split(' ');
    let arguments: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
    let printed = stdout(&fdcc(folder, &arguments, ""));
    let lines = printed.lines().zip(written.lines());
    let is_line = |(a, b): (&str, &str)| {
        let words = a.split_whitespace().zip(b.split_whitespace());
        a.split_whitespace().count() == b.split_whitespace().count()
            && words.clone().all(|(a, b)| is_same(a, b))
    };
    let same = printed.lines().count() == written.lines().count() && lines.clone().all(is_line);
    assert!(same, "{page}: {command} prints\n{printed}");
}

#[test]
fn commands_print_what_the_reference_says() {
    let pages = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reference");
    let mut commands = 0;
    for entry in fs::read_dir(pages).expect("the reference is there") {
        let path = entry.expect("a page").path();
        let page = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let blocks = blocks(&fs::read_to_string(&path).expect("a page can be read"));
        let models = blocks
            .iter()
            .filter(|(tag, _)| tag.starts_with("fdc"))
            .filter_map(|(_, text)| Some((format!("{}.fdc", model_name(text)?), text.as_bytes())));
        let models: Vec<(String, &[u8])> = models.collect();
        let files: Vec<(&str, &[u8])> =
            models.iter().map(|(name, text)| (name.as_str(), *text)).collect();
        let folder = folder(&format!("page_{page}"), &files);
        for (_, block) in blocks.iter().filter(|(tag, _)| tag == "console") {
            check(&folder, &page, block);
            commands += 1;
        }
    }
    assert!(commands >= 3, "the pages are read");
}
