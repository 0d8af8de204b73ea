//! What `fdcc --version` says of the build: the commit and its date, where there is a repository.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // While developing, a commit is no reason to build anew.
    let is_release = std::env::var("PROFILE").is_ok_and(|it| it == "release");
    let build = if is_release { commit() } else { Some("development".to_owned()) };
    println!("cargo::rustc-env=FDCC_BUILD={}", build.as_deref().unwrap_or("no repository"));
}

/// `1a2b3c4d 2026-11-23`
fn commit() -> Option<String> {
    println!("cargo::rerun-if-changed={}", git(&["rev-parse", "--git-path", "logs/HEAD"])?);
    git(&["log", "-1", "--format=%h %cs"])
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
