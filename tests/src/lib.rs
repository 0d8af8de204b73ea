//! The tests of fdcc live in `tests/`; this crate has no code of its own but what they share.

pub mod functions;
pub mod random;
pub mod symbols;

mod claims;
mod markdown;

pub use claims::unclaimed;
pub use markdown::{Block, blocks, documents, repository};
