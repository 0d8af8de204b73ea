//! The tests of fdcc live in `tests/`; this crate has no code of its own but what they share.
