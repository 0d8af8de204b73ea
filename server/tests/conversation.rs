//! The course of a conversation: beginning, end, texts that come, change and go, and messages that
//! make no sense.

mod client;

use client::{Client, URI, at};
use lsp_server::{ErrorCode, Message};
use serde_json::{Value, json};

const GOOD: &str = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ndynamics { x' = u \
                    }\nminimize x(end)\n";

fn codes(published: &Value) -> Vec<String> {
    let all = published["diagnostics"].as_array().expect("a list");
    all.iter().map(|it| it["code"].as_str().expect("a code").to_owned()).collect()
}

#[test]
fn a_conversation_begins_with_initialize_and_ends_with_shutdown_and_exit() {
    let mut client = Client::connect();
    let early =
        client.answer("textDocument/hover", at(URI, 0, 0)).response_result.expect_err("too early");
    assert_eq!(early.code, ErrorCode::ServerNotInitialized as i32);
    let result = client.result("initialize", json!({ "capabilities": {} }));
    assert_eq!(result["capabilities"]["positionEncoding"], "utf-16");
    let twice = client
        .answer("initialize", json!({ "capabilities": {} }))
        .response_result
        .expect_err("once");
    assert_eq!(twice.code, ErrorCode::InvalidRequest as i32);
    assert!(client.end());
}

#[test]
fn after_shutdown_nothing_is_answered_any_more() {
    let mut client = Client::start(json!({}));
    client.result("shutdown", Value::Null);
    let late =
        client.answer("textDocument/hover", at(URI, 0, 0)).response_result.expect_err("too late");
    assert_eq!(late.code, ErrorCode::InvalidRequest as i32);
}

#[test]
fn a_client_that_goes_away_leaves_no_server_behind() {
    assert!(!Client::start(json!({})).leave());
    let mut client = Client::start(json!({}));
    client.notify("exit", Value::Null);
    assert!(!client.leave());
}

#[test]
fn names_are_found_in_all_open_texts() {
    let mut client = Client::start(json!({}));
    client.open(URI, GOOD);
    client.diagnostics();
    client.open(
        "file:///other.fdc",
        "param Mass = 2\nfn f(mass) = mass\nphase up { state amass(x, y) }\n",
    );
    client.diagnostics();
    let found = client.result("workspace/symbol", json!({ "query": "mass" }));
    let told = |it: &Value| {
        let line = &it["location"]["range"]["start"]["line"];
        format!("{} {} {} {}", it["name"], it["containerName"], line, it["location"]["uri"])
    };
    let told: Vec<String> = found.as_array().expect("a list").iter().map(told).collect();
    assert_eq!(
        told,
        [r#""Mass" null 0 "file:///other.fdc""#, r#""amass" "up" 2 "file:///other.fdc""#,]
    );
    let all = client.result("workspace/symbol", json!({ "query": "" }));
    assert!(all.as_array().expect("a list").iter().any(|it| it["location"]["uri"] == URI));
    assert!(client.end());
}

#[test]
fn a_text_is_followed_from_opening_to_closing() {
    let mut client = Client::start(json!({}));
    client.open(URI, GOOD);
    let first = client.diagnostics();
    assert_eq!((codes(&first), &first["version"]), (vec![], &json!(1)));
    let range =
        json!({ "start": { "line": 3, "character": 16 }, "end": { "line": 3, "character": 17 } });
    client.change(URI, 2, json!([{ "range": range, "text": "w" }]));
    let second = client.diagnostics();
    assert_eq!(codes(&second), ["FDC0404", "FDC0101"]);
    assert_eq!(second["diagnostics"][1]["range"], range);
    client.change(URI, 3, json!([{ "text": GOOD }]));
    assert_eq!(codes(&client.diagnostics()), [""; 0]);
    client.notify("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    assert_eq!(client.diagnostics()["diagnostics"], json!([]));
    assert!(client.end());
}

#[test]
fn several_texts_are_kept_apart_and_a_renamed_one_is_a_new_one() {
    let mut client = Client::start(json!({}));
    let other = "file:///other.fdc";
    client.open(URI, "state x");
    client.open(other, GOOD);
    let found = [client.diagnostics(), client.diagnostics()];
    let of =
        |uri: &str| found.iter().find(|it| it["uri"] == uri).map(codes).expect("something is said");
    assert!(of(URI).contains(&"FDC0407".to_owned()) && of(other).is_empty());
    client.notify("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    client.open("file:///renamed.fdc", "state x");
    assert_eq!(client.diagnostics()["uri"], URI);
    assert_eq!(client.diagnostics()["uri"], "file:///renamed.fdc");
    let gone = client.answer("textDocument/diagnostic", json!({ "textDocument": { "uri": URI } }));
    assert_eq!(gone.response_result.expect_err("closed").code, ErrorCode::RequestFailed as i32);
}

#[test]
fn a_client_that_asks_for_diagnostics_is_not_told_unasked() {
    let mut client = Client::start(json!({ "textDocument": { "diagnostic": {} } }));
    client.open(URI, "state x");
    let report =
        client.result("textDocument/diagnostic", json!({ "textDocument": { "uri": URI } }));
    assert_eq!(report["kind"], "full");
    assert!(report["items"].as_array().expect("a list").len() > 1);
    assert!(client.heard.is_empty());
}

#[test]
fn what_makes_no_sense_is_answered_and_the_conversation_goes_on() {
    let parse_error = ErrorCode::ParseError as i32;
    let no_request = ErrorCode::InvalidRequest as i32;
    let bodies = [
        ("{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\"", parse_error),
        ("", parse_error),
        ("\u{0}\u{1}", parse_error),
        ("[]", no_request),
        ("7", no_request),
        ("{}", no_request),
        ("{\"id\": null, \"method\": \"shutdown\"}", no_request),
        ("{\"method\": 7}", no_request),
        ("{\"method\": \"x\", \"params\": \"y\"}", no_request),
    ];
    let mut client = Client::start(json!({}));
    for (body, code) in bodies {
        client.send_text(body);
        let refusal = client.next_or_refusal().expect_err("no message");
        assert_eq!(refusal["error"]["code"], code, "{body}: {refusal}");
    }
    client.send_text(&"[".repeat(100_000));
    assert!(client.next_or_refusal().is_err());
    client.send_text("{\"id\": 1e99, \"method\": \"shutdown\"}");
    assert_eq!(client.next_or_refusal().expect_err("no id of ours")["id"], json!(1e99));
    client.send_text("{\"id\": 5, \"method\": \"no/such\"}");
    client.send_text(
        "{\"id\": 6, \"method\": \"textDocument/diagnostic\", \"params\": {\"textDocument\": 7}}",
    );
    for (id, code) in [("5", ErrorCode::MethodNotFound), ("6", ErrorCode::InvalidParams)] {
        let response = loop {
            match client.next_or_refusal() {
                Ok(Message::Response(response)) if response.id.to_string() == id => break response,
                _ => {}
            }
        };
        assert_eq!(response.response_result.expect_err("refused").code, code as i32);
    }
    assert!(client.end());
}

#[test]
fn a_header_that_makes_no_sense_is_skipped() {
    let headers: [&[u8]; 5] = [
        b"Content-Length: many\r\n\r\n",
        b"nonsense\r\n\r\n",
        b"Content-Type: x\r\n\r\n",
        b"\r\n",
        b"\xff\xfe\x00\r\n\r\n",
    ];
    let mut client = Client::start(json!({}));
    for header in headers {
        client.send_bytes(header);
        assert_eq!(
            client.next_or_refusal().expect_err("no message")["error"]["code"],
            ErrorCode::ParseError as i32
        );
    }
    // What is left of a message that was longer than it said.
    client.send_bytes(b"Content-Length: 2\r\n\r\n{}}}");
    assert!(client.next_or_refusal().is_err());
    assert!(client.end());
}
