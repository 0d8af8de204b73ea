//! The text files of the repository, for tests that look at all of them.

use crate::repository;
use std::fs;
use std::path::Path;

/// A file of the repository: its path, and its text.
pub struct Source {
    /// Such as `runtime/src/lib.rs`.
    pub path: String,
    /// What is in it.
    pub text: String,
}

/// Every text file that belongs to the repository, in alphabetical order.
pub fn sources() -> Vec<Source> {
    let mut found = Vec::new();
    collect(&repository(), "", &mut found);
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn collect(folder: &Path, prefix: &str, found: &mut Vec<Source>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the folder can be read").path();
        let name = path.file_name().expect("an entry has a name").to_string_lossy().into_owned();
        let full = format!("{prefix}{name}");
        // In a worktree `.git` is a file.
        if [".git", "target", "node_modules", "out"].contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() {
            collect(&path, &format!("{full}/"), found);
        } else if let Ok(text) = fs::read_to_string(&path) {
            found.push(Source { path: full, text });
        }
    }
}

/// Whether a word stands in a line, not as a part of a longer one.
pub fn names(line: &str, word: &str) -> bool {
    let joins = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let (first, last) = (word.chars().next(), word.chars().next_back());
    line.match_indices(word).any(|(at, _)| {
        let (before, after) =
            (line[..at].chars().next_back(), line[at + word.len()..].chars().next());
        !(joins(before) && joins(first) || joins(after) && joins(last))
    })
}

/// Fails with all breaches of a rule, one on each line.
pub fn all_well(breaches: Vec<String>) {
    assert!(breaches.is_empty(), "\n{}\n", breaches.join("\n"));
}
