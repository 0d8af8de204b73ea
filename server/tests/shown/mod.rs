//! Answers as a person would note them down: lines and columns from 1, one line for each thing.

use serde_json::Value;

/// An answer to a request of that name.
pub fn shown(tag: &str, result: &Value, text: &str) -> String {
    if result.is_null() {
        return "nothing\n".into();
    }
    let lines: Vec<String> = match tag.split(' ').next().unwrap_or(tag) {
        "diagnostics" => each(&result["items"], diagnostic),
        "definition" | "references" => each(result, |it| located(&it["range"], text)),
        "highlights" => each(result, |it| {
            format!(
                "{} {}",
                located(&it["range"], text),
                if it["kind"] == 3 { "written" } else { "read" }
            )
        }),
        "prepare" => vec![located(&result["range"], text)],
        "rename" => edits(&result["changes"]["file:///model.fdc"]),
        "symbols" => outline(result, 0),
        "folding" => each(result, |it| {
            let kind = it["kind"].as_str().map_or(String::new(), |kind| format!(" {kind}"));
            format!("{}-{}{kind}", number(&it["startLine"]) + 1, number(&it["endLine"]) + 1)
        }),
        "selection" => chain(&result[0], text),
        "tokens" | "tokens-of-range" => tokens(result, text),
        "format" | "format-range" | "format-typed" => return applied(result, text),
        "actions" => each(result, |it| {
            let preferred = if it["isPreferred"] == true { ", preferred" } else { "" };
            let changes = edits(&it["edit"]["changes"]["file:///model.fdc"]).join("; ");
            format!("{} ({}{preferred}): {changes}", string(&it["title"]), string(&it["kind"]))
        }),
        "hover" => string(&result["contents"]["value"])
            .replace("```", "~~~")
            .lines()
            .map(str::to_owned)
            .collect(),
        "completion" => each(&result["items"], |it| {
            let detail =
                it["detail"].as_str().map_or(String::new(), |detail| format!(": {detail}"));
            format!("{}{detail}", string(&it["label"]))
        }),
        "signature" => {
            let signature = &result["signatures"][0];
            let active =
                &signature["parameters"][number(&result["activeParameter"]) as usize]["label"];
            vec![
                format!("{} at {active}", string(&signature["label"])),
                string(&signature["documentation"]["value"]).replace("```", "~~~"),
            ]
        }
        "hints" => {
            each(result, |it| format!("{} {}", place(&it["position"]), string(&it["label"])))
        }
        "lens" => each(result, |it| {
            format!(
                "{} {} ({})",
                located(&it["range"], text),
                string(&it["command"]["title"]),
                string(&it["command"]["command"])
            )
        }),
        other => panic!("no way to show `{other}`"),
    };
    lines.iter().map(|line| format!("{line}\n")).collect()
}

fn each(list: &Value, show: impl Fn(&Value) -> String) -> Vec<String> {
    match list {
        Value::Array(all) => all.iter().map(show).collect(),
        single => vec![show(single)],
    }
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or(0)
}

fn string(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn place(position: &Value) -> String {
    format!("{}:{}", number(&position["line"]) + 1, number(&position["character"]) + 1)
}

/// The byte of a place in UTF-16.
pub fn offset(position: &Value, text: &str) -> usize {
    let line = number(&position["line"]) as usize;
    let Some(content) = text.split('\n').nth(line) else { return text.len() };
    let start = content.as_ptr() as usize - text.as_ptr() as usize;
    let mut column = 0;
    for (at, character) in content.char_indices() {
        if column >= number(&position["character"]) as usize {
            return start + at;
        }
        column += character.len_utf16();
    }
    start + content.len()
}

fn slice<'t>(range: &Value, text: &'t str) -> &'t str {
    &text[offset(&range["start"], text)..offset(&range["end"], text)]
}

/// `3:7 slip`
fn located(range: &Value, text: &str) -> String {
    format!("{} {}", place(&range["start"]), slice(range, text))
}

fn diagnostic(it: &Value) -> String {
    let range = &it["range"];
    let tags = if it["tags"] == serde_json::json!([1]) { " (unnecessary)" } else { "" };
    let message = string(&it["message"]).replace('\n', " / ");
    let related = each(&it["relatedInformation"], |other| match other.is_null() {
        true => String::new(),
        false => format!(
            "; {} {}",
            place(&other["location"]["range"]["start"]),
            string(&other["message"])
        ),
    });
    format!(
        "{}-{} {} {}{tags}: {message}{}",
        place(&range["start"]),
        place(&range["end"]),
        ["", "error", "warning", "information"][number(&it["severity"]) as usize],
        string(&it["code"]),
        related.concat()
    )
}

/// `3:7-3:11 "slip" -> "stick"` without the old text, which the place tells.
fn edits(list: &Value) -> Vec<String> {
    let edit = |it: &Value| {
        format!("{}-{} {}", place(&it["range"]["start"]), place(&it["range"]["end"]), it["newText"])
    };
    each(list, edit)
}

/// The text with edits done, which must not touch each other.
fn applied(list: &Value, text: &str) -> String {
    let all = list.as_array().expect("a list of edits");
    let mut edits: Vec<(usize, usize, String)> = all
        .iter()
        .map(|it| {
            (
                offset(&it["range"]["start"], text),
                offset(&it["range"]["end"], text),
                string(&it["newText"]),
            )
        })
        .collect();
    edits.sort();
    assert!(edits.windows(2).all(|pair| pair[0].1 <= pair[1].0), "edits overlap: {edits:?}");
    let mut text = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        text.replace_range(start..end, &new);
    }
    text
}

fn outline(list: &Value, depth: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for it in list.as_array().into_iter().flatten() {
        let detail = it["detail"].as_str().map_or(String::new(), |detail| format!(" ({detail})"));
        lines.push(format!(
            "{}{} {}{detail}",
            "  ".repeat(depth),
            place(&it["selectionRange"]["start"]),
            string(&it["name"])
        ));
        lines.extend(outline(&it["children"], depth + 1));
    }
    lines
}

/// From the innermost to the outermost, each on one line.
fn chain(range: &Value, text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut next = range;
    while !next.is_null() {
        lines.push(slice(&next["range"], text).split_whitespace().collect::<Vec<_>>().join(" "));
        next = &next["parent"];
    }
    lines
}

fn tokens(result: &Value, text: &str) -> Vec<String> {
    const TYPES: &[&str] = &[
        "state",
        "control",
        "param",
        "free",
        "surface",
        "unit",
        "time",
        "constant",
        "variable",
        "function",
        "parameter",
        "property",
        "data",
        "phase",
        "jump",
        "constraint",
        "setting",
        "value",
        "model",
    ];
    let data: Vec<u64> = result["data"].as_array().expect("numbers").iter().map(number).collect();
    let (mut line, mut column) = (0, 0);
    let mut lines = Vec::new();
    for token in data.chunks(5) {
        column = if token[0] == 0 { column + token[1] } else { token[1] };
        line += token[0];
        let start = serde_json::json!({ "line": line, "character": column });
        let end = serde_json::json!({ "line": line, "character": column + token[2] });
        let word = &text[offset(&start, text)..offset(&end, text)];
        let modifier = ["", " declared", " written", "", " built in"][token[4] as usize];
        lines.push(format!("{} {word} {}{modifier}", place(&start), TYPES[token[3] as usize]));
    }
    lines
}
