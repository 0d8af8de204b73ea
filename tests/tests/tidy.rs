//! The rules of ARCHITECTURE.md for code that a machine can watch. Each message says what to do.
//!
//! Rules are tables: a new one is a row. Comments are taken off before code is looked at.

use fdcc_tests::imports::{circles, imports};
use fdcc_tests::repository;
use fdcc_tests::sources::{Source, all_well, names, sources};
use std::fs;

fn rust_sources() -> Vec<Source> {
    sources().into_iter().filter(|source| source.path.ends_with(".rs")).collect()
}

/// Lines of code with their numbers, without comments.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(at, line)| (at + 1, line.split("//").next().unwrap_or_default()))
}

/// Which crates of ours a crate may depend on.
const CRATES: &[(&str, &[&str])] = &[
    ("grammar", &[]),
    ("runtime", &[]),
    ("compiler", &["fdcc-grammar", "fdcc-runtime"]),
    ("fdcc", &["fdcc-grammar", "fdcc-compiler", "fdcc-runtime"]),
    ("server", &["fdcc-grammar", "fdcc"]),
    ("cli", &["fdcc-grammar", "fdcc-runtime", "fdcc", "fdcc-server"]),
    ("c", &["fdcc"]),
    ("python", &["fdcc-grammar", "fdcc-runtime", "fdcc", "fdcc-cli"]),
    ("tests", &["fdcc-grammar", "fdcc-compiler", "fdcc-runtime", "fdcc"]),
];

#[test]
fn crates_depend_on_each_other_as_drawn() {
    let mut breaches = Vec::new();
    for (folder, allowed) in CRATES {
        let manifest = fs::read_to_string(repository().join(folder).join("Cargo.toml"))
            .expect("a crate has a manifest");
        let own = manifest
            .lines()
            .skip_while(|line| *line != "[dependencies]")
            .skip(1)
            .take_while(|line| !line.starts_with('['))
            .filter(|line| line.starts_with("fdcc"));
        for name in own.filter_map(|line| line.split(['.', ' ', '=']).next()) {
            if !allowed.contains(&name) {
                breaches.push(format!(
                    "{folder}/Cargo.toml: {folder} must not depend on {name}; see \"Dependency \
                     rules\""
                ));
            }
        }
    }
    all_well(breaches);
}

/// A file that is no module of the program of its folder is never built, and nobody says so.
#[test]
fn every_file_of_tests_is_run() {
    let mut breaches = Vec::new();
    for folder in ["tests/tests/", "cli/tests/"] {
        let main = fs::read_to_string(repository().join(folder).join("main.rs"));
        let main = main.expect("the program is there");
        for source in rust_sources() {
            let name = source.path.strip_prefix(folder).and_then(|it| it.strip_suffix(".rs"));
            let Some(name) = name.filter(|it| !it.contains('/') && *it != "main") else { continue };
            if !main.lines().any(|line| line == format!("mod {name};")) {
                breaches.push(format!("{folder}main.rs: `mod {name};` is missing"));
            }
        }
    }
    all_well(breaches);
}

/// Crates of others, and the only places that may name them: theirs is the code to change when they
/// change.
const FOREIGN: &[(&str, &[&str])] = &[
    ("pest", &["grammar/src/parse/"]),
    ("pest_derive", &["grammar/src/parse/"]),
    ("cranelift", &["compiler/src/generate/cranelift/"]),
    ("clarabel", &["runtime/src/nlp/convex/clarabel.rs"]),
    ("amd", &["runtime/src/linalg/sparse_ldl/tree.rs"]),
    ("miette", &["cli/src/drawing/render.rs"]),
    (
        "plotters",
        &[
            "cli/src/page/svg.rs",
            "cli/src/page/cells.rs",
            "cli/src/page/maps.rs",
            "cli/src/page/colours.rs",
        ],
    ),
    ("svg2pdf", &["cli/src/page/pdf.rs"]),
    ("dejavu", &["cli/src/page/pdf.rs"]),
    ("similar", &["cli/src/drawing/difference.rs"]),
    ("serde", &["cli/src/output/", "cli/src/page/", "server/src/dispatch.rs"]),
    ("serde_json", &["cli/src/output/", "cli/src/page/", "cli/tests/", "server/", "tests/"]),
    ("pyo3", &["python/src/"]),
    ("lsp_server", &["server/"]),
    ("lsp_types", &["server/"]),
];

