//! Every diagnostic as it is seen: the wrong models of `docs/diagnostics/`, drawn 80 and 120
//! columns wide.
//!
//! With `UPDATE=1` the drawings are written to `tests/snapshots/` instead of compared with what is
//! there. They are there to be read.

use crate::common::{fdcc_with, folder, stdout};
use std::fs;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The codes, each with the models under `## Wrong` on its page.
fn wrong_models() -> Vec<(String, Vec<String>)> {
    let folder = fs::read_dir(repository().join("docs/diagnostics")).expect("the pages are there");
    let mut pages: Vec<PathBuf> = folder.map(|entry| entry.expect("a page").path()).collect();
    pages.sort();
    let code = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
    let text = |path: &Path| fs::read_to_string(path).expect("a page can be read");
    pages.iter().map(|path| (code(path), models(&text(path)))).collect()
}

fn models(page: &str) -> Vec<String> {
    let wrong = page.split("\n## ").filter(|section| section.starts_with("Wrong"));
    let blocks = wrong.flat_map(|section| section.split("\n```fdc\n").skip(1));
    // What cannot stand on a page stands for itself.
    let written_out = |text: &str| text.replace('␀', "\0").replace('…', &"1 + ".repeat(60_000));
    blocks
        .filter_map(|block| block.split_once("```"))
        .map(|(model, _)| written_out(model))
        .collect()
}

/// Tests that run side by side have folders of their own.
fn drawings(test: &str, width: &str) -> String {
    let mut drawn = String::new();
    for (code, models) in wrong_models() {
        for model in models {
            let name = format!("{code}.fdc");
            let folder = folder(&format!("{test}_{width}"), &[(&name, model.as_bytes())]);
            let printed = stdout(&fdcc_with(&folder, &["check", &name], &[("COLUMNS", width)]));
            drawn += &format!("---- {code} ----\n\n{printed}\n");
        }
    }
    drawn
}

fn compare(width: &str) {
    let drawn = drawings("drawing", width);
    let file = repository().join(format!("tests/snapshots/diagnostics-{width}.txt"));
    if std::env::var_os("UPDATE").is_some() {
        fs::write(&file, &drawn).expect("the drawings can be written");
    }
    let before = fs::read_to_string(&file).unwrap_or_default();
    let first = before.lines().zip(drawn.lines()).find(|(before, drawn)| before != drawn);
    assert!(
        before == drawn,
        "the drawings have changed, first here: {first:#?}\nread them, then run this test with \
         UPDATE=1"
    );
}

#[test]
fn diagnostics_are_drawn_80_columns_wide() {
    compare("80");
}

#[test]
fn diagnostics_are_drawn_120_columns_wide() {
    compare("120");
}

/// A terminal would break what is wider, and tear the arrows off.
#[test]
fn drawings_keep_to_the_width() {
    for width in ["80", "120"] {
        let drawn = drawings("wide", width);
        let is_wide = |line: &&str| line.chars().count() > width.parse().expect("a number");
        let wide: Vec<&str> = drawn.lines().filter(is_wide).collect();
        assert!(wide.is_empty(), "{width}: {wide:#?}");
    }
}
