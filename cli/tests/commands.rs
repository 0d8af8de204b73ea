//! The command from outside: what it prints, and how it ends.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A folder with the models that the cases are about.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("the folder for tests can be made");
    let write = |file: &str, text: &[u8]| fs::write(folder.join(file), text).expect("a file can be written");
    write("block.fdc", b"dynamics {\n  x' = v\n  v' = F m\n}\n");
    write("end.fdc", b"param end = 4 [s]\ntime t in [0, end]\n");
    write("clean.fdc", b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n");
    write("empty.fdc", b"# nothing\n");
    write("unused.fdc", b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\nparam p = 1\n");
    write(
        "allowed.fdc",
        b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n# fdc: allow FDC0404\nparam p = 1\n",
    );
    write("latin.fdc", b"# caf\xe9\n");
    folder
}

fn fdcc(name: &str, arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fdcc"));
    command.args(arguments).current_dir(folder(name));
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("fdcc starts");
    // A command that does not read its input may be gone already.
    let _ = child.stdin.take().expect("the input is piped").write_all(input.as_bytes());
    child.wait_with_output().expect("fdcc ends")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("fdcc prints text")
}

#[test]
fn exit_codes_are_those_of_the_contract() {
    let cases: &[(&[&str], i32)] = &[
        (&["check", "clean.fdc"], 0),
        (&["check", "block.fdc"], 1),
        (&["check", "clean.fdc", "block.fdc"], 1),
        (&["check", "empty.fdc"], 0),
        (&["check", "empty.fdc", "--deny", "warnings"], 1),
        (&["check", "unused.fdc"], 0),
        (&["check", "unused.fdc", "--deny", "warnings"], 1),
        (&["check", "allowed.fdc", "--deny", "warnings"], 0),
        (&["check", "latin.fdc"], 1),
        (&["check", "missing.fdc"], 4),
        (&["check", "block.fdc", "missing.fdc", "clean.fdc"], 4),
        (&["check"], 3),
        (&["check", "clean.fdc", "--format", "xml"], 3),
        (&["juggle"], 3),
        (&[], 3),
        (&["--help"], 0),
        (&["--version"], 0),
        (&["explain", "FDC0001"], 0),
        (&["explain", "1"], 0),
        (&["explain", "fdc0001"], 0),
        (&["explain", "FDC9999"], 3),
    ];
    for (arguments, code) in cases {
        let output = fdcc("exit_codes", arguments, "");
        assert_eq!(
            output.status.code(),
            Some(*code),
            "{arguments:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

/// The drawings are those of the language's design.
#[test]
fn diagnostics_are_drawn_over_the_lines_they_are_about() {
    let block = "\
FDC0001

  × missing operator between `F` and `m`
   ╭─[block.fdc:3:8]
 2 │   x' = v
 3 │   v' = F m
   ·        ─┬─
   ·         ╰── two values side by side
 4 │ }
   ╰────
  help: write `F * m` or `F / m`; fdc has no implicit multiplication

";
    let end = "\
FDC0003

  × `end` is a reserved word and cannot name a parameter
   ╭─[end.fdc:1:7]
 1 │ param end = 4 [s]
   ·       ─┬─
   ·        ╰── reserved: it introduces a condition at the final time
 2 │ time t in [0, end]
   ╰────
  help: rename it, for example `t_end`
        `fdcc fix` renames all 2 uses

";
    let output = fdcc("drawings", &["check", "block.fdc", "end.fdc"], "");
    let printed = stdout(&output);
    assert!(printed.contains(block) && printed.contains(end), "{printed}");
    assert!(!printed.contains('\u{1b}'), "no colour where there is no terminal");
}

#[test]
fn json_counts_lines_and_columns_in_characters_from_one() {
    let output = fdcc("json", &["check", "-", "--format", "json"], "# é\nlet é = 2 µ\n");
    let entries: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the output is JSON");
    let entry = entries.as_array().and_then(|entries| entries.first()).expect("an array of one entry");
    assert_eq!(entry["code"], "FDC0001");
    assert_eq!(entry["severity"], "error");
    assert_eq!(entry["file"], "<stdin>");
    let place = |value: &serde_json::Value| {
        ["line", "column", "end_line", "end_column"].map(|key| value[key].as_u64().expect("a number"))
    };
    assert_eq!(place(entry), [2, 9, 2, 12]);
    assert_eq!(place(&entry["labels"][0]["span"]), [2, 9, 2, 12]);
    assert_eq!(entry["labels"][0]["text"], "two values side by side");
    assert!(entry["message"].is_string() && entry["help"].is_string() && entry["fixes"].is_array());
}

#[test]
fn a_clean_file_is_an_empty_array() {
    assert_eq!(stdout(&fdcc("clean", &["check", "clean.fdc", "--format", "json"], "")), "[]\n");
}

#[test]
fn short_is_one_line_for_each() {
    let printed = stdout(&fdcc("short", &["check", "end.fdc", "--format", "short"], ""));
    let line = "end.fdc:1:7: error[FDC0003]: `end` is a reserved word and cannot name a parameter\n";
    assert_eq!(printed, line);
}

#[test]
fn sarif_names_rule_file_and_region() {
    let output = fdcc("sarif", &["check", "end.fdc", "--format", "sarif"], "");
    let log: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the output is JSON");
    let result = &log["runs"][0]["results"][0];
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!(log["version"], "2.1.0");
    assert_eq!(result["ruleId"], "FDC0003");
    assert_eq!(place["artifactLocation"]["uri"], "end.fdc");
    assert_eq!((&place["region"]["startLine"], &place["region"]["startColumn"]), (&1.into(), &7.into()));
}

#[test]
fn unknown_codes_are_answered_with_their_group() {
    let output = fdcc("explain", &["explain", "FDC0199"], "");
    let complaint = String::from_utf8(output.stderr).expect("fdcc prints text");
    assert!(complaint.contains("FDC0101") && !complaint.contains("FDC0001"), "{complaint}");
}