/// `pest::x` and `use pest`, but not our own modules of the same name: `crate::clarabel`,
/// `super::cranelift`.
fn names_crate(line: &str, name: &str) -> bool {
    line.match_indices(&format!("{name}::")).any(|(at, _)| {
        let before = &line[..at];
        let is_path = before.ends_with("::") && !before.trim_end_matches("::").is_empty();
        let is_of_ours =
            is_path && before.trim_end_matches("::").ends_with(|c: char| c.is_alphanumeric());
        !is_of_ours && !before.ends_with(|c: char| c.is_alphanumeric() || c == '_')
    })
}

/// Where a module of ours hides the crate of the same name, only `::name` is the crate.
fn is_own_module(path: &str, name: &str) -> bool {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let is_beside = |file: String| repository().join(folder).join(file).exists();
    path.ends_with("/mod.rs")
        && (is_beside(format!("{name}.rs")) || is_beside(format!("{name}/mod.rs")))
}

#[test]
fn foreign_crates_are_named_in_one_place_each() {
    let mut breaches = Vec::new();
    for source in rust_sources() {
        for (name, places) in FOREIGN {
            if places.iter().any(|place| source.path.starts_with(place))
                || is_own_module(&source.path, name)
            {
                continue;
            }
            for (line, _) in code(&source.text).filter(|(_, line)| names_crate(line, name)) {
                breaches.push(format!(
                    "{}:{line}: `{name}` may be named only in {}",
                    source.path,
                    places.join(", ")
                ));
            }
        }
    }
    all_well(breaches);
}

/// Crates whose folders import each other in one direction only.
const WITHOUT_CIRCLES: &[&str] =
    &["grammar", "compiler", "runtime", "fdcc", "server", "cli", "c", "python"];

#[test]
fn folders_import_each_other_in_no_circle() {
    let sources = sources();
    let of = |folder: &&str| circles(&imports(&sources, &format!("{folder}/src/")));
    all_well(WITHOUT_CIRCLES.iter().flat_map(of).collect());
}

/// Folders whose tuned numbers stand in files called `tuning.rs`, with their sources.
const TUNED: &[&str] =
    &["runtime/src/nlp/", "runtime/src/solve/", "runtime/src/simulate/", "fdcc/src/"];

/// Files with other numbers, which are not tuned but follow from a method.
const NUMBERS_OF_METHODS: &[(&str, &str)] = &[
    ("runtime/src/simulate/steps/dormand_prince.rs", "a tableau"),
    ("runtime/src/simulate/steps/radau.rs", "a tableau"),
    ("runtime/src/simulate/steps/departure.rs", "nodes of collocation"),
    ("runtime/src/simulate/steps/mod.rs", "a polynomial of degree 4 in the Bernstein basis"),
    ("runtime/src/simulate/location/tube.rs", "the derivative of a polynomial of degree 4"),
    ("runtime/src/simulate/location/sliding.rs", "the derivatives of a parabola"),
    (
        "runtime/src/solve/refinement/error_estimate.rs",
        "weights of the classical Runge-Kutta scheme",
    ),
    ("fdcc/src/solve/controller.rs", "an example in a message"),
    ("runtime/src/nlp/convex/convexity.rs", "a bound of the rounding errors of a factorisation"),
];

/// The numbers with a point or an exponent in a line of code.
fn floats(line: &str) -> Vec<String> {
    let line = line.replace("e-", "e").replace("..", " ");
    let words = line.split(|c: char| !(c.is_alphanumeric() || c == '.' || c == '_'));
    let numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit())).map(|word| {
        let is_part = |c: &char| c.is_ascii_digit() || ['.', 'e', '_'].contains(c);
        let number: String = word.chars().take_while(is_part).collect();
        number.trim_end_matches(['.', '_']).to_owned()
    });
    numbers.filter(|number| number.contains(['.', 'e'])).collect()
}

