//! Commands: a process of its own with progress, which can be called off. `fdcc` is a script here.

#![cfg(unix)]

mod client;

use client::{Client, URI};
use lsp_server::{ErrorCode, Message, RequestId};
use serde_json::{Value, json};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const MODEL: &str = "model fall\ntime t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n";

/// A program that solves at once, and simulates for an hour.
const PROGRAM: &str = "#!/bin/sh
lines=$(wc -l)
case $1 in
  solve) echo ' iter  objective' >&2; echo '    0  1.0' >&2; echo; echo \"solved $lines lines, \
  $2\"; exit 0 ;;
  simulate) echo ' t = 0' >&2; exec sleep 3600 ;;
esac
";

fn program(name: &str) -> PathBuf {
    program_of(name, PROGRAM)
}

fn program_of(name: &str, text: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("fdcc-{name}-{}", std::process::id()));
    fs::write(&path, text).expect("a script can be written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("it can be run");
    path
}

fn started(program: &std::path::Path) -> Client {
    let mut client = Client::connect_with(&program.display().to_string());
    let capabilities = json!({ "window": { "workDoneProgress": true } });
    client.result("initialize", json!({ "capabilities": capabilities }));
    client.open(URI, MODEL);
    client
}

fn command(name: &str) -> Value {
    json!({ "command": name, "arguments": [URI] })
}

/// The progress that was heard so far, as its kinds and messages.
fn progress(client: &Client) -> Vec<String> {
    let values = client.heard.iter().filter_map(|it| match it {
        Message::Notification(it) if it.method == "$/progress" => Some(&it.params["value"]),
        _ => None,
    });
    let text = |it: &Value| it.as_str().unwrap_or_default().to_owned();
    values
        .map(|it| format!("{} {}{}", text(&it["kind"]), text(&it["title"]), text(&it["message"])))
        .collect()
}

#[test]
fn a_command_tells_how_it_goes_and_what_came_out() {
    let program = program("solve");
    let mut client = started(&program);
    let result = client.result("workspace/executeCommand", command("fdcc.solve"));
    assert_eq!(result["exitCode"], 0);
    assert_eq!(result["output"], "\nsolved 4 lines, -\n");
    assert_eq!(
        progress(&client),
        ["begin Solve fall", "report iter  objective", "report 0  1.0", "end done"]
    );
    let shown = client.heard.iter().find_map(|it| match it {
        Message::Notification(it) if it.method == "window/showMessage" => {
            Some(it.params["message"].clone())
        }
        _ => None,
    });
    assert_eq!(shown, Some(json!("solved 4 lines, -")));
    assert!(client.end());
    fs::remove_file(program).expect("the script is there");
}

/// A program that solves a block, as `fdcc` prints it.
const SOLVES: &str = "#!/bin/sh
cat >/dev/null
echo ' done  local optimum of the true system, 2 switches located'
echo '       objective 65.9568257 N^2 s'
echo ' slip  held 0-1.568, above 1.568-2.996, held 2.996-4 s'
";

const BLOCK: &str = "model block\ntime t in [0, 4]\nstate v start 0\ncontrol F in [-9, 9]\n\
    surface slip = v\ndynamics { v' in F - Sgn(slip) }\nminimize integral(F^2)\n";

