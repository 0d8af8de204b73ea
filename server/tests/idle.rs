//! A server that nobody asks anything sleeps. Alone in its file, because the time of the whole
//! process is measured.

#![cfg(target_os = "linux")]

mod client;

use client::{Client, URI};
use serde_json::json;
use std::time::Duration;

/// Time that this process has computed for, in hundredths of a second.
fn computed() -> u64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("the system tells");
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    // The 14th and 15th field; the first two end with the name.
    after_name.split_whitespace().skip(11).take(2).filter_map(|it| it.parse::<u64>().ok()).sum()
}

#[test]
fn a_server_without_work_uses_no_time() {
    let mut client = Client::start(json!({}));
    client.open(URI, "time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n");
    client.diagnostics();
    let before = computed();
    std::thread::sleep(Duration::from_secs(2));
    assert!(
        computed() - before <= 5,
        "{} hundredths of a second in two seconds of rest",
        computed() - before
    );
    assert!(client.end());
}
