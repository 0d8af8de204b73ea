//! `workspace/executeCommand`: solving and simulating, by `fdcc` itself in a process of its own.
//!
//! The text is what the editor shows, saved or not. A command can be called off by its request or
//! by its progress; whatever still runs ends with the state.

use crate::client::{Client, Failure};
use crate::pages;
use crate::runner::Job;
use crate::state::State;
use lsp_server::Request;
use lsp_types::{ExecuteCommandParams, InlayHintRefreshRequest, Uri};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};

/// Commands with their titles.
pub const COMMANDS: &[(&str, &str)] =
    &[("fdcc.solve", "Solve"), ("fdcc.simulate", "Simulate"), ("fdcc.report", "Show report")];

/// Begins a command; the answer comes when it has ended, or at once where it cannot begin.
pub fn execute(state: &mut State, request: Request) {
    let (id, client) = (request.id.clone(), state.client.clone());
    match job(state, request).and_then(|job| begin(state, &client, job)) {
        Ok(()) => {}
        Err(failure) => client.answer(id, Err(failure)),
    }
}

fn begin(state: &State, client: &Client, job: Job) -> Result<(), Failure> {
    let running = job
        .start()
        .map_err(|error| Failure::request(format!("fdcc cannot be started: {error}")))?;
    let list = state.commands.running.clone();
    list.lock().unwrap_or_else(PoisonError::into_inner).push(running.clone());
    let (client, results) = (client.clone(), state.results.clone());
    let refreshes_hints = state.agreed.refreshes_hints;
    std::thread::spawn(move || {
        let result = running.follow(&client, &job);
        if let (true, Ok(printed)) = (job.arguments[0] == "solve", &result) {
            results.keep(&job.uri, &job.text, printed["output"].as_str().unwrap_or_default());
            if refreshes_hints {
                client.ask::<InlayHintRefreshRequest>(());
            }
        }
        list.lock().unwrap_or_else(PoisonError::into_inner).retain(|it| !Arc::ptr_eq(it, &running));
        client.answer(job.id, result);
    });
    Ok(())
}

/// What is to be run.
fn job(state: &State, request: Request) -> Result<Job, Failure> {
    let params: ExecuteCommandParams = serde_json::from_value(request.params)
        .map_err(|error| Failure::params(error.to_string()))?;
    let command = COMMANDS.iter().find(|row| row.0 == params.command);
    let &(name, title) = command
        .ok_or_else(|| Failure::params(format!("there is no command `{}`", params.command)))?;
    let Some(Value::String(address)) = params.arguments.unwrap_or_default().into_iter().next()
    else {
        return Err(Failure::params(format!("`{name}` takes the address of a text")));
    };
    let uri = Uri(address);
    let (text, model) = subject(state, &uri)?;
    let (arguments, report) = arguments(name, &model)?;
    Ok(Job {
        id: request.id,
        title: format!("{title} {model}"),
        program: state.program.clone(),
        arguments,
        folder: folder_of(&uri),
        text,
        token: params.work_done_progress_params.work_done_token,
        makes_token: state.agreed.progress,
        uri,
        report,
    })
}

/// The text at an address and the name of its model, if that can be computed now.
fn subject(state: &State, uri: &Uri) -> Result<(Arc<str>, String), Failure> {
    let document =
        state.documents.get(uri).ok_or_else(|| Failure::request(format!("`{uri}` is not open")))?;
    if state.commands.is_busy(uri) {
        return Err(Failure::request(
            "this model is being computed already; cancel that, or wait for it",
        ));
    }
    let snapshot = document.snapshot();
    match snapshot.model_name() {
        Some(name) => Ok((snapshot.text.text.clone(), name.to_owned())),
        None => Err(Failure::request("this model has mistakes; mend them first")),
    }
}

/// What `fdcc` is given; the text comes over its standard input. And the report that it writes, if
/// one is wanted.
fn arguments(name: &str, model: &str) -> Result<(Vec<String>, Option<PathBuf>), Failure> {
    let owned = |words: &[&str]| words.iter().map(|it| (*it).to_owned()).collect();
    if name != "fdcc.report" {
        return Ok((owned(&[name.trim_start_matches("fdcc."), "-"]), None));
    }
    let folder = pages::folder()
        .ok_or_else(|| Failure::request("there is no place for a report"))?
        .join("reports");
    let report = folder.join(format!("{model}.html"));
    Ok((owned(&["solve", "-", "--out", &folder.display().to_string()]), Some(report)))
}

/// Where measurements that a model names are looked for.
fn folder_of(uri: &Uri) -> Option<PathBuf> {
    let path = pages::path(uri)?;
    path.parent().filter(|it| it.is_dir()).map(Path::to_owned)
}