#[test]
fn tuned_numbers_stand_in_their_files() {
    let is_plain = |number: &str| ["0.0", "1.0", "2.0", "0.5"].contains(&number);
    let mut breaches = Vec::new();
    for source in rust_sources() {
        let is_tuned = TUNED.iter().any(|folder| source.path.starts_with(folder));
        let is_other = NUMBERS_OF_METHODS.iter().any(|row| row.0 == source.path);
        let is_free = ["/tuning.rs", "/tests.rs"].iter().any(|it| source.path.ends_with(it));
        if !is_tuned || is_other || is_free {
            continue;
        }
        let own = source.text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        for (line, text) in code(own) {
            for number in floats(text).into_iter().filter(|number| !is_plain(number)) {
                breaches.push(format!(
                    "{}:{line}: give {number} a name in `tuning.rs`, with its source",
                    source.path
                ));
            }
        }
    }
    all_well(breaches);
}

/// Names that were given up for the field's own, which `docs/glossary.md` defines.
const FORMER_WORDS: &[(&str, &str)] = &[
    ("programme", "nonlinear program"),
    ("swift pace", "superlinear barrier update"),
    ("careful pace", "monotone barrier update"),
    ("second opinion", "solver fallback"),
    ("feasible first", "phase-I restart"),
    ("multipliers excuse", "scaling of the KKT error"),
    ("setting out", "departure of a vector switch"),
    ("rehearsal", "preflight"),
];

#[test]
fn former_words_do_not_come_back() {
    let mut breaches = Vec::new();
    for source in sources().iter().filter(|source| source.path != "tests/tests/tidy.rs") {
        let (path, text) = (source.path.replace(['-', '_'], " "), source.text.to_lowercase());
        for (word, instead) in FORMER_WORDS {
            if names(&path, word) {
                breaches.push(format!("{}: name it by \"{instead}\"", source.path));
            }
            let lines = text.lines().enumerate().filter(|(_, line)| names(line, word));
            breaches.extend(
                lines.map(|(at, _)| format!("{}:{}: say \"{instead}\"", source.path, at + 1)),
            );
        }
    }
    all_well(breaches);
}

/// What is absent where: folders, words, and why.
const ABSENT: &[(&[&str], &[&str], &str)] = &[
    (
        &["grammar/src/", "compiler/src/", "runtime/src/"],
        &[
            "std::fs",
            "std::io",
            "std::net",
            "std::process",
            "std::env",
            "std::thread",
            "std::time",
            "Instant::now",
            "SystemTime",
        ],
        "files, clocks, the environment and threads belong to cli and server",
    ),
    (
        &["fdcc/src/"],
        &["std::net", "std::process", "std::env", "std::time", "Instant::now", "SystemTime"],
        "clocks and the environment belong to cli and server",
    ),
    (
        &["fdcc/src/"],
        &["print!", "println!", "eprint!", "eprintln!", "Serialize", "Deserialize", "clap"],
        "a library does not print; formats and options belong to cli",
    ),
    (
        &[
            "fdcc/src/executor.rs",
            "fdcc/src/expectations/",
            "fdcc/src/gradient/",
            "fdcc/src/record.rs",
            "fdcc/src/replay/",
            "fdcc/src/solve/",
            "fdcc/src/verification/",
            "fdcc/src/warm_start/",
        ],
        &["std::fs", "std::io"],
        "the library reads files in `Model::from_file` alone",
    ),
    (
        &["grammar/src/", "compiler/src/", "runtime/src/"],
        &["print!", "println!", "eprint!", "eprintln!"],
        "only cli prints; hand the text or a `Progress` to the caller",
    ),
    (
        &["grammar/src/", "compiler/src/", "runtime/src/"],
        &["Serialize", "Deserialize"],
        "file formats belong to cli/src/output/",
    ),
    (
        &["server/src/"],
        &["Serialize", "Deserialize", "print!", "println!", "eprint!", "eprintln!"],
        "the types of the protocol are those of lsp_types, and its stream is nobody else's",
    ),
    (
        &["compiler/src/expressions/"],
        &["crate::model", "crate::resolve", "crate::lower"],
        "expressions know no models",
    ),
    (
        &["runtime/src/linalg/", "runtime/src/nlp/interior_point/"],
        &["crate::transcribe", "crate::solution", "crate::solve", "Problem"],
        "the solver has never heard of time: it sees an `Nlp`",
    ),
    (
        &["runtime/src/transcribe/"],
        &["Inertia", "interior_point"],
        "the transcription has never heard of inertia",
    ),
];

