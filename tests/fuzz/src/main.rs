//! Texts chosen by coverage, through parse, check, layout and repair: `tests/src/fuzzed.rs` says
//! what must hold.
//!
//! How to run it is told in `docs/recipes/fuzz.md`.

#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| fdcc_tests::fuzzed::understand(text));
