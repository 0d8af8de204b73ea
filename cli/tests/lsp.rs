//! `fdcc lsp` as an editor starts it: a process that speaks over its streams, and solves with
//! itself.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

const MODEL: &str = "model fall\ntime t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ndynamics \
                     { x' = u }\nend x == 0.5\n\
                     minimize integral(u^2)\nmethod { grid N = 10 scheme implicit_euler }\n";

struct Server {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Server {
    fn start() -> Server {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fdcc"));
        let command = command.args(["lsp", "--stdio"]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = command.spawn().expect("fdcc starts");
        let input = process.stdin.take().expect("it has an input");
        let output = BufReader::new(process.stdout.take().expect("it has an output"));
        Server { process, input, output }
    }

    fn send(&mut self, message: Value) {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len())
            .expect("the server reads");
    }

    /// The next message for which something holds.
    fn wait_for(&mut self, is_meant: impl Fn(&Value) -> bool) -> Value {
        loop {
            let mut header = String::new();
            self.output.read_line(&mut header).expect("the server writes");
            let length = header.trim().strip_prefix("Content-Length: ").expect("a header");
            let mut rest = vec![0; 2 + length.parse::<usize>().expect("a number")];
            self.output.read_exact(&mut rest).expect("the whole message");
            let message: Value =
                serde_json::from_slice(&rest[2..]).expect("the server writes JSON");
            if is_meant(&message) {
                return message;
            }
        }
    }

    fn exit_code(mut self) -> Option<i32> {
        drop(self.input);
        self.process.wait().expect("it ends").code()
    }
}

#[test]
fn an_editor_opens_a_model_solves_it_and_goes() {
    let mut server = Server::start();
    let params = json!({ "capabilities": {} });
    server.send(json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": params }));
    let answer = server.wait_for(|it| it["id"] == 1);
    assert_eq!(answer["result"]["serverInfo"]["name"], "fdcc");
    server.send(json!({ "jsonrpc": "2.0", "method": "initialized", "params": {} }));
    let document =
        json!({ "uri": "untitled:fall", "languageId": "fdc", "version": 1, "text": MODEL });
    let params = json!({ "textDocument": document });
    server.send(json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": params }));
    let published = server.wait_for(|it| it["method"] == "textDocument/publishDiagnostics");
    assert_eq!(published["params"]["diagnostics"], json!([]));
    let command = json!({ "command": "fdcc.solve", "arguments": ["untitled:fall"] });
    server.send(json!({
        "jsonrpc": "2.0", "id": 2, "method": "workspace/executeCommand", "params": command
    }));
    let result = server.wait_for(|it| it["id"] == 2)["result"].clone();
    assert_eq!(result["exitCode"], 0, "{result}");
    // The least integral of u^2 that moves by 0.5 in time 1 is 0.25.
    assert!(result["output"].as_str().is_some_and(|it| it.contains("0.25")), "{result}");
    server.send(json!({ "jsonrpc": "2.0", "id": 3, "method": "shutdown" }));
    server.wait_for(|it| it["id"] == 3);
    server.send(json!({ "jsonrpc": "2.0", "method": "exit" }));
    assert_eq!(server.exit_code(), Some(0));
}

#[test]
fn an_editor_that_vanishes_leaves_no_process_behind() {
    let server = Server::start();
    assert_eq!(server.exit_code(), Some(1));
}
