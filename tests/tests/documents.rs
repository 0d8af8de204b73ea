//! Documents are true as far as a machine can tell: what they name exists, and CI does what the
//! README says.

use fdcc_tests::sources::{Source, all_well, names, sources};
use fdcc_tests::{blocks, repository};
use std::fs;

#[test]
fn the_map_is_short() {
    let map =
        fs::read_to_string(repository().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md is there");
    let lines = map.lines().count();
    assert!(
        lines <= 120,
        "ARCHITECTURE.md has {lines} lines; move details to docs/method or docs/decisions (at most \
         120)"
    );
}

/// Documents that describe the code as it is. Decisions are not among them: they say what was so
/// when they were taken.
fn is_about_the_code(source: &Source) -> bool {
    let path = &source.path;
    path == "ARCHITECTURE.md"
        || path == "README.md"
        || path == "docs/editors.md"
        || path.starts_with("docs/method/")
        || path.starts_with("docs/recipes/")
}

/// The words in backquotes outside fenced blocks, with their lines; and the folder that the last
/// heading named.
fn quoted(text: &str) -> Vec<(usize, String, &str)> {
    let (mut words, mut folder, mut fenced) = (Vec::new(), String::new(), false);
    for (at, line) in text.lines().enumerate() {
        fenced ^= line.trim_start().starts_with("```");
        let inside = || line.split('`').skip(1).step_by(2);
        if line.starts_with('#') {
            folder = inside().find(|word| word.ends_with('/')).unwrap_or_default().to_owned();
        }
        if !fenced && !line.trim_start().starts_with("```") {
            words.extend(inside().map(|word| (at + 1, folder.clone(), word)));
        }
    }
    words
}

fn is_path(word: &str) -> bool {
    let plain = word.chars().all(|c| c.is_alphanumeric() || "._-/".contains(c));
    let ending = [".rs", ".md", ".pest", ".toml", ".fdc", ".json", ".yml", "/"]
        .iter()
        .any(|ending| word.ends_with(ending));
    plain && ending && word.len() > 5 && !word.starts_with('.')
}

/// Whether a function is declared in one of the files, or anywhere if none is named.
fn is_declared(name: &str, files: &[&str], all: &[Source]) -> bool {
    let function = format!("fn {}", name.rsplit("::").next().unwrap_or(name));
    let code = all.iter().filter(|source| source.path.ends_with(".rs"));
    let mut code = code
        .filter(|source| files.is_empty() || files.iter().any(|file| source.path.ends_with(file)));
    code.any(|source| source.text.lines().any(|line| names(line, &function)))
}

#[test]
fn documents_name_only_what_exists() {
    let all = sources();
    let mut breaches = Vec::new();
    for Source { path, text } in all.iter().filter(|source| is_about_the_code(source)) {
        let quoted = quoted(text);
        for (line, folder, word) in &quoted {
            let exists = || {
                repository().join(word).exists() || repository().join(folder).join(word).exists()
            };
            if is_path(word) && !exists() {
                breaches.push(format!(
                    "{path}:{line}: there is no file `{word}`; correct the name or the page"
                ));
            }
            let beside = quoted.iter().filter(|other| other.0 == *line && other.2.ends_with(".rs"));
            let files: Vec<&str> = beside.map(|other| other.2).collect();
            if word.strip_suffix("()").is_some_and(|name| !is_declared(name, &files, &all)) {
                breaches.push(format!(
                    "{path}:{line}: there is no function `{word}` in {files:?}; correct the page"
                ));
            }
        }
    }
    all_well(breaches);
}

/// The files to which a page links, without what is code.
fn links(text: &str) -> Vec<String> {
    let mut is_fenced = false;
    let lines = text.lines().filter(|line| {
        is_fenced ^= line.trim_start().starts_with("```");
        !is_fenced
    });
    let plain: Vec<String> = lines.map(|line| line.split('`').step_by(2).collect()).collect();
    let targets = plain.iter().flat_map(|line| line.split("](").skip(1));
    let targets = targets.filter_map(|rest| rest.split([')', '#']).next());
    let is_file = |it: &&str| !it.is_empty() && !it.contains(':') && !it.contains(' ');
    targets.filter(is_file).map(str::to_owned).collect()
}

#[test]
fn links_lead_to_files() {
    let mut breaches = Vec::new();
    for Source { path, text } in sources().iter().filter(|it| it.path.ends_with(".md")) {
        let folder = repository().join(path).parent().expect("a file has a folder").to_owned();
        let missing = links(text).into_iter().filter(|link| !folder.join(link).exists());
        breaches.extend(missing.map(|link| format!("{path}: there is no file `{link}`")));
    }
    all_well(breaches);
}

#[test]
fn every_page_about_the_method_names_its_files() {
    let is_page =
        |source: &Source| source.path.starts_with("docs/method/") && source.path.ends_with(".md");
    let pages = sources().into_iter().filter(is_page);
    let names_none = |page: &Source| !quoted(&page.text).iter().any(|(_, _, word)| is_path(word));
    all_well(
        pages
            .filter(names_none)
            .map(|page| format!("{}: name the files that implement it", page.path))
            .collect(),
    );
}

/// An example is the shortest way to learn what a type is for, and is a test as well.
#[test]
fn every_public_type_of_the_library_has_an_example() {
    let mut breaches = Vec::new();
    for Source { path, text } in sources().iter().filter(|it| it.path.starts_with("fdcc/src/")) {
        let lines: Vec<&str> = text.lines().collect();
        for at in 0..lines.len() {
            let is_type = ["pub struct ", "pub enum "].iter().any(|it| lines[at].starts_with(it));
            let above = lines[..at].iter().rev().take_while(|it| it.starts_with(['/', '#']));
            if is_type && !above.into_iter().any(|line| *line == "/// ```") {
                breaches.push(format!("{path}:{}: give `{}` an example", at + 1, lines[at]));
            }
        }
    }
    all_well(breaches);
}

/// The two commands of the README are the ones that CI runs.
#[test]
fn the_readme_and_ci_run_the_same_commands() {
    let read = |path: &str| fs::read_to_string(repository().join(path)).expect("the file is there");
    let (readme, ci) = (read("README.md"), read(".ci/run"));
    let commands: Vec<String> = blocks(&readme)
        .iter()
        .filter(|block| block.tag == "sh" && block.text.starts_with("cargo "))
        .flat_map(|block| block.text.lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    assert_eq!(
        commands.len(),
        2,
        "the README has exactly two commands for a fresh machine: {commands:?}"
    );
    for command in commands {
        assert!(ci.contains(&command), ".ci/run must run the README's own `{command}`");
    }
}

#[test]
fn the_model_in_the_readme_is_the_one_in_models() {
    let read = |path: &str| fs::read_to_string(repository().join(path)).expect("the file is there");
    let shown = blocks(&read("README.md"))
        .into_iter()
        .find(|block| block.tag == "fdc")
        .expect("a model is shown");
    assert_eq!(shown.text, read("models/block.fdc"), "README.md: copy models/block.fdc again");
}
