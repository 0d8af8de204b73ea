//! An editor for tests: talks to a server in the same process through pipes.

// Each test uses what it needs.
#![allow(dead_code)]

use lsp_server::{Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};
use std::io::{BufReader, PipeWriter, Write, pipe};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Longer than anything takes, on a machine that is busy with other things.
const PATIENCE: Duration = Duration::from_secs(60);

/// The address of the text that tests are about.
pub const URI: &str = "file:///model.fdc";

/// A client and its server.
pub struct Client {
    to_server: PipeWriter,
    from_server: Receiver<Result<Message, Value>>,
    server: JoinHandle<bool>,
    asked: i32,
    /// Everything that was not an answer, in order.
    pub heard: Vec<Message>,
}

impl Client {
    /// Connects, and says nothing yet.
    pub fn connect() -> Client {
        Client::connect_with("fdcc")
    }

    /// Connects to a server with another program for its commands.
    pub fn connect_with(program: &str) -> Client {
        let program = program.into();
        let (server_input, to_server) = pipe().expect("there are pipes");
        let (client_input, server_output) = pipe().expect("there are pipes");
        let server = std::thread::spawn(move || {
            fdcc_server::serve(BufReader::new(server_input), server_output, program)
        });
        let (queue, from_server) = channel();
        std::thread::spawn(move || {
            let mut input = BufReader::new(client_input);
            while let Some(message) = read(&mut input) {
                if queue.send(message).is_err() {
                    return;
                }
            }
        });
        Client { to_server, from_server, server, asked: 0, heard: Vec::new() }
    }

    /// Connects and agrees on capabilities.
    pub fn start(capabilities: Value) -> Client {
        let mut client = Client::connect();
        client.result(
            "initialize",
            json!({ "processId": null, "rootUri": null, "capabilities": capabilities }),
        );
        client.notify("initialized", json!({}));
        client
    }

    /// Sends bytes as they are.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.to_server.write_all(bytes).expect("the server reads");
    }

    /// Sends a body with its header.
    pub fn send_text(&mut self, body: &str) {
        self.send_bytes(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
    }

    /// Tells something.
    pub fn notify(&mut self, method: &str, params: Value) {
        let message = Message::Notification(Notification { method: method.into(), params });
        message.write(&mut self.to_server).expect("the server reads");
    }

    /// Asks something, and does not wait.
    pub fn ask(&mut self, method: &str, params: Value) -> RequestId {
        self.asked += 1;
        let id = RequestId::from(self.asked);
        let message = Message::Request(Request { id: id.clone(), method: method.into(), params });
        message.write(&mut self.to_server).expect("the server reads");
        id
    }

    /// Asks something and waits for the answer.
    pub fn answer(&mut self, method: &str, params: Value) -> Response {
        let id = self.ask(method, params);
        self.answer_to(&id)
    }

    /// Waits for the answer to a request.
    pub fn answer_to(&mut self, id: &RequestId) -> Response {
        loop {
            match self.next() {
                Message::Response(response) if response.id == *id => return response,
                other => self.heard.push(other),
            }
        }
    }

    /// Asks something and waits for a result.
    pub fn result(&mut self, method: &str, params: Value) -> Value {
        let response = self.answer(method, params);
        response.response_result.unwrap_or_else(|error| panic!("{method}: {}", error.message))
    }

    /// The next message of the server.
    pub fn next(&mut self) -> Message {
        self.next_or_refusal().unwrap_or_else(|refusal| panic!("refused: {refusal}"))
    }

    /// The next message of the server, or its answer to something that it could not read.
    pub fn next_or_refusal(&mut self) -> Result<Message, Value> {
        self.from_server.recv_timeout(PATIENCE).expect("the server says something")
    }

    /// Opens a text.
    pub fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "fdc", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Changes a text.
    pub fn change(&mut self, uri: &str, version: i32, changes: Value) {
        let document = json!({ "uri": uri, "version": version });
        self.notify(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": changes }),
        );
    }

    /// Waits for the diagnostics of a text, and gives the whole notification.
    pub fn diagnostics(&mut self) -> Value {
        loop {
            match self.next() {
                Message::Notification(it) if it.method == "textDocument/publishDiagnostics" => {
                    return it.params;
                }
                other => self.heard.push(other),
            }
        }
    }

    /// Ends the conversation as the protocol wants it; says whether the server thinks so too.
    pub fn end(mut self) -> bool {
        self.result("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        self.server.join().expect("the server does not panic")
    }

    /// Goes away without a word; says what the server thinks of that.
    pub fn leave(self) -> bool {
        drop(self.to_server);
        self.server.join().expect("the server does not panic")
    }
}

/// A message, or an answer whose id is none that we give.
fn read(input: &mut dyn std::io::BufRead) -> Option<Result<Message, Value>> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if input.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim().strip_prefix("Content-Length: ") {
            Some(value) => length = value.parse().expect("a length is a number"),
            None => break,
        }
    }
    let mut body = vec![0; length];
    input.read_exact(&mut body).ok()?;
    let value: Value = serde_json::from_slice(&body).expect("the server writes JSON");
    Some(serde_json::from_value(value.clone()).map_err(|_| value))
}

/// A place.
pub fn position(line: u32, character: u32) -> Value {
    json!({ "line": line, "character": character })
}

/// What a request about a place is about.
pub fn at(uri: &str, line: u32, character: u32) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": position(line, character) })
}
