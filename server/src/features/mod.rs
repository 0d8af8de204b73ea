//! What editors ask about a text: a file for each kind of question.

pub mod actions;
pub mod diagnostics;
pub mod folding;
pub mod formatting;
pub mod hover;
pub mod navigation;
pub mod rename;
pub mod symbols;
pub mod tokens;
