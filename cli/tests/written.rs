//! What is written: whole or not at all, whatever happens on the way; and what is told where it
//! cannot be.
#![cfg(unix)]

use crate::common::*;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const WIDE: &str = "param a=1\nparam  bb = 2\n";
const TIDY: &str = "param a  = 1\nparam bb = 2\n";

fn text(path: &Path) -> String {
    fs::read_to_string(path).expect("the file is there")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    let mut names: Vec<String> =
        entries.map(|it| name(it).to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn shell(folder: &Path, script: &str) -> Output {
    let script = script.replace("fdcc ", &format!("{} ", env!("CARGO_BIN_EXE_fdcc")));
    let mut command = Command::new("bash");
    command.args(["-c", &script]).current_dir(folder).stdin(Stdio::null());
    command.output().expect("there is a shell")
}

#[test]
fn permissions_and_links_stay_and_nothing_else_is_left() {
    let place = folder("written_links", &[("real.fdc", WIDE.as_bytes())]);
    let real = place.join("real.fdc");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("it is ours");
    symlink("real.fdc", place.join("link.fdc")).expect("links can be made");
    symlink("link.fdc", place.join("again.fdc")).expect("links can be made");
    expect_exit(&fdcc(&place, &["fmt", "again.fdc"], ""), 0, "fmt");
    assert_eq!(text(&real), TIDY);
    assert_eq!(real.metadata().expect("metadata").permissions().mode() & 0o777, 0o640);
    assert!(place.join("again.fdc").is_symlink() && place.join("link.fdc").is_symlink());
    assert_eq!(names(&place), ["again.fdc", "link.fdc", "real.fdc"]);
}

#[test]
fn solutions_replace_those_before_them_through_links_too() {
    let place = folder("written_out", &[("ramp.fdc", RAMP.as_bytes()), ("kept.csv", b"old")]);
    fs::create_dir(place.join("out")).expect("a folder");
    symlink("../kept.csv", place.join("out/ramp.csv")).expect("links can be made");
    symlink("../new.html", place.join("out/ramp.html")).expect("links can be made");
    let solve = ["solve", "ramp.fdc", "--out", "out", "--log", "none"];
    expect_exit(&fdcc(&place, &solve, ""), 0, "solve");
    assert!(
        text(&place.join("kept.csv")).starts_with("t,"),
        "the file behind the link is replaced"
    );
    assert!(text(&place.join("new.html")).contains("<h1"), "or made");
    assert_eq!(names(&place.join("out")), ["ramp.csv", "ramp.html", "ramp.sol.json"]);
}

/// A file system of a few pages, where somebody may make one.
struct Small<'p>(&'p Path);

impl<'p> Small<'p> {
    fn mounted(place: &'p Path) -> Option<Self> {
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=64k", "tmpfs"])
            .arg(place)
            .output();
        let is_there = mount.is_ok_and(|it| it.status.success());
        if !is_there {
            eprintln!("skipped: only the superuser can make a small file system");
        }
        is_there.then_some(Small(place))
    }
}

impl Drop for Small<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn on_a_full_disk_every_file_stays_as_it_is() {
    let place = folder("written_full_disk", &[]);
    let Some(_small) = Small::mounted(&place) else { return };
    let wide = "param  a=1 # something to say\n".repeat(1000);
    fs::write(place.join("wide.fdc"), &wide).expect("there is room for one");
    fs::write(place.join("ramp.fdc"), RAMP).expect("and for this");
    fs::write(place.join("ramp.sol.json"), "good").expect("and for this");
    let room = 64 * 1024 - 8 * 4096 - 2 * 4096;
    fs::write(place.join("rest"), vec![0; room]).expect("the rest is taken");
    let output = fdcc(&place, &["fmt", "wide.fdc"], "");
    expect_exit(&output, 4, "fmt");
    assert!(stderr(&output).contains("wide.fdc cannot be written"), "{}", stderr(&output));
    assert_eq!(text(&place.join("wide.fdc")), wide);
    let solve = ["solve", "ramp.fdc", "--out", ".", "--method", "N=400", "--log", "none"];
    expect_exit(&fdcc(&place, &solve, ""), 4, "solve");
    assert_eq!(text(&place.join("ramp.sol.json")), "good");
    let new = fdcc(&place, &["new", "racecar", "new.fdc"], "");
    expect_exit(&new, 4, "new");
    let left = names(&place);
    assert!(left.iter().all(|name| !name.starts_with('.') && name != "new.fdc"), "{left:?}");
}

#[test]
fn a_file_that_may_not_be_written_is_not_replaced() {
    let place = folder("written_read_only", &[("wide.fdc", WIDE.as_bytes())]);
    let path = place.join("wide.fdc");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).expect("it is ours");
    if fs::OpenOptions::new().write(true).open(&path).is_ok() {
        return eprintln!("skipped: the superuser may write everything");
    }
    expect_exit(&fdcc(&place, &["fmt", "wide.fdc"], ""), 4, "fmt");
    assert_eq!(text(&path), WIDE);
}

/// Everything that prints, with what it prints.
const COMMANDS: &[&str] = &[
    "check ramp.fdc",
    "check ramp.fdc --format json",
    "solve ramp.fdc --log none",
    "solve ramp.fdc --log none --json",
    "simulate ramp.fdc",
    "grad ramp.fdc",
    "verify ramp.sol.json ramp.fdc",
    "sweep ramp.fdc goal=1,2 --log none",
    "test ramp.fdc",
    "show ramp.fdc",
    "explain 101",
    "fmt - < ramp.fdc",
    "fmt --check wide.fdc",
    "fix - < ramp.fdc",
    "new friction new.fdc",
    "--help",
    "--version",
    "solve --help",
];

