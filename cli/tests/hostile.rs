//! Files that are no models: a clear answer at once from every command, and no panic.

use crate::common::*;
use std::time::{Duration, Instant};

/// Generous: the tests share the machine.
const LIMIT: Duration = Duration::from_secs(5);

#[test]
fn every_command_answers_every_file() {
    let large = "param a = 1\n".repeat(450_000);
    let nested = format!("minimize {}1{}\n", "(".repeat(10_000), ")".repeat(10_000));
    let folder = folder(
        "hostile",
        &[
            ("empty.fdc", b""),
            ("comment.fdc", b"# nothing\n"),
            ("binary.fdc", b"\x7fELF\x00\xff\xfe\x00model"),
            ("zeros.fdc", &[0; 4096]),
            ("large.fdc", large.as_bytes()),
            ("nested.fdc", nested.as_bytes()),
        ],
    );
    std::fs::create_dir(folder.join("folder.fdc")).expect("a folder can be made");
    let files = [
        ("empty.fdc", 1, "FDC0008"),
        ("comment.fdc", 1, "FDC0008"),
        ("binary.fdc", 1, "FDC0007"),
        ("zeros.fdc", 1, "FDC0007"),
        ("large.fdc", 1, "FDC0009"),
        ("nested.fdc", 1, "FDC0004"),
        ("folder.fdc", 4, "folder.fdc cannot be read"),
        ("missing.fdc", 4, "missing.fdc cannot be read"),
    ];
    for (file, code, words) in files {
        let commands = [
            &["solve", file][..],
            &["sweep", file, "N=1,2"],
            &["show", file],
            &["test", file],
            &["simulate", file],
            &["grad", file],
        ];
        for command in commands {
            let begin = Instant::now();
            let output = fdcc(&folder, command, "");
            assert!(begin.elapsed() < LIMIT, "{command:?} takes {:?}", begin.elapsed());
            expect_exit(&output, code, &format!("{command:?}"));
            let said = stderr(&output);
            assert!(said.contains(words), "{command:?}: {said}");
            assert!(!said.contains("panicked") && said.len() < 10_000, "{command:?}: {said}");
        }
    }
}
