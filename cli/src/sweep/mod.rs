//! Which cases a sweep has, and the files in which its rows are kept.

pub mod journal;
pub mod merge;
pub mod part;
pub mod values;
