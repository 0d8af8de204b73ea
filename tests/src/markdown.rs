//! Markdown as a test suite: the fenced blocks of a document, each under its heading.

use std::fs;
use std::path::{Path, PathBuf};

/// A fenced block.
#[derive(Clone, Debug)]
pub struct Block {
    /// The heading it stands under; it names the case.
    pub heading: String,
    /// The words after the opening fence, such as `fdc` or `fdc solve`.
    pub tag: String,
    /// What is between the fences.
    pub text: String,
    /// The line of the opening fence, from 1.
    pub line: usize,
}

/// All fenced blocks of a document.
pub fn blocks(document: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut heading = String::new();
    let mut open: Option<Block> = None;
    for (number, line) in document.lines().enumerate() {
        let fence = line.trim_end().strip_prefix("```");
        match (&mut open, fence) {
            (Some(_), Some("")) => blocks.extend(open.take()),
            (Some(block), _) => block.text += &format!("{line}\n"),
            (None, Some(tag)) => {
                let (heading, tag) = (heading.clone(), tag.to_owned());
                open = Some(Block { heading, tag, text: String::new(), line: number + 1 });
            }
            (None, None) if line.starts_with('#') => {
                heading = line.trim_start_matches('#').trim().to_owned()
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fence is never closed under `{heading}`");
    blocks
}

/// The folder of the workspace.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the tests are a folder of the workspace")
        .to_owned()
}

/// Name and text of every file in a folder of the repository with an extension, in alphabetical
/// order.
pub fn documents(folder: &str, extension: &str) -> Vec<(String, String)> {
    let entries = fs::read_dir(repository().join(folder)).expect("the folder exists");
    let paths = entries.map(|entry| entry.expect("the folder can be read").path());
    let mut paths: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|e| e == extension)).collect();
    paths.sort();
    let name =
        |path: &Path| path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
    paths
        .iter()
        .map(|path| (name(path), fs::read_to_string(path).expect("the file is text")))
        .collect()
}
