//! What editors ask about a text: a file for each kind of question.

pub mod actions;
pub mod completion;
pub mod cursor;
pub mod diagnostics;
pub mod folding;
pub mod formatting;
pub mod hints;
pub mod hover;
pub mod lens;
pub mod navigation;
pub mod rename;
pub mod signature;
pub mod symbols;
pub mod tokens;
pub mod workspace;