fn printing(test: &str) -> std::path::PathBuf {
    let place = folder(test, &[("ramp.fdc", RAMP.as_bytes()), ("wide.fdc", WIDE.as_bytes())]);
    expect_exit(&fdcc(&place, &["solve", "ramp.fdc", "--out", "."], ""), 0, "solve");
    place
}

#[test]
fn a_full_standard_output_is_told() {
    if !Path::new("/dev/full").exists() {
        return eprintln!("skipped: this system has no /dev/full");
    }
    let place = printing("written_dev_full");
    for command in COMMANDS {
        let output = shell(&place, &format!("rm -f new.fdc; fdcc {command} > /dev/full"));
        expect_exit(&output, 4, command);
        let said = stderr(&output);
        assert_eq!(
            said.matches("cannot write to the standard output").count(),
            1,
            "{command}: {said}"
        );
    }
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let place = printing("written_closed_pipe");
    for command in COMMANDS {
        // The reader is gone before anything is printed.
        let script =
            format!("rm -f new.fdc; {{ sleep 0.1; fdcc {command}; echo $? > code; }} | true");
        let output = shell(&place, &script);
        let said = stderr(&output).to_lowercase();
        assert!(
            !["pipe", "standard output", "panicked"].iter().any(|it| said.contains(it)),
            "{said}"
        );
        assert_eq!(text(&place.join("code")).trim(), "0", "{command}");
    }
}

#[test]
fn what_was_asked_for_is_written_though_nobody_reads() {
    let place = printing("written_unread");
    shell(&place, "{ sleep 0.1; fdcc solve ramp.fdc --out files --log none; } | true");
    assert!(place.join("files/ramp.sol.json").exists());
}

/// Far more work than a test waits for, in rows that are done at once.
const SLOW: [&str; 6] = ["sweep", "slow.fdc", "--trajectories", "--out", "all", "--jobs"];

fn many_rows() -> String {
    let goals: Vec<String> =
        (0..4000).map(|row| format!("{}", 1.0 + f64::from(row) / 4000.0)).collect();
    format!("goal={}", goals.join(","))
}

fn wait_for(path: &Path) {
    for _ in 0..6000 {
        if path.exists() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("{} does not come", path.display());
}

#[test]
fn rows_that_were_solved_survive_a_kill() {
    let place = folder("written_kill", &[("slow.fdc", RAMP.as_bytes())]);
    let rows = many_rows();
    let mut child = start(&place, &[&SLOW[..], &["1", &rows]].concat());
    wait_for(&place.join("all/ramp.3.html"));
    child.kill().expect("it runs");
    let _ = child.wait();
    for row in 1..=3 {
        let saved = text(&place.join(format!("all/ramp.{row}.sol.json")));
        let saved: serde_json::Value = serde_json::from_str(&saved).expect("whole");
        assert_eq!(saved["status"], "solved");
    }
    assert!(!place.join("all/ramp.4000.sol.json").exists());
}

#[test]
fn ctrl_c_writes_no_row_that_never_ran_and_counts_those_that_did() {
    let place = folder("written_interrupt", &[("slow.fdc", RAMP.as_bytes())]);
    let rows = many_rows();
    let child = start(&place, &[&SLOW[..], &["2", &rows, "--json", "--log", "none"]].concat());
    wait_for(&place.join("all/ramp.3.html"));
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    expect_exit(&output, 2, "interrupted");
    let ran = json(&output)["rows"].as_u64().expect("a count") as usize;
    assert!((3..4000).contains(&ran), "{ran}");
    let said = stderr(&output);
    assert!(said.contains(&format!("interrupted: {ran} of 4000 rows ran")), "{said}");
    let files = names(&place.join("all"));
    assert_eq!(files.iter().filter(|name| name.ends_with(".sol.json")).count(), ran);
}

#[test]
fn ctrl_c_prints_no_row_that_was_cut_off() {
    let place = folder("written_table", &[]);
    let racecar = smoothed_race_car();
    let rows = format!("muN={}", vec!["1"; 200].join(","));
    let arguments = ["sweep", &racecar, &rows, "--jobs", "2", "--json", "--method", "N=400"];
    let mut child = start(&place, &arguments);
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    assert!(lines.any(|line| line.expect("text").contains("row 1 solved")), "a row is solved");
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    let said: Vec<String> = lines.map(|line| line.expect("text")).collect();
    let output = child.wait_with_output().expect("it ends");
    expect_exit(&output, 2, "interrupted");
    let rows = json(&output);
    let rows = rows.as_array().expect("rows");
    assert!(!rows.is_empty() && rows.iter().all(|row| row["status"] == "solved"), "{rows:?}");
    let counted = format!("interrupted: {} of 200 rows ran", rows.len());
    assert!(said.iter().any(|line| line.contains(&counted)), "{said:?}");
}

#[test]
fn ctrl_c_counts_the_starts_that_ran() {
    let place = folder("written_starts", &[]);
    let racecar = smoothed_race_car();
    let arguments = ["solve", &racecar, "--starts", "5000", "--log", "full", "--no-verify"];
    let mut child = start(&place, &arguments);
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    assert!(lines.any(|line| line.expect("text").contains("start")), "a start begins");
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    let said: Vec<String> = lines.map(|line| line.expect("text")).collect();
    // Some start may have been solved by then.
    assert!(matches!(child.wait().expect("it ends").code(), Some(0 | 2)));
    let said = said.join("\n");
    let line = said.lines().find(|line| line.contains("of 5000 starts came to their end"));
    let numbers = line.unwrap_or_else(|| panic!("{said}")).split_whitespace();
    let numbers: Vec<usize> = numbers.filter_map(|word| word.parse().ok()).collect();
    assert_eq!(numbers[0] + numbers[2] + numbers[3], 5000, "{line:?}");
}
