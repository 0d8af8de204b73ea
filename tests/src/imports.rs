//! Which folders of a crate import from which.
//!
//! A path that begins with `crate`, `super`, `self` or a module of the file is followed through
//! re-exports to the file that defines what it names. `pub use` itself is no import: it is a door.
//! Code for tests only is left out.

use crate::sources::Source;
use std::collections::{BTreeMap, BTreeSet};

type Path = Vec<String>;

/// The modules of a crate, and what its doors re-export.
struct Modules<'s> {
    files: BTreeMap<Path, &'s str>,
    reexports: BTreeMap<Path, Path>,
}

/// The folders that a folder imports from, each with an example: the importing file, and the path.
pub type Imports = BTreeMap<String, BTreeMap<String, (String, String)>>;

/// The imports between the folders of the crate in `root`, such as `runtime/src/`.
pub fn imports(sources: &[Source], root: &str) -> Imports {
    let codes: Vec<(Path, String, String)> = sources
        .iter()
        .filter(|source| source.path.starts_with(root) && source.path.ends_with(".rs"))
        .map(|source| {
            (module(&source.path[root.len()..]), source.path.clone(), without_tests(&source.text))
        })
        .collect();
    let tested: BTreeSet<Path> = sources
        .iter()
        .filter(|it| it.path.starts_with(root))
        .flat_map(|it| tests_of(it, root))
        .collect();
    let own = || codes.iter().filter(|(module, ..)| !tested.contains(module));
    let files = own().map(|(module, file, _)| (module.clone(), file.as_str())).collect();
    let mut modules = Modules { files, reexports: BTreeMap::new() };
    for (module, _, code) in own() {
        for (door, path) in statements(code).into_iter().filter(|it| it.0) {
            debug_assert!(door);
            let (path, name) = renamed(&path);
            if let Some(target) = modules.absolute(&path, module) {
                modules.reexports.insert([&module[..], &[name]].concat(), target);
            }
        }
    }
    let mut found = Imports::new();
    for (module, file, code) in own() {
        let named = statements(code).into_iter().filter(|it| !it.0).map(|it| renamed(&it.1).0);
        for path in named.chain(expressions(code)) {
            let target = modules.absolute(&path, module).and_then(|it| modules.file(&it, 0));
            let (Some(target), from) = (target, folder(file)) else { continue };
            if folder(target) != from {
                let example = (file.clone(), path.join("::"));
                found
                    .entry(from.into())
                    .or_default()
                    .entry(folder(target).into())
                    .or_insert(example);
            }
        }
    }
    found
}

/// Pairs of folders that import from each other, directly or through others, with an example.
pub fn circles(imports: &Imports) -> Vec<String> {
    let reaches = |from: &str, to: &str| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(folder) = open.pop() {
            let next = imports.get(folder).into_iter().flat_map(|it| it.keys());
            open.extend(next.map(String::as_str).filter(|next| seen.insert(*next)));
        }
        seen.contains(to)
    };
    let edges = imports.iter().flat_map(|(from, to)| to.iter().map(move |it| (from, it)));
    let back = edges.filter(|(from, (to, _))| reaches(to, from));
    back.map(|(from, (to, (file, path)))| {
        format!("{file}: `{path}` leads from {from} to {to}, which imports from {from} in turn")
    })
    .collect()
}

impl Modules<'_> {
    /// A path from the root of the crate; `None` where it leads out of the crate.
    fn absolute(&self, path: &[String], module: &[String]) -> Option<Path> {
        let (mut base, mut rest) = (module.to_vec(), path);
        match rest.first()?.as_str() {
            "crate" => (base, rest) = (Path::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|it| it == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            first => {
                let child = [&base[..], &[first.to_owned()]].concat();
                self.files.contains_key(&child).then_some(())?;
            }
        }
        Some([&base[..], rest].concat())
    }

    /// The file that defines what a path names.
    fn file(&self, path: &[String], depth: usize) -> Option<&str> {
        for length in 1..=path.len() {
            let door = self.reexports.get(&path[..length]);
            if let Some(target) =
                door.filter(|_| depth < 9 && !self.files.contains_key(&path[..length]))
            {
                return self.file(&[&target[..], &path[length..]].concat(), depth + 1);
            }
        }
        (0..=path.len()).rev().find_map(|length| self.files.get(&path[..length]).copied())
    }
}

