//! The command from outside: what it prints, and how it ends.

use crate::common::{self, stdout};
use std::process::Output;

const MODELS: &[(&str, &[u8])] = &[
    ("block.fdc", b"dynamics {\n  x' = v\n  v' = F m\n}\n"),
    ("end.fdc", b"param end = 4 [s]\ntime t in [0, end]\n"),
    ("clean.fdc", b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n"),
    ("empty.fdc", b"# nothing\n"),
    ("unused.fdc", b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\nparam p = 1\n"),
    (
        "allowed.fdc",
        b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n# fdc: allow FDC0404\nparam p = \
          1\n",
    ),
    ("latin.fdc", b"# caf\xe9\n"),
];

fn fdcc(name: &str, arguments: &[&str], input: &str) -> Output {
    common::fdcc(&common::folder(name, MODELS), arguments, input)
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
        common::expect_exit(&output, *code, &format!("{arguments:?}"));
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
    let entries: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("the output is JSON");
    let entry =
        entries.as_array().and_then(|entries| entries.first()).expect("an array of one entry");
    assert_eq!(entry["code"], "FDC0001");
    assert_eq!(entry["severity"], "error");
    assert_eq!(entry["file"], "<stdin>");
    let place = |value: &serde_json::Value| {
        ["line", "column", "end_line", "end_column"]
            .map(|key| value[key].as_u64().expect("a number"))
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
    let line =
        "end.fdc:1:7: error[FDC0003]: `end` is a reserved word and cannot name a parameter\n";
    assert_eq!(printed, line);
}

#[test]
fn sarif_names_rule_file_and_region() {
    let output = fdcc("sarif", &["check", "end.fdc", "--format", "sarif"], "");
    let log: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("the output is JSON");
    let result = &log["runs"][0]["results"][0];
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!(log["version"], "2.1.0");
    assert_eq!(result["ruleId"], "FDC0003");
    assert_eq!(place["artifactLocation"]["uri"], "end.fdc");
    assert_eq!(
        (&place["region"]["startLine"], &place["region"]["startColumn"]),
        (&1.into(), &7.into())
    );
}

#[test]
fn unknown_codes_are_answered_with_their_group() {
    let output = fdcc("explain", &["explain", "FDC0199"], "");
    let complaint = common::stderr(&output);
    assert!(complaint.contains("FDC0101") && !complaint.contains("FDC0001"), "{complaint}");
}

#[test]
fn every_code_has_a_page_with_a_wrong_and_a_right_model() {
    for code in fdcc_grammar::Code::ALL {
        let page = stdout(&fdcc("pages", &["explain", code.as_str()], ""));
        let heading = format!("# {code}: {}", code.title());
        assert!(page.starts_with(&heading), "{page}");
        assert!(page.contains("## Wrong") && page.contains("## Right"), "{page}");
    }
}

#[test]
fn a_misspelt_command_is_recognised() {
    let output = fdcc("misspelt", &["sovle"], "");
    common::expect_exit(&output, 3, "sovle");
    assert!(common::stderr(&output).contains("'solve'"));
}

#[test]
fn help_explains_every_option_in_one_line() {
    for command in ["check", "solve", "sweep", "test", "show", "explain"] {
        let help = stdout(&fdcc("help", &[command, "--help"], ""));
        let mut lines = help.lines().map(str::trim);
        while let Some(line) = lines.next() {
            let is_alone = line.starts_with("--") && !line.contains("  ");
            assert!(
                !is_alone || lines.next().is_some_and(|text| !text.is_empty()),
                "{command}: {line}"
            );
        }
    }
}

/// As in `fdcc solve ... 2>&1 | head -1`.
#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = common::start(
        &common::folder("closed", &[]),
        &["solve", &common::model("turbo"), "--log", "full"],
    );
    drop((child.stdout.take(), child.stderr.take()));
    let status = child.wait().expect("fdcc ends");
    assert_eq!(status.code(), Some(0));
}