#[test]
fn what_a_solve_said_stands_in_its_text_and_in_no_other() {
    let program = program_of("results", SOLVES);
    let mut client = Client::connect_with(&program.display().to_string());
    let capabilities = json!({ "workspace": { "inlayHint": { "refreshSupport": true } } });
    client.result("initialize", json!({ "capabilities": capabilities }));
    client.open(URI, BLOCK);
    let range = json!({ "start": { "line": 0, "character": 0 },
        "end": { "line": 9, "character": 0 } });
    let about = json!({ "textDocument": { "uri": URI }, "range": range });
    let hints =
        |client: &mut Client| client.result("textDocument/inlayHint", about.clone()).to_string();
    let hover = |client: &mut Client| {
        client.result("textDocument/hover", client::at(URI, 4, 9)).to_string()
    };
    assert!(!hints(&mut client).contains("65.95") && !hover(&mut client).contains("last solve"));
    client.result("workspace/executeCommand", command("fdcc.solve"));
    let shown = hints(&mut client);
    assert!(shown.contains("done: local optimum of the true system, 65.9568257 N^2 s"), "{shown}");
    assert!(shown.contains("held 0-1.568, above 1.568-2.996, held 2.996-4 s"), "{shown}");
    assert!(hover(&mut client).contains("the last solve: held 0-1.568"));
    let refresh = "workspace/inlayHint/refresh";
    let is_refresh = |it: &Message| matches!(it, Message::Request(it) if it.method == refresh);
    assert!(client.heard.iter().any(is_refresh));
    client.change(URI, 2, json!([{ "text": BLOCK.replace("[-9, 9]", "[-8, 8]") }]));
    assert!(!hints(&mut client).contains("65.95") && !hover(&mut client).contains("last solve"));
    assert!(client.end());
    fs::remove_file(program).expect("the script is there");
}

/// Waits until a command runs.
fn begun(client: &mut Client) -> (RequestId, Value) {
    let id = client.ask("workspace/executeCommand", command("fdcc.simulate"));
    loop {
        let message = client.next();
        if let Message::Notification(it) = &message
            && it.params["value"]["kind"] == "report"
        {
            return (id, it.params["token"].clone());
        }
        client.heard.push(message);
    }
}

#[test]
fn a_command_can_be_called_off_by_its_request_and_by_its_progress() {
    let program = program("simulate");
    let mut client = started(&program);
    let cancelled = ErrorCode::RequestCanceled as i32;
    let (id, _) = begun(&mut client);
    // Meanwhile the server answers other things, but does not compute one model twice.
    let twice = client.answer("workspace/executeCommand", command("fdcc.solve"));
    assert_eq!(twice.response_result.expect_err("busy").code, ErrorCode::RequestFailed as i32);
    client.notify("$/cancelRequest", json!({ "id": id }));
    assert_eq!(client.answer_to(&id).response_result.expect_err("cancelled").code, cancelled);
    let (id, token) = begun(&mut client);
    client.notify("window/workDoneProgress/cancel", json!({ "token": token }));
    assert_eq!(client.answer_to(&id).response_result.expect_err("cancelled").code, cancelled);
    assert_eq!(progress(&client).last().map(String::as_str), Some("end cancelled"));
    // One that still runs ends with the session.
    begun(&mut client);
    let before = Instant::now();
    assert!(client.end());
    assert!(before.elapsed() < Duration::from_secs(30));
    fs::remove_file(program).expect("the script is there");
}

#[test]
fn a_command_that_cannot_begin_says_why() {
    let mut client = started(&PathBuf::from("/nowhere/fdcc"));
    let mut refused = |command: Value| {
        let error = client
            .answer("workspace/executeCommand", command)
            .response_result
            .expect_err("refused");
        error.message
    };
    assert!(refused(command("fdcc.solve")).starts_with("fdcc cannot be started"));
    assert_eq!(refused(command("fdcc.nothing")), "there is no command `fdcc.nothing`");
    assert_eq!(
        refused(json!({ "command": "fdcc.solve" })),
        "`fdcc.solve` takes the address of a text"
    );
    let other = json!({ "command": "fdcc.solve", "arguments": ["file:///other.fdc"] });
    assert_eq!(refused(other), "`file:///other.fdc` is not open");
    client.change(URI, 2, json!([{ "text": "state" }]));
    let error = client.answer("workspace/executeCommand", command("fdcc.solve")).response_result;
    assert_eq!(error.expect_err("refused").message, "this model has mistakes; mend them first");
}
