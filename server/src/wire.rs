//! Messages on a stream: `Content-Length: 17`, an empty line, JSON.
//!
//! What cannot be read is refused, not fatal: reading goes on with the next header that can be
//! found.

use lsp_server::{ErrorCode, Message, RequestId};
use serde_json::{Value, json};
use std::io::{self, BufRead, Read, Write};

/// A longer header line is none.
const LONGEST_LINE: u64 = 4096;
/// A model has at most 4 MB; a message with one in it is a few times longer.
const LONGEST_BODY: u64 = 64_000_000;

/// What came in.
pub enum Received {
    /// A message that can be worked on.
    Message(Message),
    /// One that cannot, with what is answered.
    Refused(Refusal),
    /// A response that nobody can read is not answered.
    Nothing,
}

/// The answer to a message that cannot be read.
pub struct Refusal {
    /// The id of the request, or null where there is none to be found.
    pub id: Value,
    /// The kind of mistake.
    pub code: ErrorCode,
    /// In words.
    pub message: String,
}

/// The next message; nothing at the end of the stream.
pub fn read(input: &mut dyn BufRead) -> io::Result<Option<Received>> {
    let Some(header) = read_header(input)? else { return Ok(None) };
    let length = match header {
        Ok(length) if length <= LONGEST_BODY => length,
        Ok(length) => {
            io::copy(&mut input.take(length), &mut io::sink())?;
            return Ok(Some(refused(format!("a message of {length} bytes is too long"))));
        }
        Err(message) => return Ok(Some(refused(message))),
    };
    let mut body = vec![0; length as usize];
    match input.read_exact(&mut body) {
        Ok(()) => Ok(Some(understood(&body))),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
        Err(error) => Err(error),
    }
}

/// The length of the body that follows, or what is wrong with the header; nothing at the end of the
/// stream.
fn read_header(input: &mut dyn BufRead) -> io::Result<Option<Result<u64, String>>> {
    let mut length = Err("a header without `Content-Length`".to_owned());
    loop {
        let mut line = Vec::new();
        if input.take(LONGEST_LINE).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        if text.is_empty() {
            return Ok(Some(length));
        }
        // What is left of a message that was longer than it said may stand before it.
        let name = "content-length:";
        if let Some(at) = text.to_ascii_lowercase().rfind(name) {
            let value = text[at + name.len()..].trim();
            length = value.parse().map_err(|_| format!("`{value}` is no length of a message"));
        }
    }
}

fn refused(message: String) -> Received {
    Received::Refused(Refusal { id: Value::Null, code: ErrorCode::ParseError, message })
}

/// A message from its JSON.
fn understood(body: &[u8]) -> Received {
    let value: Value = match serde_json::from_slice(body) {
        Ok(value) => value,
        Err(error) => return refused(format!("this is not JSON: {error}")),
    };
    let id = value.get("id").cloned();
    let wrong = |message: &str| {
        let (id, message) = (id.clone().unwrap_or_default(), message.to_owned());
        Received::Refused(Refusal { id, code: ErrorCode::InvalidRequest, message })
    };
    let is_response = value.get("result").is_some() || value.get("error").is_some();
    if value.get("method").is_none() && is_response {
        return serde_json::from_value(value).map_or(Received::Nothing, Received::Message);
    }
    match value.get("method") {
        None => return wrong("a message has a `method`, or the `result` or `error` of a request"),
        Some(method) if !method.is_string() => return wrong("a `method` is a string"),
        Some(_) => {}
    }
    let is_list_or_object = |it: &Value| it.is_object() || it.is_array() || it.is_null();
    if !value.get("params").is_none_or(is_list_or_object) {
        return wrong("`params` are an object or an array");
    }
    if let Some(given) = &id
        && serde_json::from_value::<RequestId>(given.clone()).is_err()
    {
        return wrong("an `id` is a string or a whole number of 32 bits");
    }
    serde_json::from_value(value).map_or_else(|error| wrong(&error.to_string()), Received::Message)
}

/// Writes a message.
pub fn write(output: &mut dyn Write, message: &Message) -> io::Result<()> {
    message.write(&mut &mut *output)
}

/// Writes the answer to a message that could not be read.
pub fn write_refusal(output: &mut dyn Write, refusal: &Refusal) -> io::Result<()> {
    let error = json!({ "code": refusal.code as i32, "message": refusal.message });
    let text = json!({ "jsonrpc": "2.0", "id": refusal.id, "error": error }).to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}
