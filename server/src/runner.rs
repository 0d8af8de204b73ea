//! A process of `fdcc`, with its progress in the editor.

use crate::client::{Client, Failure};
use crate::pages;
use lsp_server::{ErrorCode, RequestId};
use lsp_types::{
    MessageType, ProgressNotification, ProgressParams, ProgressToken, ShowDocumentParams,
    ShowDocumentRequest, ShowMessageNotification, ShowMessageParams, Uri,
    WorkDoneProgressCreateParams, WorkDoneProgressCreateRequest,
};
use serde_json::{Value, json};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What is to be run.
pub struct Job {
    /// The request that asks for it.
    pub id: RequestId,
    /// What its progress is called.
    pub title: String,
    /// `fdcc`.
    pub program: PathBuf,
    /// What it is given.
    pub arguments: Vec<String>,
    /// Where it runs.
    pub folder: Option<PathBuf>,
    /// The model.
    pub text: Arc<str>,
    /// The progress that the client asks for.
    pub token: Option<ProgressToken>,
    /// Whether a progress may be begun without being asked for.
    pub makes_token: bool,
    /// The address of the model.
    pub uri: Uri,
    /// What is opened at the end.
    pub report: Option<PathBuf>,
}

/// What is being run.
pub struct Running {
    /// The request that asks for it.
    pub id: RequestId,
    /// Its progress.
    pub token: Option<ProgressToken>,
    /// The address of the model.
    pub uri: Uri,
    child: Mutex<Child>,
    is_stopped: AtomicBool,
}

impl Job {
    /// Starts the process.
    pub fn start(&self) -> io::Result<Arc<Running>> {
        let mut command = Command::new(&self.program);
        command
            .args(&self.arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        self.folder.iter().for_each(|folder| {
            command.current_dir(folder);
        });
        let own = || self.makes_token.then(|| ProgressToken::String(format!("fdcc {}", self.id)));
        let running = Running {
            id: self.id.clone(),
            token: self.token.clone().or_else(own),
            uri: self.uri.clone(),
            child: Mutex::new(command.spawn()?),
            is_stopped: AtomicBool::new(false),
        };
        Ok(Arc::new(running))
    }
}

impl Running {
    /// Ends the process; [`Running::follow`] sees it.
    pub fn stop(&self) {
        self.is_stopped.store(true, Ordering::SeqCst);
        // One that has ended by itself cannot be ended.
        let _ = self.child().kill();
    }

    fn child(&self) -> std::sync::MutexGuard<'_, Child> {
        self.child.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells the client how it goes, and gives what it is answered in the end.
    pub fn follow(&self, client: &Client, job: &Job) -> Result<Value, Failure> {
        if job.token.is_none() {
            self.token.iter().for_each(|token| {
                client.ask::<WorkDoneProgressCreateRequest>(WorkDoneProgressCreateParams {
                    token: token.clone(),
                })
            });
        }
        self.progress(client, json!({ "kind": "begin", "title": job.title, "cancellable": true }));
        let output = self.communicate(client, &job.text);
        let status = self.child().wait();
        let is_stopped = self.is_stopped.load(Ordering::SeqCst);
        self.progress(
            client,
            json!({ "kind": "end", "message": if is_stopped { "cancelled" } else { "done" } }),
        );
        if is_stopped {
            return Err(Failure::cancelled());
        }
        let code = status.ok().and_then(|it| it.code());
        let failed = |message: String| Failure { code: ErrorCode::RequestFailed, message };
        let output = output.map_err(|error| failed(format!("fdcc broke off: {error}")))?;
        self.tell(client, job, &output, code);
        Ok(json!({ "exitCode": code, "output": output.stdout, "log": output.stderr }))
    }

    /// Hands over the text and reads both streams; the log is told line by line.
    fn communicate(&self, client: &Client, text: &Arc<str>) -> io::Result<Output> {
        let (stdin, stdout, stderr) = {
            let mut child = self.child();
            (child.stdin.take(), child.stdout.take(), child.stderr.take())
        };
        let text = text.clone();
        std::thread::spawn(move || {
            // A process that does not want the text has said why.
            stdin.into_iter().for_each(|mut it| drop(it.write_all(text.as_bytes())));
        });
        let results = std::thread::spawn(move || read_all(stdout));
        let mut log = String::new();
        for line in stderr.into_iter().flat_map(|it| BufReader::new(it).lines()) {
            let line = line?;
            self.progress(client, json!({ "kind": "report", "message": line.trim() }));
            log += &format!("{line}\n");
        }
        let stdout = results.join().unwrap_or_default();
        Ok(Output { stdout, stderr: log })
    }

    fn progress(&self, client: &Client, value: Value) {
        if let Some(token) = &self.token {
            client.notify::<ProgressNotification>(ProgressParams { token: token.clone(), value });
        }
    }

    /// The verdict, and the report if that was wanted.
    fn tell(&self, client: &Client, job: &Job, output: &Output, code: Option<i32>) {
        let is_fine = code == Some(0);
        let source = if output.stdout.trim().is_empty() { &output.stderr } else { &output.stdout };
        let message = source
            .lines()
            .map(str::trim)
            .find(|it| !it.is_empty())
            .unwrap_or("nothing was said")
            .to_owned();
        let kind = if is_fine { MessageType::Info } else { MessageType::Warning };
        client.notify::<ShowMessageNotification>(ShowMessageParams { kind, message });
        let made = job.report.as_ref().filter(|it| it.is_file()).and_then(|it| pages::address(it));
        if let Some(uri) = made {
            let external = Some(true);
            client.ask::<ShowDocumentRequest>(ShowDocumentParams {
                uri,
                external,
                take_focus: None,
                selection: None,
            });
        }
    }
}

/// What a process has written.
struct Output {
    stdout: String,
    stderr: String,
}

fn read_all(stream: Option<ChildStdout>) -> String {
    let mut bytes = Vec::new();
    // What was written before it broke off is still worth showing.
    stream.into_iter().for_each(|mut it| drop(it.read_to_end(&mut bytes)));
    String::from_utf8_lossy(&bytes).into_owned()
}