/// The folder of a file; a file at the root of a crate is a room of its own.
fn folder(file: &str) -> &str {
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    if folder.ends_with("/src") { file } else { folder }
}

fn module(path: &str) -> Path {
    let stem = path.trim_end_matches(".rs");
    let mut parts: Path = stem.split('/').map(str::to_owned).collect();
    parts.pop_if(|last| ["mod", "lib", "main"].contains(&last.as_str()));
    parts
}

/// The modules that are declared for tests only.
fn tests_of(source: &Source, root: &str) -> Vec<Path> {
    let lines: Vec<&str> = source.text.lines().map(str::trim).collect();
    let declared = lines.windows(2).filter(|pair| pair[0] == "#[cfg(test)]");
    let names = declared.filter_map(|pair| pair[1].split("mod ").nth(1)?.strip_suffix(';'));
    let own = module(&source.path[root.len()..]);
    names.map(|name| [&own[..], &[name.to_owned()]].concat()).collect()
}

/// Code without comments, up to the tests.
fn without_tests(text: &str) -> String {
    let lines: Vec<&str> =
        text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let begins = |at: &usize| {
        lines[*at].trim() == "#[cfg(test)]"
            && lines.get(at + 1).is_some_and(|next| next.contains("mod ") && next.ends_with('{'))
    };
    let end = (0..lines.len()).find(begins).unwrap_or(lines.len());
    lines[..end].join("\n")
}

/// The paths of all `use` statements, and whether they are doors.
fn statements(code: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    for statement in code.split(';') {
        let Some(at) = statement.rfind("use ").filter(|at| is_statement(statement, *at)) else {
            continue;
        };
        let door = statement[..at].trim_end().ends_with([')', 'b']);
        let tree: String = statement[at + 4..].split_whitespace().collect::<Vec<_>>().join(" ");
        found.extend(expanded(&tree).into_iter().map(|path| (door, path)));
    }
    found
}

fn is_statement(text: &str, at: usize) -> bool {
    let line = text[..at].rsplit('\n').next().unwrap_or_default().trim();
    ["", "pub", "pub(crate)", "pub(super)"].contains(&line)
}

/// `a::{b, c::{d, e}}` as the paths `a::b`, `a::c::d`, `a::c::e`.
fn expanded(tree: &str) -> Vec<String> {
    let Some((before, inside)) = tree.trim().split_once('{') else {
        return vec![tree.trim().into()];
    };
    let inside = inside.trim_end().strip_suffix('}').unwrap_or(inside);
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, c) in inside.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inside[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&inside[start..]);
    let full = parts.into_iter().filter(|part| !part.trim().is_empty());
    full.flat_map(|part| expanded(&format!("{}{}", before.trim(), part.trim()))).collect()
}

/// A path, and the name that it has here.
fn renamed(path: &str) -> (Path, String) {
    let (path, alias) = path.split_once(" as ").map_or((path, None), |it| (it.0, Some(it.1)));
    let mut parts: Path = path.trim().split("::").map(|part| part.trim().to_owned()).collect();
    parts.pop_if(|last| last == "self");
    let name =
        alias.map_or_else(|| parts.last().cloned().unwrap_or_default(), |it| it.trim().into());
    (parts, name)
}

/// Paths in the code itself, beside its `use` statements.
fn expressions(code: &str) -> Vec<Path> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let beside = |statement| {
        let at = str::rfind(statement, "use ").filter(|at| is_statement(statement, *at));
        &statement[..at.unwrap_or(statement.len())]
    };
    let words = code.split(';').flat_map(|it| beside(it).split(|c| !is_word(c)));
    let paths = words
        .filter(|word| word.contains("::"))
        .map(|word| word.trim_matches(':').split("::").map(str::to_owned).collect());
    paths.filter(|path: &Path| path.len() > 1).collect()
}
