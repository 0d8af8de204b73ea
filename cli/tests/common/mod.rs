//! Running the command from outside.
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// The quickest way from 0 to 1 with the least `integral(u^2)` is straight: `u = 1`, `x = t`, on
/// every grid.
pub const RAMP: &str = "\
model ramp
param goal = 1
time t in [0, 1]
state x start 0
control u in [-4, 4]
dynamics { x' = u }
end x == goal
minimize integral(u^2)
method { grid N = 4 scheme implicit_euler }
report { double = 2*x }
";

/// A model of the repository.
pub fn model(name: &str) -> String {
    format!("{}/../models/{name}.fdc", env!("CARGO_MANIFEST_DIR"))
}

/// The smoothed race car of the paper.
pub fn smoothed_race_car() -> String {
    format!("{}/../tests/reference/racecar.fdc", env!("CARGO_MANIFEST_DIR"))
}

/// A model of the literature, by its place in `tests/classics`.
pub fn classic(name: &str) -> String {
    format!("{}/../tests/classics/{name}.fdc", env!("CARGO_MANIFEST_DIR"))
}

/// An empty folder of the test that calls it, with some files.
pub fn folder(name: &str, files: &[(&str, &[u8])]) -> PathBuf {
    let thread = std::thread::current();
    let test = thread.name().expect("it has the name of the test").replace("::", "-");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the folder for tests can be made");
    for (name, content) in files {
        fs::write(folder.join(name), content).expect("a file can be written");
    }
    folder
}

/// Starts `fdcc` in a folder, all its streams piped.
pub fn start(folder: &Path, arguments: &[&str]) -> Child {
    command(folder, arguments).spawn().expect("fdcc starts")
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fdcc"));
    command.args(arguments).current_dir(folder).env_remove("COLUMNS");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs `fdcc` in a folder with variables of the environment.
pub fn fdcc_with(folder: &Path, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
    command(folder, arguments).envs(variables.iter().copied()).output().expect("fdcc runs")
}

/// Runs `fdcc` in a folder to its end.
pub fn fdcc(folder: &Path, arguments: &[&str], input: &str) -> Output {
    let mut child = start(folder, arguments);
    // A command that does not read its input may be gone already.
    let _ = child.stdin.take().expect("the input is piped").write_all(input.as_bytes());
    child.wait_with_output().expect("fdcc ends")
}

/// The standard output as text.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("fdcc prints text")
}

/// The standard error as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("fdcc prints text")
}

/// The whole standard output as one JSON value.
pub fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}{}", stdout(output), stderr(output)))
}

/// Checks the exit code, and shows what was said if it is another one.
pub fn expect_exit(output: &Output, code: i32, case: &str) {
    assert_eq!(output.status.code(), Some(code), "{case}: {}{}", stdout(output), stderr(output));
}

/// A JSON value without its wall-clock times.
pub fn without_seconds(mut value: Value) -> Value {
    match &mut value {
        Value::Array(rows) => rows.iter_mut().for_each(|row| *row = without_seconds(row.take())),
        Value::Object(fields) => drop(fields.remove("seconds")),
        _ => {}
    }
    value
}

/// A number in a JSON value.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A column of numbers in a JSON value.
pub fn column(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("{value} is no array")).iter().map(number).collect()
}