#[test]
fn what_must_be_absent_is_absent() {
    let mut breaches = Vec::new();
    for source in rust_sources() {
        for (folders, words, why) in ABSENT {
            if !folders.iter().any(|folder| source.path.starts_with(folder)) {
                continue;
            }
            for (line, text) in code(&source.text) {
                let found = words.iter().filter(|word| names(text, word));
                breaches
                    .extend(found.map(|word| format!("{}:{line}: `{word}`: {why}", source.path)));
            }
        }
    }
    all_well(breaches);
}

#[test]
fn the_compiler_sees_only_the_contract_of_the_runtime() {
    let mut breaches = Vec::new();
    for source in rust_sources().iter().filter(|source| source.path.starts_with("compiler/")) {
        for (line, text) in code(&source.text) {
            let is_contract = ["fdcc_runtime::problem", "fdcc_runtime::simulate"]
                .iter()
                .any(|it| text.contains(it));
            if text.contains("fdcc_runtime") && !is_contract {
                breaches.push(format!(
                    "{}:{line}: the compiler may use `fdcc_runtime::problem`, the types of \
                     `fdcc_runtime::simulate` and nothing else",
                    source.path
                ));
            }
        }
    }
    all_well(breaches);
}

#[test]
fn unsafe_code_is_in_its_places_and_says_why_it_is_sound() {
    let places = [
        "compiler/src/generate/",
        "runtime/src/linalg/riccati/chain.rs",
        "runtime/src/linalg/products/mod.rs",
        "runtime/src/nlp/convex/clarabel.rs",
        "editors/tree-sitter-fdc/bindings/",
        "python/src/column.rs",
        "c/src/lib.rs",
    ];
    let mut breaches = Vec::new();
    for source in rust_sources() {
        let lines: Vec<&str> = source.text.lines().collect();
        let is_unsafe = |text: &str| {
            ["{", "fn", "impl", "trait"].iter().any(|next| names(text, &format!("unsafe {next}")))
        };
        for (line, _) in code(&source.text).filter(|(_, text)| is_unsafe(text)) {
            if source.path == "tests/tests/tidy.rs" {
                continue;
            }
            if !places.iter().any(|place| source.path.starts_with(place)) {
                breaches.push(format!(
                    "{}:{line}: `unsafe` is for {} only",
                    source.path,
                    places.join(", ")
                ));
            }
            let above = &lines[line.saturating_sub(6)..line - 1];
            if !above.iter().any(|line| line.contains("SAFETY:")) {
                breaches.push(format!(
                    "{}:{line}: write `// SAFETY:` above, with the reason why this is sound",
                    source.path
                ));
            }
        }
    }
    all_well(breaches);
}

/// Most lines of a file of code; tests are free.
const MOST_LINES: usize = 400;

/// Files that are longer, with their limit and the reason why they are still one idea.
const LONGER: &[(&str, usize, &str)] =
    &[("compiler/src/expressions/graph/builtins.rs", 700, "a table: one row for each builtin")];

