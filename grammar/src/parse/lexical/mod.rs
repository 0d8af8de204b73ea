//! A text before the grammar has seen it: its words and signs, and the regions they form.

pub(super) mod items;
pub(super) mod limits;
pub(super) mod tokens;
pub mod words;
