//! The command line as it was given, for who runs it again. It is in the documents of runs, so it
//! is without what does not change them: where they are written, how much is told meanwhile, how
//! many solves run at a time, in which of several processes.

use std::sync::OnceLock;

static GIVEN: OnceLock<Vec<String>> = OnceLock::new();

/// Options with a value that change no result.
const WITH_VALUE: [&str; 4] = ["--out", "--log", "--jobs", "--part"];

/// Remembers the arguments behind the name of the program.
pub fn remember(arguments: impl Iterator<Item = String>) {
    let _ = GIVEN.set(kept(arguments));
}

/// The arguments that change the result; none where there is no command line, as in Python.
pub fn given() -> Vec<String> {
    GIVEN.get().cloned().unwrap_or_default()
}

fn kept(mut arguments: impl Iterator<Item = String>) -> Vec<String> {
    let mut kept = Vec::new();
    while let Some(argument) = arguments.next() {
        let name = argument.split('=').next().unwrap_or_default();
        match name {
            "--json" => {}
            name if WITH_VALUE.contains(&name) => {
                if name == argument {
                    arguments.next();
                }
            }
            _ => kept.push(argument),
        }
    }
    kept
}

/// A line for a shell: `fdcc solve a.fdc --set 'm=200[g]'`.
pub fn line<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    let words = words.into_iter().map(quoted);
    ["fdcc".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> String {
    let is_plain = |it: char| it.is_alphanumeric() || "-_=./,:+@%".contains(it);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changes_no_result_is_left_out() {
        let given =
            "solve a.fdc --set m=2 --out r --json --log=none --warm b.sol.json --jobs 2 --part 1/2";
        let kept = kept(given.split(' ').map(str::to_owned));
        assert_eq!(kept, ["solve", "a.fdc", "--set", "m=2", "--warm", "b.sol.json"]);
    }

    #[test]
    fn a_shell_reads_the_same_words() {
        let line = line(["solve", "my model.fdc", "--set", "m=200[g]", "it's"]);
        assert_eq!(line, r"fdcc solve 'my model.fdc' --set 'm=200[g]' 'it'\''s'");
    }
}
