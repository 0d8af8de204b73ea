//! Random edits, requests, cancellations and nonsense: the server answers every request once, never
//! dies, never grows, and says in the end of a text what it says of it alone.
//!
//! `FUZZ_SECONDS=600 cargo test --release -p fdcc-server --test fuzz -- --nocapture` goes on for
//! ten minutes; `FUZZ_SEED` begins elsewhere.

mod client;

use client::{Client, URI};
use fdcc_tests::random::Random;
use lsp_server::Message;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What is inserted: pieces of models, and what never belongs into one.
const PIECES: &[&str] = &[
    "x",
    "v",
    "'",
    " ",
    "\n",
    "\r\n",
    "\r",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "+",
    "*",
    "^",
    "=",
    "in",
    ".",
    ",",
    "#",
    "\"",
    "0",
    "1e-3",
    "Sgn(",
    "match slip { below => 1, above => 2 }",
    "state q [m] start 0\n",
    "param p = 2 [kg]\n",
    "let a = x^2 + p\n",
    "surface slip = v\n",
    "dynamics { x' = v }\n",
    "phase one {\n",
    "piecewise { x <= 0 => 1 otherwise => 2 }",
    "time t in [0, 1]\n",
    "minimize integral(x^2)\n",
    "method { grid N = 10 scheme euler }\n",
    "é",
    "𝛼",
    "\u{FEFF}",
    "\u{0}",
    "\u{301}",
    "sum(k in obs, k.x)",
    "link a -> b { h := h }\n",
];

/// Requests about a place, a range, the whole text or all texts.
const METHODS: &[&str] = &[
    "textDocument/hover",
    "textDocument/completion",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/documentHighlight",
    "textDocument/prepareRename",
    "textDocument/rename",
    "textDocument/documentSymbol",
    "workspace/symbol",
    "textDocument/foldingRange",
    "textDocument/selectionRange",
    "textDocument/semanticTokens/full",
    "textDocument/semanticTokens/range",
    "textDocument/inlayHint",
    "textDocument/formatting",
    "textDocument/rangeFormatting",
    "textDocument/onTypeFormatting",
    "textDocument/codeAction",
    "textDocument/codeLens",
    "textDocument/signatureHelp",
    "textDocument/diagnostic",
    "textDocument/nothing",
];

const NONSENSE: &[&str] = &[
    "{",
    "[]",
    "null",
    "{\"id\": 1.5, \"method\": \"x\"}",
    "{\"jsonrpc\": \"2.0\"}",
    "\u{0}",
    "{\"method\": 7}",
    "{\"id\": \"a\", \"result\": 1}",
    "{\"method\": \"textDocument/didChange\", \"params\": {}}",
    "{\"method\": \"$/cancelRequest\", \"params\": {\"id\": null}}",
    "{\"method\": \"exit\", \"params\": 7}",
];

struct Fuzzer {
    random: Random,
    client: Client,
    version: i32,
    /// What each request is asked; taken out when it is answered.
    waiting: BTreeMap<String, String>,
    /// What was done, by kind.
    edits: usize,
    requests: usize,
    cancelled: usize,
    nonsense: usize,
    answered: usize,
    /// The newest version that something was said about.
    published: i64,
}

impl Fuzzer {
    fn new(seed: u64) -> Fuzzer {
        let client = Client::start(
            json!({ "textDocument": { "publishDiagnostics": { "relatedInformation": true } } }),
        );
        Fuzzer {
            random: Random::new(seed),
            client,
            version: 0,
            waiting: BTreeMap::new(),
            edits: 0,
            requests: 0,
            cancelled: 0,
            nonsense: 0,
            answered: 0,
            published: 0,
        }
    }

    fn place(&mut self) -> Value {
        let far = self.random.below(200) == 0;
        let line = if far { u32::MAX as usize } else { self.random.below(45) };
        json!({ "line": line, "character": self.random.below(60) })
    }

    fn range(&mut self) -> Value {
        let start = self.place();
        let end = match self.random.below(4) {
            0 => self.place(),
            1 => {
                let character = start["character"].as_u64().unwrap_or(0) + 5;
                json!({ "line": start["line"], "character": character })
            }
            _ => start.clone(),
        };
        json!({ "start": start, "end": end })
    }

    fn edit(&mut self) {
        let mut changes = Vec::new();
        for _ in 0..=self.random.below(2) {
            let text = if self.random.below(5) == 0 { "" } else { self.random.of(PIECES) };
            changes.push(json!({ "range": self.range(), "text": text }));
        }
        self.version += 1;
        self.edits += 1;
        self.client.change(URI, self.version, json!(changes));
    }

