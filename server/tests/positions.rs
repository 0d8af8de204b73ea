//! Places in texts: each encoding, each kind of line end, characters of every size. References are
//! counted by hand.

mod client;

use client::{Client, URI};
use serde_json::{Value, json};

/// `e` with an accent is 2, 1 and 1 units wide, the astral alpha 4, 2 and 1.
const TEXT: &str = "\u{FEFF}param é𝛼 = 1 # ü\r\nlet b = é𝛼*zz\rlet c = b\n";

fn started(encodings: &Value) -> Client {
    let mut client = Client::connect();
    let general = json!({ "positionEncodings": encodings });
    let capabilities = json!({ "general": general, "textDocument": { "diagnostic": {} } });
    client.result("initialize", json!({ "capabilities": capabilities }));
    client
}

fn pair(position: &Value) -> (u64, u64) {
    let number = |name: &str| position[name].as_u64().expect("a number");
    (number("line"), number("character"))
}

/// The place of `zz`, which is unknown, and that of `é𝛼` where it is declared.
fn places(client: &mut Client, at: (u64, u64)) -> [((u64, u64), (u64, u64)); 2] {
    client.open(URI, TEXT);
    let document = json!({ "uri": URI });
    let report = client.result("textDocument/diagnostic", json!({ "textDocument": document }));
    let items = report["items"].as_array().expect("a list");
    let unknown = &items.iter().find(|it| it["code"] == "FDC0101").expect("zz is unknown")["range"];
    let position = json!({ "line": at.0, "character": at.1 });
    let declared = &client.result(
        "textDocument/definition",
        json!({ "textDocument": document, "position": position }),
    )["range"];
    [unknown, declared].map(|range| (pair(&range["start"]), pair(&range["end"])))
}

#[test]
fn columns_count_what_was_agreed_on() {
    let agreed = |offered: Value| {
        let mut client = Client::connect();
        let capabilities = json!({ "general": { "positionEncodings": offered } });
        let answer = client.result("initialize", json!({ "capabilities": capabilities }));
        answer["capabilities"]["positionEncoding"].clone()
    };
    assert_eq!(agreed(json!(["utf-8", "utf-16"])), "utf-8");
    assert_eq!(agreed(json!(["utf-32", "utf-16"])), "utf-32");
    assert_eq!(agreed(json!(["utf-7"])), "utf-16");
    assert_eq!(agreed(json!(7)), "utf-16");
    // param é𝛼: the mark is 3, 1 and 1 wide, `param ` 6.
    let mut utf8 = started(&json!(["utf-8"]));
    assert_eq!(places(&mut utf8, (1, 9)), [((1, 15), (1, 17)), ((0, 9), (0, 15))]);
    let mut utf16 = started(&json!(["utf-16"]));
    assert_eq!(places(&mut utf16, (1, 9)), [((1, 12), (1, 14)), ((0, 7), (0, 10))]);
    let mut utf32 = started(&json!(["utf-32"]));
    assert_eq!(places(&mut utf32, (1, 9)), [((1, 11), (1, 13)), ((0, 7), (0, 9))]);
}

/// Edits of the same characters, in each encoding, give the same text: `zz` becomes `1`, the line
/// break goes, `é𝛼` is renamed.
#[test]
fn edits_hit_what_they_mean() {
    let expected = "\u{FEFF}param a = 1 # ü\r\nlet b = a*1let c = b\n";
    let cases = [
        ("utf-8", [(1, 15, 1, 17), (1, 16, 2, 0), (1, 8, 1, 14), (0, 9, 0, 15)]),
        ("utf-16", [(1, 12, 1, 14), (1, 13, 2, 0), (1, 8, 1, 11), (0, 7, 0, 10)]),
        ("utf-32", [(1, 11, 1, 13), (1, 12, 2, 0), (1, 8, 1, 10), (0, 7, 0, 9)]),
    ];
    for (encoding, ranges) in cases {
        let mut client = started(&json!([encoding]));
        client.open(URI, TEXT);
        let edit = |(line, column, end_line, end_column): (u32, u32, u32, u32), text: &str| {
            let start = json!({ "line": line, "character": column });
            let end = json!({ "line": end_line, "character": end_column });
            json!({ "range": { "start": start, "end": end }, "text": text })
        };
        let changes: Vec<Value> =
            ranges.into_iter().zip(["1", "", "a", "a"]).map(|(it, text)| edit(it, text)).collect();
        client.change(URI, 2, json!(changes));
        // The text as the server has it: what it would fix, told as one whole.
        assert_eq!(text_of(&mut client, expected), None, "{encoding}");
    }
}

/// Nothing, if the server has this text: the same questions have the same answers after it is sent
/// anew.
fn text_of(client: &mut Client, expected: &str) -> Option<(Value, Value)> {
    let before = answers(client);
    client.change(URI, 3, json!([{ "text": expected }]));
    let after = answers(client);
    (before != after).then_some((before, after))
}

fn answers(client: &mut Client) -> Value {
    let document = json!({ "textDocument": { "uri": URI } });
    let methods = [
        "textDocument/semanticTokens/full",
        "textDocument/diagnostic",
        "textDocument/foldingRange",
    ];
    methods.map(|method| client.result(method, document.clone())).to_vec().into()
}

#[test]
fn places_outside_of_the_text_are_its_nearest() {
    let mut client = started(&json!(["utf-16"]));
    client.open(URI, TEXT);
    for (line, character) in [(0, 1000), (99, 0), (u32::MAX, u32::MAX), (1, 10)] {
        client.result("textDocument/hover", client::at(URI, line, character));
    }
    // A range that runs backwards, and one that ends beyond the text.
    let range =
        json!({ "start": { "line": 9, "character": 9 }, "end": { "line": 0, "character": 0 } });
    client.change(URI, 2, json!([{ "range": range, "text": "param a = 1\n" }]));
    assert_eq!(text_of(&mut client, "param a = 1\n"), None);
}
