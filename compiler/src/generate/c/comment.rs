//! What a file says of itself.

use super::{Argument, Exported};

const MOST_COLUMNS: usize = 100;

/// Lines as one comment.
pub(super) fn block(lines: &str) -> String {
    let lines: String = lines.lines().map(line).collect();
    format!("/*{} */\n", lines.strip_prefix(" *").unwrap_or(&lines))
}

/// What must not end a comment, or begin another one, is written apart.
fn line(text: &str) -> String {
    let text = text.replace("*/", "* /").replace("/*", "/ *");
    format!("{}\n", format!(" * {text}").trim_end())
}

/// The inputs and outputs of a function, with the names of their entries.
pub(super) fn of(function: &Exported) -> String {
    let arguments: Vec<&str> = function.arguments.iter().map(|it| it.name.as_str()).collect();
    let results: Vec<&str> = function.results.iter().map(|it| it.name.as_str()).collect();
    let [arguments, results] = [arguments, results].map(|it| it.join(", "));
    let mut text = format!("{}: ({arguments}) -> ({results})\n", function.name);
    let inputs = function.arguments.iter().map(|it: &Argument| (&it.name, &it.labels));
    let outputs = function.results.iter().map(|it| (&it.name, &it.labels));
    for (name, labels) in inputs.chain(outputs) {
        text += &entries(name, labels);
    }
    block(&text)
}

/// `  x  pos.x, pos.y`, in lines that are short.
fn entries(name: &str, labels: &[String]) -> String {
    let indent = format!("  {:width$}  ", "", width = name.chars().count());
    let mut lines = vec![format!("  {name}  ")];
    for (at, label) in labels.iter().enumerate() {
        let entry = format!("{label}{}", if at + 1 < labels.len() { ", " } else { "" });
        let last = lines.last_mut().expect("there is a line");
        if last.chars().count() + entry.chars().count() > MOST_COLUMNS && *last != indent {
            lines.push(indent.clone());
        }
        *lines.last_mut().expect("there is a line") += &entry;
    }
    lines.join("\n") + "\n"
}
