//! What editors ask about a text: a file for each.

pub mod diagnostics;
