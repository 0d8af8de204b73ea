//! What an installation needs besides the command: which program it is, completions, the manual.

use crate::common::*;
use std::fs;

#[test]
fn the_version_says_what_results_depend_on() {
    let folder = folder("installing_version", &[]);
    let short = stdout(&fdcc(&folder, &["-V"], ""));
    assert_eq!(short, format!("fdcc {}\n", env!("CARGO_PKG_VERSION")));
    let long = stdout(&fdcc(&folder, &["--version"], ""));
    assert!(long.starts_with(&format!("{} (", short.trim())), "{long}");
    assert!(long.contains(std::env::consts::ARCH), "{long}");
}

#[test]
fn shells_complete_the_commands() {
    let folder = folder("installing_completions", &[]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = fdcc(&folder, &["completions", shell], "");
        expect_exit(&output, 0, shell);
        let script = stdout(&output);
        assert!(script.contains("sweep") && script.contains("trajectories"), "{shell}: {script}");
    }
    expect_exit(&fdcc(&folder, &["completions", "cmd"], ""), 3, "no such shell");
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let folder = folder("installing_man", &[]);
    expect_exit(&fdcc(&folder, &["man", "man1"], ""), 0, "man");
    let help = stdout(&fdcc(&folder, &["--help"], ""));
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect();
    assert!(commands.contains(&"solve") && commands.contains(&"man"), "{help}");
    for name in commands {
        let page = fs::read_to_string(folder.join(format!("man1/fdcc-{name}.1")));
        assert!(page.expect(name).contains(&format!("fdcc\\-{name}")), "{name}");
    }
    let whole = fs::read_to_string(folder.join("man1/fdcc.1")).expect("the first page");
    assert!(whole.contains("friction"), "{whole}");
}
