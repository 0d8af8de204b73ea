//! The tests of fdcc live in `tests/`; this crate has no code of its own but what they share.

pub mod closed_loop;
pub mod expected;
pub mod expressions;
pub mod functions;
pub mod fuzzed;
pub mod imports;
pub mod large;
pub mod layout;
pub mod models;
pub mod optimality;
pub mod pages;
pub mod planar;
pub mod race;
pub mod random;
pub mod section_two;
pub mod sources;
pub mod svg;
pub mod symbols;
pub mod transcribed;

mod claims;
mod markdown;
mod quadrature;
mod rate;
mod solved;

pub use claims::unclaimed;
pub use markdown::{Block, blocks, documents, repository};
pub use rate::rate;
pub use solved::Solved;
