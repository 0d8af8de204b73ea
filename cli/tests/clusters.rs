//! The page about sweeps on clusters: its commands do what it says.

use crate::common::{expect_exit, fdcc, folder, stdout};
use std::fs;

/// The blocks of the page with their tags, in their order.
fn blocks(page: &str) -> Vec<(&str, &str)> {
    let fences = page.split("\n```").skip(1).step_by(2);
    fences.filter_map(|block| block.split_once('\n')).collect()
}

#[test]
fn the_commands_of_the_page_do_what_it_says() {
    let read = |path: &str| {
        let path = format!("{}/../{path}", env!("CARGO_MANIFEST_DIR"));
        fs::read_to_string(path).expect("the file is there")
    };
    let (page, block) = (read("docs/clusters.md"), read("models/block.fdc"));
    let blocks = blocks(&page);
    let cases = blocks.iter().find(|(tag, _)| *tag == "csv").expect("cases are shown").1;
    let files = [("block.fdc", block.as_bytes()), ("cases.csv", cases.as_bytes())];
    let folder = folder("page_clusters", &files);
    let (mut printed, mut tables, mut commands) = (String::new(), Vec::new(), 0);
    for (tag, text) in blocks {
        for line in text.lines() {
            if let ("sh", Some(command)) = (tag, line.strip_prefix("fdcc ")) {
                let output = fdcc(&folder, &command.split(' ').collect::<Vec<_>>(), "");
                expect_exit(&output, 0, command);
                (printed, commands) = (stdout(&output), commands + 1);
                tables.extend(command.starts_with("merge").then(|| printed.clone()));
            }
            let is_printed = || printed.lines().any(|own| own.starts_with(line));
            assert!(tag != "text" || is_printed(), "the page says\n{line}\nand not\n{printed}");
        }
    }
    assert_eq!(commands, 8, "all commands are run");
    assert_eq!(tables.len(), 2);
    assert_eq!(tables[0], tables[1], "one process and two write the same table");
}