#[test]
fn files_are_short() {
    let mut breaches = Vec::new();
    for source in rust_sources().iter().filter(|source| !source.path.contains("tests/")) {
        let lines = source.text.lines().count();
        let exception = LONGER.iter().find(|row| row.0 == source.path);
        let most = exception.map_or(MOST_LINES, |row| row.1);
        if lines > most {
            breaches.push(format!(
                "{}: {lines} lines; split it at the seam between its ideas (at most {most})",
                source.path
            ));
        }
        if exception.is_some() && lines <= MOST_LINES {
            breaches.push(format!(
                "{}: {lines} lines; take it off the list of longer files",
                source.path
            ));
        }
    }
    all_well(breaches);
}

/// Most lines of a function; tests are free.
const MOST_LINES_OF_FUNCTION: usize = 60;

/// Functions that are longer, with their limit and the reason why they are still one idea.
const LONGER_FUNCTIONS: &[(&str, &str, usize, &str)] =
    &[("compiler/src/syntax/walk.rs", "expressions", 70, "a table: one arm for each kind of item")];

/// The functions of a formatted file: name, line, number of lines. A function ends at the first
/// closing brace below it that stands as far to the left as it does.
fn functions(text: &str) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let begins = lines.iter().enumerate().filter_map(|(at, line)| {
        let head = line.trim_start();
        let (before, name) = head.split_once("fn ")?;
        let words = ["pub", "pub(crate)", "pub(super)", "const", "unsafe", "extern", "\"C\""];
        let is_head = before.split_whitespace().all(|word| words.contains(&word));
        let name: String = name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        (is_head && !head.ends_with(['}', ';'])).then(|| (name, at, line.len() - head.len()))
    });
    let ends = begins.filter_map(|(name, at, indent)| {
        let last = format!("{}}}", " ".repeat(indent));
        let length = lines[at..].iter().position(|line| *line == last)?;
        Some((name, at + 1, length + 1))
    });
    ends.collect()
}

#[test]
fn functions_are_short() {
    let mut breaches = Vec::new();
    for source in rust_sources().iter().filter(|source| !source.path.contains("tests/")) {
        for (name, line, lines) in functions(&source.text) {
            let is_it = |row: &&(&str, &str, usize, &str)| row.0 == source.path && row.1 == name;
            let exception = LONGER_FUNCTIONS.iter().find(is_it);
            let most = exception.map_or(MOST_LINES_OF_FUNCTION, |row| row.2);
            if lines > most {
                breaches.push(format!(
                    "{}:{line}: `{name}` has {lines} lines; divide it (at most {most})",
                    source.path
                ));
            }
        }
    }
    all_well(breaches);
}

/// Most columns of a line; `rustfmt` leaves comments and strings as they are.
const MOST_COLUMNS: usize = 100;

#[test]
fn lines_are_short() {
    let mut breaches = Vec::new();
    for source in rust_sources() {
        for (at, line) in source.text.lines().enumerate() {
            let columns = line.chars().count();
            if columns > MOST_COLUMNS {
                let place = format!("{}:{}", source.path, at + 1);
                breaches.push(format!("{place}: {columns} columns; break it at {MOST_COLUMNS}"));
            }
        }
    }
    all_well(breaches);
}

#[test]
fn files_say_what_they_do() {
    let silent = |source: &&Source| !source.text.starts_with("//! ");
    let breach =
        |source: &Source| format!("{}: begin with `//!` and what the file does", source.path);
    all_well(rust_sources().iter().filter(silent).map(breach).collect());
}

#[test]
fn nothing_is_left_over() {
    // Written in two halves, so that this file is not found.
    let left_over = [
        ("todo", "!("),
        ("unimplemented", "!("),
        ("dbg", "!("),
        ("#[ign", "ore"),
        ("/wo", "rk/"),
        ("/ro", "ot/"),
        ("/tm", "p/"),
    ];
    let mut breaches = Vec::new();
    for source in sources() {
        for (at, line) in source.text.lines().enumerate() {
            for word in
                left_over.iter().map(|(a, b)| format!("{a}{b}")).filter(|word| line.contains(word))
            {
                breaches.push(format!(
                    "{}:{}: `{word}` must not stay: finish it, or make the path relative",
                    source.path,
                    at + 1
                ));
            }
        }
    }
    all_well(breaches);
}
