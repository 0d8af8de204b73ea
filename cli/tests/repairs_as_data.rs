//! Repairs in `check --format json` and `sarif`: whoever applies them by their places gets what
//! `fdcc fix` writes.

use crate::common::*;
use serde_json::Value;
use std::fs;

/// A certain and a likely repair, behind letters of more than one byte.
const WRONG: &str = "\
# Größe und Maß
param μ = 0.3
time t in [0, 2]
state v start 1
control kraft in [-1, 1]
surface glatt = v
dynamics { v' = kraft - μ*Sgn(glatt)  # früh
}
end v == 0
minimize integral(krafft^2)
";

/// An edit: line and column of its start and of its end, and the new text.
type Edit = ([usize; 4], String);

fn numbers(place: &Value, keys: [&str; 4]) -> [usize; 4] {
    keys.map(|key| place[key].as_u64().expect("a place has numbers") as usize)
}

fn text(value: &Value) -> String {
    value.as_str().expect("a replacement is text").to_owned()
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("a list")
}

/// Byte of a line and column, both from 1, columns in characters.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
    start + text[start..].chars().take(column - 1).map(char::len_utf8).sum::<usize>()
}

fn applied(text: &str, mut edits: Vec<Edit>) -> String {
    let mut text = text.to_owned();
    edits.sort();
    for ([line, column, end_line, end_column], replacement) in edits.into_iter().rev() {
        let range = offset(&text, line, column)..offset(&text, end_line, end_column);
        text.replace_range(range, &replacement);
    }
    text
}

/// The first repair of each finding.
fn in_json(entries: &Value, with_likely: bool) -> Vec<Edit> {
    let first = list(entries).iter().filter_map(|entry| list(&entry["fixes"]).first());
    let wanted =
        first.filter(|fix| fix["title"].is_string() && (with_likely || fix["certain"] == true));
    let edits = wanted.flat_map(|fix| list(&fix["edits"]));
    let keys = ["line", "column", "end_line", "end_column"];
    edits.map(|edit| (numbers(&edit["span"], keys), text(&edit["replacement"]))).collect()
}

fn in_sarif(log: &Value) -> Vec<Edit> {
    let results = list(&log["runs"][0]["results"]).iter();
    let first = results.filter_map(|result| result["fixes"].as_array()?.first());
    let changes = first.flat_map(|fix| {
        assert!(fix["description"]["text"].is_string());
        list(&fix["artifactChanges"])
    });
    let keys = ["startLine", "startColumn", "endLine", "endColumn"];
    let replacements = changes.flat_map(|change| {
        assert_eq!(change["artifactLocation"]["uri"], "wrong.fdc");
        list(&change["replacements"])
    });
    replacements
        .map(|it| (numbers(&it["deletedRegion"], keys), text(&it["insertedContent"]["text"])))
        .collect()
}

#[test]
fn repairs_applied_from_data_are_those_of_fix() {
    let place = folder("repairs_as_data", &[("wrong.fdc", WRONG.as_bytes())]);
    let found = |format: &str| json(&fdcc(&place, &["check", "wrong.fdc", "--format", format], ""));
    let (entries, log) = (found("json"), found("sarif"));
    let certain = applied(WRONG, in_json(&entries, false));
    let likely = applied(WRONG, in_json(&entries, true));
    assert_eq!(likely, applied(WRONG, in_sarif(&log)), "both formats say the same");
    for (arguments, expected) in
        [(&["fix", "wrong.fdc"][..], &certain), (&["fix", "--unsafe", "wrong.fdc"], &likely)]
    {
        fs::write(place.join("wrong.fdc"), WRONG).expect("the model can be written");
        fdcc(&place, arguments, "");
        let repaired = fs::read_to_string(place.join("wrong.fdc")).expect("it is there");
        assert_eq!(repaired, *expected, "{arguments:?}");
    }
    assert!(
        certain.contains("v' in kraft - μ*Sgn(glatt)  # früh") && certain.contains("krafft"),
        "{certain}"
    );
    assert!(likely.contains("minimize integral(kraft^2)"), "{likely}");
}