    fn reopen(&mut self, models: &[(String, String)]) {
        if self.random.below(2) == 0 {
            self.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
        }
        self.version += 1;
        let text = &models[self.random.below(models.len())].1;
        let document =
            json!({ "uri": URI, "languageId": "fdc", "version": self.version, "text": text });
        self.client.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    fn request(&mut self) {
        let method = self.random.of(METHODS);
        let place = self.place();
        let params = json!({
            "textDocument": { "uri": URI },
            "position": place,
            "range": self.range(),
            "positions": [place],
            "query": self.random.of(&["", "x", "Ä"]),
            "newName": self.random.of(&["y", "state", "θ", "two words", ""]),
            "context": { "diagnostics": [], "includeDeclaration": true, "triggerKind": 1 },
            "options": { "tabSize": 2, "insertSpaces": true },
            "ch": self.random.of(&["}", "\n"]),
        });
        let id = self.client.ask(method, params);
        self.requests += 1;
        self.waiting.insert(id.to_string(), method.to_owned());
        if self.random.below(8) == 0 {
            self.cancelled += 1;
            self.client.notify("$/cancelRequest", json!({ "id": id }));
        }
    }

    /// Takes in all answers, and has no patience for an error of ours.
    fn catch_up(&mut self) {
        let last = self
            .client
            .ask("textDocument/codeLens", json!({ "textDocument": { "uri": URI } }))
            .to_string();
        self.waiting.insert(last.clone(), "textDocument/codeLens".into());
        loop {
            let message = match self.client.next_or_refusal() {
                Ok(message) => message,
                Err(_) => continue,
            };
            match message {
                Message::Response(response) => {
                    let id = response.id.to_string();
                    let asked = self.waiting.remove(&id);
                    assert!(asked.is_some() || id == "\"a\"", "an answer to nothing: {id}");
                    self.answered += 1;
                    if let Err(error) = &response.response_result {
                        assert_ne!(error.code, -32603, "{asked:?}: {}", error.message);
                    }
                    if id == last {
                        break;
                    }
                }
                Message::Notification(it) if it.method == "textDocument/publishDiagnostics" => {
                    if let Some(version) = it.params["version"].as_i64() {
                        assert!(version >= self.published, "what is said goes back in time");
                        self.published = version;
                    }
                }
                other => panic!("nobody has asked for {other:?}"),
            }
        }
        assert!(self.waiting.is_empty(), "never answered: {:?}", self.waiting);
    }

    /// The text set anew: what is said about it must not depend on what was there before.
    fn compare(&mut self, models: &[(String, String)]) {
        let (_, text) = &models[self.random.below(models.len())];
        self.version += 1;
        self.client.change(URI, self.version, json!([{ "text": text }]));
        let document = json!({ "textDocument": { "uri": URI } });
        let here = self.client.result("textDocument/diagnostic", document);
        let mut alone = Client::start(
            json!({ "textDocument": { "diagnostic": { "relatedInformation": true } } }),
        );
        alone.open(URI, text);
        let there =
            alone.result("textDocument/diagnostic", json!({ "textDocument": { "uri": URI } }));
        assert_eq!(here, there);
        assert!(alone.end());
        // What was heard while waiting is looked at as always.
        self.client.heard.clear();
    }

    fn run(&mut self, time: Duration, models: &[(String, String)]) -> Vec<u64> {
        let (begin, mut memory) = (Instant::now(), Vec::new());
        self.reopen(models);
        while begin.elapsed() < time {
            for _ in 0..400 {
                match self.random.below(100) {
                    0..45 => self.edit(),
                    45..95 => self.request(),
                    95..98 => self.reopen(models),
                    _ => {
                        self.nonsense += 1;
                        let body = self.random.of(NONSENSE);
                        self.client.send_text(body);
                    }
                }
            }
            self.catch_up();
            self.compare(models);
            memory.push(resident());
        }
        memory
    }
}

/// Memory in use, in kilobytes; 0 where the system does not tell.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS")).unwrap_or_default();
    line.split_whitespace().nth(1).and_then(|it| it.parse().ok()).unwrap_or(0)
}

#[test]
fn nothing_that_a_client_does_ends_the_conversation() {
    let variable = |name: &str, default: u64| {
        std::env::var(name).ok().and_then(|it| it.parse().ok()).unwrap_or(default)
    };
    let models = fdcc_tests::documents("models", "fdc");
    let mut fuzzer = Fuzzer::new(variable("FUZZ_SEED", 1));
    let memory = fuzzer.run(Duration::from_secs(variable("FUZZ_SECONDS", 20)), &models);
    let Fuzzer { edits, requests, cancelled, nonsense, answered, .. } = fuzzer;
    let (early, late) = (memory[memory.len() / 4], memory[memory.len() - 1]);
    println!(
        "{edits} edits, {requests} requests, {cancelled} cancelled, {nonsense} messages of \
         nonsense, {answered} answers"
    );
    println!("memory: {early} kB after a quarter of the time, {late} kB at the end");
    assert!(late < early + early / 2 + 50_000, "memory grows: {memory:?}");
    assert!(fuzzer.client.end());
}
